#include "cpu_solver.hpp"
#include "flush_denormals.hpp"
#include "plane_monitor.hpp"

#include <algorithm>

namespace frontalis
{

// threads take their slabs, planes are added up in their order
template <class Real>
Monitor CpuSolver<Real>::measure()
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
  g.tiles = from.tiles;
  g.plane_tiles = from.plane_tiles;
  g.plane_nodes = from.plane_nodes;
  g.planes = from.planes;
  g.stiffness = from.stiffness;
  g.stabilisation = from.stabilisation;
  g.selective_reduced = from.selective_reduced;
  g.laws = from.laws;
  std::vector<PlaneMonitor> planes(static_cast<std::size_t>(rows_.planes));
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
        choice_.monitor(g, slab_[t], std::min(slab_[t + 1], rows_.planes - 1), planes.data());
      });
  PlaneMonitor sum;
  for (const PlaneMonitor& plane : planes)
    sum.add(plane);
  return monitor_of(sum);
}

template Monitor CpuSolver<float>::measure();
template Monitor CpuSolver<double>::measure();

}  // namespace frontalis
