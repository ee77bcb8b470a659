#pragma once

#include "cuda/kernels/tissue_contact.cuh"

namespace frontalis
{
namespace cuda
{

// The search for pairs of a vertex and a triangle before the steps of a plan.

/// Largest speed of the nodes of a vertex's voxel [m/s]. `v`: velocities of device nodes.
__device__ __forceinline__ float speed_of(const TissueContactArguments& c, std::uint32_t vertex,
                                          const float* const (&v)[3])
{
  const uint4 low = c.bound.nodes[2 * vertex], high = c.bound.nodes[2 * vertex + 1];
  const std::uint32_t corner[8] = { low.x, low.y, low.z, low.w, high.x, high.y, high.z, high.w };
  float most = 0;
  for (const std::uint32_t n : corner)
    most = fmaxf(most, norm(Place{ v[0][n], v[1][n], v[2][n] }));
  return most;
}

/// Empties the grid and the lists of patches before the search.
__device__ __forceinline__ void clear_grid(const TissueContactArguments& c, std::uint32_t first, std::uint32_t stride)
{
  for (std::uint32_t b = first; b <= c.bucket_mask; b += stride)
    c.heads[b] = -1;
  if (c.in_patches.patches != nullptr)
    for (std::uint32_t p = first; p < 2 * c.in_patches.patch_count; p += stride)
      c.in_patches.counts[p] = 0;
}

/// Whether and how far pairs have to be searched for before steps that take `seconds`.
struct TouchReach
{
  __device__ __forceinline__ TouchReach(const TissueContactArguments& c, float seconds)
  {
    const TouchControl& control = *c.control;
    // Two vertices that approach each other may both move, and may become twice as fast.
    const float approached = 2 * __uint_as_float(control.moved), ahead = 4 * __uint_as_float(control.speed) * seconds;
    const float share = float(touch_search::renewal_share), least = float(touch_search::reach) * c.edge;
    needed = !(approached + ahead < share * control.reach);
    reach = fminf(fmaxf(least, ahead / share), 4 * least);
    // The distance of a corner from its triangle's centre has grown at most by twice the largest displacement since
    // that distance was measured.
    cell = float(touch_search::margin) * (reach + __uint_as_float(control.radius) + 2 * __uint_as_float(control.moved));
  }
  bool needed;
  float reach;  ///< distance within which the search finds pairs [m]
  float cell;   ///< edge of the grid's cells [m]
};

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
  return place(c.vertices[v].rest) + place(c.placed[v]);
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
__device__ __forceinline__ std::int32_t nearest_triangle(const TouchView& view, const TouchReach& far, std::int32_t p,
                                                         std::int32_t but)
{
  const TissueContactArguments& c = view.c;
  const GridCell at(place_of(c, p), far.cell);
  std::int32_t nearest = -1;
  float least = 1e30F;
  for (std::int32_t n = 0; n < 27; ++n)
  {
    const std::uint32_t bucket =
        touch_search::cell_hash(at.x + n % 3 - 1, at.y + n / 3 % 3 - 1, at.z + n / 9 - 1) & c.bucket_mask;
    for (std::int32_t t = c.heads[bucket]; t >= 0; t = c.next[t])
    {
      float gap = 0;
      if ((but >= 0 && touch_search::adjoin(view, t, but)) ||
          !touch_search::may_touch(view, p, t, far.reach, far.cell, gap))
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

/// Chooses up to two pairs of a vertex for the next steps: those that touch, then those with the nearest triangles that
/// do not adjoin each other.
static __device__ __noinline__ void search_pairs(const TissueContactArguments& c, const TouchReach& far,
                                                 std::uint32_t v)
{
  const TouchView view{ c };
  const auto p = static_cast<std::int32_t>(v);
  const TouchPair none{ -1, 0, 0, 0, { 0, 0, 0 }, -1 };
  TouchPair* const pairs = c.pairs + 2 * std::size_t(v);
  TouchPair kept[touch_search::most_pairs] = { none, none };
  int count = 0;
  for (int k = 0; k < touch_search::most_pairs; ++k)
    if (const TouchPair pair = pairs[k]; pair.triangle >= 0 && (pair.held > 0 || pair.pressed > 0))
      kept[count++] = pair;
  std::int32_t found = -1;
  for (int turn = 0; turn < touch_search::most_pairs && count < touch_search::most_pairs; ++turn)
  {
    found = nearest_triangle(view, far, p, found);
    if (found < 0)
      break;
    if (count > 0 && touch_search::adjoin(view, found, kept[0].triangle))
      continue;
    kept[count] = none;
    kept[count++].triangle = found;
  }
  for (int k = 0; k < touch_search::most_pairs; ++k)
    pairs[k] = kept[k];
  c.searched[v] = c.placed[v];
}

/// Finds the vertex of each pair's triangle that is nearest to the pair's foot.
__device__ __forceinline__ void begin_pairs(const TissueContactArguments& c, std::uint32_t v)
{
  const TouchView view{ c };
  for (int k = 0; k < touch_search::most_pairs; ++k)
  {
    TouchPair& pair = c.pairs[2 * std::size_t(v) + k];
    if (pair.triangle < 0)
      continue;
    const std::int32_t* const corner = view.corners(pair.triangle);
    const auto foot =
        physics::surface_foot(view.triangle(pair.triangle), view.apart(static_cast<std::int32_t>(v), corner[0]));
    pair.began = foot.weight[0] > fmaxf(foot.weight[1], foot.weight[2]) ? corner[0]
                 : foot.weight[1] > foot.weight[2]                      ? corner[1]
                                                                        : corner[2];
  }
}

/// Calls call(patch) once for each patch whose list must have a vertex with these pairs.
template <class Call>
__device__ __forceinline__ void each_list(const TissueContactArguments& c, std::uint32_t v, const TouchPair* pairs,
                                          const Call& call)
{
  if (pairs[0].triangle < 0 && pairs[1].triangle < 0)
    return;
  const TouchPatches& in = c.in_patches;
  std::uint32_t at[3] = { in.near_begin[v], 0, 0 }, end[3] = { in.near_begin[v + 1], 0, 0 };
  for (int k = 0; k < touch_search::most_pairs; ++k)
    if (pairs[k].triangle >= 0)
    {
      at[k + 1] = in.near_begin[c.vertex_count + pairs[k].began];
      end[k + 1] = in.near_begin[c.vertex_count + pairs[k].began + 1];
    }
  for (;;)
  {
    constexpr std::uint32_t none = 0xffffffffu;
    std::uint32_t least = none;
    for (int i = 0; i < 3; ++i)
      if (at[i] < end[i] && in.near[at[i]] < least)
        least = in.near[at[i]];
    if (least == none)
      return;
    for (int i = 0; i < 3; ++i)
      at[i] += at[i] < end[i] && in.near[at[i]] == least ? 1 : 0;
    call(least);
  }
}

/// Adds a vertex to the lists that must have it. Places in several lists are asked for at once, because each answer
/// takes long.
__device__ __forceinline__ void list_vertex(const TissueContactArguments& c, std::uint32_t v)
{
  constexpr std::uint32_t most = 4;
  const TouchPatches& in = c.in_patches;
  const TouchPair* const pairs = c.pairs + touch_search::most_pairs * std::size_t(v);
  std::uint32_t patch[most], count = 0;
  const auto add = [&]
  {
    const std::uint32_t first = atomicAdd(&c.control->entries, count);
    std::uint32_t place[most], copy[most];
#pragma unroll
    for (std::uint32_t i = 0; i < most; ++i)
      copy[i] = i < count ? in.copy_of[std::size_t(patch[i]) * c.vertex_count + v] : no_touch_copy;
#pragma unroll
    for (std::uint32_t i = 0; i < most; ++i)
      if (i < count)
      {
        const bool has = copy[i] != no_touch_copy;
        place[i] = atomicAdd(in.counts + 2 * patch[i] + (has ? 0 : 1), 1u);
        place[i] = has ? place[i] : c.vertex_count - 1 - place[i];
      }
#pragma unroll
    for (std::uint32_t i = 0; i < most; ++i)
      if (i < count)
      {
        const bool keeps =
            copy[i] != no_touch_copy && (in.vertex_of[in.patches[patch[i]].vertex_begin + copy[i]] & touch_mark) != 0;
        in.lists[std::size_t(patch[i]) * c.vertex_count + place[i]] = first + i;
        in.entry_vertex[first + i] = v | (keeps ? touch_mark : 0);
        for (int k = 0; k < touch_search::most_pairs; ++k)
          in.entries[first + i].pair[k] = pairs[k];
      }
    count = 0;
  };
  each_list(c, v, pairs,
            [&](std::uint32_t p)
            {
              patch[count++] = p;
              if (count == most)
                add();
            });
  if (count > 0)
    add();
}

/// Ends the search before steps of length dt. Other threads must not use the control at this time.
__device__ __forceinline__ void end_search(const TissueContactArguments& c, const TouchReach& far, float dt)
{
  TouchControl& control = *c.control;
  if (far.needed)
  {
    control.reach = far.reach;
    control.radius = control.radius_found;
  }
  control.moved = control.speed = control.radius_found = control.entries = control.done = 0;
  control.dt = dt;
}

}  // namespace cuda
}  // namespace frontalis
