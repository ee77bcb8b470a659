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

/// What goes out: ~skin, ~skin_points, ~skin_field, ~skin_topology, ~landmarks, ~state and the transforms. A message is
/// built only while somebody subscribes to it, and its memory is used again once nobody holds it. One caller at a time.
class FacePublisher
{
public:
  /// Advertises the topics; nothing is published yet.
  explicit FacePublisher(ros::NodeHandle private_handle);

  /// Takes the model; publishes the topology (latched) and, where `parent_frame` is not empty, an identity transform
  /// from it to the face.
  void start(std::shared_ptr<const Model> model, const std::string& face_frame, const std::string& parent_frame,
             const std::string& backend);

  /// Whether anybody wants to see the field of the skin; for any thread.
  bool shows_field() const { return field_.getNumSubscribers() > 0; }

  /// Publishes a frame. Returns false and publishes nothing where the skin is not finite. Needs start().
  bool publish(const Frame& frame, const ros::Time& stamp, bool paused);

  /// Publishes a state that has failed with this message; for a face that has no model.
  void publish_fault(const std::string& message, const ros::Time& stamp);

  /// What start() was given.
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
