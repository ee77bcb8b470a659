#pragma once

#include <sensor_msgs/PointCloud2.h>
#include <shape_msgs/Mesh.h>
#include <visualization_msgs/Marker.h>

#include <array>
#include <cstdint>
#include <vector>

namespace frontalis
{

/// A vertex as graphics cards read it.
struct ColouredVertex
{
  std::array<float, 3> position;
  std::array<std::uint8_t, 4> colour;  ///< red, green, blue, opacity
};

struct ColouredTriangles
{
  std::vector<ColouredVertex> vertices;
  std::vector<std::uint32_t> corners;  ///< vertices of the triangles, three each
};

/// The vertices of a cloud that has x, y, z and rgb as little-endian float32. Throws Error, which says what is wrong,
/// of another cloud and if a coordinate is not finite.
std::vector<ColouredVertex> vertices_of(const sensor_msgs::PointCloud2& cloud);

/// The skin: the vertices of a cloud and the triangles of ~skin_topology. Throws Error as vertices_of(), and if a
/// triangle has a vertex that does not exist.
ColouredTriangles skin_of(const sensor_msgs::PointCloud2& cloud, const shape_msgs::Mesh& topology);

/// A body of the topic ~bodies as lit by the face's lamps, in the frame of the marker. Throws Error if it has no
/// triangle or a vertex that is not finite.
ColouredTriangles body_of(const visualization_msgs::Marker& marker);

}  // namespace frontalis
