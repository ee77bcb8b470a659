#include "frontalis/study/equilibrium.hpp"

#include "frontalis/error.hpp"

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
  result.solver = make_solver(std::make_shared<const Model>(std::move(model)), { settings.backend, 0, 0 });
  Controls target = result.solver->controls();
  std::fill(target.activation.begin(), target.activation.end(), settings.activation);
  std::fill(target.bone.begin(), target.bone.end(), settings.bone_pose);
  result.solver->advance(settings.ramp * settings.period, target);
  result.periods = settings.ramp;
  result.solver->displacements(result.displacements);
  for (int quiet = 0; quiet < 2;)
  {
    if (result.periods > settings.longest)
      throw Error("no equilibrium within " + std::to_string(settings.longest) + " periods of " +
                  std::to_string(settings.period) + " s");
    result.solver->advance(settings.period / 4, target);
    result.periods += 0.25;
    Vectors now;
    result.solver->displacements(now);
    double largest = 0, change = 0;
    for (std::size_t n = 0; n < now.size(); ++n)
      for (std::size_t axis = 0; axis < 3; ++axis)
      {
        largest = std::max(largest, std::abs(now[n][axis]));
        change = std::max(change, std::abs(now[n][axis] - result.displacements[n][axis]));
      }
    quiet = change <= settings.tolerance * largest ? quiet + 1 : 0;
    result.displacements = std::move(now);
  }
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
