#include "solver/energy/voxel_monitor.hpp"

#include "frontalis/physics/element/voxel_readings.hpp"
#include "solver/energy/plane_monitor.hpp"
#include "solver/model_voxel.hpp"
#include "solver/stepping/step_bound.hpp"

#include <cmath>

namespace frontalis
{

Monitor monitor_of(const PlaneMonitor& sum, double frequency_squared, std::int32_t stiffest_voxel)
{
  Monitor result;
  result.kinetic = sum.kinetic;
  result.internal = sum.internal;
  result.hourglass = sum.hourglass;
  result.worst_jacobian = sum.worst_jacobian;
  result.worst_voxel = sum.worst_voxel;
  result.inverted = sum.inverted;
  result.critical_time_step = 2 / std::sqrt(frequency_squared);
  result.stiffest_voxel = stiffest_voxel;
  result.finite = std::isfinite(sum.kinetic) && std::isfinite(sum.internal) && std::isfinite(sum.hourglass);
  return result;
}

Monitor monitor_voxels(const Model& model, const Discretisation& d, const std::vector<std::array<double, 3>>& u,
                       const std::vector<std::array<double, 3>>& v, const std::vector<float>& mobility)
{
  const auto& h = model.spacing;
  const std::array<double, 3> scale{ { 0.25 / h[0], 0.25 / h[1], 0.25 / h[2] } };
  std::vector<double> stiffness(model.voxels.size(), 0);
  PlaneMonitor sum;
  for (std::size_t n = 0; n < v.size(); ++n)
    sum.kinetic += 0.5 * d.node_mass[n] * (v[n][0] * v[n][0] + v[n][1] * v[n][1] + v[n][2] * v[n][2]);
  VoxelProperties voxel;
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    d.voxel(e, voxel);
    double mode[3][8];
    for (int axis = 0; axis < 3; ++axis)
    {
      for (int b = 0; b < 8; ++b)
        mode[axis][b] = u[model.voxel_nodes[e][b]][axis];
      physics::walsh_hadamard(mode[axis]);
      physics::to_tissue_centre(voxel.centre, mode[axis]);
    }
    const auto readings = physics::voxel_readings(ModelVoxel{ model, d, voxel, e, nullptr, {}, scale }, mode);
    stiffness[e] = readings.stiffness;
    sum.add(PlaneMonitor::of_voxel(readings, static_cast<std::int32_t>(e)));
  }
  const StepBound bound = step_bound(d, model, stiffness, mobility);
  return monitor_of(sum, bound.frequency_squared, stiffest_voxel_at(model, bound.node, stiffness.data()));
}

}  // namespace frontalis
