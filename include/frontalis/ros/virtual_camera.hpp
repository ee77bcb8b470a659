#pragma once

#include "frontalis/render/face_appearance.hpp"
#include "frontalis/ros/wall_throttle.hpp"

#include <frontalis/SimulationState.h>
#include <geometry_msgs/PoseArray.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/subscriber.h>
#include <ros/wall_timer.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/PointCloud2.h>
#include <shape_msgs/Mesh.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_listener.h>
#include <visualization_msgs/MarkerArray.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace frontalis
{

/// A virtual RGB-D camera that sees a face through the topics of its node, from where tf2 says that the camera is. For
/// each frame of the face, at most `~rate` times per second, it publishes ~camera_info, ~rgb, ~depth, ~labels, ~points
/// and ~landmarks with the stamp of that frame, as long as any of them has subscribers. If they wait in vain for a
/// frame of the face, it logs a warning every 30 s. doc/perception.md has the parameters.
class VirtualCamera
{
public:
  /// Throws Error on parameters of a wrong type or out of range.
  VirtualCamera(ros::NodeHandle handle, ros::NodeHandle private_handle);

private:
  /// The latest messages of the face.
  struct Inputs
  {
    shape_msgs::Mesh::ConstPtr topology;
    sensor_msgs::PointCloud2::ConstPtr skin;
    geometry_msgs::PoseArray::ConstPtr landmarks;
    SimulationState::ConstPtr state;
    visualization_msgs::MarkerArray::ConstPtr eyes, bodies;
  };

  void place(const std::string& parent, const RigidTransform& to_camera);
  template <class Message>
  void subscribe(ros::NodeHandle& handle, const std::string& topic, typename Message::ConstPtr Inputs::*input);
  bool is_complete() const;
  bool has_listeners() const;
  bool is_wanted() const;
  void report_silence();
  void take_picture();
  SkinState skin() const;
  void find_appearance(const SkinState& skin, const std::vector<RenderBall>& eyes);
  void add_eyes(const std::string& face_frame, const ros::Time& stamp, RenderScene& scene);
  void add_bodies(const std::string& face_frame, const ros::Time& stamp, RenderScene& scene);
  RigidTransform transform(const std::string& to, const std::string& from, const ros::Time& stamp);
  void publish(const Images& images, const std_msgs::Header& header);
  void publish_landmarks(const Renderer& renderer, const std::vector<std::array<float, 3>>& landmarks,
                         const std_msgs::Header& header);

  std::string frame_;
  PinholeCamera camera_;
  Light light_;
  int samples_ = 1;
  double rate_ = 10;  ///< pictures per second of the stamps; 0: every frame
  Inputs inputs_;
  WallThrottle warning_;
  bool was_complete_ = false;  ///< whether the inputs were complete since the latest report_silence()
  ros::Time pictured_;
  /// the messages from which appearance_ and triangles_ were made
  std::pair<shape_msgs::Mesh::ConstPtr, visualization_msgs::MarkerArray::ConstPtr> appearance_of_;
  SkinAppearance appearance_;
  std::vector<std::array<std::int32_t, 3>> triangles_;
  visualization_msgs::MarkerArray::ConstPtr body_meshes_of_;  ///< the message from which body_meshes_ were made
  std::vector<RenderMesh> body_meshes_;                       ///< per marker

  /// Stamp of the first transform from a frame to another one that was waited for in vain; 0 after a success.
  std::map<std::pair<std::string, std::string>, ros::Time> missed_;
  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener listener_;
  tf2_ros::StaticTransformBroadcaster broadcaster_;
  ros::Publisher info_, rgb_, depth_, labels_, points_, landmarks_;
  // last, so that no callback comes before the rest is made
  std::vector<ros::Subscriber> subscribers_;
  ros::WallTimer silence_timer_;
};

}  // namespace frontalis
