#include "solver/cpu/cpu_solver.hpp"
#include "solver/cpu/flush_denormals.hpp"
#include "solver/energy/plane_monitor.hpp"
#include "solver/stepping/step_bound.hpp"

#include <algorithm>

namespace frontalis
{

// Computes the monitor and, if `found` is not 0, what measure_growth() does with it. Each thread processes its slab;
// the sums of the planes are then added in order.
template <class Real>
Monitor CpuSolver<Real>::examine(double found, bool keeps)
{
  const Arguments from = arguments(0, nullptr);
  CpuKernelArguments<double> g{};
  for (int axis = 0; axis < 3; ++axis)
  {
    wide_[axis].resize(u_[axis].size());
    g.u[axis] = wide_[axis].data();
    g.scale[axis] = 0.25 / model_->spacing[axis];
    g.stretch_weight[axis] = discretisation_.stretch_weight[axis];
    g.hourglass_weight[axis] = discretisation_.hourglass_weight[axis];
  }
  g.stretch_half_sum = discretisation_.stretch_half_sum;
  g.tiles = from.tiles;
  g.plane_tiles = from.plane_tiles;
  g.plane_nodes = from.plane_nodes;
  g.planes = from.planes;
  g.stiffness = from.stiffness;
  g.stabilisation = from.stabilisation;
  g.selective_reduced = from.selective_reduced;
  g.laws = from.laws;
  g.cut = from.cut;
  std::vector<PlaneMonitor> planes(static_cast<std::size_t>(rows_.planes));
  std::vector<StepBound> bounds(slab_.size() - 1);
  std::vector<double> stiffness(model_->voxels.size());
  const auto first_voxel = [&](std::int32_t k) { return rows_.plane_voxels[std::clamp(k, 0, rows_.planes)]; };
  team_.run(
      [&](int t)
      {
        const FlushDenormals flush;
        for (std::int32_t k = slab_[t]; k < slab_[t + 1]; ++k)
          for (int axis = 0; axis < 3; ++axis)
          {
            double kinetic = 0;
            for (auto n = rows_.plane_nodes[k]; n < rows_.plane_nodes[k + 1]; ++n)
            {
              wide_[axis][n] = double(u_[axis][n]);
              kinetic += discretisation_.node_mass[n] * double(v_[axis][n]) * double(v_[axis][n]);
            }
            planes[k].kinetic += 0.5 * kinetic;
          }
        team_.barrier();
        const std::int32_t first = slab_[t], last = slab_[t + 1];
        choice_.monitor(g, first, std::min(last, rows_.planes - 1), planes.data(), stiffness.data());
        team_.barrier();
        // The displacements in wide_ are no longer needed, so that its memory can be used for the sums.
        const IndexRange nodes{ rows_.plane_nodes[first], rows_.plane_nodes[last] };
        bounds[t] = bound_of_nodes(discretisation_, *model_, stiffness.data(),
                                   { first_voxel(first - 1), first_voxel(last) }, nodes, mobility_, wide_[0].data());
        if (found > 0)
          limit_mobility(discretisation_, nodes, wide_[0].data(), found, keeps, mobility_);
      });
  PlaneMonitor sum;
  for (const PlaneMonitor& plane : planes)
    sum.add(plane);
  StepBound bound;
  for (const StepBound& part : bounds)
    bound.add(part);
  return monitor_of(sum, bound.frequency_squared, stiffest_voxel_at(*model_, bound.node, stiffness.data()));
}

template Monitor CpuSolver<float>::examine(double found, bool keeps);
template Monitor CpuSolver<double>::examine(double found, bool keeps);

}  // namespace frontalis
