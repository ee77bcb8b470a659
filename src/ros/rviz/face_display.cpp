#include "ros/rviz/face_display.hpp"

#include "frontalis/error.hpp"

#include <pluginlib/class_list_macros.hpp>
#include <rviz/display_context.h>
#include <rviz/frame_manager.h>

#include <QCoreApplication>
#include <QEvent>

namespace frontalis
{

FaceDisplay::FaceDisplay()
{
  topic_property_->setDescription(
      "Topic of the skin's vertices. The topics skin_topology and bodies of the same face "
      "are shown with it.");
}

FaceDisplay::~FaceDisplay() = default;

void FaceDisplay::reset()
{
  MFDClass::reset();  // forgets all that was said in the status
  // clouds of the former topic wait in Qt's queue
  QCoreApplication::removePostedEvents(this, QEvent::MetaCall);
  cloud_.reset();
  bodies_drawn_ = -1;
  hide_skin(rviz::StatusProperty::Warn, "no vertices have come");
}

void FaceDisplay::subscribe()
{
  MFDClass::subscribe();
  const std::string topic = topic_property_->getTopicStd();
  if (!isEnabled() || topic.empty())
    return;
  const std::string face = topic.substr(0, topic.find_last_of('/') + 1);
  try
  {
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
  catch (const ros::Exception& error)
  {
    setStatus(rviz::StatusProperty::Error, "Topic", QString("Error subscribing: ") + error.what());
  }
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

void FaceDisplay::hide_skin(rviz::StatusProperty::Level level, const QString& why)
{
  skin_.reset();
  if (isEnabled())
    setStatus(level, "Skin", why);
}

void FaceDisplay::draw_skin()
{
  if (!cloud_)
    return;
  if (!topology_)
    return hide_skin(rviz::StatusProperty::Warn, "no triangles have come on skin_topology");
  const std::size_t count = std::size_t(cloud_->width) * cloud_->height;
  if (count != topology_->vertices.size() || topology_->triangles.empty())
    return hide_skin(rviz::StatusProperty::Warn, "skin_topology has the triangles of another skin");
  Ogre::Vector3 position;
  Ogre::Quaternion orientation;
  if (!context_->getFrameManager()->getTransform(cloud_->header, position, orientation))
    return hide_skin(rviz::StatusProperty::Warn, "there is no transform from its frame to the fixed frame");
  try
  {
    if (skin_)
      skin_->set_vertices(vertices_of(*cloud_));
    else
      skin_ = std::make_unique<ColouredMesh>(skin_of(*cloud_, *topology_), *scene_node_);
  }
  catch (const Error& error)
  {
    return hide_skin(rviz::StatusProperty::Error, error.what());
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
  bodies_drawn_ = -1;
  for (const visualization_msgs::Marker& marker : bodies->markers)
  {
    if (marker.action != visualization_msgs::Marker::ADD || marker.type != visualization_msgs::Marker::TRIANGLE_LIST)
      continue;
    try
    {
      bodies_in_frame_.emplace(marker.header.frame_id, std::make_unique<ColouredMesh>(body_of(marker), *scene_node_));
    }
    catch (const Error& error)
    {
      setStatus(rviz::StatusProperty::Error, QString::fromStdString(marker.ns), error.what());
    }
  }
}

void FaceDisplay::update(float /*wall_seconds*/, float /*ros_seconds*/)
{
  int drawn = 0;
  for (const auto& [frame, body] : bodies_in_frame_)
  {
    Ogre::Vector3 position;
    Ogre::Quaternion orientation;
    const bool is_known = context_->getFrameManager()->getTransform(frame, ros::Time(), position, orientation);
    if (is_known)
      body->place(position, orientation);
    body->setVisible(is_known);
    drawn += is_known ? 1 : 0;
  }
  if (drawn == bodies_drawn_)
    return;
  bodies_drawn_ = drawn;
  const auto all = static_cast<int>(bodies_in_frame_.size());
  setStatus(drawn == all ? rviz::StatusProperty::Ok : rviz::StatusProperty::Warn, "Bodies",
            drawn == all ? QString::number(all) : QString("%1 of %2 have a transform").arg(drawn).arg(all));
}

}  // namespace frontalis

PLUGINLIB_EXPORT_CLASS(frontalis::FaceDisplay, rviz::Display)
