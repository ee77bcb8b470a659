#pragma once

#include "ros/rviz/coloured_mesh.hpp"

#include <ros/subscriber.h>
#include <rviz/message_filter_display.h>
#include <sensor_msgs/PointCloud2.h>
#include <shape_msgs/Mesh.h>
#include <visualization_msgs/MarkerArray.h>

#include <map>
#include <memory>
#include <string>

namespace frontalis
{

/// A display of rviz that draws a face: its skin from ~skin_points and ~skin_topology, and its bodies. It shows what
/// the markers on ~skin and ~bodies show, in less time: a frame of the skin takes an eighth of the bytes of its marker,
/// and bodies that move are not made anew, as rviz does with markers in moving frames.
class FaceDisplay : public rviz::MessageFilterDisplay<sensor_msgs::PointCloud2>
{
  Q_OBJECT

public:
  FaceDisplay();
  ~FaceDisplay() override;

  void reset() override;
  void update(float wall_seconds, float ros_seconds) override;

protected:
  void subscribe() override;
  void unsubscribe() override;

private:
  void processMessage(const sensor_msgs::PointCloud2::ConstPtr& cloud) override;
  /// Hides the skin; the status `Skin` says why.
  void hide_skin(rviz::StatusProperty::Level level, const QString& why);
  /// Draws the latest skin, or hides it if something is missing or wrong.
  void draw_skin();
  void take_bodies(const visualization_msgs::MarkerArray::ConstPtr& bodies);

  ros::Subscriber topology_subscriber_, bodies_subscriber_;
  sensor_msgs::PointCloud2::ConstPtr cloud_;
  shape_msgs::Mesh::ConstPtr topology_;
  visualization_msgs::MarkerArray::ConstPtr bodies_;
  std::unique_ptr<ColouredMesh> skin_;                                         ///< null while it is hidden
  std::multimap<std::string, std::unique_ptr<ColouredMesh>> bodies_in_frame_;  ///< by the frame in which they rest
  int bodies_drawn_ = -1;  ///< in the latest picture; -1: not told in the status
};

}  // namespace frontalis
