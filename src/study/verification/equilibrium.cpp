#include "frontalis/study/equilibrium.hpp"

#include "frontalis/error.hpp"
#include "frontalis/solver/guard.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace frontalis
{

RestState find_equilibrium(Model model, const EquilibriumSettings& settings)
{
  const double pi = std::acos(-1.0);
  model.damping = 4 * pi / settings.period;
  for (auto& load : model.loads)
    load.ramp = settings.ramp * settings.period;
  RestState result;
  // with few voxels threads would wait for each other longer than they work
  const int threads = model.voxels.size() < 2000 ? 1 : 0;
  const auto shared = std::make_shared<const Model>(std::move(model));
  result.solver = make_solver(shared, { settings.backend, threads, 0 });
  Controls target = result.solver->controls();
  std::fill(target.activation.begin(), target.activation.end(), settings.activation);
  std::fill(target.bone.begin(), target.bone.end(), settings.bone_pose);
  Guard guard(*result.solver, shared);
  guard.advance(settings.ramp * settings.period, target);
  const Equilibrium end = guard.settle(target, settings.tolerance, settings.longest * settings.period);
  if (!end.reached)
    throw Error(fmt::format("no equilibrium within {:g} periods of {:g} s: {:.3g} of the displacement is left",
                            settings.longest, settings.period, end.residual));
  result.solver->displacements(result.displacements);
  return result;
}

std::array<double, 3> mean_displacement(const Vectors& displacements, const std::vector<std::int32_t>& nodes)
{
  std::array<double, 3> mean{};
  for (const auto node : nodes)
    for (std::size_t axis = 0; axis < 3; ++axis)
      mean[axis] += displacements[node][axis] / static_cast<double>(nodes.size());
  return mean;
}

std::array<double, 3> internal_force(Solver& solver, const std::vector<std::int32_t>& nodes)
{
  Vectors forces;
  solver.internal_forces(forces);
  std::array<double, 3> sum{};
  for (const auto node : nodes)
    for (std::size_t axis = 0; axis < 3; ++axis)
      sum[axis] += forces[node][axis];
  return sum;
}

}  // namespace frontalis
