#pragma once

#include "frontalis/ros/conversions.hpp"
#include "frontalis/ros/shading.hpp"

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>

#include <boost/shared_ptr.hpp>

#include <memory>
#include <string>
#include <vector>

namespace frontalis
{

/// Publishes the topics ~skin, ~skin_points, ~skin_field, ~skin_topology, ~landmarks and ~state, and the transforms. A
/// message is built only while its topic has subscribers, and its memory is reused once no subscriber holds it. Only
/// one thread at a time may call these functions, except for shows_field().
class FacePublisher
{
public:
  /// Advertises the topics; nothing is published yet.
  explicit FacePublisher(ros::NodeHandle private_handle);

  /// Sets the model and publishes its topology (latched). If `parent_frame` is not empty, it also publishes an identity
  /// transform from that frame to the face frame.
  void start(std::shared_ptr<const Model> model, const std::string& face_frame, const std::string& parent_frame,
             const std::string& backend);

  /// Whether ~skin_field has subscribers. Any thread may call this at any time.
  bool shows_field() const { return field_.getNumSubscribers() > 0; }

  /// Publishes a frame. Returns false and publishes nothing if the skin is not finite. start() must have been called.
  bool publish(const Frame& frame, const ros::Time& stamp, bool paused);

  /// Publishes a failed ~state with this message, for a face that has no model.
  void publish_fault(const std::string& message, const ros::Time& stamp);

  /// The model that start() was given; null before.
  const Model* model() const { return model_.get(); }

private:
  ros::Publisher skin_, points_, field_, topology_, landmarks_, state_;
  tf2_ros::TransformBroadcaster transforms_;
  tf2_ros::StaticTransformBroadcaster static_transforms_;

  std::shared_ptr<const Model> model_;
  std::string face_frame_;
  std::string backend_;
  std::unique_ptr<SkinShading> shading_;
  std::vector<std::array<float, 3>> rest_;

  boost::shared_ptr<visualization_msgs::Marker> skin_message_;
  boost::shared_ptr<sensor_msgs::PointCloud2> points_message_, field_message_;
  boost::shared_ptr<geometry_msgs::PoseArray> landmarks_message_;
  boost::shared_ptr<SimulationState> state_message_;
  std::vector<geometry_msgs::TransformStamped> landmark_transforms_;
};

}  // namespace frontalis
