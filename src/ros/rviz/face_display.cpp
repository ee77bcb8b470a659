#include "ros/rviz/face_display.hpp"

#include "frontalis/error.hpp"

#include <pluginlib/class_list_macros.hpp>
#include <rviz/display_context.h>
#include <rviz/frame_manager.h>

namespace frontalis
{

namespace
{

ColouredTriangles skin_of(const sensor_msgs::PointCloud2& cloud, const shape_msgs::Mesh& topology)
{
  ColouredTriangles out{ vertices_of(cloud), {} };
  for (const auto& triangle : topology.triangles)
    for (const std::uint32_t vertex : triangle.vertex_indices)
    {
      if (vertex >= out.vertices.size())
        throw Error("a triangle of skin_topology has a vertex that does not exist");
      out.corners.push_back(vertex);
    }
  return out;
}

}  // namespace

FaceDisplay::FaceDisplay()
{
  topic_property_->setDescription(
      "Topic of the skin's vertices. The topics skin_topology and bodies of the same face "
      "are shown with it.");
}

FaceDisplay::~FaceDisplay() = default;

void FaceDisplay::reset()
{
  MFDClass::reset();
  cloud_.reset();
  skin_.reset();
}

void FaceDisplay::subscribe()
{
  MFDClass::subscribe();
  const std::string topic = topic_property_->getTopicStd();
  if (!isEnabled() || topic.empty())
    return;
  const std::string face = topic.substr(0, topic.find_last_of('/') + 1);
  topology_subscriber_ = update_nh_.subscribe<shape_msgs::Mesh>(face + "skin_topology", 1,
                                                                [this](const shape_msgs::Mesh::ConstPtr& topology)
                                                                {
                                                                  topology_ = topology;
                                                                  skin_.reset();
                                                                  draw_skin();
                                                                });
  bodies_subscriber_ = update_nh_.subscribe<visualization_msgs::MarkerArray>(
      face + "bodies", 1, [this](const visualization_msgs::MarkerArray::ConstPtr& bodies) { take_bodies(bodies); });
}

void FaceDisplay::unsubscribe()
{
  MFDClass::unsubscribe();
  topology_subscriber_.shutdown();
  topology_.reset();
  bodies_subscriber_.shutdown();
  bodies_.reset();
  bodies_in_frame_.clear();
}

void FaceDisplay::processMessage(const sensor_msgs::PointCloud2::ConstPtr& cloud)
{
  cloud_ = cloud;
  draw_skin();
}

void FaceDisplay::draw_skin()
{
  const auto hide = [this](rviz::StatusProperty::Level level, const QString& why)
  {
    skin_.reset();
    setStatus(level, "Skin", why);
  };
  if (!cloud_)
    return;
  if (!topology_)
    return hide(rviz::StatusProperty::Warn, "no triangles have come on skin_topology");
  const std::size_t count = std::size_t(cloud_->width) * cloud_->height;
  if (count != topology_->vertices.size() || topology_->triangles.empty())
    return hide(rviz::StatusProperty::Warn, "skin_topology has the triangles of another skin");
  Ogre::Vector3 position;
  Ogre::Quaternion orientation;
  if (!context_->getFrameManager()->getTransform(cloud_->header, position, orientation))
    return;
  try
  {
    if (skin_)
      skin_->set_vertices(vertices_of(*cloud_));
    else
      skin_ = std::make_unique<ColouredMesh>(skin_of(*cloud_, *topology_), *scene_node_);
  }
  catch (const Error& error)
  {
    return hide(rviz::StatusProperty::Error, error.what());
  }
  skin_->place(position, orientation);
  setStatus(rviz::StatusProperty::Ok, "Skin", QString("%1 triangles").arg(topology_->triangles.size()));
  context_->queueRender();
}

void FaceDisplay::take_bodies(const visualization_msgs::MarkerArray::ConstPtr& bodies)
{
  // A face sends its bodies twice.
  if (bodies_ && bodies_->markers == bodies->markers)
    return;
  bodies_ = bodies;
  bodies_in_frame_.clear();
  for (const visualization_msgs::Marker& marker : bodies->markers)
  {
    if (marker.action != visualization_msgs::Marker::ADD || marker.type != visualization_msgs::Marker::TRIANGLE_LIST ||
        marker.points.size() < 3)
      continue;
    auto drawn = std::make_unique<ColouredMesh>(body_of(marker), *scene_node_);
    drawn->setVisible(false);
    bodies_in_frame_.emplace(marker.header.frame_id, std::move(drawn));
  }
  setStatus(rviz::StatusProperty::Ok, "Bodies", QString::number(bodies_in_frame_.size()));
}

void FaceDisplay::update(float /*wall_seconds*/, float /*ros_seconds*/)
{
  for (const auto& [frame, body] : bodies_in_frame_)
  {
    Ogre::Vector3 position;
    Ogre::Quaternion orientation;
    const bool is_known = context_->getFrameManager()->getTransform(frame, ros::Time(), position, orientation);
    if (is_known)
      body->place(position, orientation);
    body->setVisible(is_known);
  }
}

}  // namespace frontalis

PLUGINLIB_EXPORT_CLASS(frontalis::FaceDisplay, rviz::Display)
