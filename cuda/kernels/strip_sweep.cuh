#pragma once

#include "cuda/kernels/cut_voxel.cuh"
#include "cuda/kernels/element_stress.cuh"
#include "cuda/kernels/kernel_before.cuh"
#include "cuda/kernels/node_tasks.cuh"

namespace frontalis
{
namespace cuda
{

/// A row of nodes after the x step of the Walsh-Hadamard transform: sum and difference with the neighbour in x.
struct RowValues
{
  float sum[3];
  float difference[3];
};

/// The displacement of a node. The fourth number of the float4 is not loaded, because the compiler would reuse its
/// unread register at once, and the next instruction would have to wait for the load.
struct Displacement
{
  float2 xy;
  float z;
};

__device__ __forceinline__ Displacement displacement(const float4* u, const uint2& place)
{
  const float* const at = reinterpret_cast<const float*>(u + (place.x & StripSlot::node_mask));
  return { *reinterpret_cast<const float2*>(at), at[2] };
}

__device__ __forceinline__ RowValues transform_x(const Displacement& u)
{
  const float here[3] = { u.xy.x, u.xy.y, u.z };
  RowValues row;
#pragma unroll
  for (int c = 0; c < 3; ++c)
  {
    const float next = __shfl_down_sync(whole_warp, here[c], 1);
    row.sum[c] = here[c] + next;
    row.difference[c] = next - here[c];
  }
  return row;
}

/// Forces on a row of nodes before the transposed x step of the Walsh-Hadamard transform: [component][sum, difference].
struct RowForces
{
  float part[3][2];
};

__device__ __forceinline__ RowForces no_forces() { return { { { 0, 0 }, { 0, 0 }, { 0, 0 } } }; }

__device__ __forceinline__ void add(RowForces& to, const RowForces& from)
{
#pragma unroll
  for (int c = 0; c < 3; ++c)
  {
    to.part[c][0] += from.part[c][0];
    to.part[c][1] += from.part[c][1];
  }
}

/// A voxel of a strip. With Effects::added, the stress of its fibres and of its laws other than neo-Hookean was
/// computed before the step.
template <Effects With>
struct StripVoxel : ElementVoxel<With>
{
  using Kinematics = physics::Kinematics<float>;
  using Stress = physics::Matrix3<float>;
  const AddedStress& added;

  __device__ __forceinline__ bool has_laws() const { return has<With, Effects::added>; }
  __device__ __forceinline__ void add_laws(const Kinematics&, Stress&) const {}
  __device__ __forceinline__ void add_fibres(const Kinematics& k, Stress& P) const
  {
    if constexpr (has<With, Effects::added>)
    {
      const float of[9] = { added.xx_to_yx.x, added.xx_to_yx.y, added.xx_to_yx.z, added.xx_to_yx.w, added.yy_to_zy.x,
                            added.yy_to_zy.y, added.yy_to_zy.z, added.yy_to_zy.w, added.zz };
#pragma unroll
      for (int n = 0; n < 9; ++n)
        P.a[n / 3][n % 3] += of[n];
    }
    else
      ElementVoxel<With>::add_fibres(k, P);
  }
  __device__ __forceinline__ float law_stiffening(const Kinematics&) const { return added.stiffening; }
  __device__ __forceinline__ float stiffness_now(const Kinematics& k) const { return physics::stiffness_now(*this, k); }
};

/// What a voxel with this palette entry adds to the neo-Hookean stress. The entries after entry 0 begin with those of
/// the added voxels.
template <Effects With>
__device__ __forceinline__ AddedStress fetch_added(const StepArguments& g, std::uint32_t palette)
{
  AddedStress added{};
  if (has<With, Effects::added> && palette - 1 < g.added_count)
  {
    const float4* const from = reinterpret_cast<const float4*>(g.added_stress + (palette - 1));
    // not __ldg(): the kernel before may still write them when this one starts
    const float4 last = from[2];
    added = { from[0], from[1], last.x, last.y };
  }
  return added;
}

/// Forces of the voxel between rows a and b of the lower and upper planes of nodes: the y and z steps of the transform,
/// the forces on the modes, and the transposed z and y steps.
template <Effects With>
__device__ __forceinline__ void voxel_forces(const StepArguments& g, const ElementPlace& place,
                                             const Activations& activation, const AddedStress& added,
                                             const RowValues& below_a, const RowValues& below_b,
                                             const RowValues& above_a, const RowValues& above_b, bool with_bound,
                                             float& stiffness, RowForces force[2][2])
{
  float mode[3][8];
#pragma unroll
  for (int c = 0; c < 3; ++c)
  {
    const float low[4] = { below_a.sum[c] + below_b.sum[c], below_a.difference[c] + below_b.difference[c],
                           below_b.sum[c] - below_a.sum[c], below_b.difference[c] - below_a.difference[c] };
    const float high[4] = { above_a.sum[c] + above_b.sum[c], above_a.difference[c] + above_b.difference[c],
                            above_b.sum[c] - above_a.sum[c], above_b.difference[c] - above_a.difference[c] };
#pragma unroll
    for (int q = 0; q < 4; ++q)
    {
      mode[c][q] = low[q] + high[q];
      mode[c][q + 4] = high[q] - low[q];
    }
  }
  const StripVoxel<With> voxel{ element_voxel<With>(g, place, activation, 0), added };
  if constexpr (has<With, Effects::cut>)
  {
    const physics::TissueCentre<float> centre = tissue_centre(g, place.palette);
#pragma unroll
    for (int c = 0; c < 3; ++c)
      physics::to_tissue_centre(centre, mode[c]);
    element_forces(voxel, mode, with_bound, stiffness);
#pragma unroll
    for (int c = 0; c < 3; ++c)
      physics::from_tissue_centre(centre, mode[c]);
  }
  else
    element_forces(voxel, mode, with_bound, stiffness);
#pragma unroll
  for (int c = 0; c < 3; ++c)
#pragma unroll
    for (int x = 0; x < 2; ++x)
    {
      const float without_y = mode[c][x], with_y = mode[c][x + 2];
      const float below0 = without_y - mode[c][x + 4], below1 = with_y - mode[c][x + 6];
      const float above0 = without_y + mode[c][x + 4], above1 = with_y + mode[c][x + 6];
      force[0][0].part[c][x] = below0 - below1;
      force[0][1].part[c][x] = below0 + below1;
      force[1][0].part[c][x] = above0 - above1;
      force[1][1].part[c][x] = above0 + above1;
    }
}

/// Transposed x step of the Walsh-Hadamard transform: the forces on the nodes of a row.
__device__ __forceinline__ void transform_x_transposed(const RowForces& row, int left, float (&force)[3])
{
#pragma unroll
  for (int c = 0; c < 3; ++c)
  {
    // The first lane gets the value of the last lane, which is 0 because that lane never has a voxel.
    const float from_left = __shfl_sync(whole_warp, row.part[c][0] + row.part[c][1], left);
    force[c] = row.part[c][0] - row.part[c][1] + from_left;
  }
}

/// Applies the transposed x step of the transform, then updates the node or stores its force.
__device__ __forceinline__ void step_node(const StepArguments& g, float4* next, std::uint32_t word, int left,
                                          const NodeFetch& fetch, const RowForces& row)
{
  float force[3];
  transform_x_transposed(row, left, force);
  const std::uint32_t node = word & StripSlot::node_mask;
  if (g.forces_only)
  {
    if (word & StripSlot::owned)
      next[node] = make_float4(force[0], force[1], force[2], 0);
  }
  else if (word & StripSlot::updated)
  {
    const NodeState n = updated(g, node, fetch, force);
#pragma unroll
    for (int i = 0; i < 3; ++i)
      g.v[i][node] = n.v[i];
    next[node] = make_float4(n.u[0], n.u[1], n.u[2], fetch.own.w);
  }
}

/// Walks through a strip along z. The force on a node is summed in a fixed order: voxels below the node before those
/// above, rows in order, right before left. No other strip adds to this force, because voxels on the border are
/// computed by the strips on both sides. To hide memory latency, slots are loaded two planes ahead, displacements and
/// fibre words one row ahead; loads beyond the end of a strip read slots of the next strip, or padding. slot,
/// fibre_word, viscous_word: those of this lane; null if the strip has none.
template <int Rows, Effects With>
__device__ __forceinline__ void sweep_strip(const StepArguments& g, const Strip& strip, const uint2* slot,
                                            const std::uint32_t* fibre_word, const std::uint32_t* viscous_word,
                                            const float4* u, float4* next, const Activations& activation,
                                            bool with_bound, std::uint32_t& frequency_bits)
{
  constexpr int nodes = Rows + 2;
  const int lane = threadIdx.x & 31;
  const int left = (lane + 31) & 31;
  RowValues below[nodes];
  RowForces carried[Rows];
  float carried_stiffness[Rows] = {};
  CornerBounds<Rows> corner_bounds{};
  uint2 here[nodes], above_slot[nodes];
#pragma unroll
  for (int r = 0; r < nodes; ++r)
    here[r] = slot[r * 32];
  slot += nodes * 32;
#pragma unroll
  for (int r = 0; r < nodes; ++r)
    above_slot[r] = slot[r * 32];
  wait_for_kernel_before();
  {
    Displacement raw[nodes];
#pragma unroll
    for (int r = 0; r < nodes; ++r)
      raw[r] = displacement(u, here[r]);
#pragma unroll
    for (int r = 0; r < nodes; ++r)
      below[r] = transform_x(raw[r]);
  }
#pragma unroll
  for (int r = 0; r < Rows; ++r)
    carried[r] = no_forces();
  ElementPlace place{};
  std::uint32_t next_word = has<With, Effects::fibres> && fibre_word != nullptr ? *fibre_word : 0;
  Displacement raw_a = displacement(u, above_slot[0]), raw_b = displacement(u, above_slot[1]);
  for (std::uint32_t plane = 0; plane < strip.planes; ++plane)
  {
    slot += nodes * 32;
    uint2 further[nodes];
#pragma unroll
    for (int r = 0; r < nodes; ++r)
      further[r] = slot[r * 32];
    RowForces pending_below = no_forces(), pending_above = no_forces();
    float pending_stiffness = 0;
    corner_bounds.begin_plane();
    RowValues above_a = transform_x(raw_a);
#pragma unroll
    for (int r = 0; r <= Rows; ++r)
    {
      // The load is issued before the data are needed, because the warp would otherwise wait for them.
      const AddedStress added = fetch_added<With>(g, here[r].y);
      const RowValues above_b = transform_x(raw_b);
      if (r + 2 < nodes)
        raw_b = displacement(u, above_slot[r + 2]);
      else
      {
        raw_a = displacement(u, further[0]);
        raw_b = displacement(u, further[1]);
      }
      if (has<With, Effects::fibres> && fibre_word != nullptr)
      {
        fetch_fibre(g, next_word, place);
        fibre_word += 32;
        next_word = *fibre_word;
      }
      if (has<With, Effects::viscosity> && viscous_word != nullptr)
        place.viscous = viscous_word[(plane * nodes + r) * 32];
      NodeFetch fetch{};
      if (r > 0)
        fetch = fetch_node(g, u, here[r].x);
      RowForces force[2][2] = { { no_forces(), no_forces() }, { no_forces(), no_forces() } };
      float stiffness = 0;
      if (__any_sync(whole_warp, here[r].y != 0))
      {
        place.palette = here[r].y;
        voxel_forces<With>(g, place, activation, added, below[r], below[r + 1], above_a, above_b, with_bound, stiffness,
                           force);
      }
      if constexpr (has<With, Effects::cut>)
      {
        if (with_bound)
        {
          const float sum = corner_bounds.add(g, here[r].y, stiffness, r, left);
          if (r > 0 && (here[r].x & StripSlot::updated) != 0)
            frequency_bits =
                max(frequency_bits, frequency_bits_of(g, here[r].x & StripSlot::node_mask, fetch.own.w, sum));
        }
      }
      // A whole voxel adds the same stiffness to each of its nodes.
      else if (with_bound && r > 0)
      {
        const float pair = pending_stiffness + stiffness, right = carried_stiffness[r - 1] + pair;
        const float sum = right + __shfl_sync(whole_warp, right, left);
        if ((here[r].x & StripSlot::updated) != 0)
          frequency_bits =
              max(frequency_bits, frequency_bits_of(g, here[r].x & StripSlot::node_mask, fetch.own.w, sum));
        carried_stiffness[r - 1] = pair;
      }
      pending_stiffness = stiffness;
      if (r > 0)
      {
        RowForces sum = carried[r - 1];
        add(sum, pending_below);
        add(sum, force[0][0]);
        step_node(g, next, here[r].x, left, fetch, sum);
        carried[r - 1] = pending_above;
        add(carried[r - 1], force[1][0]);
      }
      pending_below = force[0][1];
      pending_above = force[1][1];
      below[r] = above_a;
      above_a = above_b;
    }
    below[nodes - 1] = above_a;
#pragma unroll
    for (int r = 0; r < nodes; ++r)
    {
      here[r] = above_slot[r];
      above_slot[r] = further[r];
    }
  }
}

}  // namespace cuda
}  // namespace frontalis
