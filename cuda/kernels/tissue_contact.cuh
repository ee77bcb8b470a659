#pragma once

#include "cuda/kernels/tissue_contact_arguments.hpp"
#include "frontalis/physics/surface_touch.hpp"
#include "frontalis/physics/surface_vertex.hpp"
#include "solver/contact/touch_search.hpp"

namespace frontalis
{
namespace cuda
{

// The work of one thread in each kernel of contact of tissue with itself. One thread serves one vertex.

using Place = physics::Vec3<float>;

__device__ __forceinline__ Place place(const float4& a) { return { a.x, a.y, a.z }; }
__device__ __forceinline__ float4 word(const Place& a) { return make_float4(a.x, a.y, a.z, 0); }

/// The surfaces at their present positions, for the functions of touch_search.hpp.
struct TouchView
{
  using Number = float;
  static constexpr float edge_error = 3e-5F;  // above the rounding errors of a foot

  __device__ __forceinline__ Place rest_apart(std::int32_t v, std::int32_t w) const
  {
    return place(c.vertices[v].rest) - place(c.vertices[w].rest);
  }
  __device__ __forceinline__ Place apart(std::int32_t v, std::int32_t w) const
  {
    return rest_apart(v, w) + (place(c.moved[v]) - place(c.moved[w]));
  }
  __device__ __forceinline__ Place normal(std::int32_t v) const { return place(c.normal[v]); }
  __device__ __forceinline__ float overlap(std::int32_t v) const { return c.vertices[v].overlap; }
  __device__ __forceinline__ std::int32_t contact_of(std::int32_t v) const { return c.vertices[v].contact; }
  __device__ __forceinline__ const std::int32_t* corners(std::int32_t t) const { return c.triangles[t].vertex; }
  __device__ __forceinline__ const std::int32_t* neighbours(std::int32_t t) const { return c.triangles[t].neighbour; }
  __device__ __forceinline__ bool placed(std::int32_t) const { return true; }
  __device__ __forceinline__ float edge() const { return c.edge; }
  __device__ __forceinline__ bool joined(std::int32_t v, std::int32_t w) const
  {
    const std::int32_t source = c.vertices[w].source;
    std::int32_t begin = c.joined_begin[c.vertices[v].source], end = c.joined_begin[c.vertices[v].source + 1];
    while (begin < end)
    {
      const std::int32_t middle = (begin + end) / 2;
      if (c.joined_sources[middle] < source)
        begin = middle + 1;
      else
        end = middle;
    }
    return begin < c.joined_begin[c.vertices[v].source + 1] && c.joined_sources[begin] == source;
  }

  const TissueContactArguments& c;
};

/// Places a vertex at the displacements u of device nodes, and clears its forces. Returns how far it has moved since
/// the latest search [m]. Calls wait(), which waits for the preceding kernel, once constant data have been loaded.
template <class Wait>
__device__ __forceinline__ float place_touching(const TissueContactArguments& c, std::uint32_t v, const float4* u,
                                                const Wait& wait)
{
  const float4 at = c.bound.coordinates[v];
  const uint4 low = c.bound.nodes[2 * v], high = c.bound.nodes[2 * v + 1];
  const std::uint32_t corner[8] = { low.x, low.y, low.z, low.w, high.x, high.y, high.z, high.w };
  const Place tangent[2] = { place(c.vertices[v].tangent[0]), place(c.vertices[v].tangent[1]) };
  wait();
  const auto vertex = physics::surface_vertex(physics::SideWeights<float>(at.x, at.y, at.z), tangent,
                                              Place{ c.inverse_spacing[0], c.inverse_spacing[1], c.inverse_spacing[2] },
                                              [&](int two, Place& first, Place& second)
                                              {
                                                first = place(u[corner[2 * two]]);
                                                second = place(u[corner[2 * two + 1]]);
                                              });
  if (c.change != nullptr)
    c.change[v] = word(vertex.displacement - place(c.moved[v]));
  c.moved[v] = word(vertex.displacement);
  c.normal[v] = word(vertex.normal);
  c.dual[2 * v] = word(vertex.dual[0]);
  c.dual[2 * v + 1] = word(vertex.dual[1]);
  c.sums[v] = TouchSum{};
  return norm(vertex.displacement - place(c.searched[v]));
}

/// Empties buckets of the grid before triangles are sorted.
__device__ __forceinline__ void clear_grid(const TissueContactArguments& c, std::uint32_t first, std::uint32_t stride)
{
  for (std::uint32_t b = first; b <= c.bucket_mask; b += stride)
    c.heads[b] = -1;
}

struct GridCell
{
  __device__ __forceinline__ GridCell(const Place& p, float edge)
      : x(index(p.x, edge)), y(index(p.y, edge)), z(index(p.z, edge))
  {
  }
  // Coordinates that are not finite count as cell 0.
  static __device__ __forceinline__ std::int32_t index(float x, float edge)
  {
    return fabsf(x) < 1e6F * edge ? static_cast<std::int32_t>(floorf(x / edge)) : 0;
  }
  std::int32_t x, y, z;
};

__device__ __forceinline__ Place place_of(const TissueContactArguments& c, std::int32_t v)
{
  return place(c.vertices[v].rest) + place(c.moved[v]);
}

/// Edge of the grid's cells [m]. The distance of a corner from its triangle's centre has grown at most by twice the
/// largest displacement since that distance was measured.
__device__ __forceinline__ float cell_edge(const TissueContactArguments& c)
{
  return float(touch_search::margin) * (float(touch_search::reach) * c.edge + __uint_as_float(c.control->radius) +
                                        2 * __uint_as_float(c.control->moved));
}

/// Sorts a triangle into the cell of its centre.
__device__ __forceinline__ void sort_triangle(const TissueContactArguments& c, std::uint32_t t, float cell)
{
  const TouchView view{ c };
  const std::int32_t* const corner = view.corners(static_cast<std::int32_t>(t));
  const Place b = view.apart(corner[1], corner[0]), d = view.apart(corner[2], corner[0]), centre = (1.0F / 3) * (b + d);
  const float radius = fmaxf(norm(centre), fmaxf(norm(b - centre), norm(d - centre)));
  atomicMax(&c.control->radius_found, __float_as_uint(radius));
  const GridCell at(place_of(c, corner[0]) + centre, cell);
  const std::uint32_t bucket = touch_search::cell_hash(at.x, at.y, at.z) & c.bucket_mask;
  c.next[t] = atomicExch(&c.heads[bucket], static_cast<std::int32_t>(t));
}

/// The triangle nearest to a vertex among those that it may touch and that do not adjoin the triangle `but`; -1: none.
/// Of triangles at the same distance, the triangle with the lowest index is taken, so that the order in a bucket does
/// not matter.
__device__ __forceinline__ std::int32_t nearest_triangle(const TouchView& view, std::int32_t p, std::int32_t but)
{
  const TissueContactArguments& c = view.c;
  const float cell = c.control->cell;
  const GridCell at(place_of(c, p), cell);
  std::int32_t nearest = -1;
  float least = 1e30F;
  for (std::int32_t n = 0; n < 27; ++n)
  {
    const std::uint32_t bucket =
        touch_search::cell_hash(at.x + n % 3 - 1, at.y + n / 3 % 3 - 1, at.z + n / 9 - 1) & c.bucket_mask;
    for (std::int32_t t = c.heads[bucket]; t >= 0; t = c.next[t])
    {
      float gap = 0;
      if ((but >= 0 && touch_search::adjoin(view, t, but)) || !touch_search::may_touch(view, p, t, cell, gap))
        continue;
      const float distance = fabsf(gap);
      if (distance < least || (distance == least && t < nearest))
      {
        least = distance;
        nearest = t;
      }
    }
  }
  return nearest;
}

/// Chooses up to two pairs of a vertex for the next step: those that touch, then those with the nearest triangles that
/// do not adjoin each other.
static __device__ __noinline__ void search_pairs(const TissueContactArguments& c, std::uint32_t v)
{
  const TouchView view{ c };
  const auto p = static_cast<std::int32_t>(v);
  const TouchPair none{ -1, 0, 0, 0, { 0, 0, 0 }, 0 };
  TouchPair* const pairs = c.pairs + 2 * std::size_t(v);
  TouchPair kept[touch_search::most_pairs] = { none, none };
  int count = 0;
  for (int k = 0; k < touch_search::most_pairs; ++k)
    if (const TouchPair pair = pairs[k]; pair.triangle >= 0 && (pair.held > 0 || pair.pressed > 0))
      kept[count++] = pair;
  std::int32_t found = -1;
  for (int turn = 0; turn < touch_search::most_pairs && count < touch_search::most_pairs; ++turn)
  {
    found = nearest_triangle(view, p, found);
    if (found < 0)
      break;
    if (count > 0 && touch_search::adjoin(view, found, kept[0].triangle))
      continue;
    kept[count] = none;
    kept[count++].triangle = found;
  }
  for (int k = 0; k < touch_search::most_pairs; ++k)
    pairs[k] = kept[k];
  c.searched[v] = c.moved[v];
}

__device__ __forceinline__ void add_units(unsigned long long* to, long long units)
{
  atomicAdd(to, static_cast<unsigned long long>(units));
}

/// Adds the forces of a vertex's pairs to the sums of the vertices. `response`: physics::friction_response(). Calls
/// wait(), which waits for the preceding kernel, once the pairs have been loaded.
template <bool rubs, class Wait>
__device__ __forceinline__ void touch_triangles(const TissueContactArguments& c, std::uint32_t v, float response,
                                                const Wait& wait)
{
  static_assert(touch_search::most_pairs == 2, "both pairs are loaded at once");
  const TouchView view{ c };
  const auto p = static_cast<std::int32_t>(v);
  const TouchPair both[2] = { c.pairs[2 * std::size_t(v)], c.pairs[2 * std::size_t(v) + 1] };
  wait();
  float stored = 0, lost = 0;
  std::int32_t first = -1;
  for (int k = 0; k < touch_search::most_pairs; ++k)
  {
    TouchPair pair = k == 0 ? both[0] : both[1];
    if (pair.triangle < 0)
      continue;
    physics::SurfaceTriangle<float> triangle;
    const auto foot = touch_search::follow(view, p, pair.triangle, triangle);
    if (pair.triangle == first)  // both pairs have reached the same triangle
    {
      c.pairs[2 * std::size_t(v) + k] = { -1, 0, 0, 0, { 0, 0, 0 }, 0 };
      continue;
    }
    first = pair.triangle;
    const TouchTriangle& corners = c.triangles[pair.triangle];
    const TouchVertex& vertex = c.vertices[v];
    physics::TouchingPair<float> of{ vertex.stiffness, {}, {}, vertex.overlap, vertex.friction };
    for (int i = 0; i < 3; ++i)
    {
      of.softer[i] = c.vertices[corners.vertex[i]].rest.w / vertex.rest.w;
      of.inner[i] = corners.neighbour[i] < 0 ? 0.0F : 1.0F;
    }
    const float gap = foot.gap - of.overlap;
    const float stiffness = gap < 0 && gap > -float(touch_search::deepest_held) * c.edge
                                ? physics::pair_stiffness(of, foot, view.normal(p))
                                : 0.0F;
    physics::PairGrip<float> grip{ pair.held, 0, 0, { 0, 0, 0 } };
    Place slip{ 0, 0, 0 };
    if constexpr (rubs)
    {
      grip = { pair.held, pair.pressed, pair.along, { pair.stretch[0], pair.stretch[1], pair.stretch[2] } };
      slip = place(c.change[v]);
      for (int i = 0; i < 3; ++i)
        slip = slip - carried(foot, i, place(c.change[corners.vertex[i]]));
    }
    const auto force = physics::touch_pair<rubs>(of, triangle, foot, gap, stiffness, slip, response, grip);
    c.pairs[2 * std::size_t(v) + k] = {
      pair.triangle, grip.stiffness, grip.pressed, grip.along, { grip.stretch.x, grip.stretch.y, grip.stretch.z }, 0
    };
    stored += force.stored;
    lost += force.lost;
    if (!(stiffness > 0))
      continue;
    long long sum[3] = { 0, 0, 0 };
    const float per_moment = c.per_newton / c.edge;
    for (int i = 0; i < 3; ++i)
    {
      TouchSum& to = c.sums[corners.vertex[i]];
      const Place on = c.per_newton * force.corner[i], turn = per_moment * force.turn[i];
      const long long units[3] = { __float2ll_rn(on.x), __float2ll_rn(on.y), __float2ll_rn(on.z) };
      add_units(&to.turn[0], __float2ll_rn(turn.x));
      add_units(&to.turn[1], __float2ll_rn(turn.y));
      add_units(&to.turn[2], __float2ll_rn(turn.z));
      for (int axis = 0; axis < 3; ++axis)
      {
        add_units(&to.force[axis], units[axis]);
        sum[axis] -= units[axis];
      }
    }
    for (int axis = 0; axis < 3; ++axis)
      add_units(&c.sums[v].force[axis], sum[axis]);
  }
  if (rubs && lost != 0)
    c.lost[v] += double(lost);
  if (c.looks_only)
    c.stored[v] = stored;
}

/// Chooses the stage of the next step. Other threads must not change the control at this time.
__device__ __forceinline__ void choose_stage(const TissueContactArguments& c, float dt)
{
  TouchControl& control = *c.control;
  control.dt = dt;
  if (control.stage == TouchStage::sort)
  {
    control.cell = cell_edge(c);
    control.next = TouchStage::search;
    return;
  }
  if (control.stage == TouchStage::search)
  {
    control.radius = control.radius_found;
    control.radius_found = control.moved = 0;
  }
  // Two vertices that approach each other may both move.
  const float approached = 2 * __uint_as_float(control.moved);
  const bool far = approached >= float(touch_search::renewal_share * touch_search::reach) * c.edge;
  control.next = far ? TouchStage::sort : TouchStage::hold;
}

/// Force of a vertex on corner b of its voxel [N].
__device__ __forceinline__ Place corner_push(const TissueContactArguments& c, std::uint32_t v, std::uint32_t b)
{
  const TouchSum sum = c.sums[v];
  const float4 at = c.bound.coordinates[v], normal = c.normal[v], dual0 = c.dual[2 * v], dual1 = c.dual[2 * v + 1];
  const Place tangent[2] = { place(c.vertices[v].tangent[0]), place(c.vertices[v].tangent[1]) };
  const auto in_newton = [&](const unsigned long long(&units)[3])
  {
    return (1 / c.per_newton) * Place{ static_cast<float>(static_cast<long long>(units[0])),
                                       static_cast<float>(static_cast<long long>(units[1])),
                                       static_cast<float>(static_cast<long long>(units[2])) };
  };
  const Place along = physics::normal_forces(c.edge * in_newton(sum.turn), place(dual0), place(dual1), tangent,
                                             Place{ c.inverse_spacing[0], c.inverse_spacing[1], c.inverse_spacing[2] });
  return physics::surface_node_force(physics::SideWeights<float>(at.x, at.y, at.z), static_cast<int>(b),
                                     in_newton(sum.force), along, place(normal));
}

}  // namespace cuda
}  // namespace frontalis
