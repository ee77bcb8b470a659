#include "frontalis/study/effect_presence.hpp"

#include "frontalis/model/sample_field.hpp"
#include "frontalis/study/dense_block.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

constexpr std::int32_t length = 64, depth = 40;

// gives an effect to a share of the voxels, or of the nodes of the face z = 0
void give(Model& model, Effect effect, double share)
{
  const auto rows = static_cast<std::int32_t>(std::lround(share * depth));
  const auto has = [&](std::size_t e) { return model.voxels[e][1] < rows; };
  if (effect == Effect::viscosity)
  {
    model.materials.push_back(model.materials[0]);
    model.materials.back().viscous_share = { { 0.3, 0.2 } };
    model.materials.back().viscous_time = { { 0.1, 1 } };
    for (std::size_t e = 0; e < model.voxels.size(); ++e)
      model.mixture_material[e] = has(e) ? 1 : 0;
  }
  if (effect == Effect::contraction || effect == Effect::fibre_stiffness)
  {
    Muscle muscle;
    muscle.name = "pull";
    muscle.stress_reference = 1e3;
    muscle.passive = effect == Effect::fibre_stiffness;
    model.muscles.push_back(muscle);
    for (std::size_t e = 0; e < model.voxels.size(); ++e)
    {
      if (has(e))
      {
        model.fibre_muscle.push_back(0);
        model.fibre_weight.push_back(1);
        model.fibre_direction.push_back({ { 1, 0, 0 } });
      }
      model.fibre_begin[e + 1] = static_cast<std::int32_t>(model.fibre_muscle.size());
    }
  }
  if (effect == Effect::sliding || effect == Effect::friction)
  {
    // the cost of friction is what it adds to sliding, so that all nodes of the face slide
    const std::int32_t sliding_rows = effect == Effect::friction ? depth + 1 : rows;
    const auto height = [](const std::array<double, 3>& p) { return p[2]; };
    const auto slides_between = [&](std::int32_t first, std::int32_t last)
    {
      std::vector<std::int32_t> nodes;
      for (std::size_t n = 0; n < model.nodes.size(); ++n)
        if (const auto& at = model.nodes[n]; at[2] == 0 && at[0] > 0 && at[1] >= first && at[1] < last)
          nodes.push_back(static_cast<std::int32_t>(n));
      return nodes;
    };
    const std::int32_t rough_rows = effect == Effect::friction ? rows : 0;
    slide_on(model, "smooth floor", height, slides_between(rough_rows, sliding_rows));
    if (rough_rows > 0)
    {
      slide_on(model, "rough floor", height, slides_between(0, rough_rows));
      model.constraint_surfaces.back().friction = 0.3;
    }
  }
}

}  // namespace

std::vector<double> presence_shares() { return { 0, 0.1, 0.5, 1 }; }

std::vector<PresenceCost> measure_presence(const SolverSettings& settings, double seconds)
{
  // where the arrays of a solver lie in memory changes its step by a percent, so solvers are made anew a few times
  constexpr int rounds = 4;
  const StepTimer timer = step_timer(settings, seconds / rounds);
  const std::vector<double> shares = presence_shares();
  std::vector<PresenceCost> costs;
  for (const Effect effect :
       { Effect::contraction, Effect::fibre_stiffness, Effect::viscosity, Effect::sliding, Effect::friction })
  {
    StepTimes times;
    for (int round = 0; round < rounds; ++round)
    {
      std::vector<std::unique_ptr<Solver>> solvers;
      std::vector<TimedSolver> timed;
      for (const double share : shares)
      {
        Model model = dense_block(length, depth, depth);
        model.gravity = {};
        give(model, effect, share);
        solvers.push_back(make_solver(std::make_shared<const Model>(std::move(model)), settings));
        Controls controls = solvers.back()->controls();
        std::fill(controls.activation.begin(), controls.activation.end(), 0.75f);
        timed.push_back({ solvers.back().get(), controls });
      }
      const StepTimes more = timer(timed);
      times.insert(times.end(), more.begin(), more.end());
    }
    for (std::size_t s = 0; s < shares.size(); ++s)
      costs.push_back({ effect, shares[s], spread_of_difference(times, s, 0), spread_of(times, 0).median });
  }
  return costs;
}

ActivationCost measure_activation(const std::shared_ptr<const Model>& model, const SolverSettings& settings,
                                  const StepTimer& timer)
{
  const auto one = make_solver(model, settings), all = make_solver(model, settings);
  Controls of_one = one->controls(), of_all = all->controls();
  of_one.activation.at(0) = 0.75f;
  std::fill(of_all.activation.begin(), of_all.activation.end(), 0.75f);
  const StepTimes times = timer({ { one.get(), of_one }, { all.get(), of_all } });
  return { spread_of(times, 0).median, spread_of(times, 1).median, spread_of_difference(times, 1, 0).half };
}

}  // namespace frontalis
