#pragma once

#include "bake/bake_stages.hpp"
#include "bake/mesh/triangle_tree.hpp"

#include <memory>
#include <string>
#include <vector>

namespace frontalis
{

/// A surface of the scene, ready for questions: joined, oriented, in scene coordinates [m].
class PreparedSurface
{
public:
  PreparedSurface(std::string name, TriangleMesh mesh, int line);

  const std::string& name() const { return name_; }
  const TriangleMesh& mesh() const { return mesh_; }
  const TriangleTree& tree() const { return tree_; }
  const Box& box() const { return box_; }
  int line() const { return line_; }
  bool closed() const { return rim_.empty(); }

  /// Bound on how much the winding number changes within `radius` of p without crossing the surface: the gradient of an
  /// open surface's solid angle depends on its rim alone (Biot-Savart). 0 for a closed surface.
  double winding_variation(const Vector3& p, double radius) const;

  /// Whether the distance to the rim of the surface is less than `distance`.
  bool rim_within(const Vector3& p, double distance) const;

  /// Distance with a sign: positive on the side of the outward normals, by the angle-weighted pseudonormal of the
  /// closest feature (Baerentzen & Aanaes 2005). `closest` as found by tree().
  double signed_distance(const Vector3& p, const ClosestPoint& closest) const;
  /// Unit pseudonormal of the feature that a closest point lies on.
  const Vector3& pseudonormal(const ClosestPoint& closest) const;

private:
  std::string name_;
  TriangleMesh mesh_;
  int line_;
  TriangleTree tree_;
  Box box_;
  Edges rim_;
  std::vector<Vector3> face_normals_;
  std::vector<std::array<Vector3, 3>> edge_normals_;
  std::vector<Vector3> vertex_normals_;
};

/// Loads, makes or joins every surface of the scene, orients it and reports what was repaired. Throws Error naming the
/// file and what is wrong.
std::vector<std::unique_ptr<PreparedSurface>> prepare_surfaces(const Scene& scene, BakeStages& stages);

/// The surface of that name; throws Error beginning with `place` where there is none.
const PreparedSurface& named_surface(const std::vector<std::unique_ptr<PreparedSurface>>& surfaces,
                                     const std::string& name, const std::string& place);

/// One mesh of several surfaces that close a volume together, each turned so that the winding numbers of all are as
/// near to whole numbers as they can be.
TriangleMesh join_surfaces(const std::vector<const PreparedSurface*>& parts);

/// Reads a mesh file of any format that assimp knows; vertices times `unit`. Throws Error naming the file.
TriangleMesh import_mesh(const std::string& file, double unit);

/// Triangles of a built-in shape but the forehead: closed, outward.
TriangleMesh make_shape(const Shape& shape);

}  // namespace frontalis
