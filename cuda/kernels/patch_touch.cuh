#pragma once

#include "cuda/kernels/patch_contact.cuh"
#include "cuda/kernels/patch_exchange.cuh"
#include "cuda/kernels/tissue_contact.cuh"

namespace frontalis
{
namespace cuda
{

// Contact of tissue with itself in patches. A patch computes all pairs that push vertices of its voxels, even if other
// patches compute them as well. The pairs of a plan are listed before it. Vertices of other patches are read as words
// with step numbers. Two buffers suffice, because no vertex is published in step s + 2 before it has been read in step
// s: its patch has waited for all patches that may compute the same pairs to end step s (await_touch()), or it has read
// the pair's other vertices, whose patches have waited, or which share a voxel with the reader.

/// Shared memory of a patch's vertices, each array at a stride of `room` entries.
struct TouchMemory
{
  float4 *moved, *normal, *dual[2], *change;
  std::int32_t* sums;     // of forces and moments, in units of TouchPatches: [component][vertex]
  float4* pairs;          // the first entries of the list: [word of TouchEntry][entry]
  std::uint32_t* code;    // of these entries: TouchPatches::entry_vertex
  std::uint32_t* pushed;  // TouchStep::mark of the latest step in which a pair had forces
  std::uint32_t room;
};

/// Contact of tissue with itself of a patch in a step.
struct TouchStep
{
  TouchPatch patch;
  std::uint32_t count, first_others;  ///< length of the patch's list, and place of the first vertex of other patches
  std::uint32_t room, mark, index;
  int buffer;
  bool first, last;  ///< whether the step is the launch's first, last
};

__device__ __forceinline__ TouchMemory touch_memory(const PatchMemory& memory, std::uint32_t room)
{
  float4* const first = memory.touch;
  return { first,
           first + room,
           { first + 2 * room, first + 3 * room },
           first + 4 * room,
           reinterpret_cast<std::int32_t*>(first + (5 + 4 * touch_ahead) * room),
           first + 5 * room,
           reinterpret_cast<std::uint32_t*>(first + (5 + 4 * touch_ahead) * room) + touch_components * room,
           reinterpret_cast<std::uint32_t*>(first + (5 + 4 * touch_ahead) * room) +
               (touch_components + touch_ahead) * room,
           room };
}

/// Clears the sums at the start of a launch.
__device__ __forceinline__ void clear_touch(const StepLaunch& launch, const PatchMemory& memory)
{
  const TouchMemory own = touch_memory(memory, launch.room.touch_vertices);
  for (std::uint32_t i = threadIdx.x; i < touch_components * own.room; i += blockDim.x)
    own.sums[i] = 0;
  if (threadIdx.x == 0 && own.room > 0)
    *own.pushed = 0;
}

__device__ __forceinline__ TouchStep fetch_touch(const StepArguments& g, const StepLaunch& launch, std::uint32_t p,
                                                 std::int32_t step)
{
  const TouchPatches& in = g.touch.in_patches;
  TouchStep touch{};
  if (in.patches == nullptr || g.forces_only)
    return touch;
  touch.patch = in.patches[p];
  touch.first_others = in.counts[2 * p];
  touch.count = touch.first_others + in.counts[2 * p + 1];
  touch.room = launch.room.touch_vertices;
  touch.mark = mark(g, step);
  touch.index = p;
  touch.buffer = (g.first + step - g.step_begin) & 1;
  touch.first = step == g.step_begin;
  touch.last = step + 1 == g.step_end;
  return touch;
}

/// Waits for the patches that may read the vertices of this one to be ready for the step.
__device__ __forceinline__ void await_touch(const StepArguments& g, const TouchStep& touch)
{
  if (touch.count == 0 || touch.first)
    return;
  const TouchPatches& in = g.touch.in_patches;
  const std::uint32_t end = in.watch_begin[touch.index + 1];
  // The first threads wait for nodes.
  for (std::uint32_t i = in.watch_begin[touch.index] + blockDim.x - 1 - threadIdx.x; i < end; i += blockDim.x)
    if (const std::uint32_t patch = __ldg(in.watched + i); in.counts[2 * patch] + in.counts[2 * patch + 1] > 0)
      receive(in.ended[touch.buffer] + patch, touch.mark);
}

/// Places the patch's vertices and publishes those that it has to. Ends with a barrier. Where no pair is near, vertices
/// are placed in the last step only, so that friction in the next plan finds how far they move.
__device__ __forceinline__ void place_touch(const StepArguments& g, const TouchStep& touch, const PatchMemory& memory)
{
  if (touch.count == 0 && !touch.last)
    return;
  const TissueContactArguments& c = g.touch;
  const TouchMemory own = touch_memory(memory, touch.room);
  // Vertices are given to threads in reverse order, because the first threads have more voxels.
  for (std::uint32_t i = blockDim.x - 1 - threadIdx.x; i < touch.patch.vertices; i += blockDim.x)
  {
    const std::uint32_t copy = touch.patch.vertex_begin + i, code = __ldg(c.in_patches.vertex_of + copy);
    const std::uint32_t v = code & ~touch_mark;
    std::uint32_t corner[8];
    split(__ldg(c.in_patches.corners + copy), corner);
    const auto vertex = touching_vertex(c, __ldg(c.bound.coordinates + v), c.vertices[v],
                                        [&](int two, Place& first, Place& second)
                                        {
                                          first = place(memory.place[corner[2 * two]]);
                                          second = place(memory.place[corner[2 * two + 1]]);
                                        });
    Place change{ 0, 0, 0 };
    if (c.rubs)
      change = vertex.displacement - place(touch.first ? c.in_patches.before[copy] : own.moved[i]);
    own.moved[i] = word(vertex.displacement);
    own.normal[i] = word(vertex.normal);
    own.dual[0][i] = word(vertex.dual[0]);
    own.dual[1][i] = word(vertex.dual[1]);
    own.change[i] = word(change);
    if (touch.last)
      c.in_patches.before[copy] = word(vertex.displacement);
    if ((code & touch_mark) == 0)
      continue;
    const auto publish = [&](std::uint32_t which, const Place& value)
    {
      const float words[3] = { value.x, value.y, value.z };
      send(c.in_patches.words[touch.buffer] + touch_words * v + which, words, touch.mark);
    };
    publish(0, vertex.displacement);
    publish(1, vertex.normal);
    if (c.rubs)
      publish(2, change);
    if (touch.last)
      c.moved[v] = word(vertex.displacement);
  }
  __syncthreads();
}

/// The surfaces as a patch sees them, for touch_triangle(): a vertex and a triangle, with their present values.
template <bool rubs>
struct PatchTouchView
{
  using Number = float;
  using Units = std::int32_t;
  static constexpr float edge_error = TouchView::edge_error;

  static __device__ __forceinline__ Units units(float x) { return __float2int_rn(x); }
  __device__ __forceinline__ float per_newton() const { return c.in_patches.per_newton; }

  /// Fetches the triangle and the present values of its corners, and at first those of the vertex.
  __device__ __forceinline__ physics::SurfaceTriangle<float> triangle(std::int32_t t)
  {
    at = c.triangles[t];
    fetch();
    return { { { 0, 0, 0 },
               Place{ at.side[0][0], at.side[0][1], at.side[0][2] } + (place(moved[1]) - place(moved[0])),
               Place{ at.side[1][0], at.side[1][1], at.side[1][2] } + (place(moved[2]) - place(moved[0])) },
             { place(turned[0]), place(turned[1]), place(turned[2]) } };
  }
  /// The vector from the triangle's first corner to the vertex.
  __device__ __forceinline__ Place apart(std::int32_t, std::int32_t) const
  {
    return place(vertex.rest) - Place{ at.x, at.y, at.z } + (place(moved[3]) - place(moved[0]));
  }
  __device__ __forceinline__ const TouchTriangle& record(std::int32_t) const { return at; }
  __device__ __forceinline__ const std::int32_t* corners(std::int32_t) const { return at.vertex; }
  __device__ __forceinline__ const std::int32_t* neighbours(std::int32_t) const { return at.neighbour; }
  __device__ __forceinline__ Place normal(std::int32_t) const { return place(turned[3]); }
  __device__ __forceinline__ Place change(int i, std::int32_t) const { return place(changed[i]); }
  /// All patches that have the pair decide alike whether it may reach a triangle.
  __device__ __forceinline__ bool placed(std::int32_t t) const
  {
    const Place here = place(c.vertices[began].rest);
    const float farthest = c.in_patches.slide * c.in_patches.slide;
    bool any = false;
    for (int i = 0; i < 3; ++i)
    {
      const Place way = place(c.vertices[c.triangles[t].vertex[i]].rest) - here;
      any = any || dot(way, way) < farthest;
    }
    return any;
  }
  __device__ __forceinline__ void fetch()
  {
    const std::uint16_t* const copies = c.in_patches.copy_of + std::size_t(touch.index) * c.vertex_count;
    const std::int32_t of[4] = { at.vertex[0], at.vertex[1], at.vertex[2], v };
    bool waits[4];
#pragma unroll
    for (int i = 0; i < 4; ++i)
    {
      waits[i] = false;
      if (i == 3 && fetched)
        continue;
      copy[i] = __ldg(copies + of[i]);
      waits[i] = copy[i] == no_touch_copy;
      const std::uint32_t from = waits[i] ? 0 : copy[i];
      moved[i] = own.moved[from];
      turned[i] = own.normal[from];
      if (rubs)
        changed[i] = own.change[from];
    }
    fetched = true;
    // All words are requested before the first of them is waited for. The threads of a warp leave the loop together,
    // because what follows would take longer if it were executed for some threads after the others.
    for (const std::uint32_t threads = __activemask();
         __any_sync(threads, waits[0] || waits[1] || waits[2] || waits[3]) != 0;)
    {
#pragma unroll
      for (int i = 0; i < 4; ++i)
        if (waits[i])
        {
          const float4* const from = c.in_patches.words[touch.buffer] + touch_words * of[i];
          moved[i] = look_at(from);
          turned[i] = look_at(from + 1);
          if (rubs)
            changed[i] = look_at(from + 2);
        }
#pragma unroll
      for (int i = 0; i < 4; ++i)
        waits[i] =
            waits[i] && (__float_as_uint(moved[i].w) != touch.mark || __float_as_uint(turned[i].w) != touch.mark ||
                         (rubs && __float_as_uint(changed[i].w) != touch.mark));
    }
  }

  const TissueContactArguments& c;
  const TouchStep& touch;
  const TouchMemory& own;
  const TouchVertex vertex;
  const std::int32_t v;
  std::int32_t began = -1;
  bool fetched = false;  ///< whether the vertex's values have been fetched
  TouchTriangle at{};
  // Of the triangle's corners and of the vertex: copy in the patch, displacement, normal, change of displacement.
  std::uint16_t copy[4]{};
  float4 moved[4]{}, turned[4]{}, changed[4]{};
};

__device__ __forceinline__ TouchPair touch_pair(const float4& a, const float4& b)
{
  return { __float_as_int(a.x), a.y, a.z, a.w, { b.x, b.y, b.z }, __float_as_int(b.w) };
}

__device__ __forceinline__ std::uint32_t touch_entry(const TissueContactArguments& c, const TouchStep& touch,
                                                     std::uint32_t place)
{
  const std::uint32_t at = place < touch.first_others ? place : c.vertex_count - 1 - (place - touch.first_others);
  return c.in_patches.lists[std::size_t(touch.index) * c.vertex_count + at];
}

/// Finds the forces of the pairs in the patch's list, and adds those on the patch's vertices to their sums.
template <bool rubs>
__device__ __forceinline__ void find_listed(const StepArguments& g, const TouchStep& touch, const TouchMemory& own)
{
  const TissueContactArguments& c = g.touch;
  const auto response = static_cast<float>(g.friction_response);
  for (std::uint32_t i = blockDim.x - 1 - threadIdx.x; i < touch.count; i += blockDim.x)
  {
    // Each thread keeps its first entries in shared memory.
    const bool kept = i < touch_ahead * own.room;
    const bool loads = !kept || touch.first;
    const std::uint32_t e = loads ? touch_entry(c, touch, i) : 0;
    const std::uint32_t code = loads ? c.in_patches.entry_vertex[e] : own.code[i];
    if (kept)
      own.code[i] = code;
    const auto shared_word = [&](int k, int half) -> float4&
    { return own.pairs[(2 * k + half) * touch_ahead * own.room + i]; };
    const bool keeps = (code & touch_mark) != 0;
    const auto v = static_cast<std::int32_t>(code & ~touch_mark);
    PatchTouchView<rubs> view{ c, touch, own, c.vertices[v], v };
    float stored = 0, lost = 0;
    std::int32_t first = -1;
#pragma unroll 1
    for (int k = 0; k < touch_search::most_pairs; ++k)
    {
      TouchPair pair = loads ? c.in_patches.entries[e].pair[k] : touch_pair(shared_word(k, 0), shared_word(k, 1));
      if (pair.triangle >= 0)
      {
        view.began = pair.began;
        const auto add = [&](int corner, std::int32_t, const std::int32_t(&force)[3], const Place* turn)
        {
          const std::uint32_t copy = view.copy[corner];
          if (copy == no_touch_copy)
            return;
          const auto add_to = [&](std::uint32_t component, std::int32_t units)
          { atomicAdd(own.sums + component * own.room + copy, units); };
#pragma unroll
          for (std::uint32_t axis = 0; axis < 3; ++axis)
            add_to(axis, force[axis]);
          if (turn == nullptr)
            return;
          add_to(3, view.units(turn->x));
          add_to(4, view.units(turn->y));
          add_to(5, view.units(turn->z));
        };
        touch_triangle<rubs>(view, v, pair, first, response, add, stored, lost);
        first = pair.triangle;
        if (pair.held > 0)
          *own.pushed = touch.mark;
      }
      if (kept)
      {
        shared_word(k, 0) = make_float4(__int_as_float(pair.triangle), pair.held, pair.pressed, pair.along);
        shared_word(k, 1) = make_float4(pair.stretch[0], pair.stretch[1], pair.stretch[2], __int_as_float(pair.began));
      }
      if (!kept || touch.last)
        c.in_patches.entries[touch_entry(c, touch, i)].pair[k] = pair;
      if (touch.last && keeps)
        c.pairs[2 * v + k] = pair;
    }
    if (rubs && lost != 0 && keeps)
      c.lost[v] += double(lost);
  }
}

__device__ __forceinline__ void find_touch(const StepArguments& g, const TouchStep& touch, const PatchMemory& memory)
{
  if (touch.count == 0)
    return;
  const TouchMemory own = touch_memory(memory, touch.room);
  if (g.touch.rubs)
    find_listed<true>(g, touch, own);
  else
    find_listed<false>(g, touch, own);
}

/// Adds the forces on the patch's vertices to those on the corners of their voxels. At first each thread processes a
/// vertex, then a corner of a voxel. Ends with a barrier.
__device__ __forceinline__ void add_forces(const TissueContactArguments& c, const TouchStep& touch,
                                           const PatchMemory& memory, const TouchMemory& own)
{
  const float unit = 1 / c.in_patches.per_newton;
  for (std::uint32_t i = threadIdx.x; i < touch.patch.vertices; i += blockDim.x)
  {
    const std::uint32_t v = __ldg(c.in_patches.vertex_of + touch.patch.vertex_begin + i) & ~touch_mark;
    const float4 at = __ldg(c.bound.coordinates + v);
    float sum[touch_components];
#pragma unroll
    for (std::uint32_t component = 0; component < touch_components; ++component)
    {
      std::int32_t& units = own.sums[component * own.room + i];
      sum[component] = static_cast<float>(units);
      units = 0;
    }
    const Place force = unit * Place{ sum[0], sum[1], sum[2] };
    const Place along = normal_push(c, c.vertices[v], (c.edge * unit) * Place{ sum[3], sum[4], sum[5] }, own.dual[0][i],
                                    own.dual[1][i]);
    // From here on, the words of the dual vectors have the forces, and the last components the place in the voxel.
    own.dual[0][i] = make_float4(force.x, force.y, force.z, at.x);
    own.dual[1][i] = make_float4(along.x, along.y, along.z, at.y);
    own.normal[i].w = at.z;
  }
  __syncthreads();
  for (std::uint32_t i = threadIdx.x; i < 8 * touch.patch.voxels; i += blockDim.x)
  {
    const BoundVoxel voxel = c.in_patches.voxels[touch.patch.voxel_begin + i / 8];
    const std::uint32_t b = i % 8;
    Place force{ 0, 0, 0 };
    for (std::uint32_t p = voxel.first; p < voxel.end; ++p)
    {
      const float4 on = own.dual[0][p], along = own.dual[1][p], normal = own.normal[p];
      force = force + physics::surface_node_force(physics::SideWeights<float>(on.w, along.w, normal.w),
                                                  static_cast<int>(b), place(on), place(along), place(normal));
    }
    float* const to = memory.force + 3 * b * memory.width + voxel.column;
    // Internal forces have the opposite sign.
    to[0] -= force.x;
    to[memory.width] -= force.y;
    to[2 * memory.width] -= force.z;
  }
  __syncthreads();
}

/// Adds the forces of find_touch(), and tells other patches that this one has ended the step.
__device__ __forceinline__ void add_touch(const StepArguments& g, const TouchStep& touch, const PatchMemory& memory)
{
  if (touch.count == 0)
    return;
  const TissueContactArguments& c = g.touch;
  const TouchMemory own = touch_memory(memory, touch.room);
  if (*own.pushed == touch.mark)
    add_forces(c, touch, memory, own);
  if (threadIdx.x == 0 && !touch.last)
  {
    const float nothing[3] = { 0, 0, 0 };
    send(c.in_patches.ended[1 - touch.buffer] + touch.index, nothing, 0x80000000u | (touch.mark + 1));
  }
}

}  // namespace cuda
}  // namespace frontalis
