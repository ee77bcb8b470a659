#pragma once

#include "bake/mesh/surface_mesh.hpp"

namespace frontalis
{

/// A mesh of polygons, such as a control cage. Positions in metres.
struct PolygonMesh
{
  std::vector<Vector3d> vertices;
  std::vector<std::vector<std::int32_t>> faces;
  std::vector<std::int32_t> groups;  ///< for each face an index of group_names
  std::vector<std::string> group_names;
};

/// Reads the vertices and faces of an OBJ file with coordinates in `unit` [m]. Unlike import_mesh(), this function
/// keeps the order of the vertices. Throws Error naming the file and line.
PolygonMesh read_polygons(const std::string& file, double unit);

/// Adds the mirror image at the plane of the coordinate `axis` = 0. Vertices less than 1e-5 of the mesh's extent away
/// from the plane are moved onto it and shared. Vertices of the mesh keep their numbers; mirror[v] is the number of the
/// image of v.
PolygonMesh with_mirror_image(const PolygonMesh& half, int axis, std::vector<std::int32_t>* mirror = nullptr);

/// Makes `levels` steps of Catmull & Clark's subdivision (Computer-Aided Design 10(6), 1978) and then moves each vertex
/// to its limit position (Halstead, Kass & DeRose, SIGGRAPH 1993), so that vertices lie on the same smooth surface at
/// every level. Vertices of the cage keep their numbers. With `groups`, only triangles of these groups of faces are
/// returned. Throws Error if the cage is not a manifold.
TriangleMesh subdivide(const PolygonMesh& cage, int levels, const std::vector<std::string>& groups = {});

}  // namespace frontalis
