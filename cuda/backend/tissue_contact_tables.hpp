#pragma once

#include "cuda/kernels/tissue_contact_arguments.hpp"
#include "solver/contact/tissue_contact.hpp"

#include <algorithm>
#include <cstring>
#include <vector>

namespace frontalis
{
namespace cuda
{

/// Number of units of force (TissueContactArguments::sums) in the force of the stiffest vertex at a depth of one voxel
/// edge. A unit is below the rounding error of a single number, and sums may be 2^19 times as large as that force.
constexpr double touch_units_in_force = 1LL << 44;
/// The same within patches. A unit corresponds to a depth of 1.5e-8 voxel edges, less than the rounding error of a
/// gap, and sums may be 32 times as large as that force. A pair pushes with at most a few times that force, because a
/// point that is deeper than one edge is let go.
constexpr double touch_units_in_patches = 1LL << 26;

/// The constant arrays of contact of tissue with itself, on the host.
struct TouchTables
{
  TouchTables(const Model& model, const Discretisation& discretisation);

  std::vector<TouchVertex> vertices;
  std::vector<std::uint32_t> voxel;  ///< of each vertex
  std::vector<float4> coordinates;   ///< of each vertex in its voxel
  std::vector<TouchTriangle> triangles;
  std::vector<std::int32_t> joined_begin, joined_sources;
  TouchControl rest{};             ///< TissueContactArguments::control at rest
  TissueContactArguments sizes{};  ///< numbers only; pointers are null
};

inline TouchTables::TouchTables(const Model& model, const Discretisation& discretisation)
{
  const TissueContact<float> host(model, discretisation, plain_touch_kernels<float>());
  const TouchingSurface& surface = host.surface();
  double stiffest = 0, radius = 0;
  for (std::size_t v = 0; v < surface.vertices.size(); ++v)
  {
    const TouchingSurface::Vertex& from = surface.vertices[v];
    const double friction = model.self_contacts[from.contact].friction;
    TouchVertex to{};
    const auto word = [](const TouchingSurface::Vector& a, float last) {
      return float4{ static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z), last };
    };
    to.rest = word(from.rest, host.per_area()[v]);
    to.tangent[0] = word(from.tangent[0], 0);
    to.tangent[1] = word(from.tangent[1], 0);
    to.stiffness = host.stiffness()[v];
    to.overlap = host.overlap()[v];
    to.friction = static_cast<float>(friction);
    to.contact = from.contact;
    to.source = from.source;
    vertices.push_back(to);
    voxel.push_back(static_cast<std::uint32_t>(from.voxel));
    coordinates.push_back({ from.coordinates[0], from.coordinates[1], from.coordinates[2], 0 });
    stiffest = std::max(stiffest, double(to.stiffness));
    sizes.rubs = sizes.rubs || friction > 0;
  }
  for (const TouchingSurface::Triangle& from : surface.triangles)
  {
    TouchTriangle to{};
    std::copy(from.vertex.begin(), from.vertex.end(), to.vertex);
    std::copy(from.neighbour.begin(), from.neighbour.end(), to.neighbour);
    const TouchVertex* corner[3];
    for (int i = 0; i < 3; ++i)
    {
      corner[i] = &vertices[from.vertex[i]];
      to.per_area[i] = corner[i]->rest.w;
    }
    const float4 &a = corner[0]->rest, &b = corner[1]->rest, &c = corner[2]->rest;
    to.x = a.x;
    to.y = a.y;
    to.z = a.z;
    const float sides[2][3] = { { b.x - a.x, b.y - a.y, b.z - a.z }, { c.x - a.x, c.y - a.y, c.z - a.z } };
    std::memcpy(to.side, sides, sizeof sides);
    triangles.push_back(to);
    const auto at = [&](std::size_t i) { return surface.vertices[from.vertex[i]].rest; };
    const auto centre = (1.0 / 3) * (at(0) + at(1) + at(2));
    for (const std::size_t i : { 0, 1, 2 })
      radius = std::max(radius, norm(at(i) - centre));
  }
  joined_begin = surface.joined_begin();
  joined_sources = surface.joined_sources();
  std::uint32_t buckets = 1;
  while (buckets < triangles.size())
    buckets *= 2;
  sizes.vertex_count = static_cast<std::uint32_t>(vertices.size());
  sizes.triangle_count = static_cast<std::uint32_t>(triangles.size());
  sizes.bucket_mask = buckets - 1;
  sizes.edge = static_cast<float>(surface.edge);
  for (std::size_t axis = 0; axis < 3; ++axis)
    sizes.inverse_spacing[axis] = static_cast<float>(1 / model.spacing[axis]);
  const double largest_force = std::max(stiffest * surface.edge, 1e-12);
  sizes.per_newton = static_cast<float>(touch_units_in_force / largest_force);
  sizes.in_patches.per_newton = static_cast<float>(touch_units_in_patches / largest_force);
  const auto largest = static_cast<float>(radius);
  std::memcpy(&rest.radius, &largest, sizeof largest);
}

}  // namespace cuda
}  // namespace frontalis
