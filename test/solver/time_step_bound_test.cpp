#include "../../src/solver/step_bound.hpp"
#include "../../src/solver/thread_team.hpp"
#include "../../src/solver/voxel_monitor.hpp"

#include "backends.hpp"
#include "block_model.hpp"
#include "true_frequency.hpp"

#include "frontalis/physics/hourglass.hpp"
#include "frontalis/physics/time_step.hpp"
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

// fat, and stiffer and heavier things in single voxels, two in some, at random; holes; a muscle through some voxels;
// nodes that are rigid, prescribed, or prescribed along one axis; unequal edges, all forms of the element
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
    model.materials[1].law = Law::fung;
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

// unknowns that nothing holds; nodes that are prescribed along one axis are free along the others
std::vector<std::size_t> free_unknowns(const Model& model)
{
  std::vector<std::size_t> free;
  for (std::size_t a = 0; a < 3 * model.nodes.size(); ++a)
  {
    const auto is_it = [&](const auto& held) { return static_cast<std::size_t>(held.node) == a / 3; };
    const auto prescribed = std::find_if(model.prescribed.begin(), model.prescribed.end(), is_it);
    if (std::none_of(model.rigid.begin(), model.rigid.end(), is_it) &&
        (prescribed == model.prescribed.end() || !model.loads[prescribed->load].fixed[a % 3]))
      free.push_back(a);
  }
  return free;
}

Vectors random_displacements(const Model& model, double size, std::mt19937& random)
{
  std::normal_distribution<double> noise;
  Vectors u(model.nodes.size());
  for (auto& x : u)
    for (double& component : x)
      component = size * noise(random);
  return u;
}

// bound of each voxel
std::vector<double> stiffness_of(const Model& model, const Discretisation& discretisation, const Vectors& u)
{
  std::vector<double> result;
  VoxelProperties voxel;
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    discretisation.voxel(e, voxel);
    double mode[3][8], scale[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      scale[axis] = 0.25 / model.spacing[axis];
      for (int b = 0; b < 8; ++b)
        mode[axis][b] = u[model.voxel_nodes[e][b]][axis];
      physics::walsh_hadamard(mode[axis]);
    }
    result.push_back(stiffness_now(discretisation, voxel, physics::kinematics(mode[0], mode[1], mode[2], scale)));
  }
  return result;
}

double critical_step(const Model& model)
{
  return make_solver(std::make_shared<const Model>(model), { Backend::reference, 1, 0 })->monitor().critical_time_step;
}

// with voxels of another material where it is asked for
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

TEST(AssembledBound, holds_for_mixtures_fibres_and_constraints)
{
  std::mt19937 random(3);
  double worst = 0;
  for (int i = 0; i < 60; ++i)
  {
    const Model model = random_mixture(random);
    const double size = i % 3 == 0 ? 0 : i % 3 == 1 ? 3e-5 : 1.5e-4;
    const Vectors u = random_displacements(model, size, random);
    const double ratio = test::true_over_bound(model, u, masses(model), free_unknowns(model));
    EXPECT_LT(ratio, 1) << "model " << i;
    worst = std::max(worst, ratio);
  }
  EXPECT_GT(worst, 0.5) << "far too careful";
}

// of a voxel: gradient modes with stiffness 1, hourglass modes with less, in the metric of the weights
TEST(WeightedShare, bounds_a_voxel)
{
  std::mt19937 random(13);
  std::uniform_real_distribution<double> exponent(-2, 0), share(0, 1);
  double closest = 0;
  for (int i = 0; i < 200; ++i)
  {
    const double hourglass = i % 2 == 0 ? 0 : share(random);
    double weight[8];
    for (double& w : weight)
      w = std::pow(10, exponent(random));
    std::vector<std::vector<double>> K(8, std::vector<double>(8, 0));
    for (int m = 1; m < 8; ++m)
    {
      double mode[8] = {};
      mode[m] = 1 / std::sqrt(8.0);
      physics::walsh_hadamard_transposed(mode);
      for (std::size_t a = 0; a < 8; ++a)
        for (std::size_t b = 0; b < 8; ++b)
          K[a][b] +=
              (physics::is_hourglass_mode(m) ? hourglass : 1) * mode[a] * mode[b] * std::sqrt(weight[a] * weight[b]);
    }
    const double ratio = test::largest_eigenvalue(K) / physics::weighted_share(weight, hourglass);
    EXPECT_LT(ratio, 1 + 1e-9) << "voxel " << i;
    closest = std::max(closest, ratio);
  }
  EXPECT_GT(closest, 0.95) << "far too careful";
  const double equal[8] = { 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5 };
  EXPECT_DOUBLE_EQ(physics::weighted_share(equal, 0.1), 0.5);
}

// of nodes: those at random and those that are found, which lower it
TEST(AssembledBound, holds_for_any_weights)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<double> exponent(-2, 0);
  double least = 1, closest = 0;
  int weighted = 0;
  for (int i = 0; i < 40; ++i)
  {
    Model model = random_mixture(random);
    model.hourglass = HourglassControl::scalar;
    model.integration = Integration::one_point;
    const Vectors u = random_displacements(model, i % 2 == 0 ? 1.5e-4 : 3e-4, random);
    const Discretisation discretisation(model);
    const std::vector<double> stiffness = stiffness_of(model, discretisation, u);
    const double critical = [&]
    {
      const auto solver = make_solver(std::make_shared<const Model>(model), { Backend::reference, 1, 0 });
      solver->set_displacements(u);
      return solver->monitor().critical_time_step;
    }();
    const double truth =
        test::true_over_bound(model, u, masses(model), free_unknowns(model)) * 4 / (critical * critical);
    const double plain = step_bound(discretisation, model, stiffness).frequency_squared;
    NodeWeights any;
    for (std::size_t n = 0; n < model.nodes.size(); ++n)
      any.of_node.push_back(static_cast<float>(std::pow(10, exponent(random))));
    for (const auto& nodes : model.voxel_nodes)
    {
      double weight[8];
      for (int b = 0; b < 8; ++b)
        weight[b] = double(any.of_node[nodes[b]]);
      any.share.push_back(static_cast<float>(physics::weighted_share(weight, discretisation.hourglass_share)));
    }
    EXPECT_LT(truth, step_bound(discretisation, model, stiffness, any).frequency_squared) << "model " << i;
    NodeWeights found;
    ThreadTeam alone(1);
    const double squared = find_weights(discretisation, model, stiffness, { whole(model) }, alone, found);
    EXPECT_LT(truth, squared) << "model " << i;
    EXPECT_LE(squared, plain);
    EXPECT_NEAR(step_bound(discretisation, model, stiffness, found).frequency_squared / squared, 1, 1e-12);
    least = std::min(least, squared / plain);
    closest = std::max(closest, truth / squared);
    weighted += found.of_node.empty() ? 0 : 1;
  }
  EXPECT_GT(weighted, 20);
  EXPECT_LT(least, 0.6) << "hardly worth it";
  EXPECT_GT(closest, 0.6) << "far too careful";
}

TEST(AssembledBound, finds_the_same_weights_with_any_number_of_threads)
{
  std::mt19937 random(9);
  Model model = random_mixture(random);
  const Vectors u = random_displacements(model, 3e-4, random);
  const Discretisation discretisation(model);
  const std::vector<double> stiffness = stiffness_of(model, discretisation, u);
  NodeWeights by_one, by_three;
  ThreadTeam one(1), three(3);
  const ModelPart all = whole(model);
  std::vector<ModelPart> parts(3, all);
  for (std::size_t t = 0; t < 3; ++t)
  {
    const auto share = [&](std::int32_t count, std::size_t part)
    { return static_cast<std::int32_t>(count * part / 3); };
    parts[t].nodes = { share(all.nodes.last, t), share(all.nodes.last, t + 1) };
    parts[t].voxels = { share(all.voxels.last, t), share(all.voxels.last, t + 1) };
  }
  const double squared = find_weights(discretisation, model, stiffness, { all }, one, by_one);
  EXPECT_EQ(find_weights(discretisation, model, stiffness, parts, three, by_three), squared);
  EXPECT_FALSE(by_one.of_node.empty());
  EXPECT_EQ(by_one.of_node, by_three.of_node);
  EXPECT_EQ(by_one.share, by_three.share);
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
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
    if (model.nodes[n][2] == 0)
      model.rigid.push_back({ static_cast<std::int32_t>(n), -1 });
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

// what the kernels find where they step, not what the monitor does
TEST_P(Looks, find_what_the_monitor_finds)
{
  std::mt19937 random(11);
  int stiffened = 0;
  for (int i = 0; i < 12; ++i)
  {
    Model model = random_mixture(random);
    model.time_step_share = 0.5;
    const auto solver = this->solver(model, 2);
    Vectors u = random_displacements(model, 1.5e-4, random);
    for (const auto& node : model.rigid)
      u[node.node] = { 0, 0, 0 };
    solver->set_displacements(u);
    const std::vector<float> activation(model.muscles.size(), 0);
    // what was believed fades in steps in which nothing moves
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
