#include "ros/marker_meshes.hpp"

#include "frontalis/render/face_appearance.hpp"
#include "frontalis/ros/shading.hpp"

#include <algorithm>
#include <map>

namespace frontalis
{

namespace
{

// Gives a mesh the colours and labels of painted teeth. The marker's colours include light, which is found by lighting
// the same mesh in white.
void paint(const std::vector<std_msgs::ColorRGBA>& colours, const std::vector<std::int32_t>& corners, RenderMesh& mesh)
{
  mesh.colours.assign(mesh.vertices.size(), { { 1, 1, 1 } });
  mesh.labels.assign(mesh.vertices.size(), body_label);
  const std::vector<std::array<float, 3>> white = lit(mesh);
  for (std::size_t c = 0; c < std::min(corners.size(), colours.size()); ++c)
  {
    const auto vertex = static_cast<std::size_t>(corners[c]);
    const std::array<float, 3> colour{ colours[c].r, colours[c].g, colours[c].b };
    for (std::size_t i = 0; i < 3; ++i)
      mesh.colours[vertex][i] = std::min(1.0F, colour[i] / std::max(white[vertex][i], 0.01F));
  }
}

}  // namespace

RenderMesh mesh_of_iris(const visualization_msgs::Marker& marker)
{
  RenderMesh mesh;
  for (std::size_t c = 0; c < std::min(marker.points.size(), marker.colors.size()); ++c)
  {
    const auto& p = marker.points[c];
    mesh.vertices.push_back({ static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z) });
    mesh.colours.push_back({ marker.colors[c].r, marker.colors[c].g, marker.colors[c].b });
    mesh.labels.push_back(eye_label);
    if (const auto v = static_cast<std::int32_t>(c); c % 3 == 2)
      mesh.triangles.push_back({ v - 2, v - 1, v });
  }
  return mesh;
}

RenderMesh mesh_of_body(const visualization_msgs::Marker& marker)
{
  RenderMesh mesh;
  std::map<std::array<float, 3>, std::int32_t> numbers;
  std::vector<std::int32_t> corners;
  for (const auto& point : marker.points)
  {
    const std::array<float, 3> p{ static_cast<float>(point.x), static_cast<float>(point.y),
                                  static_cast<float>(point.z) };
    const auto [known, is_new] = numbers.insert({ p, static_cast<std::int32_t>(mesh.vertices.size()) });
    if (is_new)
      mesh.vertices.push_back(p);
    corners.push_back(known->second);
  }
  for (std::size_t c = 0; c + 2 < corners.size(); c += 3)
    mesh.triangles.push_back({ corners[c], corners[c + 1], corners[c + 2] });
  if (!marker.colors.empty() && marker.ns.compare(0, 5, "teeth") == 0)
  {
    paint(marker.colors, corners, mesh);
    return mesh;
  }
  // What is shown without touching has colours too.
  const bool only_shown = !marker.colors.empty();
  TriangleMesh surface;
  surface.triangles = mesh.triangles;
  for (const auto& p : mesh.vertices)
    surface.vertices.push_back({ p[0], p[1], p[2] });
  const BodyAppearance look = body_appearance(marker.ns, only_shown, surface);
  mesh.colours = look.colours;
  mesh.labels.assign(mesh.vertices.size(), look.label);
  return mesh;
}

RenderBall ball_of(const visualization_msgs::Marker& marker)
{
  const auto& p = marker.pose.position;
  return { { p.x, p.y, p.z }, 0.5 * marker.scale.x, { marker.color.r, marker.color.g, marker.color.b }, eye_label };
}

RenderMesh moved(RenderMesh mesh, const RigidTransform& pose)
{
  for (auto& vertex : mesh.vertices)
  {
    const std::array<double, 3> p = pose(vertex);
    vertex = { static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]) };
  }
  return mesh;
}

}  // namespace frontalis
