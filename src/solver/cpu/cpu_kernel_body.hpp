#pragma once

#include "solver/cpu/cpu_element.hpp"

namespace frontalis
{

/// Steps a slab plane by plane. When a plane of voxels has added its forces, those on its lower plane of nodes are
/// complete, and these nodes move.
template <class Architecture, class Real>
struct CpuKernelBody
{
  using Element = CpuElement<Architecture, Real>;
  using Arguments = CpuKernelArguments<Real>;
  using Batch = typename Element::Batch;
  using Voxels = typename Element::Voxels;
  static constexpr int lanes = Element::lanes;

  template <Stabilisation Form>
  static void plane_forces(const Arguments& g, std::int32_t plane, Real* below, Real* above, bool owned,
                           bool with_bound)
  {
    double work = 0;
    const std::int32_t base[2] = { g.plane_nodes[plane], g.plane_nodes[plane + 1] };
    using Batches = typename Element::template VoxelsOf<Form>;
    using Simple = typename Element::template SimpleVoxels<Form, false>;
    const auto add = [&](const Batches& at)
    {
      if (Simple::are(at))
        Element::template add_forces<Form, false>(Simple{ at }, below, above, base);
      else if (Element::template SimpleVoxels<Form, true>::are(at))
        Element::template add_simple_forces_and_bounds<Form>(at, below, above, base);
      else if (at.tile->cut >= 0)
        Element::template add_cut_forces<Form>(at, below, above, base);
      else
        Element::template add_other_forces<Form>(at, below, above, base);
    };
    Element::template each_batch<Batches>(g, plane, owned, with_bound, &work, add);
    if (g.muscle_work != nullptr && owned)
      g.muscle_work[plane] += work;
  }

  /// Bound of the squared highest frequency at the nodes of a plane. `stiffness`: sum of the bounds of the voxels at
  /// each node.
  static Real plane_frequency(const Arguments& g, std::int32_t plane, const Real* stiffness)
  {
    const std::int32_t first = g.plane_nodes[plane], count = g.plane_nodes[plane + 1] - first;
    const float* const mobility = g.mobility + first;
    using N = typename Element::N;
    // Maxima ignore NaN. `odd` becomes NaN if a stiffness is NaN.
    Batch most(Real(0)), odd(Real(0));
    const auto take = [&](const Batch& squared)
    {
      most = N::max(most, squared);
      odd = odd + (squared - squared);
    };
    std::int32_t n = 0;
    for (; n + lanes <= count; n += lanes)
      take(Element::Lane::load(stiffness + n) * Element::Lane::load(mobility + n));
    for (; n < count; ++n)
      take(Batch(stiffness[n] * static_cast<Real>(mobility[n])));
    alignas(64) Real lane_values[lanes];
    (most + odd).store_aligned(lane_values);
    Real result = 0;
    for (const Real value : lane_values)
      result = physics::larger_or_none(result, value);
    return result;
  }

  template <bool Compensated>
  static void update(const Arguments& g, std::int32_t plane, const Real* force)
  {
    const std::int32_t first = g.plane_nodes[plane], count = g.plane_nodes[plane + 1] - first;
    const physics::Kick<Real> kick = g;
    for (int c = 0; c < 3; ++c)
    {
      const Real* f = force + c * g.buffer_stride;
      const Real* u = g.u[c] + first;
      const float* inverse_mass = g.inverse_mass + first;
      Real* __restrict v = g.v[c] + first;
      Real* __restrict next = g.next[c] + first;
      Real* __restrict rounding = Compensated ? g.rounding[c] + first : nullptr;
      for (std::int32_t n = 0; n < count; ++n)
      {
        const Real velocity = physics::kicked(kick, c, v[n], kick.gain * inverse_mass[n], f[n]);
        v[n] = velocity;
        if (Compensated)
        {
          // Kahan summation: the rounding error of the previous sum is subtracted first.
          const Real step = g.dt * velocity - rounding[n];
          const Real sum = u[n] + step;
          rounding[n] = (sum - u[n]) - step;
          next[n] = sum;
        }
        else
          next[n] = u[n] + g.dt * velocity;
      }
    }
  }

  static void clear(Real* p, std::int32_t count)
  {
    for (std::int32_t i = 0; i < count; ++i)
      p[i] = 0;
  }

  template <Stabilisation Form>
  static Real sweep_planes(const Arguments& g, std::int32_t first, std::int32_t last, Real* buffer, KernelTask task)
  {
    Real* below = buffer;
    Real* above = buffer + 4 * static_cast<std::size_t>(g.buffer_stride);
    const bool with_bound = task == KernelTask::step_and_bound;
    const auto clear_plane = [&](Real* plane, std::int32_t k)
    {
      const std::int32_t count = k < 0 ? 0 : g.plane_nodes[k + 1] - g.plane_nodes[k] + 2 * Tile::width;
      for (int c = 0; c < (with_bound ? 4 : 3); ++c)
        clear(plane + c * g.buffer_stride, count);
    };
    clear_plane(below, first - 1);
    Real frequency_squared = 0;
    // Voxel plane k lies between node planes k and k + 1. The lowest voxel plane is computed for its upper nodes only.
    for (std::int32_t k = first - 1; k < last; ++k)
    {
      clear_plane(above, k + 1 < g.planes ? k + 1 : -1);
      if (k >= 0 && k < g.planes - 1)
        plane_forces<Form>(g, k, below, above, k >= first, with_bound);
      if (k >= first)
      {
        if (with_bound)
          frequency_squared =
              physics::larger_or_none(frequency_squared, plane_frequency(g, k, below + 3 * g.buffer_stride));
        if (task == KernelTask::forces)
          for (int c = 0; c < 3; ++c)
            for (std::int32_t n = g.plane_nodes[k]; n < g.plane_nodes[k + 1]; ++n)
              g.next[c][n] = below[c * g.buffer_stride + n - g.plane_nodes[k]];
        else if (g.rounding[0] != nullptr)
          update<true>(g, k, below);
        else
          update<false>(g, k, below);
      }
      Real* const swapped = below;
      below = above;
      above = swapped;
    }
    return frequency_squared;
  }

  static void relax(const Arguments& g, std::int32_t first, std::int32_t last)
  {
    for (std::int32_t k = first; k < last && k < g.planes - 1; ++k)
    {
      double* const work = g.viscous_work == nullptr ? nullptr : g.viscous_work + 2 * static_cast<std::size_t>(k);
      if (work != nullptr)
        work[1] = 0;
      Element::each_batch(g, k, true, false, nullptr,
                          [&](const Voxels& at)
                          {
                            if (at.tile->viscous >= 0)
                              Element::relax(at, work);
                          });
    }
  }

  static Real run(const Arguments& g, std::int32_t first, std::int32_t last, Real* buffer, KernelTask task)
  {
    if (task == KernelTask::relax)
    {
      relax(g, first, last);
      return 0;
    }
    if (g.selective_reduced)
      return sweep_planes<Stabilisation::selective_reduced>(g, first, last, buffer, task);
    if (g.stabilisation != nullptr)
      return sweep_planes<Stabilisation::assumed_strain>(g, first, last, buffer, task);
    return sweep_planes<Stabilisation::scalar>(g, first, last, buffer, task);
  }
};

}  // namespace frontalis
