#include "ros/coloured_triangles.hpp"

#include "frontalis/error.hpp"
#include "frontalis/ros/shading.hpp"
#include "ros/marker_meshes.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace frontalis
{

namespace
{

/// Where coordinates and colour are in the points of a cloud.
std::array<std::size_t, 4> places(const sensor_msgs::PointCloud2& cloud)
{
  std::array<std::size_t, 4> out{};
  const std::array<const char*, 4> names{ "x", "y", "z", "rgb" };
  for (std::size_t i = 0; i < names.size(); ++i)
  {
    const auto field = std::find_if(cloud.fields.begin(), cloud.fields.end(),
                                    [&](const auto& candidate) { return candidate.name == names[i]; });
    if (field == cloud.fields.end() || field->datatype != sensor_msgs::PointField::FLOAT32 ||
        std::size_t(field->offset) + sizeof(float) > cloud.point_step || cloud.is_bigendian)
      throw Error("the cloud needs x, y, z and rgb as little-endian float32, as skin_points has them");
    out[i] = field->offset;
  }
  return out;
}

}  // namespace

std::vector<ColouredVertex> vertices_of(const sensor_msgs::PointCloud2& cloud)
{
  const std::array<std::size_t, 4> place = places(cloud);
  std::vector<ColouredVertex> out(std::size_t(cloud.width) * cloud.height);
  if (cloud.data.size() < out.size() * cloud.point_step)
    throw Error("the cloud has fewer bytes than its points need");
  const std::uint8_t* point = cloud.data.data();
  for (auto& [position, colour] : out)
  {
    for (std::size_t axis = 0; axis < 3; ++axis)
      std::memcpy(&position[axis], point + place[axis], sizeof(float));
    if (!std::isfinite(position[0] + position[1] + position[2]))
      throw Error("a vertex is not finite");
    std::uint32_t packed = 0;
    std::memcpy(&packed, point + place[3], sizeof packed);
    colour = { { static_cast<std::uint8_t>(packed >> 16), static_cast<std::uint8_t>(packed >> 8),
                 static_cast<std::uint8_t>(packed), 255 } };
    point += cloud.point_step;
  }
  return out;
}

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

ColouredTriangles body_of(const visualization_msgs::Marker& marker)
{
  if (marker.points.size() < 3)
    throw Error("it has no triangle");
  for (const auto& point : marker.points)
    if (!std::isfinite(point.x + point.y + point.z))
      throw Error("a vertex is not finite");
  const RenderMesh mesh = mesh_of_body(marker);
  const std::vector<std::array<float, 3>> colours = lit(mesh);
  const auto byte = [](float share) { return static_cast<std::uint8_t>(std::lround(255 * share)); };
  ColouredTriangles out;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    out.vertices.push_back(
        { mesh.vertices[v], { { byte(colours[v][0]), byte(colours[v][1]), byte(colours[v][2]), 255 } } });
  for (const auto& triangle : mesh.triangles)
    out.corners.insert(out.corners.end(), triangle.begin(), triangle.end());
  return out;
}

}  // namespace frontalis
