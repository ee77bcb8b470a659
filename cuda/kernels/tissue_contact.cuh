#pragma once

#include "cuda/kernels/tissue_contact_arguments.hpp"
#include "frontalis/physics/surface_touch.hpp"
#include "frontalis/physics/surface_vertex.hpp"
#include "solver/contact/touch_search.hpp"

#include <type_traits>

namespace frontalis
{
namespace cuda
{

// Contact of tissue with itself: the work of one thread, which serves one vertex.

using Place = physics::Vec3<float>;

__device__ __forceinline__ Place place(const float4& a) { return { a.x, a.y, a.z }; }
__device__ __forceinline__ float4 word(const Place& a) { return make_float4(a.x, a.y, a.z, 0); }

/// The surfaces at their present positions, for the functions of touch_search.hpp.
struct TouchView
{
  using Number = float;
  using Units = long long;                    // whole numbers in which forces are added
  static constexpr float edge_error = 3e-5F;  // above the rounding errors of a foot

  static __device__ __forceinline__ Units units(float x) { return __float2ll_rn(x); }
  __device__ __forceinline__ float per_newton() const { return c.per_newton; }

  __device__ __forceinline__ Place rest_apart(std::int32_t v, std::int32_t w) const
  {
    return place(c.vertices[v].rest) - place(c.vertices[w].rest);
  }
  __device__ __forceinline__ Place apart(std::int32_t v, std::int32_t w) const
  {
    return rest_apart(v, w) + (place(c.placed[v]) - place(c.placed[w]));
  }
  __device__ __forceinline__ Place normal(std::int32_t v) const { return place(c.normal[v]); }
  __device__ __forceinline__ Place change(int, std::int32_t v) const { return place(c.change[v]); }
  __device__ __forceinline__ float overlap(std::int32_t v) const { return c.vertices[v].overlap; }
  __device__ __forceinline__ std::int32_t contact_of(std::int32_t v) const { return c.vertices[v].contact; }
  __device__ __forceinline__ const std::int32_t* corners(std::int32_t t) const { return c.triangles[t].vertex; }
  __device__ __forceinline__ const std::int32_t* neighbours(std::int32_t t) const { return c.triangles[t].neighbour; }
  __device__ __forceinline__ bool placed(std::int32_t) const { return true; }
  __device__ __forceinline__ const TouchTriangle& record(std::int32_t t) const { return c.triangles[t]; }
  __device__ __forceinline__ physics::SurfaceTriangle<float> triangle(std::int32_t t) const
  {
    return touch_search::triangle_of(*this, t);
  }
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

/// Vertex v where the displacements of the corners of its voxel put it; see physics::surface_vertex().
template <class Corners>
__device__ __forceinline__ physics::SurfaceVertex<float> touching_vertex(const TissueContactArguments& c,
                                                                         const float4& at, const TouchVertex& vertex,
                                                                         const Corners& corners)
{
  const Place tangent[2] = { place(vertex.tangent[0]), place(vertex.tangent[1]) };
  return physics::surface_vertex(physics::SideWeights<float>(at.x, at.y, at.z), tangent,
                                 Place{ c.inverse_spacing[0], c.inverse_spacing[1], c.inverse_spacing[2] }, corners);
}

/// Places a vertex at the displacements u of device nodes, and clears its forces. Calls wait(), which waits for the
/// preceding kernel, once constant data have been loaded.
template <class Wait>
__device__ __forceinline__ void place_touching(const TissueContactArguments& c, std::uint32_t v, const float4* u,
                                               const Wait& wait)
{
  const float4 at = c.bound.coordinates[v];
  const uint4 low = c.bound.nodes[2 * v], high = c.bound.nodes[2 * v + 1];
  const std::uint32_t corner[8] = { low.x, low.y, low.z, low.w, high.x, high.y, high.z, high.w };
  wait();
  const auto vertex = touching_vertex(c, at, c.vertices[v],
                                      [&](int two, Place& first, Place& second)
                                      {
                                        first = place(u[corner[2 * two]]);
                                        second = place(u[corner[2 * two + 1]]);
                                      });
  if (c.change != nullptr)
    c.change[v] = word(vertex.displacement - place(c.moved[v]));
  c.placed[v] = word(vertex.displacement);
  c.normal[v] = word(vertex.normal);
  c.dual[2 * v] = word(vertex.dual[0]);
  c.dual[2 * v + 1] = word(vertex.dual[1]);
  c.sums[v] = TouchSum{};
}

/// Finds the forces of a pair of vertex p and updates the pair. Calls add(i, vertex, force, turn) with the force on
/// each of the four vertices, in View::Units, and the moment on its normal, which is still to be rounded to such units:
/// i is the triangle's corner, or 3 for p, for which `turn` is null. `first`: the triangle of p's other pair, if that
/// has been computed. `response`: physics::friction_response(). Adds to the energies `stored` and `lost` [J].
template <bool rubs, class View, class Add>
__device__ __forceinline__ void touch_triangle(View&& view, std::int32_t p, TouchPair& pair, std::int32_t first,
                                               float response, const Add& add, float& stored, float& lost)
{
  const TissueContactArguments& c = view.c;
  physics::SurfaceTriangle<float> triangle;
  const auto foot = touch_search::follow(view, p, pair.triangle, triangle);
  if (pair.triangle == first)  // both pairs have reached the same triangle
  {
    pair = { -1, 0, 0, 0, { 0, 0, 0 }, -1 };
    return;
  }
  const TouchTriangle& corners = view.record(pair.triangle);
  const TouchVertex& vertex = c.vertices[p];
  physics::TouchingPair<float> of{ vertex.stiffness, {}, {}, vertex.overlap, vertex.friction };
  FRONTALIS_UNROLL
  for (int i = 0; i < 3; ++i)
  {
    of.softer[i] = corners.per_area[i] / vertex.rest.w;
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
    slip = view.change(3, p);
    FRONTALIS_UNROLL
    for (int i = 0; i < 3; ++i)
      slip = slip - carried(foot, i, view.change(i, corners.vertex[i]));
  }
  const auto force = physics::touch_pair<rubs>(of, triangle, foot, gap, stiffness, slip, response, grip);
  pair = { pair.triangle, grip.stiffness, grip.pressed, grip.along, { grip.stretch.x, grip.stretch.y, grip.stretch.z },
           pair.began };
  stored += force.stored;
  lost += force.lost;
  if (!(stiffness > 0))
    return;
  using Units = typename std::remove_reference_t<View>::Units;
  Units sum[3] = { 0, 0, 0 };
  const float per_newton = view.per_newton(), per_moment = per_newton / c.edge;
  FRONTALIS_UNROLL
  for (int i = 0; i < 3; ++i)
  {
    const Place on = per_newton * force.corner[i], turned = per_moment * force.turn[i];
    const Units units[3] = { view.units(on.x), view.units(on.y), view.units(on.z) };
    for (int axis = 0; axis < 3; ++axis)
      sum[axis] -= units[axis];
    add(i, corners.vertex[i], units, &turned);
  }
  add(3, p, sum, nullptr);
}

/// Adds the forces of a vertex's pairs to the sums of the vertices. Calls wait(), which waits for the preceding kernel.
template <bool rubs, class Wait>
__device__ __forceinline__ void touch_triangles(const TissueContactArguments& c, std::uint32_t v, float response,
                                                const Wait& wait)
{
  static_assert(touch_search::most_pairs == 2, "both pairs are loaded at once");
  TouchPair* const pairs = c.pairs + 2 * std::size_t(v);
  wait();
  const TouchPair both[2] = { pairs[0], pairs[1] };
  const auto add = [&](int, std::int32_t to, const long long(&force)[3], const Place* turn)
  {
    for (int axis = 0; axis < 3; ++axis)
      atomicAdd(&c.sums[to].force[axis], static_cast<unsigned long long>(force[axis]));
    if (turn == nullptr)
      return;
    atomicAdd(&c.sums[to].turn[0], static_cast<unsigned long long>(TouchView::units(turn->x)));
    atomicAdd(&c.sums[to].turn[1], static_cast<unsigned long long>(TouchView::units(turn->y)));
    atomicAdd(&c.sums[to].turn[2], static_cast<unsigned long long>(TouchView::units(turn->z)));
  };
  float stored = 0, lost = 0;
  std::int32_t first = -1;
  for (int k = 0; k < touch_search::most_pairs; ++k)
  {
    TouchPair pair = k == 0 ? both[0] : both[1];
    if (pair.triangle < 0)
      continue;
    touch_triangle<rubs>(TouchView{ c }, static_cast<std::int32_t>(v), pair, first, response, add, stored, lost);
    pairs[k] = pair;
    first = pair.triangle;
  }
  if (rubs && lost != 0)
    c.lost[v] += double(lost);
  if (c.measures)
    c.stored[v] = stored;
}

/// What a moment on a vertex's normal [N m] exerts on its voxel: physics::normal_forces().
__device__ __forceinline__ Place normal_push(const TissueContactArguments& c, const TouchVertex& vertex,
                                             const Place& turn, const float4& dual0, const float4& dual1)
{
  const Place tangent[2] = { place(vertex.tangent[0]), place(vertex.tangent[1]) };
  return physics::normal_forces(turn, place(dual0), place(dual1), tangent,
                                Place{ c.inverse_spacing[0], c.inverse_spacing[1], c.inverse_spacing[2] });
}

/// Force of a vertex on corner b of its voxel [N], from the forces in TissueContactArguments::sums.
__device__ __forceinline__ Place corner_push(const TissueContactArguments& c, std::uint32_t v, std::uint32_t b)
{
  const TouchSum sum = c.sums[v];
  const auto in_newton = [&](const unsigned long long(&units)[3])
  {
    return (1 / c.per_newton) * Place{ static_cast<float>(static_cast<long long>(units[0])),
                                       static_cast<float>(static_cast<long long>(units[1])),
                                       static_cast<float>(static_cast<long long>(units[2])) };
  };
  const float4 at = c.bound.coordinates[v];
  return physics::surface_node_force(
      physics::SideWeights<float>(at.x, at.y, at.z), static_cast<int>(b), in_newton(sum.force),
      normal_push(c, c.vertices[v], c.edge * in_newton(sum.turn), c.dual[2 * v], c.dual[2 * v + 1]),
      place(c.normal[v]));
}

}  // namespace cuda
}  // namespace frontalis
