#pragma once

#include "bake/bake_monitor.hpp"
#include "bake/mesh/triangle_tree.hpp"

#include <memory>

namespace frontalis
{

/// A surface of the scene, prepared for closest points, distances and winding numbers: equal vertices are joined and
/// triangles oriented. Scene coordinates [m].
class PreparedSurface
{
public:
  PreparedSurface(std::string name, TriangleMesh mesh);

  const std::string& name() const { return name_; }
  const TriangleMesh& mesh() const { return mesh_; }
  const TriangleTree& tree() const { return tree_; }
  const Box& box() const { return box_; }
  bool closed() const { return rim_.empty(); }

  /// Upper bound on how much the winding number changes within `radius` of p if the surface is not crossed: the
  /// gradient of an open surface's solid angle depends on its rim alone (Biot-Savart). 0 for a closed surface.
  double winding_variation(const Vector3d& p, double radius) const;

  /// Whether the distance to the rim of the surface is less than `distance`.
  bool rim_within(const Vector3d& p, double distance) const;

  /// Distance of p, positive on the side of the outward normals and negative on the other, by the angle-weighted
  /// pseudonormal of the closest feature (Baerentzen & Aanaes 2005). `closest` is tree()'s answer for p.
  double signed_distance(const Vector3d& p, const ClosestPoint& closest) const;
  /// Unit pseudonormal of the face, edge or corner that a closest point lies on.
  const Vector3d& pseudonormal(const ClosestPoint& closest) const;

private:
  std::string name_;
  TriangleMesh mesh_;
  TriangleTree tree_;
  Box box_;
  Edges rim_;  ///< empty: the surface is closed
  std::vector<Vector3d> face_normals_;
  std::vector<std::array<Vector3d, 3>> edge_normals_;
  std::vector<Vector3d> vertex_normals_;
};

using PreparedSurfaces = std::vector<std::unique_ptr<PreparedSurface>>;

/// Loads or makes every surface of the scene, in the scene's order, and reports what was repaired. Throws Error naming
/// the surface and what is wrong.
PreparedSurfaces prepare_surfaces(const Scene& scene, BakeMonitor& monitor);

/// The surface called `name`. If there is none, throws Error with a message that begins with `place`.
const PreparedSurface& named_surface(const PreparedSurfaces& surfaces, const std::string& name,
                                     const std::string& place);

/// One mesh of several surfaces that close a volume together. Each is flipped as it must be for the winding numbers of
/// all to be as near to whole numbers as they can be.
TriangleMesh join_surfaces(const std::vector<const PreparedSurface*>& parts);

/// Reads a mesh file of any format that assimp knows; vertices times `unit`. Throws Error naming the file.
TriangleMesh import_mesh(const std::string& file, double unit);

/// Closed mesh, normals outwards, of a built-in shape other than the forehead. Throws Error on impossible sizes.
TriangleMesh make_shape(const Shape& shape);

struct LoadedSurface
{
  TriangleMesh mesh;                  ///< vertices joined, triangles oriented, scene coordinates [m]
  std::vector<std::string> findings;  ///< repairs and harmless faults, one sentence each
};

/// Makes or reads a surface and repairs what can be repaired without changing its shape. `unit` [m] is the length unit
/// of the places in messages. Throws Error, with the place and the remedy, for a surface without a triangle that has an
/// area, an edge at which an odd number of triangles meet, a closed surface that encloses nothing, and a surface that
/// passes through itself. Holes are no error here: check_openings decides whether they do harm.
LoadedSurface load_surface(const Surface& surface, double unit);

}  // namespace frontalis
