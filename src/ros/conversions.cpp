#include "frontalis/ros/conversions.hpp"

#include "frontalis/error.hpp"
#include "frontalis/render/face_appearance.hpp"
#include "frontalis/ros/shading.hpp"
#include "frontalis/runner/face_frame.hpp"
#include "frontalis/solver/rigid_motion.hpp"

#include <fmt/format.h>
#include <sensor_msgs/point_cloud2_iterator.h>
#include <tf2/LinearMath/Matrix3x3.h>
#include <tf2/LinearMath/Quaternion.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <iterator>

namespace frontalis
{

namespace
{

/// Sets the coordinates of a point or vector of a message.
template <typename Message, typename Number>
void set(Message& message, const std::array<Number, 3>& coordinates)
{
  message.x = coordinates[0];
  message.y = coordinates[1];
  message.z = coordinates[2];
}

void set(geometry_msgs::Quaternion& message, const tf2::Quaternion& rotation)
{
  message.x = rotation.x();
  message.y = rotation.y();
  message.z = rotation.z();
  message.w = rotation.w();
}

std_msgs::ColorRGBA opaque(const std::array<float, 3>& colour)
{
  std_msgs::ColorRGBA out;
  out.r = colour[0];
  out.g = colour[1];
  out.b = colour[2];
  out.a = 1;
  return out;
}

/// Triangles in a frame that moves; displays use its latest transform. They are added by add_triangles().
visualization_msgs::Marker marker_in(const std::string& frame, const std::string& name)
{
  visualization_msgs::Marker marker;
  marker.header.frame_id = frame;
  marker.frame_locked = true;
  marker.ns = name;
  marker.type = visualization_msgs::Marker::TRIANGLE_LIST;
  marker.action = visualization_msgs::Marker::ADD;
  marker.pose.orientation.w = 1;
  marker.scale.x = marker.scale.y = marker.scale.z = 1;
  return marker;
}

/// Adds the triangles of a mesh in the face frame to a marker whose frame has its origin at `centre` of the face frame.
/// `colours`: per vertex, or empty.
void add_triangles(const RenderMesh& mesh, const std::array<double, 3>& centre, const SkinColours& colours,
                   visualization_msgs::Marker& marker)
{
  for (const auto& triangle : mesh.triangles)
    for (const auto corner : triangle)
    {
      const auto vertex = static_cast<std::size_t>(corner);
      const auto& v = mesh.vertices[vertex];
      set(marker.points.emplace_back(),
          std::array<double, 3>{ { v[0] - centre[0], v[1] - centre[1], v[2] - centre[2] } });
      if (!colours.empty())
        marker.colors.push_back(opaque(colours[vertex]));
    }
}

}  // namespace

bool is_publishable(const SkinState& skin, const Model& model)
{
  return skin.vertices.size() == model.skin.vertices.size() && skin.normals.size() == skin.vertices.size() &&
         skin.landmarks.size() == model.landmarks.size() && is_finite(skin);
}

shape_msgs::Mesh to_mesh(const Model& model)
{
  shape_msgs::Mesh out;
  for (const auto& vertex : rest_in_face(model).vertices)
    set(out.vertices.emplace_back(), vertex);
  for (const auto& triangle : model.skin.triangles)
    std::copy(triangle.begin(), triangle.end(), out.triangles.emplace_back().vertex_indices.begin());
  return out;
}

void to_marker(const Model& model, const SkinColours& colours, const SkinState& skin, visualization_msgs::Marker& out)
{
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
      set(out.points[entry], skin.vertices[vertex]);
      auto& colour = out.colors[entry++];
      colour.r = colours[vertex][0];
      colour.g = colours[vertex][1];
      colour.b = colours[vertex][2];
      colour.a = 1;
    }
}

std::vector<float> distances(const SkinState& skin, const std::vector<std::array<float, 3>>& rest)
{
  std::vector<float> out(rest.size());
  std::transform(rest.begin(), rest.end(), skin.vertices.begin(), out.begin(),
                 [](const auto& a, const auto& b) { return std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]); });
  return out;
}

void to_point_cloud(const SkinState& skin, const std::vector<float>& intensity, const SkinColours& colours,
                    sensor_msgs::PointCloud2& out)
{
  out.height = 1;
  out.is_bigendian = __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__;
  out.is_dense = true;
  sensor_msgs::PointCloud2Modifier layout(out);
  constexpr auto number = sensor_msgs::PointField::FLOAT32;
  const int fields = colours.empty() ? 7 : 8;
  layout.setPointCloud2Fields(fields, "x", 1, number, "y", 1, number, "z", 1, number, "normal_x", 1, number, "normal_y",
                              1, number, "normal_z", 1, number, "intensity", 1, number, "rgb", 1, number);
  layout.resize(skin.vertices.size());
  for (std::size_t vertex = 0; vertex < skin.vertices.size(); ++vertex)
  {
    const auto& position = skin.vertices[vertex];
    const auto& normal = skin.normals[vertex];
    const float values[7] = {
      position[0], position[1], position[2], normal[0], normal[1], normal[2], intensity[vertex]
    };
    std::uint8_t* const point = out.data.data() + vertex * out.point_step;
    std::memcpy(point, values, sizeof values);
    if (colours.empty())
      continue;
    std::uint32_t packed = 0;
    for (const float channel : colours[vertex])
      packed = packed << 8 | static_cast<std::uint32_t>(std::lround(255 * channel));
    std::memcpy(point + sizeof values, &packed, sizeof packed);
  }
}

std::vector<std::size_t> landmark_vertices(const Model& model)
{
  std::vector<std::size_t> out;
  out.reserve(model.landmark_positions.size());
  for (const auto& [x, y, z] : model.landmark_positions)
  {
    const auto& all = model.skin.vertices;
    const auto distance = [at = std::array<double, 3>{ { x, y, z } }](const auto& v)
    { return std::hypot(v[0] - at[0], v[1] - at[1], v[2] - at[2]); };
    out.push_back(static_cast<std::size_t>(std::min_element(all.begin(), all.end(),
                                                            [&](const auto& a, const auto& b)
                                                            { return distance(a) < distance(b); }) -
                                           all.begin()));
  }
  return out;
}

std::vector<std::size_t> standard_landmarks(const Model& model)
{
  constexpr int count = 68;
  std::vector<std::size_t> out;
  out.reserve(count);
  for (int number = 1; number <= count; ++number)
  {
    const auto found = std::find(model.landmarks.begin(), model.landmarks.end(), fmt::format("ibug_{}", number));
    if (found == model.landmarks.end())
      return {};
    out.push_back(static_cast<std::size_t>(found - model.landmarks.begin()));
  }
  return out;
}

void to_poses(const SkinState& skin, const std::vector<std::size_t>& vertices, geometry_msgs::PoseArray& out)
{
  out.poses.resize(skin.landmarks.size());
  for (std::size_t landmark = 0; landmark < out.poses.size(); ++landmark)
  {
    auto& pose = out.poses[landmark];
    set(pose.position, skin.landmarks[landmark]);
    tf2::Vector3 outwards(1, 0, 0);
    if (vertices[landmark] < skin.normals.size())
    {
      const auto& n = skin.normals[vertices[landmark]];
      outwards = tf2::Vector3(n[0], n[1], n[2]);
    }
    // If the normal points straight up, z points to the back of the face; if it points straight down, to the front.
    const tf2::Vector3 up = std::abs(outwards.z()) < 0.99 ? tf2::Vector3(0, 0, 1) : tf2::Vector3(-outwards.z(), 0, 0);
    const tf2::Vector3 left = up.cross(outwards).normalized(), upwards = outwards.cross(left);
    tf2::Quaternion rotation;
    tf2::Matrix3x3(outwards.x(), left.x(), upwards.x(), outwards.y(), left.y(), upwards.y(), outwards.z(), left.z(),
                   upwards.z())
        .getRotation(rotation);
    set(pose.orientation, rotation);
  }
}

std::string body_frame(const std::string& face_frame, const BodyShape& shape) { return face_frame + "/" + shape.frame; }

geometry_msgs::Transform to_transform(const Model& model, const BodyShape& shape, const RigidTransform& pose)
{
  const auto& r = pose.rotation;
  tf2::Quaternion rotation;
  tf2::Matrix3x3(r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8]).getRotation(rotation);
  geometry_msgs::Transform out;
  set(out.translation, pose(model.to_face(shape.centre)));
  set(out.rotation, rotation);
  return out;
}

geometry_msgs::Wrench to_wrench(const Model& model, const BodyShape& shape, const BodyFrame& body)
{
  const RigidTransform back = inverse(body.pose);
  const auto force = back.turned(body.reaction.force), moment = back.turned(body.reaction.moment);
  const auto centre = model.to_face(shape.centre);
  std::array<double, 3> about_centre{};
  for (std::size_t i = 0; i < 3; ++i)
  {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    about_centre[i] = moment[i] - (centre[j] * force[k] - centre[k] * force[j]);
  }
  geometry_msgs::Wrench out;
  set(out.force, force);
  set(out.torque, about_centre);
  return out;
}

visualization_msgs::MarkerArray to_bodies(const Model& model, const std::string& face_frame)
{
  visualization_msgs::MarkerArray out;
  for (const BodyShape& shape : body_shapes(model))
  {
    const RenderMesh mesh = body_at_rest(model, shape);
    if (mesh.triangles.empty())
      continue;
    visualization_msgs::Marker& marker = out.markers.emplace_back(marker_in(body_frame(face_frame, shape), shape.name));
    marker.color = opaque(mesh.colours.front());
    const bool is_painted = std::any_of(mesh.colours.begin(), mesh.colours.end(),
                                        [&](const auto& colour) { return colour != mesh.colours.front(); });
    add_triangles(mesh, model.to_face(shape.centre), is_painted || shape.only_shown ? lit(mesh) : SkinColours(),
                  marker);
  }
  return out;
}

visualization_msgs::MarkerArray to_eyeballs(const Model& model, const std::string& face_frame)
{
  visualization_msgs::MarkerArray out;
  const std::vector<BodyShape> bones = bone_shapes(model);
  for (const Eyeball& eye : eyeballs(model, [](std::size_t) { return RigidTransform(); }))
  {
    visualization_msgs::Marker marker = marker_in(body_frame(face_frame, bones[eye.bone]), model.bones[eye.bone]);
    marker.color = opaque(eye.ball.colour);
    visualization_msgs::Marker& ball = out.markers.emplace_back(marker);
    ball.type = visualization_msgs::Marker::SPHERE;
    ball.scale.x = ball.scale.y = ball.scale.z = 2 * eye.ball.radius;
    marker.id = 1;
    add_triangles(eye.iris, eye.ball.centre, eye.iris.colours, marker);
    out.markers.push_back(marker);
  }
  return out;
}

void to_transforms(const Model& model, const Frame& frame, const geometry_msgs::PoseArray& landmarks,
                   const std::string& face_frame, const ros::Time& stamp,
                   std::vector<geometry_msgs::TransformStamped>& out)
{
  const SkinState& skin = frame.skin;
  out.resize(skin.landmarks.size());
  const auto add = [&](const std::vector<BodyShape>& shapes, const std::vector<BodyFrame>& bodies)
  {
    for (std::size_t body = 0; body < bodies.size(); ++body)
    {
      auto& transform = out.emplace_back();
      transform.header.stamp = stamp;
      transform.header.frame_id = face_frame;
      transform.child_frame_id = body_frame(face_frame, shapes[body]);
      transform.transform = to_transform(model, shapes[body], bodies[body].pose);
    }
  };
  add(body_shapes(model), frame.bodies);
  add(bone_shapes(model), frame.bones);
  for (std::size_t landmark = 0; landmark < skin.landmarks.size(); ++landmark)
  {
    auto& transform = out[landmark];
    transform.header.stamp = stamp;
    transform.header.frame_id = face_frame;
    transform.child_frame_id = face_frame + "/" + model.landmarks[landmark];
    set(transform.transform.translation, skin.landmarks[landmark]);
    transform.transform.rotation = landmarks.poses[landmark].orientation;
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
