#include "frontalis/ros/face_publisher.hpp"

#include <boost/make_shared.hpp>

#include <atomic>

namespace frontalis
{

template <typename Message>
template <typename Fill>
void FacePublisher::Topic<Message>::publish(const std::string& frame, const ros::Time& stamp, const Fill& fill)
{
  if (publisher.getNumSubscribers() == 0)
    return;
  if (!message || message.use_count() > 1)
    message = boost::make_shared<Message>();
  else
    std::atomic_thread_fence(std::memory_order_acquire);
  message->header.frame_id = frame;
  message->header.stamp = stamp;
  fill(*message);
  publisher.publish(message);
}

FacePublisher::FacePublisher(ros::NodeHandle private_handle)
    : skin_(private_handle, "skin"),
      points_(private_handle, "skin_points"),
      field_(private_handle, "skin_field"),
      landmarks_(private_handle, "landmarks"),
      state_(private_handle, "state"),
      topology_(private_handle.advertise<shape_msgs::Mesh>("skin_topology", 1, true)),
      bodies_(private_handle.advertise<visualization_msgs::MarkerArray>("bodies", 1, true)),
      handle_(private_handle)
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
  bodies_.publish(to_bodies(*model_, face_frame_));
  shapes_ = body_shapes(*model_);
  for (const BodyShape& shape : shapes_)
    wrenches_.emplace_back(handle_, "wrench/" + shape.name);
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

  const SkinState& skin = frame.skin;
  skin_.publish(face_frame_, stamp, [&](auto& marker) { to_marker(*model_, *shading_, skin, marker); });
  points_.publish(face_frame_, stamp, [&](auto& cloud) { to_point_cloud(skin, distances(skin, rest_), cloud); });
  // a frame that was made before there were subscribers has no field
  if (frame.field.size() == skin.vertices.size())
    field_.publish(face_frame_, stamp, [&](auto& cloud) { to_point_cloud(skin, frame.field, cloud); });
  landmarks_.publish(face_frame_, stamp, [&](auto& poses) { to_poses(skin, poses); });
  state_.publish(face_frame_, stamp,
                 [&](auto& state)
                 {
                   to_state(*model_, frame, state);
                   state.paused = paused;
                   state.backend = backend_;
                 });
  for (std::size_t b = 0; b < frame.bodies.size(); ++b)
  {
    const BodyShape& shape = shapes_[b];
    wrenches_[b].publish(body_frame(face_frame_, shape), stamp,
                         [&](auto& wrench) { wrench.wrench = to_wrench(*model_, shape, frame.bodies[b]); });
  }
  to_transforms(*model_, frame, face_frame_, stamp, frame_transforms_);
  transforms_.sendTransform(frame_transforms_);
  return true;
}

void FacePublisher::publish_fault(const std::string& message, const ros::Time& stamp)
{
  state_.publish(face_frame_, stamp,
                 [&](auto& state)
                 {
                   state.failed = true;
                   state.message = message;
                 });
}

}  // namespace frontalis
