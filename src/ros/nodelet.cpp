#include "frontalis/ros/face_node.hpp"
#include "frontalis/ros/virtual_camera.hpp"

#include <ros/ros.h>

#include <nodelet/nodelet.h>
#include <pluginlib/class_list_macros.hpp>

namespace frontalis
{

/// Calls start(). The loader of nodelets would hide why it failed.
template <class Start>
void told(const std::string& name, const Start& start)
{
  try
  {
    start();
  }
  catch (const std::exception& error)
  {
    ROS_FATAL_STREAM(name << ": " << error.what());
    throw;
  }
}

/// The nodelet frontalis/face.
class FaceNodelet : public nodelet::Nodelet
{
  void onInit() override
  {
    told(getName(),
         [this] { face_ = std::make_unique<FaceNode>(getMTNodeHandle(), getMTPrivateNodeHandle(), getName()); });
  }

  std::unique_ptr<FaceNode> face_;
};

/// The nodelet frontalis/camera.
class CameraNodelet : public nodelet::Nodelet
{
  void onInit() override
  {
    told(getName(), [this] { camera_ = std::make_unique<VirtualCamera>(getNodeHandle(), getPrivateNodeHandle()); });
  }

  std::unique_ptr<VirtualCamera> camera_;
};

}  // namespace frontalis

PLUGINLIB_EXPORT_CLASS(frontalis::FaceNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(frontalis::CameraNodelet, nodelet::Nodelet)
