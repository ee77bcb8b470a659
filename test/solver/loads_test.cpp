#include "backends.hpp"
#include "block_model.hpp"

#include "solver/stepping/discretisation.hpp"
#include "solver/stepping/nodal_loads.hpp"

#include <cmath>

using namespace frontalis;
using Vectors = std::vector<std::array<double, 3>>;

namespace
{

// A square on top of the block with four triangles per voxel, bound to the voxels below it. Its normals point up.
Load top_surface(const Model& model, Load::Kind kind, const std::array<double, 3>& value)
{
  Load load;
  load.name = "top";
  load.kind = kind;
  load.value = value;
  load.ramp = 0.01;
  const int nx = model.size[0], ny = model.size[1], nz = model.size[2];
  const auto voxel = [&](int i, int j) { return ((nz - 1) * ny + std::min(j, ny - 1)) * nx + std::min(i, nx - 1); };
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i)
    {
      load.mesh.vertices.push_back({ { i * model.spacing[0], j * model.spacing[1], nz * model.spacing[2] } });
      load.binding.voxel.push_back(voxel(i, j));
      load.binding.coordinates.push_back({ { i == nx ? 1.0f : 0.0f, j == ny ? 1.0f : 0.0f, 1.0f } });
    }
  // Each square has a vertex at its centre, so that each of its nodes gets a quarter of the force.
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i)
    {
      const int a = j * (nx + 1) + i, b = a + 1, c = a + nx + 1, d = c + 1;
      const auto middle = static_cast<std::int32_t>(load.mesh.vertices.size());
      load.mesh.vertices.push_back(
          { { (i + 0.5) * model.spacing[0], (j + 0.5) * model.spacing[1], nz * model.spacing[2] } });
      load.binding.voxel.push_back(voxel(i, j));
      load.binding.coordinates.push_back({ { 0.5f, 0.5f, 1.0f } });
      for (const auto& edge :
           { std::make_pair(a, b), std::make_pair(b, d), std::make_pair(d, c), std::make_pair(c, a) })
        load.mesh.triangles.push_back({ { edge.first, edge.second, middle } });
    }
  return load;
}

// Fixes the displacement along an axis on the lower face of this axis.
void roller(Model& model, int axis)
{
  Load load;
  load.kind = Load::Kind::displacement;
  load.fixed = { { axis == 0, axis == 1, axis == 2 } };
  model.loads.push_back(load);
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
    if (model.nodes[n][axis] == 0)
      model.prescribed.push_back({ static_cast<std::int32_t>(n), static_cast<std::int32_t>(model.loads.size()) - 1 });
}

Model loaded_block(Load::Kind kind, const std::array<double, 3>& value, test::BlockSettings& s)
{
  s.voxels = { { 3, 4, 5 } };
  s.damping = 3000;
  Model model = test::block_model(s);
  for (int axis = 0; axis < 3; ++axis)
    roller(model, axis);
  model.loads.push_back(top_surface(model, kind, value));
  return model;
}

double stretch(const Solver& solver, const Model& model)
{
  Vectors u;
  solver.displacements(u);
  double sum = 0;
  int count = 0;
  for (std::size_t n = 0; n < u.size(); ++n)
    if (model.nodes[n][2] == model.size[2])
    {
      sum += u[n][2];
      ++count;
    }
  return 1 + sum / count / (model.size[2] * model.spacing[2]);
}

double top_stretch(Solver& solver, const Model& model)
{
  for (int i = 0; i < 10; ++i)
    solver.advance(0.01, {});
  return stretch(solver, model);
}

}  // namespace

class Loads : public test::EveryBackend
{
};

TEST_P(Loads, TractionStretchesAsTheUniaxialTableSays)
{
  // P33 / mu is 0.701838 at the stretch 1.3. A traction is a first Piola-Kirchhoff stress.
  test::BlockSettings s;
  const double mu = test::shear_modulus(s);
  const Model model = loaded_block(Load::Kind::traction, { { 0, 0, 0.701838 * mu } }, s);
  const auto solver_ = solver(model);
  EXPECT_NEAR(top_stretch(*solver_, model), 1.3, 1e-4);
}

TEST_P(Loads, PressureFollowsTheArea)
{
  // At the stretch 0.7 the Cauchy stress is P33 / (lateral stretch)^2.
  test::BlockSettings s;
  const double mu = test::shear_modulus(s);
  const Model model = loaded_block(Load::Kind::pressure, { { 1.333561 * mu / (1.191455 * 1.191455), 0, 0 } }, s);
  const auto solver_ = solver(model);
  EXPECT_NEAR(top_stretch(*solver_, model), 0.7, 1e-4);
}

TEST_P(Loads, ActivationSetsThePressure)
{
  // A pressure of the stretch 0.7 that acts by seven tenths, against one of seven tenths that acts in full.
  test::BlockSettings s;
  const double mu = test::shear_modulus(s), pressure = 1.333561 * mu / (1.191455 * 1.191455);
  Model activated = loaded_block(Load::Kind::pressure, { { pressure, 0, 0 } }, s);
  activated.muscles.push_back({ "air" });
  activated.loads.back().activation = 0;
  const Model whole = loaded_block(Load::Kind::pressure, { { 0.7 * pressure, 0, 0 } }, s);
  const auto by_activation = solver(activated), by_ramp = solver(whole);

  by_activation->advance(0.02, { { 0 }, {} });
  Vectors u;
  by_activation->displacements(u);
  for (const auto& moved : u)
    for (const double component : moved)
      EXPECT_EQ(component, 0);
  by_activation->advance(0.01, { { 0.7F }, {} });
  const double reached = top_stretch(*by_ramp, whole);
  for (int i = 0; i < 10; ++i)
    by_activation->advance(0.01, { { 0.7F }, {} });
  EXPECT_NEAR(stretch(*by_activation, activated), reached, 1e-4);

  for (int i = 0; i < 20; ++i)
    by_activation->advance(0.01, { { 0 }, {} });
  EXPECT_NEAR(stretch(*by_activation, activated), 1, 1e-4);
}

TEST_P(Loads, ActivationSetsThePressureWhileContractionIsOff)
{
  test::BlockSettings s;
  const double pressure = 0.2 * test::shear_modulus(s);
  Model model = loaded_block(Load::Kind::pressure, { { pressure, 0, 0 } }, s);
  Muscle muscle;
  muscle.name = "muscle";
  muscle.stress_reference = test::shear_modulus(s);
  test::add_muscle(model, { { 0, 0, 1 } }, muscle);
  model.muscles.push_back({ "air" });
  model.loads.back().activation = 1;
  const auto reached = [&](const std::vector<float>& activation, bool contracts)
  {
    const auto solver_ = solver(model);
    solver_->switch_effect(Effect::contraction, contracts);
    for (int i = 0; i < 10; ++i)
      solver_->advance(0.01, { activation, {} });
    return stretch(*solver_, model);
  };
  const double by_pressure = reached({ 0, 0.7F }, true);
  EXPECT_LT(by_pressure, 0.97);
  EXPECT_LT(reached({ 0.5F, 0.7F }, true), by_pressure - 0.02) << "the muscle shortens the block";
  EXPECT_NEAR(reached({ 0.5F, 0.7F }, false), by_pressure, 1e-4);
}

TEST(NodalLoads, KeepThePressureForFourStepsOfAPlan)
{
  test::BlockSettings s;
  const Model model = loaded_block(Load::Kind::pressure, { { 100, 0, 0 } }, s);
  NodalLoads<double> loads(model, Discretisation(model));
  std::vector<double> u[3];
  for (int axis = 0; axis < 3; ++axis)
    for (const auto& node : model.nodes)
      u[axis].push_back(axis < 2 ? 0.01 * model.spacing[axis] * node[axis] : 0);
  // Returns the total force after a step at u, whose x and y components are multiplied first.
  const auto force_after = [&](int index, double factor)
  {
    for (int axis = 0; axis < 2; ++axis)
      for (double& x : u[axis])
        x *= factor;
    ConstraintStep step;
    step.index = index;
    step.time_before = 1;
    const double* const pointers[3] = { u[0].data(), u[1].data(), u[2].data() };
    loads.before_step({ 0, 1, 0, 0, 0, 0 }, pointers, step);
    double sum = 0;
    for (const auto& force : loads.forces())
      sum += force[2];
    return sum;
  };
  const double first = force_after(0, 1);
  for (int index = 1; index < 4; ++index)
    EXPECT_EQ(force_after(index, 2), first);
  EXPECT_NEAR(force_after(4, 1) / first, 1.08 * 1.08 / (1.01 * 1.01), 1e-6);
}

FRONTALIS_EVERY_BACKEND(Loads);
