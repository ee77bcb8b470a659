#include "frontalis/ros/conversions.hpp"

#include "frontalis/error.hpp"
#include "frontalis/runner/face_frame.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstring>

namespace frontalis
{

namespace
{

void set_cloud_layout(std::size_t points, sensor_msgs::PointCloud2& out)
{
  static const char* const names[] = { "x", "y", "z", "normal_x", "normal_y", "normal_z", "intensity" };
  out.height = 1;
  out.width = static_cast<std::uint32_t>(points);
  out.fields.resize(7);
  for (std::uint32_t field = 0; field < 7; ++field)
  {
    out.fields[field].name = names[field];
    out.fields[field].offset = field * sizeof(float);
    out.fields[field].datatype = sensor_msgs::PointField::FLOAT32;
    out.fields[field].count = 1;
  }
  out.is_bigendian = __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__;
  out.point_step = 7 * sizeof(float);
  out.row_step = out.point_step * out.width;
  out.is_dense = true;
  out.data.resize(out.row_step);
}

}  // namespace

std::vector<std::array<float, 3>> rest_in_face(const Model& model)
{
  SkinState skin;
  skin.vertices.reserve(model.skin.vertices.size());
  for (const auto& vertex : model.skin.vertices)
    skin.vertices.push_back(
        { { static_cast<float>(vertex[0]), static_cast<float>(vertex[1]), static_cast<float>(vertex[2]) } });
  to_face_frame(model, skin);
  return skin.vertices;
}

bool is_publishable(const SkinState& skin, const Model& model)
{
  return skin.vertices.size() == model.skin.vertices.size() && skin.normals.size() == skin.vertices.size() &&
         skin.landmarks.size() == model.landmarks.size() && is_finite(skin);
}

shape_msgs::Mesh to_mesh(const Model& model)
{
  shape_msgs::Mesh out;
  out.vertices.reserve(model.skin.vertices.size());
  for (const auto& vertex : rest_in_face(model))
  {
    geometry_msgs::Point point;
    point.x = vertex[0];
    point.y = vertex[1];
    point.z = vertex[2];
    out.vertices.push_back(point);
  }
  out.triangles.resize(model.skin.triangles.size());
  for (std::size_t triangle = 0; triangle < out.triangles.size(); ++triangle)
    for (int corner = 0; corner < 3; ++corner)
      out.triangles[triangle].vertex_indices[corner] =
          static_cast<std::uint32_t>(model.skin.triangles[triangle][corner]);
  return out;
}

void to_marker(const Model& model, const SkinShading& shading, const SkinState& skin, visualization_msgs::Marker& out)
{
  thread_local std::vector<std::array<float, 3>> colours;
  shading.colours(skin, colours);

  out.type = visualization_msgs::Marker::TRIANGLE_LIST;
  out.action = visualization_msgs::Marker::ADD;
  out.ns = "skin";
  out.pose.orientation.w = 1;
  out.scale.x = out.scale.y = out.scale.z = 1;
  out.color.r = out.color.g = out.color.b = out.color.a = 1;
  out.points.resize(3 * model.skin.triangles.size());
  out.colors.resize(out.points.size());
  std::size_t entry = 0;
  for (const auto& triangle : model.skin.triangles)
    for (const auto vertex : triangle)
    {
      auto& point = out.points[entry];
      auto& colour = out.colors[entry++];
      point.x = skin.vertices[vertex][0];
      point.y = skin.vertices[vertex][1];
      point.z = skin.vertices[vertex][2];
      colour.r = colours[vertex][0];
      colour.g = colours[vertex][1];
      colour.b = colours[vertex][2];
      colour.a = 1;
    }
}

std::vector<float> distances(const SkinState& skin, const std::vector<std::array<float, 3>>& rest)
{
  std::vector<float> out;
  for (std::size_t vertex = 0; vertex < rest.size(); ++vertex)
  {
    const auto& position = skin.vertices[vertex];
    out.push_back(
        std::hypot(position[0] - rest[vertex][0], position[1] - rest[vertex][1], position[2] - rest[vertex][2]));
  }
  return out;
}

void to_point_cloud(const SkinState& skin, const std::vector<float>& intensity, sensor_msgs::PointCloud2& out)
{
  set_cloud_layout(skin.vertices.size(), out);
  for (std::size_t vertex = 0; vertex < skin.vertices.size(); ++vertex)
  {
    const auto& position = skin.vertices[vertex];
    const auto& normal = skin.normals[vertex];
    const float values[7] = {
      position[0], position[1], position[2], normal[0], normal[1], normal[2], intensity[vertex]
    };
    std::memcpy(out.data.data() + vertex * sizeof values, values, sizeof values);
  }
}

void to_poses(const SkinState& skin, geometry_msgs::PoseArray& out)
{
  out.poses.resize(skin.landmarks.size());
  for (std::size_t landmark = 0; landmark < out.poses.size(); ++landmark)
  {
    auto& pose = out.poses[landmark];
    pose.position.x = skin.landmarks[landmark][0];
    pose.position.y = skin.landmarks[landmark][1];
    pose.position.z = skin.landmarks[landmark][2];
    pose.orientation.w = 1;
  }
}

void to_transforms(const Model& model, const SkinState& skin, const std::string& face_frame, const ros::Time& stamp,
                   std::vector<geometry_msgs::TransformStamped>& out)
{
  out.resize(skin.landmarks.size());
  for (std::size_t landmark = 0; landmark < out.size(); ++landmark)
  {
    auto& transform = out[landmark];
    transform.header.stamp = stamp;
    transform.header.frame_id = face_frame;
    transform.child_frame_id = face_frame + "/" + model.landmarks[landmark];
    transform.transform.translation.x = skin.landmarks[landmark][0];
    transform.transform.translation.y = skin.landmarks[landmark][1];
    transform.transform.translation.z = skin.landmarks[landmark][2];
    transform.transform.rotation.w = 1;
  }
}

void to_state(const Model& model, const Frame& frame, SimulationState& out)
{
  out.time = frame.time;
  out.wall_time = frame.wall_time;
  out.real_time_factor = frame.real_time_factor;
  out.time_step = frame.time_step;
  out.critical_time_step = frame.monitor.critical_time_step;
  out.steps = static_cast<std::uint64_t>(frame.steps);
  out.sequence = frame.sequence;
  out.kinetic_energy = frame.monitor.kinetic;
  out.internal_energy = frame.monitor.internal;
  out.hourglass_energy = frame.monitor.hourglass;
  out.worst_jacobian = frame.monitor.worst_jacobian;
  out.failed = frame.failed;
  out.message = frame.failure;
  out.name.clear();
  for (const auto& muscle : model.muscles)
    out.name.push_back(muscle.name);
  out.activation.assign(frame.activation.begin(), frame.activation.end());
  out.landmark = model.landmarks;
  out.voxels = static_cast<std::uint32_t>(model.voxels.size());
  out.nodes = static_cast<std::uint32_t>(model.nodes.size());
  out.skin_vertices = static_cast<std::uint32_t>(model.skin.vertices.size());
}

RigidTransform to_motion(const geometry_msgs::Transform& transform)
{
  const auto& q = transform.rotation;
  const double length = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  if (!(std::abs(length - 1) < 1e-3))
    throw Error(fmt::format("the rotation is a quaternion of length {}; must be 1", length));
  const double x = q.x / length, y = q.y / length, z = q.z / length, w = q.w / length;
  RigidTransform motion;
  motion.rotation = { { 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y), 2 * (x * y + w * z),
                        1 - 2 * (x * x + z * z), 2 * (y * z - w * x), 2 * (x * z - w * y), 2 * (y * z + w * x),
                        1 - 2 * (x * x + y * y) } };
  motion.translation = { { transform.translation.x, transform.translation.y, transform.translation.z } };
  return motion;
}

}  // namespace frontalis
