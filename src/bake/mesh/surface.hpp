#pragma once

#include "bake/bake_monitor.hpp"
#include "bake/mesh/triangle_tree.hpp"

#include <memory>

namespace frontalis
{

/// A surface of the scene, prepared for closest points, distances and winding numbers. Equal vertices are joined and
/// the triangles are oriented. Scene coordinates [m].
class PreparedSurface
{
public:
  PreparedSurface(std::string name, TriangleMesh mesh);

  const std::string& name() const { return name_; }
  const TriangleMesh& mesh() const { return mesh_; }
  const TriangleTree& tree() const { return tree_; }
  const Box& box() const { return box_; }
  bool closed() const { return rim_.empty(); }

  /// Upper bound on how much the winding number changes within `radius` of p if the surface is not crossed. The bound
  /// follows from the border alone, as the gradient of an open surface's solid angle does (Biot-Savart). 0 for a closed
  /// surface.
  double winding_variation(const Vector3d& p, double radius) const;

  /// Whether p is closer than `distance` [m] to the border of the surface.
  bool rim_within(const Vector3d& p, double distance) const;

  /// Distance of p [m], positive on the side of the outward normals. The angle-weighted pseudonormal of the closest
  /// feature gives the sign (Baerentzen & Aanaes 2005). `closest` is the result of tree().closest(p).
  double signed_distance(const Vector3d& p, const ClosestPoint& closest) const;
  /// Unit pseudonormal of the face, edge or corner that a closest point lies on.
  const Vector3d& pseudonormal(const ClosestPoint& closest) const;

private:
  std::string name_;
  TriangleMesh mesh_;
  TriangleTree tree_;
  Box box_;
  Edges rim_;  ///< border edges; empty: the surface is closed
  std::vector<Vector3d> face_normals_;
  std::vector<std::array<Vector3d, 3>> edge_normals_;
  std::vector<Vector3d> vertex_normals_;
};

using PreparedSurfaces = std::vector<std::unique_ptr<PreparedSurface>>;

/// Loads or makes the scene's surfaces in its order, without parts of heads that nothing in it names, and reports
/// repairs. Throws Error naming the surface and its fault.
PreparedSurfaces prepare_surfaces(const Scene& scene, BakeMonitor& monitor);

/// The surface called `name`. If there is none, throws Error with a message that begins with `place`.
const PreparedSurface& named_surface(const PreparedSurfaces& surfaces, const std::string& name,
                                     const std::string& place);

/// Joins surfaces that together enclose a volume. Flips them so that the sums of their winding numbers are as near to
/// whole numbers as possible.
TriangleMesh join_surfaces(const std::vector<const PreparedSurface*>& parts);

/// Reads a mesh file of any format known to assimp, with coordinates in `unit` [m]. Throws Error naming the file.
TriangleMesh import_mesh(const std::string& file, double unit);

/// Throws Error if a line of this length [m] on a shape has more than 1000 edges: finer shapes have tens of millions of
/// triangles.
void check_edges(double edge, double length);

/// Closed mesh, with outward normals, of a built-in shape whose kind needs no other surface or template (box to torus).
/// Throws Error on impossible sizes.
TriangleMesh make_shape(const Shape& shape);

/// Closed mesh of a shape of the kind `offset`, with edges of about `shape.edge` [m] (0: 1.75 mm): the points inside
/// `above` that lie at the depths of the shape below it. Throws Error if `above` is open or less deep than asked for.
TriangleMesh make_offset(const Shape& shape, const TriangleMesh& above);

struct LoadedSurface
{
  TriangleMesh mesh;                  ///< vertices joined, triangles oriented, scene coordinates [m]
  std::vector<std::string> findings;  ///< repairs and harmless faults, one sentence each
  std::vector<std::string> warnings;  ///< probable mistakes
};

/// Makes or reads a surface and makes the repairs that do not change its shape. Messages give positions in the length
/// unit `unit` [m]. Throws Error, with position and remedy, if no triangle has an area, an odd number of triangles meet
/// at an edge, a closed surface encloses nothing, or a surface passes through itself. Holes are allowed here;
/// check_openings() refuses those that do harm.
LoadedSurface load_surface(const Surface& surface, double unit);

}  // namespace frontalis
