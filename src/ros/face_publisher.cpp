#include "frontalis/ros/face_publisher.hpp"

#include "frontalis/ros/brows.hpp"

#include <boost/make_shared.hpp>

#include <atomic>

namespace frontalis
{

namespace
{

/// The message in `slot` with its header set. If a subscriber in this process still holds the message, it is replaced
/// by a new one.
template <typename Message>
Message& reuse_or_make(boost::shared_ptr<Message>& slot, const std::string& frame, const ros::Time& stamp)
{
  if (!slot || slot.use_count() > 1)
    slot = boost::make_shared<Message>();
  else
    std::atomic_thread_fence(std::memory_order_acquire);
  slot->header.frame_id = frame;
  slot->header.stamp = stamp;
  return *slot;
}

}  // namespace

FacePublisher::FacePublisher(ros::NodeHandle private_handle)
    : skin_(private_handle.advertise<visualization_msgs::Marker>("skin", 1)),
      points_(private_handle.advertise<sensor_msgs::PointCloud2>("skin_points", 1)),
      field_(private_handle.advertise<sensor_msgs::PointCloud2>("skin_field", 1)),
      topology_(private_handle.advertise<shape_msgs::Mesh>("skin_topology", 1, true)),
      landmarks_(private_handle.advertise<geometry_msgs::PoseArray>("landmarks", 1)),
      state_(private_handle.advertise<SimulationState>("state", 1))
{
}

void FacePublisher::start(std::shared_ptr<const Model> model, const std::string& face_frame,
                          const std::string& parent_frame, const std::string& backend)
{
  model_ = std::move(model);
  face_frame_ = face_frame;
  backend_ = backend;
  shading_ = std::make_unique<SkinShading>(model_->skin, brow_cover(*model_));
  rest_ = rest_in_face(*model_);
  topology_.publish(to_mesh(*model_));
  if (!parent_frame.empty())
  {
    geometry_msgs::TransformStamped transform;
    transform.header.stamp = ros::Time::now();
    transform.header.frame_id = parent_frame;
    transform.child_frame_id = face_frame_;
    transform.transform.rotation.w = 1;
    static_transforms_.sendTransform(transform);
  }
}

bool FacePublisher::publish(const Frame& frame, const ros::Time& stamp, bool paused)
{
  if (!is_publishable(frame.skin, *model_))
    return false;

  if (skin_.getNumSubscribers() > 0)
  {
    to_marker(*model_, *shading_, frame.skin, reuse_or_make(skin_message_, face_frame_, stamp));
    skin_.publish(skin_message_);
  }
  if (points_.getNumSubscribers() > 0)
  {
    to_point_cloud(frame.skin, distances(frame.skin, rest_), reuse_or_make(points_message_, face_frame_, stamp));
    points_.publish(points_message_);
  }
  // a frame that was made before there were subscribers has no field
  if (shows_field() && frame.field.size() == frame.skin.vertices.size())
  {
    to_point_cloud(frame.skin, frame.field, reuse_or_make(field_message_, face_frame_, stamp));
    field_.publish(field_message_);
  }
  if (landmarks_.getNumSubscribers() > 0)
  {
    to_poses(frame.skin, reuse_or_make(landmarks_message_, face_frame_, stamp));
    landmarks_.publish(landmarks_message_);
  }
  if (state_.getNumSubscribers() > 0)
  {
    SimulationState& state = reuse_or_make(state_message_, face_frame_, stamp);
    to_state(*model_, frame, state);
    state.paused = paused;
    state.backend = backend_;
    state_.publish(state_message_);
  }
  to_transforms(*model_, frame.skin, face_frame_, stamp, landmark_transforms_);
  transforms_.sendTransform(landmark_transforms_);
  return true;
}

void FacePublisher::publish_fault(const std::string& message, const ros::Time& stamp)
{
  if (state_.getNumSubscribers() == 0)
    return;
  SimulationState& state = reuse_or_make(state_message_, face_frame_, stamp);
  state.failed = true;
  state.message = message;
  state_.publish(state_message_);
}

}  // namespace frontalis
