#include "ros/wrinkle_topic.hpp"

#include "frontalis/ros/conversions.hpp"

#include <boost/make_shared.hpp>
#include <ros/console.h>

#include <algorithm>
#include <utility>

namespace frontalis
{
namespace
{

// thrown to end a measurement whose result nobody waits for
struct Stopped
{
};

template <typename Vector>
void fill(Vector& to, const std::array<double, 3>& from)
{
  to.x = from[0];
  to.y = from[1];
  to.z = from[2];
}

}  // namespace

WrinkleTopic::WrinkleTopic(ros::NodeHandle& handle)
    : publisher_(handle.advertise<SkinWrinkles>("wrinkles", 1)), thread_([this] { run(); })
{
}

WrinkleTopic::~WrinkleTopic()
{
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

void WrinkleTopic::start(std::shared_ptr<const Model> model, const std::vector<double>& part)
{
  auto face = std::make_shared<Face>();
  face->model = std::move(model);
  for (std::size_t i = 0; i < part.size(); ++i)
    (i < 2 ? face->settings.lower : face->settings.upper)[1 + i % 2] = part[i];
  const std::vector<std::array<float, 3>> skin = rest_in_face(*face->model).vertices;
  if (!part.empty() &&
      std::none_of(skin.begin(), skin.end(), [&](const auto& vertex) { return face->settings.contains(vertex); }))
    ROS_WARN("~wrinkles_in: no skin lies there; must be two corners LEFT, UP, LEFT, UP in metres");
  const std::lock_guard<std::mutex> lock(mutex_);
  face_ = std::move(face);
  wanted_.reset();
}

void WrinkleTopic::offer(const SkinState& skin, const std_msgs::Header& header)
{
  if (publisher_.getNumSubscribers() == 0)
    return;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    wanted_ = Wanted{ face_, skin, header };
  }
  wake_.notify_all();
}

void WrinkleTopic::run()
{
  std::unique_lock<std::mutex> lock(mutex_);
  for (;;)
  {
    wake_.wait(lock, [&] { return stop_ || wanted_; });
    if (stop_)
      return;
    const Wanted wanted = *std::exchange(wanted_, std::nullopt);
    lock.unlock();
    try
    {
      publisher_.publish(measured(wanted));
    }
    catch (const Stopped&)
    {
    }
    catch (const std::exception& error)
    {
      if (warning_.passes(10))
        ROS_ERROR("wrinkles are not measured: %s", error.what());
    }
    lock.lock();
  }
}

SkinWrinklesPtr WrinkleTopic::measured(const Wanted& wanted)
{
  const auto go_on = [&](double)
  {
    if (stop_ || publisher_.getNumSubscribers() == 0)
      throw Stopped();
  };
  Face& face = *wanted.face;
  if (!face.meter)
  {
    const SkinTriangles& triangles = face.model->skin.triangles;
    face.meter = std::make_unique<WrinkleMeter>(rest_in_face(*face.model), triangles, face.settings, go_on);
  }
  // A face that stands still repeats its frame.
  auto message = boost::make_shared<SkinWrinkles>();
  if (latest_ && latest_wanted_.face == wanted.face && latest_wanted_.skin.vertices == wanted.skin.vertices)
    *message = *latest_;
  else
  {
    const auto found = face.meter->measure(wanted.skin, go_on);
    message->count = found.count;
    message->depth = found.depth;
    message->deepest = found.deepest;
    message->spacing = found.spacing;
    fill(message->direction, found.direction);
    for (const Furrow& furrow : found.furrows)
    {
      fill(message->line.emplace_back(), furrow.middle);
      message->line_depth.push_back(furrow.depth);
      message->line_length.push_back(furrow.length);
    }
  }
  message->header = wanted.header;
  latest_ = message;
  latest_wanted_ = wanted;
  return message;
}

}  // namespace frontalis
