#pragma once

#include "frontalis/model/model.hpp"
#include "frontalis/ros/wall_throttle.hpp"
#include "frontalis/study/wrinkles.hpp"

#include <frontalis/SkinWrinkles.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

namespace frontalis
{

/// Measures the wrinkles of frames in a thread of its own and publishes them on ~wrinkles. Frames that come while it
/// measures are left out, except for the latest.
class WrinkleTopic
{
public:
  explicit WrinkleTopic(ros::NodeHandle& handle);
  ~WrinkleTopic();
  WrinkleTopic(const WrinkleTopic&) = delete;
  WrinkleTopic& operator=(const WrinkleTopic&) = delete;

  /// Sets the skin of later frames. `part`: the part of the skin at rest that is measured, LEFT, UP, LEFT, UP [m] of
  /// two corners in the face frame; empty: all.
  void start(std::shared_ptr<const Model> model, const std::vector<double>& part);

  /// Publishes the wrinkles of a frame once they are measured. Does nothing while nobody listens.
  void offer(const SkinState& skin, const std_msgs::Header& header);

private:
  /// The face that is measured, and its meter, which is made when there is something to measure.
  struct Face
  {
    std::shared_ptr<const Model> model;
    WrinkleSettings settings;
    std::unique_ptr<WrinkleMeter> meter;
  };
  struct Wanted
  {
    std::shared_ptr<Face> face;
    SkinState skin;
    std_msgs::Header header;
  };

  void run();
  SkinWrinklesPtr measured(const Wanted& wanted);

  ros::Publisher publisher_;
  std::mutex mutex_;  // protects the members up to stop_
  std::condition_variable wake_;
  std::shared_ptr<Face> face_;
  std::optional<Wanted> wanted_;
  std::atomic<bool> stop_{ false };
  // used by the thread: the latest message, and the face and the skin that it is about
  SkinWrinklesPtr latest_;
  Wanted latest_wanted_;
  WallThrottle warning_;
  std::thread thread_;
};

}  // namespace frontalis
