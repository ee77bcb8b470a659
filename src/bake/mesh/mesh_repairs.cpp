#include "bake/mesh/mesh_faults.hpp"

#include "bake/mesh/triangle_tree.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <utility>

namespace frontalis
{
namespace
{

using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;

// Triangles with the same corners and opposite orientations cancel each other. Of equal triangles that remain, one is
// kept. `oriented`: whether orientations are consistent already. If not, only triangles that are equal, and have no
// opposite one, are removed.
void remove_repeated_triangles(TriangleMesh& mesh, bool oriented, MeshRepairs& repairs)
{
  std::map<Triangle, std::array<std::vector<std::size_t>, 2>> alike;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
  {
    Triangle corners = mesh.triangles[t];
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    const std::size_t orientation = corners[1] < corners[2] ? 0 : 1;
    std::sort(corners.begin(), corners.end());
    alike[corners][orientation].push_back(t);
  }
  std::vector<bool> keep(mesh.triangles.size(), true);
  for (const auto& [corners, by_orientation] : alike)
  {
    const std::size_t pairs = std::min(by_orientation[0].size(), by_orientation[1].size());
    if (pairs > 0 && !oriented)
      continue;
    for (const auto& triangles : by_orientation)
      for (std::size_t i = 0; i < triangles.size(); ++i)
      {
        keep[triangles[i]] = i == pairs;
        repairs.repeated += i > pairs ? 1 : 0;
      }
    repairs.back_to_back += pairs;
  }
  if (repairs.repeated + repairs.back_to_back > 0)
    mesh = keep_triangles(mesh, keep);
}

/// The corner, 0..2, that lies between the other two in a triangle without area; 3 if the triangle has an area.
std::size_t middle_corner(const TriangleMesh& mesh, const Triangle& t)
{
  std::array<Point, 3> p;
  for (std::size_t c = 0; c < 3; ++c)
  {
    const Vector3& v = mesh.vertices[t[c]];
    p[c] = Point(v[0], v[1], v[2]);
  }
  if (!CGAL::collinear(p[0], p[1], p[2]))
    return 3;
  for (std::size_t c = 0; c < 2; ++c)
    if (CGAL::collinear_are_ordered_along_line(p[(c + 1) % 3], p[c], p[(c + 2) % 3]))
      return c;
  return 2;
}

/// Removes each triangle a, b, c without area, where b lies between a and c. The neighbour a, c, d across the edge a-c
/// is split into a, b, d and b, c, d, which cover the same points.
void remove_flat_triangles(TriangleMesh& mesh, MeshRepairs& repairs)
{
  std::vector<std::size_t> flat;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (middle_corner(mesh, mesh.triangles[t]) < 3)
      flat.push_back(t);
  if (flat.empty())
    return;
  std::map<std::pair<std::int32_t, std::int32_t>, std::vector<std::size_t>> at_edge;
  const auto enter = [&](std::size_t t)
  {
    for (std::size_t c = 0; c < 3; ++c)
      at_edge[{ mesh.triangles[t][c], mesh.triangles[t][(c + 1) % 3] }].push_back(t);
  };
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    enter(t);
  std::vector<bool> keep(mesh.triangles.size(), true);
  // Splitting a neighbour without area adds two such triangles to the list. The limit guarantees termination.
  const std::size_t limit = 10 * flat.size() + 100;
  for (std::size_t f = 0; f < flat.size() && f < limit; ++f)
  {
    const Triangle t = mesh.triangles[flat[f]];
    const std::size_t middle = middle_corner(mesh, t);
    const std::int32_t b = t[middle], c = t[(middle + 1) % 3], a = t[(middle + 2) % 3];
    // The triangle runs along the edge from c to a, its neighbour from a to c.
    std::vector<std::size_t>& others = at_edge[{ a, c }];
    others.erase(std::remove_if(others.begin(), others.end(),
                                [&](std::size_t other) { return !keep[other] || other == flat[f]; }),
                 others.end());
    if (others.size() > 1)
      continue;
    keep[flat[f]] = false;
    ++repairs.flat;
    if (others.empty())
      continue;
    const std::size_t other = others.front();
    std::int32_t d = -1;
    for (const std::int32_t v : mesh.triangles[other])
      d = v != a && v != c ? v : d;
    keep[other] = false;
    if (d == b)
      continue;  // the triangle and its neighbour lie back to back
    for (const Triangle& part : { Triangle{ a, b, d }, Triangle{ b, c, d } })
    {
      mesh.triangles.push_back(part);
      keep.push_back(true);
      enter(mesh.triangles.size() - 1);
      if (middle_corner(mesh, part) < 3)
        flat.push_back(mesh.triangles.size() - 1);
    }
  }
  mesh = keep_triangles(mesh, keep);
}

}  // namespace

MeshRepairs repair_mesh(TriangleMesh& mesh)
{
  MeshRepairs repairs;
  repairs.collapsed = join_vertices(mesh);
  // A surface that was exported twice would be oriented as two sheets, back to back along its border.
  remove_repeated_triangles(mesh, false, repairs);
  repairs.turned = make_orientation_consistent(mesh);
  remove_repeated_triangles(mesh, true, repairs);
  remove_flat_triangles(mesh, repairs);
  return repairs;
}

std::size_t turn_inside_out_pieces(TriangleMesh& mesh, const std::vector<std::int32_t>& piece, std::size_t& nested)
{
  // The winding number is evaluated in front of the largest triangle of each piece.
  struct Largest
  {
    Vector3d middle{ 0, 0, 0 }, normal{ 0, 0, 0 };  // the normal's length is twice the triangle's area
  };
  std::vector<Largest> pieces(1 + *std::max_element(piece.begin(), piece.end()));
  for (std::size_t t = 0; t < piece.size(); ++t)
  {
    const auto [a, b, c] = corners(mesh, mesh.triangles[t]);
    const Vector3d normal = (b - a).cross(c - a);
    Largest& largest = pieces[piece[t]];
    if (normal.norm() > largest.normal.norm())
      largest = { (1.0 / 3) * (a + b + c), normal };
  }
  nested = 0;
  if (pieces.size() < 2)
  {
    const bool inside_out = signed_volume(mesh) < 0;
    if (inside_out)
      flip(mesh);
    return inside_out ? 1 : 0;
  }
  const TriangleTree tree(mesh);
  std::vector<bool> turn(pieces.size(), false);
  for (std::size_t p = 0; p < pieces.size(); ++p)
  {
    const auto& [middle, normal] = pieces[p];
    const double outside = tree.winding_number(middle + 1e-3 * std::sqrt(normal.norm()) * normal.normalized());
    turn[p] = outside < -0.5;
    nested += outside > 0.5 ? 1 : 0;
  }
  for (std::size_t t = 0; t < piece.size(); ++t)
    if (turn[piece[t]])
      std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  return std::count(turn.begin(), turn.end(), true);
}

}  // namespace frontalis
