#include "backends.hpp"
#include "block_model.hpp"

#include "frontalis/solver/solver.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numeric>
#include <random>

using namespace frontalis;
using Vectors = std::vector<std::array<double, 3>>;

namespace
{

using Matrix = std::array<std::array<double, 3>, 3>;

Matrix product(const Matrix& a, const Matrix& b)
{
  Matrix c{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k)
        c[i][j] += a[i][k] * b[k][j];
  return c;
}

// from a random unit quaternion
Matrix random_rotation(std::mt19937& random)
{
  std::normal_distribution<double> normal;
  double q[4], length = 0;
  for (double& x : q)
  {
    x = normal(random);
    length += x * x;
  }
  for (double& x : q)
    x /= std::sqrt(length);
  const double w = q[0], x = q[1], y = q[2], z = q[3];
  return { { { { 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y) } },
             { { 2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x) } },
             { { 2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y) } } } };
}

// stretches up to `most` and down to its inverse, volume kept to within 2 % in three of four
Matrix random_gradient(std::mt19937& random, double most, int index)
{
  std::uniform_real_distribution<double> value(-1, 1);
  double stretch[3], J = 1;
  for (double& s : stretch)
  {
    s = std::pow(most, value(random));
    J *= s;
  }
  const double scale = index % 4 == 0 ? 1 : (1 + 0.02 * value(random)) / std::cbrt(J);
  Matrix diagonal{};
  for (int i = 0; i < 3; ++i)
    diagonal[i][i] = scale * stretch[i];
  return product(random_rotation(random), product(diagonal, random_rotation(random)));
}

// largest eigenvalue of a symmetric matrix, by power iteration on one that is shifted to be positive
double largest_eigenvalue(const std::vector<std::vector<double>>& K)
{
  double shift = 0;
  for (const auto& row : K)
    for (const double x : row)
      shift += x * x;
  shift = 0.3 * std::sqrt(shift);
  std::vector<double> mode(K.size()), next(K.size());
  for (std::size_t i = 0; i < mode.size(); ++i)
    mode[i] = std::sin(1.0 + 3.0 * static_cast<double>(i));
  double value = 0;
  for (int iteration = 0; iteration < 300; ++iteration)
  {
    double length = 0;
    for (std::size_t i = 0; i < K.size(); ++i)
    {
      next[i] = shift * mode[i];
      for (std::size_t j = 0; j < K.size(); ++j)
        next[i] += 0.5 * (K[i][j] + K[j][i]) * mode[j];
      length += next[i] * next[i];
    }
    value = std::sqrt(length);
    for (std::size_t i = 0; i < K.size(); ++i)
      mode[i] = next[i] / value;
  }
  return value - shift;
}

// square of the true highest frequency at given displacements, every muscle at full activation, over the bound's. Node
// masses [kg]; rows: unknowns that are free.
double true_over_bound(const Model& model, const Vectors& u, const std::vector<double>& mass,
                       const std::vector<std::size_t>& free)
{
  const auto solver = make_solver(std::make_shared<const Model>(model), { Backend::reference, 1, 0 });
  solver->advance(1e-12, { std::vector<float>(model.muscles.size(), 1), {} });
  solver->set_displacements(u);
  const double critical = solver->monitor().critical_time_step;
  Vectors moved, plus, minus;
  std::vector<std::vector<double>> K(free.size(), std::vector<double>(free.size()));
  for (std::size_t a = 0; a < free.size(); ++a)
  {
    const double step = 1e-8;
    for (const double sign : { 1.0, -1.0 })
    {
      moved = u;
      moved[free[a] / 3][free[a] % 3] += sign * step;
      solver->set_displacements(moved);
      solver->internal_forces(sign > 0 ? plus : minus);
    }
    for (std::size_t b = 0; b < free.size(); ++b)
      K[a][b] = (plus[free[b] / 3][free[b] % 3] - minus[free[b] / 3][free[b] % 3]) /
                (2 * step * std::sqrt(mass[free[a] / 3] * mass[free[b] / 3]));
  }
  return largest_eigenvalue(K) * critical * critical / 4;
}

// of a lone voxel
double true_over_bound(const Model& model, const Matrix& F)
{
  Vectors u(8);
  for (std::size_t n = 0; n < 8; ++n)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        u[n][i] += (F[i][j] - (i == j ? 1 : 0)) * test::rest(model, n)[j];
  std::vector<std::size_t> free(24);
  std::iota(free.begin(), free.end(), 0);
  return true_over_bound(model, u, std::vector<double>(8, model.materials[0].density * 1e-9 / 8), free);
}

struct Tissue
{
  const char* name;
  Law law;
  double poisson;
  std::array<double, 11> own;  // in place of parameters that are not 0 here
  double allowed;
};
constexpr double mu = 34e3 / 2.98;

class TimeStepBound : public testing::TestWithParam<Tissue>
{
};

}  // namespace

TEST_P(TimeStepBound, holds_for_a_deformed_voxel)
{
  const Tissue& tissue = GetParam();
  test::BlockSettings settings;
  settings.voxels = { { 1, 1, 1 } };
  settings.poisson = tissue.poisson;
  Model model = test::block_model(settings);
  Material& material = model.materials[0];
  material.law = tissue.law;
  for (std::size_t p = 0; p < tissue.own.size(); ++p)
    if (tissue.own[p] != 0)
      material.parameters[p] = tissue.own[p];
  std::mt19937 random(5);
  double worst = 0;
  for (int i = 0; i < 120; ++i)
    worst = std::max(worst, true_over_bound(model, random_gradient(random, i % 2 == 0 ? 1.3 : 2, i)));
  EXPECT_LT(worst, tissue.allowed);
  EXPECT_GT(worst, 0.9) << "far too careful";
}

TEST(FibreBound, holds_for_fibres_that_are_stretched_and_pressed)
{
  std::mt19937 random(7);
  for (const double tension : { 0.3e6, 5e6 })
    for (const bool passive : { false, true })
      for (const bool with_length : { false, true })
      {
        test::BlockSettings settings;
        settings.voxels = { { 1, 1, 1 } };
        settings.young = 0.5e6;
        Model model = test::block_model(settings);
        Muscle muscle;
        muscle.name = "muscle";
        muscle.stress_reference = tension;
        muscle.passive = passive;
        muscle.tension_length = with_length;
        test::add_muscle(model, { { 0.6f, 0, 0.8f } }, muscle);
        double worst = 0;
        for (int i = 0; i < 120; ++i)
          worst = std::max(worst, true_over_bound(model, random_gradient(random, i % 2 == 0 ? 1.3 : 2.5, i)));
        EXPECT_LT(worst, 1.01) << tension << " Pa, " << passive << with_length;
        EXPECT_GT(worst, 0.3) << "far too careful";
      }
}

INSTANTIATE_TEST_SUITE_P(
    Laws, TimeStepBound,
    testing::Values(Tissue{ "neo_hookean", Law::neo_hookean, 0.49, {}, 1.01 },
                    Tissue{ "neo_hookean_compressible", Law::neo_hookean, 0.3, {}, 1.1 },
                    Tissue{ "neo_hookean_nearly_incompressible", Law::neo_hookean, 0.4999, {}, 1.01 },
                    Tissue{ "mooney_rivlin", Law::mooney_rivlin, 0.49, { 0.25 * mu, 0, 0.25 * mu }, 1.01 },
                    Tissue{ "ogden", Law::ogden, 0.49, { 0.5 * mu, 0, 2, -0.25 * mu, -4 }, 1.01 },
                    Tissue{ "fung", Law::fung, 0.49, { 0, 0, 4 }, 1.02 },
                    Tissue{ "holzapfel", Law::holzapfel, 0.49, { mu, 0, mu, 5, 0, 1, 0, 0, 0, 1, 0 }, 1.02 },
                    Tissue{ "guccione", Law::guccione, 0.49, { 0.25 * mu, 0, 8, 2, 4, 1, 0, 0 }, 1.01 }),
    [](const auto& of) { return of.param.name; });

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

// nodes that are prescribed along one axis are free along the others
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
    const double ratio = true_over_bound(model, u, masses(model), free);
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
