#pragma once

#include "frontalis/model/model.hpp"
#include "frontalis/physics/surface_foot.hpp"
#include "solver/stepping/array_list.hpp"

#include <array>
#include <vector>

namespace frontalis
{

/// The surfaces of a model that touch each other, in the form that contact needs. Vertices are sorted by voxel; a point
/// on a crease has one vertex for each smooth part of the surface. Also lists neighbours of triangles and parts that
/// are joined at rest.
class TouchingSurface
{
public:
  using Vector = physics::Vec3<double>;
  struct Vertex
  {
    std::int32_t voxel;
    std::int32_t contact;              // index into Model::self_contacts
    std::int32_t source_in_contact;    // index of the vertex of that contact's surface from which this one was made
    std::int32_t source;               // the same index, counted over all contacts
    std::array<float, 3> coordinates;  // in the voxel
    float area_share;                  // fraction of the area of its source
    Vector rest;
    Vector normal;                  // at rest, unit vector
    std::array<Vector, 2> tangent;  // two vectors whose cross product is the normal
  };
  struct Triangle
  {
    std::array<std::int32_t, 3> vertex;
    /// Triangle across the edge opposite to each corner; -1: the surface ends there or has a crease.
    std::array<std::int32_t, 3> neighbour;
  };
  explicit TouchingSurface(const Model& model);

  /// Whether two vertices never touch, because their distance along the surface is below `joined_within`.
  bool joined(std::size_t v, std::size_t w) const;
  /// The sources that are near source s along the surface are the entries of joined_sources() from joined_begin()[s] up
  /// to, but not including, joined_begin()[s + 1], in ascending order.
  const std::vector<std::int32_t>& joined_begin() const { return joined_begin_; }
  const std::vector<std::int32_t>& joined_sources() const { return joined_; }

  Binding binding() const;  ///< binding of the vertices
  void list_arrays(ArrayList& list, Effect effect) const;

  std::vector<Vertex> vertices;
  std::vector<Triangle> triangles;
  double edge;  ///< shortest voxel edge [m]

private:
  void add(std::int32_t contact, std::int32_t first_source);
  void join(const TriangleMesh& mesh, std::int32_t first_source, double within);
  void sort_vertices();

  const Model& model_;
  std::vector<std::int32_t> joined_begin_, joined_;  // sources near each source along the surface, ascending
};

}  // namespace frontalis
