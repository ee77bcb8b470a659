#include "backends.hpp"
#include "block_model.hpp"
#include "true_frequency.hpp"

#include "frontalis/physics/materials/all.hpp"
#include "frontalis/solver/solver.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numeric>
#include <random>

using namespace frontalis;
using test::Vectors;

namespace
{

// A model of fat with random single voxels of one or two stiffer and heavier materials. It has holes, unequal edges, a
// muscle in some voxels, a random kind of element, and nodes that are rigid, prescribed, or prescribed along one axis.
Model random_mixture(std::mt19937& random)
{
  std::uniform_real_distribution<double> share(0, 1);
  test::BlockSettings settings;
  if (share(random) < 0.3)
    settings.spacing = { { 1e-3, 1.4e-3, 0.8e-3 } };
  settings.voxels = { { 3, 2, 2 } };
  settings.keep = [&](auto i, auto, auto) { return i == 0 || share(random) < 0.85; };
  Model model = test::block_model(settings);
  for (const double stiffer : { 10.0, 100.0, 700.0 })
  {
    Material material = model.materials[0];
    material.parameters[0] *= stiffer;
    material.parameters[1] *= stiffer;
    material.density *= 1 + share(random);
    model.materials.push_back(material);
  }
  if (share(random) < 0.3)
  {
    model.materials[1].law = law_of<physics::FungExponential>;
    model.materials[1].parameters[2] = 2;
  }
  if (share(random) < 0.3)
    model.hourglass = HourglassControl::assumed_strain;
  if (share(random) < 0.2)
    model.integration = Integration::selective_reduced;
  model.mixture_begin.assign(1, 0);
  model.mixture_material.clear();
  model.mixture_proportion.clear();
  for (auto& fill : model.fill)
  {
    fill = static_cast<float>(0.3 + 0.7 * share(random));
    const std::int16_t stiff = share(random) < 0.3 ? static_cast<std::int16_t>(1 + 3 * share(random)) : std::int16_t(0);
    const auto part = static_cast<float>(stiff > 0 && share(random) < 0.5 ? share(random) : 1);
    model.mixture_material.insert(model.mixture_material.end(), { stiff, std::int16_t(0) });
    model.mixture_proportion.insert(model.mixture_proportion.end(), { part, 1 - part });
    model.mixture_begin.push_back(static_cast<std::int32_t>(model.mixture_material.size()));
  }
  if (share(random) < 0.5)
  {
    Muscle muscle;
    muscle.name = "muscle";
    muscle.stress_reference = 3e5;
    muscle.passive = share(random) < 0.5;
    test::add_muscle(model, { { 0.6f, 0, 0.8f } }, muscle);
  }
  Load along, whole;
  along.kind = whole.kind = Load::Kind::displacement;
  along.name = "along";
  along.fixed = { { true, false, false } };
  whole.name = "whole";
  model.loads = { along, whole };
  for (std::int32_t n = 0; n < static_cast<std::int32_t>(model.nodes.size()); ++n)
    if (const double kind = share(random); kind < 0.15)
      model.rigid.push_back({ n, -1 });
    else if (kind < 0.3)
      model.prescribed.push_back({ n, kind < 0.2 ? 1 : 0 });
  return model;
}

std::vector<double> masses(const Model& model)
{
  std::vector<double> mass(model.nodes.size(), 0);
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
    for (auto m = model.mixture_begin[e]; m < model.mixture_begin[e + 1]; ++m)
      for (const auto n : model.voxel_nodes[e])
        mass[n] += model.materials[model.mixture_material[m]].density * model.mixture_proportion[m] * model.fill[e] *
                   model.spacing[0] * model.spacing[1] * model.spacing[2] / 8;
  return mass;
}

double critical_step(const Model& model)
{
  return make_solver(std::make_shared<const Model>(model), { "reference", 1, 0 })->monitor().critical_time_step;
}

// A model with a stiffer material in the voxels for which `stiff` is true.
Model with_stiff_voxels(const std::function<bool(const std::array<std::int32_t, 3>&)>& stiff)
{
  test::BlockSettings settings;
  settings.voxels = { { 5, 5, 5 } };
  Model model = test::block_model(settings);
  model.materials.push_back(model.materials[0]);
  for (double& parameter : model.materials[1].parameters)
    parameter *= 1e4;
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
    model.mixture_material[e] = stiff(model.voxels[e]) ? 1 : 0;
  return model;
}

}  // namespace

// Nodes with a displacement prescribed along one axis are free along the others.
TEST(AssembledBound, holds_for_mixtures_fibres_and_constraints)
{
  std::mt19937 random(3);
  std::normal_distribution<double> noise;
  double worst = 0;
  for (int i = 0; i < 60; ++i)
  {
    const Model model = random_mixture(random);
    const double size = i % 3 == 0 ? 0 : i % 3 == 1 ? 3e-5 : 1.5e-4;
    Vectors u(model.nodes.size());
    for (auto& x : u)
      for (double& component : x)
        component = size * noise(random);
    std::vector<std::size_t> free;
    for (std::size_t a = 0; a < 3 * u.size(); ++a)
    {
      const auto is_it = [&](const auto& held) { return static_cast<std::size_t>(held.node) == a / 3; };
      const auto prescribed = std::find_if(model.prescribed.begin(), model.prescribed.end(), is_it);
      if (std::none_of(model.rigid.begin(), model.rigid.end(), is_it) &&
          (prescribed == model.prescribed.end() || !model.loads[prescribed->load].fixed[a % 3]))
        free.push_back(a);
    }
    const double ratio = test::true_over_bound(model, u, masses(model), free);
    EXPECT_LT(ratio, 1) << "model " << i;
    worst = std::max(worst, ratio);
  }
  EXPECT_GT(worst, 0.5) << "far too careful";
}

TEST(AssembledBound, shares_a_stiff_voxels_nodes_with_its_neighbours)
{
  const double whole = critical_step(with_stiff_voxels([](const auto&) { return true; }));
  const double lone = critical_step(with_stiff_voxels([](const auto& v) { return v[0] + v[1] + v[2] == 0; }));
  const double layer = critical_step(with_stiff_voxels([](const auto& v) { return v[2] == 2; }));
  const double single = critical_step(with_stiff_voxels(
      [](const auto& v) {
        return v == std::array<std::int32_t, 3>{ { 2, 2, 2 } };
      }));
  test::BlockSettings settings;
  settings.voxels = { { 1, 1, 1 } };
  settings.young *= 1e4;
  EXPECT_NEAR(whole / critical_step(test::block_model(settings)), 1, 1e-9) << "a uniform block is as its voxels are";
  EXPECT_NEAR(lone / whole, 1, 1e-9) << "a corner has the mass of its voxel alone";
  EXPECT_NEAR(layer / whole, std::sqrt(2.0), 1e-3);
  EXPECT_NEAR(single / whole, std::sqrt(8.0), 1e-3);
}

TEST(AssembledBound, leaves_out_what_cannot_move)
{
  Model model = with_stiff_voxels([](const auto& v) { return v[2] == 0; });
  const double before = critical_step(model);
  test::hold_plane(model, 2);
  EXPECT_NEAR(critical_step(model) / before, std::sqrt(2.0), 1e-3) << "what is left has neighbours";
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
    if (model.nodes[n][2] > 0)
      model.rigid.push_back({ static_cast<std::int32_t>(n), -1 });
  EXPECT_NEAR(critical_step(model) / before, 1, 1e-9) << "where nothing can move a time step is left";
}

namespace
{

class Looks : public test::EveryBackend
{
};

// Bounds that the stepping kernels find equal that of the monitor.
TEST_P(Looks, find_what_the_monitor_finds)
{
  std::mt19937 random(11);
  std::normal_distribution<double> noise;
  int stiffened = 0;
  for (int i = 0; i < 12; ++i)
  {
    Model model = random_mixture(random);
    model.time_step_share = 0.5;
    const auto solver = this->solver(model, 2);
    Vectors u(model.nodes.size());
    for (auto& x : u)
      for (double& component : x)
        component = 1e-4 * noise(random);
    for (const auto& node : model.rigid)
      u[node.node] = { 0, 0, 0 };
    solver->set_displacements(u);
    const std::vector<float> activation(model.muscles.size(), 0);
    // The step grows slowly when the bound falls. Tiny steps, in which nothing moves, let it grow completely.
    for (int step = 0; step < 100; ++step)
      solver->advance(1e-13, { activation, {} });
    const double critical = solver->monitor().critical_time_step;
    const double at_rest = this->solver(model, 2)->time_step();
    EXPECT_NEAR(solver->time_step(), std::min(0.5 * critical, at_rest), 1e-4 * at_rest) << "model " << i;
    stiffened += 0.5 * critical < 0.95 * at_rest ? 1 : 0;
  }
  EXPECT_GE(stiffened, 4);
}

FRONTALIS_EVERY_BACKEND(Looks);

}  // namespace
