// Layers that are shells: energy, momentum, threads, switches, the time step.

#include "backends.hpp"
#include "contact_model.hpp"
#include "nodal_vectors.hpp"
#include "shell_model.hpp"

#include "frontalis/model/effects.hpp"
#include "frontalis/physics/hourglass.hpp"
#include "frontalis/physics/materials/lookup.hpp"
#include "frontalis/solver/shell_mesh.hpp"
#include "solver/stepping/discretisation.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace frontalis
{
namespace
{

using namespace test;

class ShellBackend : public testing::TestWithParam<Backend>
{
protected:
  std::unique_ptr<Solver> make(const Model& model, int threads = 2, bool ledger = true) const
  {
    SolverSettings settings{ GetParam(), threads, 0 };
    settings.ledger = ledger;
    return make_solver(std::make_shared<const Model>(model), settings);
  }
};

Model film_on_block(bool free = true, double young = 1e6)
{
  BlockSettings settings;
  settings.voxels = { { 7, 6, 4 } };
  Model model = block_model(settings);
  if (!free)
    hold_plane(model, 2);
  ShellSettings film;
  film.young = young;
  add_shell(model, film);
  check_model(model);
  return model;
}

// Velocities that bend, stretch and shear the film.
Vectors disturbance(const Model& model, double speed)
{
  Vectors v(model.nodes.size());
  for (std::size_t n = 0; n < v.size(); ++n)
  {
    const auto p = rest(model, n);
    v[n] = { { speed * std::sin(700 * p[0] + 300 * p[1]), speed * std::cos(500 * p[1] - 200 * p[2]),
               speed * std::sin(900 * p[0]) * p[2] / 4e-3 } };
  }
  return v;
}

TEST_P(ShellBackend, a_strained_block_strains_its_film)
{
  const Model model = film_on_block();
  const auto solver = make(model);
  const double a = 0.03, b = -0.02;
  Vectors u(model.nodes.size());
  for (std::size_t n = 0; n < u.size(); ++n)
    u[n] = { { a * rest(model, n)[0], b * rest(model, n)[1], 0 } };
  solver->set_displacements(u);
  const ShellSettings s;
  const double mu = s.young / (2 * (1 + s.poisson)), lambda = s.young * s.poisson / (1 - s.poisson * s.poisson);
  const double expected = 7e-3 * 6e-3 * s.thickness * (mu * (a * a + b * b) + 0.5 * lambda * (a + b) * (a + b));
  EXPECT_NEAR(solver->ledger()["shell"], expected, 1e-5 * expected);
}

TEST_P(ShellBackend, energy_and_momentum_are_kept)
{
  const Model model = film_on_block(true, 10e6);
  const auto solver = make(model);
  // Stretches the film along one axis and shortens it along the other, at constant volume.
  Vectors v(model.nodes.size());
  for (std::size_t n = 0; n < v.size(); ++n)
    v[n] = { { 30 * rest(model, n)[0] - 0.1, 0.1 - 30 * rest(model, n)[1], 0.01 } };
  std::array<double, 3> before{}, after{}, length{};
  const double mass = model.materials[0].density * 1e-9 / 8;
  const auto momentum = [&](const Vectors& moved, std::array<double, 3>& sum)
  {
    for (const auto& nodes : model.voxel_nodes)
      for (const auto n : nodes)
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
          sum[axis] += mass * moved[n][axis];
          length[axis] += mass * std::abs(moved[n][axis]);
        }
  };
  solver->set_velocities(v);
  constexpr double allowed = 2e-3;
  double largest = 0;
  for (int k = 0; k < 20; ++k)
  {
    solver->advance(0.5e-3, solver->controls());
    const EnergyLedger ledger = solver->ledger();
    EXPECT_LT(std::abs(ledger.imbalance()), allowed * ledger.largest);
    largest = std::max(largest, ledger["shell"] / ledger.largest);
  }
  EXPECT_GT(largest, 10 * allowed);  // the energy is so large that an error would be noticed
  // Find the momentum from two positions of the centre of mass.
  const double time = solver->time();
  momentum(displacements(*solver), before);
  solver->advance(1e-3, solver->controls());
  momentum(displacements(*solver), after);
  std::array<double, 3> given{};
  momentum(v, given);
  for (std::size_t axis = 0; axis < 3; ++axis)
    EXPECT_NEAR((after[axis] - before[axis]) / (solver->time() - time), given[axis], 1e-4 * length[axis]);
}

TEST_P(ShellBackend, threads_do_not_change_a_bit)
{
  const Model model = film_on_block(false);
  Vectors expected;
  for (const int threads : { 1, 2, 3 })
  {
    const auto solver = make(model, threads);
    solver->set_velocities(disturbance(model, 0.2));
    solver->advance(5e-3, solver->controls());
    if (threads == 1)
      expected = displacements(*solver);
    EXPECT_EQ(displacements(*solver), expected) << threads;
  }
}

TEST_P(ShellBackend, moves_as_the_reference_does)
{
  const Model film = film_on_block(false);
  Model pressed = film;
  pressed.contacts.push_back(touching_side(film, true, plate(4e-3, 1)));
  for (const Model& model : { film, pressed })
  {
    const auto solver = make(model),
               reference = make_solver(std::make_shared<const Model>(model), { "reference", 1, 0 });
    for (Solver* const one : { solver.get(), reference.get() })
    {
      one->set_velocities(disturbance(model, 0.2));
      one->advance(4e-3, one->controls());
    }
    const Vectors u = displacements(*solver), right = displacements(*reference);
    const double allowed = model.contacts.empty() ? 2e-7 : 1e-6;
    for (std::size_t n = 0; n < u.size(); ++n)
      for (std::size_t axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(u[n][axis], right[n][axis], allowed);
  }
}

// A plate above the block stops nodes that the film pushes too.
TEST_P(ShellBackend, a_plate_touches_the_block_beside_it)
{
  Model model = film_on_block(false), film = model;
  model.contacts.push_back(touching_side(model, true, plate(4e-3, 1)));
  const auto pressed = make(model), free = make(film);
  double highest[2] = {};
  for (const bool plate : { false, true })
  {
    Solver& solver = plate ? *pressed : *free;
    solver.set_velocities(Vectors(model.nodes.size(), { { 0, 0, 0.2 } }));
    for (int k = 0; k < 20; ++k)
    {
      solver.advance(0.2e-3, solver.controls());
      for (const auto& u : displacements(solver))
        highest[plate ? 1 : 0] = std::max(highest[plate ? 1 : 0], u[2]);
    }
  }
  EXPECT_LT(highest[1], 0.5 * highest[0]);
  EXPECT_GT(pressed->ledger()["shell"], 0);
}

TEST_P(ShellBackend, none_costs_nothing)
{
  const Model with = film_on_block();
  EXPECT_TRUE(effects_of(with).has(Effect::shell));
  EXPECT_EQ(presence_of(with, Effect::shell).nodes, with.shells[0].surface.vertices.size());
  Model off = with, never = with;
  switch_off(off, EffectSet().with(Effect::shell));
  never.shells.clear();
  for (const Model& model : { off, never })
  {
    for (const Allocation& allocation : make(model)->allocations())
      EXPECT_NE(allocation.effect, Effect::shell) << allocation.what;
    EXPECT_GT(make(model)->time_step(), make(with)->time_step());
  }
  std::size_t bytes = 0;
  for (const Allocation& allocation : make(with)->allocations())
    bytes += allocation.effect == Effect::shell ? allocation.bytes : 0;
  EXPECT_GT(bytes, 100 * with.shells[0].surface.triangles.size());
}

TEST_P(ShellBackend, it_is_switched_while_running)
{
  Model model = film_on_block(false), without = model;
  switch_off(without, EffectSet().with(Effect::shell));
  SolverSettings settings{ GetParam(), 2, 1e-5 };
  settings.ledger = true;
  const auto solver = make_solver(std::make_shared<const Model>(model), settings);
  const auto other = make_solver(std::make_shared<const Model>(without), settings);
  solver->switch_effect(Effect::shell, false);
  for (Solver* const one : { solver.get(), other.get() })
  {
    one->set_velocities(disturbance(model, 0.2));
    one->advance(2e-3, one->controls());
  }
  EXPECT_EQ(displacements(*solver), displacements(*other));
  EXPECT_EQ(solver->ledger()["shell"], 0);
  solver->switch_effect(Effect::shell, true);
  EXPECT_GT(solver->ledger()["shell"], 0);
  solver->advance(1e-3, solver->controls());
  EXPECT_NE(displacements(*solver), displacements(*other));
}

// A film that determines the highest frequency gains no energy with full time steps and without damping.
TEST_P(ShellBackend, the_bound_of_the_time_step_includes_the_film)
{
  Model model = film_on_block(true, 300e6);
  model.time_step_share = 1;
  Model plain = model;
  plain.shells.clear();
  for (const auto estimate : { TimeStepEstimate::element, TimeStepEstimate::assembled })
  {
    model.time_step_estimate = estimate;
    const auto solver = make(model);
    EXPECT_LT(solver->time_step(), 0.5 * make(plain)->time_step());
    solver->set_velocities(disturbance(model, 1e-2));
    for (int k = 0; k < 10; ++k)
      solver->advance(0.2e-3, solver->controls());
    const EnergyLedger ledger = solver->ledger();
    EXPECT_LT(std::abs(ledger.imbalance()), 0.02 * ledger.largest);
  }
}

// A plate bends under its weight. It is far stiffer than the tissue around it, whose own vibrations are much slower.
TEST_P(ShellBackend, it_settles_at_the_damping_that_its_own_stiffness_needs)
{
  BlockSettings settings;
  settings.voxels = { { 10, 3, 1 } };
  settings.young = 100;
  settings.poisson = 0.3;
  Model model = block_model(settings);
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
    if (model.nodes[n][0] < 2)
      model.rigid.push_back({ static_cast<std::int32_t>(n) });
  ShellSettings plate;
  plate.height = 0.5e-3;
  plate.thickness = 0.2e-3;
  add_shell(model, plate);
  model.gravity = { { 0, 0, -0.2 } };
  constexpr double period = 0.14;  // period of a beam's slowest vibration [s]
  const auto solver = make(model, 1, false);
  EXPECT_TRUE(solver->settle(solver->controls(), 1e-3, 8 * period).reached);
}

// A plate of irregular triangles, 20 edges long and wide, in one voxel. Most vertices have six neighbours.
Model irregular_plate()
{
  constexpr int n = 20;
  constexpr double edge = 1e-3;
  BlockSettings settings;
  settings.voxels = { { 1, 1, 1 } };
  const double side = (n + 3) * edge;
  settings.spacing = { { side, side, side } };
  Model model = block_model(settings);
  Shell shell;
  shell.name = "plate";
  shell.thickness = 0.1 * edge;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i)
    {
      const double x = i + 0.5 * (j % 2) + 0.15 * std::sin(3.0 * i + 5 * j);
      const double y = std::sqrt(0.75) * j + 0.15 * std::cos(4.0 * i + 3 * j);
      shell.surface.vertices.push_back({ { edge * (x + 1), edge * (y + 1), 0 } });
    }
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
    {
      const int a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
      const bool slash = (j % 2 == 1) != ((3 * i + 5 * j) % 17 == 0);
      shell.surface.triangles.push_back(slash ? std::array<std::int32_t, 3>{ { a, b, d } }
                                              : std::array<std::int32_t, 3>{ { a, b, c } });
      shell.surface.triangles.push_back(slash ? std::array<std::int32_t, 3>{ { a, d, c } }
                                              : std::array<std::int32_t, 3>{ { b, d, c } });
    }
  for (const auto& v : shell.surface.vertices)
  {
    shell.binding.voxel.push_back(0);
    shell.binding.coordinates.push_back({ { static_cast<float>(v[0] / side), static_cast<float>(v[1] / side), 0 } });
  }
  model.shells.push_back(shell);
  return model;
}

// A shell has no fibres.
TEST(ShellMembrane, of_fibrous_tissue_is_that_of_its_ground)
{
  Model plain = irregular_plate(), fibrous = plain;
  Material& material = fibrous.materials[0];
  const double mu = material.parameters[0];
  material.law = physics::law_named("holzapfel").value();
  material.parameters = { { mu, material.parameters[1], 50 * mu, 1, 0, 1, 0, 0, 0, 1, 0 } };
  const auto strained = [](const Model& model)
  {
    const ShellMesh mesh(model);
    double energy = 0;
    for (const ShellMesh::Triangle& t : mesh.triangles)
    {
      physics::Vec3<double> u[6];
      for (std::size_t i = 0; i < 6; ++i)
        u[i] = { -1e-3 * model.spacing[0] * mesh.binding.coordinates[t.vertex[i]][0], 0, 0 };
      energy += physics::shell_forces(t.rest, u).membrane;
    }
    return energy;
  };
  const double expected = strained(plain);
  EXPECT_GT(expected, 0);
  EXPECT_NEAR(strained(fibrous), expected, 1e-6 * expected);
}

// The patch test of bending: in uniform curvatures, forces cancel at vertices away from the rim, up to a quarter of
// what triangles leave that do not know of each other, and the energy is that of a plate.
TEST(ShellBending, a_uniform_moment_is_in_equilibrium_on_irregular_triangles)
{
  using Vector = physics::Vec3<double>;
  const Model model = irregular_plate();
  const Shell& shell = model.shells[0];
  const ShellMesh mesh(model);
  const double side = model.spacing[0], edge = 1e-3;
  const double mu = physics::shear_modulus_of(model.materials[0].law, model.materials[0].parameters),
               young = physics::young_modulus(mu, model.materials[0].parameters[1]);
  const double poisson = young / (2 * mu) - 1;
  for (const auto& [xx, yy, xy] : { std::array<double, 3>{ 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 1, 1, 0 } })
  {
    const double curvature = 1e-3 / side;
    std::vector<Vector> moved(mesh.binding.voxel.size()), force(moved.size(), { 0, 0, 0 }), before = force;
    std::vector<bool> inner(moved.size());
    for (std::size_t v = 0; v < moved.size(); ++v)
    {
      const double x = mesh.binding.coordinates[v][0] * side, y = mesh.binding.coordinates[v][1] * side;
      moved[v] = { 0, 0, 0.5 * curvature * (xx * x * x + yy * y * y + 2 * xy * x * y) };
      inner[v] = x > 5 * edge && x < 18 * edge && y > 5 * edge && y < 15 * edge;
    }
    double energy = 0, area = 0;
    for (const ShellMesh::Triangle& t : mesh.triangles)
    {
      Vector u[6];
      std::array<Vector, 6> rest{};
      for (std::size_t i = 0; i < 6; ++i)
      {
        u[i] = moved[t.vertex[i]];
        const auto& at = mesh.binding.coordinates[t.vertex[i]];
        rest[i] = { at[0] * side, at[1] * side, 0 };
      }
      if (!t.has_beyond(0) || !t.has_beyond(1) || !t.has_beyond(2))
        continue;
      // the same triangle by itself, whose forces do not cancel with those of its neighbours
      const auto alone = shell_triangle(rest, { true, true, true }, shell.thickness, young, poisson);
      const auto here = physics::shell_forces(t.rest, u), there = physics::shell_forces(alone.rest, u);
      for (std::size_t i = 0; i < 6; ++i)
      {
        force[t.vertex[i]] = force[t.vertex[i]] + here.force[i];
        before[t.vertex[i]] = before[t.vertex[i]] + there.force[i];
      }
      energy += here.bending;
      area += 0.5 / t.rest.inverse_area;
    }
    double left = 0, first = 0;
    for (std::size_t v = 0; v < moved.size(); ++v)
      if (inner[v])
      {
        left += force[v].z * force[v].z;
        first += before[v].z * before[v].z;
      }
    EXPECT_LT(std::sqrt(left), 0.3 * std::sqrt(first)) << xx << yy << xy;
    const double plate = young * std::pow(shell.thickness, 3) / (12 * (1 - poisson * poisson));
    const double expected = 0.5 * plate * area * curvature * curvature *
                            (xx * xx + yy * yy + 2 * poisson * xx * yy + 2 * (1 - poisson) * xy * xy);
    EXPECT_NEAR(energy, expected, 0.01 * expected) << xx << yy << xy;
  }
}

FRONTALIS_EVERY_BACKEND(ShellBackend);

}  // namespace
}  // namespace frontalis
