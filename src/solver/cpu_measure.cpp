#include "cpu_solver.hpp"
#include "flush_denormals.hpp"
#include "plane_monitor.hpp"
#include "step_bound.hpp"

#include <algorithm>

namespace frontalis
{

template <class Real>
CpuKernelArguments<double> CpuSolver<Real>::monitor_arguments()
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
  return g;
}

// of the threads
template <class Real>
std::vector<ModelPart> CpuSolver<Real>::parts() const
{
  // of voxel plane k; there is none above the last plane of nodes
  const auto first_voxel = [&](std::int32_t k)
  {
    const auto tile = rows_.plane_tiles[std::clamp(k, 0, rows_.planes - 1)];
    return static_cast<std::size_t>(tile) < rows_.tiles.size() ? rows_.tiles[tile].first_voxel[0]
                                                               : static_cast<std::int32_t>(model_->voxels.size());
  };
  std::vector<ModelPart> parts;
  for (std::size_t t = 0; t + 1 < slab_.size(); ++t)
  {
    const std::int32_t first = slab_[t], last = slab_[t + 1];
    parts.push_back({ { rows_.plane_nodes[first], rows_.plane_nodes[last] },
                      { first_voxel(first - 1), first_voxel(last) },
                      { first_voxel(first), first_voxel(last) } });
  }
  return parts;
}

// Threads take their slabs, planes are added up in their order. Displacements go to where the monitor reads them.
template <class Real>
std::vector<PlaneMonitor> CpuSolver<Real>::look(std::vector<double>& stiffness)
{
  const CpuKernelArguments<double> g = monitor_arguments();
  std::vector<PlaneMonitor> planes(static_cast<std::size_t>(rows_.planes));
  stiffness.resize(model_->voxels.size());
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
        choice_.monitor(g, slab_[t], std::min(slab_[t + 1], rows_.planes - 1), planes.data(), stiffness.data());
      });
  return planes;
}

template <class Real>
Monitor CpuSolver<Real>::measure()
{
  std::vector<double> stiffness;
  PlaneMonitor sum;
  for (const PlaneMonitor& plane : look(stiffness))
    sum.add(plane);
  const std::vector<ModelPart> parts = this->parts();
  std::vector<StepBound> bounds(parts.size());
  // displacements have been read: their place takes the nodes' bounds
  team_.run(
      [&](int t) {
        bounds[t] = bound_of_nodes(discretisation_, *model_, stiffness.data(), weights(), parts[t], wide_[0].data());
      });
  StepBound bound;
  for (const StepBound& part : bounds)
    bound.add(part);
  return monitor_of(sum, bound.frequency_squared, stiffest_voxel_at(*model_, bound.node, stiffness.data()));
}

// what sleeps is not looked at: it must not have weights that change
template <class Real>
double CpuSolver<Real>::find_weights(NodeWeights& weights)
{
  if (sleep_)
    return 0;
  std::vector<double> stiffness;
  look(stiffness);
  return frontalis::find_weights(discretisation_, *model_, stiffness, parts(), team_, weights);
}

template <class Real>
void CpuSolver<Real>::weights_changed()
{
  const NodeWeights& weights = this->weights();
  weighted_mobility_.clear();
  share_.clear();
  if (weights.of_node.empty())
    return;
  const std::vector<float>& mobility = mobility_.empty() ? inverse_mass_ : mobility_;
  for (std::size_t n = 0; n < weights.of_node.size(); ++n)
    weighted_mobility_.push_back(mobility[n] / weights.of_node[n]);
  share_.resize(rows_.tiles.size() * Tile::width, 0);
  for (std::size_t t = 0; t < rows_.tiles.size(); ++t)
    for (int lane = 0; lane < Tile::width; ++lane)
      if (const auto e = rows_.tiles[t].voxel(lane); e >= 0)
        share_[t * Tile::width + static_cast<std::size_t>(lane)] = weights.share[e];
}

template Monitor CpuSolver<float>::measure();
template Monitor CpuSolver<double>::measure();
template double CpuSolver<float>::find_weights(NodeWeights&);
template double CpuSolver<double>::find_weights(NodeWeights&);
template void CpuSolver<float>::weights_changed();
template void CpuSolver<double>::weights_changed();

}  // namespace frontalis
