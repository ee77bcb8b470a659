#include "backends.hpp"
#include "block_model.hpp"
#include "frontalis/error.hpp"

#include <cmath>

using namespace frontalis;
using Vectors = std::vector<std::array<double, 3>>;

namespace
{

// Prescribes the chosen components of the nodes on the lower or upper face of an axis.
void prescribe(Model& model, int axis, bool upper, const std::array<bool, 3>& fixed, const std::array<double, 3>& value,
               double ramp)
{
  Load load;
  load.name = "face";
  load.kind = Load::Kind::displacement;
  load.fixed = fixed;
  load.value = value;
  load.ramp = ramp;
  const auto index = static_cast<std::int32_t>(model.loads.size());
  model.loads.push_back(load);
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
    if (model.nodes[n][axis] == (upper ? model.size[axis] : 0))
      model.prescribed.push_back({ static_cast<std::int32_t>(n), index });
}

// Makes the planes x = 0, y = 0 and z = 0 planes of symmetry.
void symmetry(Model& model)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    std::array<bool, 3> fixed{ { false, false, false } };
    fixed[axis] = true;
    prescribe(model, axis, false, fixed, { { 0, 0, 0 } }, 0);
  }
}

std::size_t far_corner(const Model& model)
{
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
    if (model.nodes[n] == model.size)
      return n;
  return 0;
}

// Runs until the kinetic energy is below `share` times Young's modulus times volume, or for a limited time.
void settle(Solver& solver, const Controls& controls, double slice, double share, const test::BlockSettings& s)
{
  const double scale = s.young * s.voxels[0] * s.voxels[1] * s.voxels[2] * s.spacing[0] * s.spacing[1] * s.spacing[2];
  for (int i = 0; i < 100; ++i)
  {
    solver.advance(slice, controls);
    if (solver.monitor().kinetic < share * scale)
      return;
  }
  FAIL() << "did not come to rest";
}

}  // namespace

class Motion : public test::EveryBackend
{
};

TEST_P(Motion, UniaxialStretchesAsTheTableSays)
{
  const double table[3][3] = { { 0.7, 1.191455, 0.993695 }, { 1.3, 0.879723, 1.006086 }, { 2.0, 0.715038, 1.022560 } };
  for (const auto& row : table)
  {
    test::BlockSettings s;
    s.voxels = { { 3, 3, 3 } };
    s.damping = 3000;
    Model model = test::block_model(s);
    symmetry(model);
    prescribe(model, 0, true, { { true, false, false } }, { { (row[0] - 1) * 3e-3, 0, 0 } }, 0.02);
    const auto solver_ = solver(model);
    solver_->advance(0.02, {});
    settle(*solver_, {}, 0.01, 1e-10, s);
    Vectors u;
    solver_->displacements(u);
    const std::size_t corner = far_corner(model);
    EXPECT_NEAR(1 + u[corner][1] / 3e-3, row[1], 1e-4);
    EXPECT_NEAR(1 + u[corner][2] / 3e-3, row[1], 1e-4);
    EXPECT_NEAR(solver_->monitor().worst_jacobian, row[2], 1e-4);
  }
}

TEST_P(Motion, ActiveBarShortensAsTheClosedFormSays)
{
  const double table[4][2] = { { 0.1, 0.96873 }, { 0.5, 0.87358 }, { 1, 0.79370 }, { 2, 0.69336 } };
  for (const auto& row : table)
  {
    test::BlockSettings s;
    s.voxels = { { 4, 2, 2 } };
    s.poisson = 0.4995;  // the closed form is for incompressible material
    s.damping = 3000;
    Model model = test::block_model(s);
    symmetry(model);
    Muscle muscle;
    muscle.name = "bar";
    muscle.tension_length = false;
    muscle.stress_reference = 2 * test::shear_modulus(s);
    test::add_muscle(model, { { 1, 0, 0 } }, muscle);
    const auto solver_ = solver(model);
    const Controls controls{ { static_cast<float>(row[0] / 2) }, {} };
    solver_->advance(0.02, controls);
    settle(*solver_, controls, 0.01, 1e-10, s);
    Vectors u;
    solver_->displacements(u);
    EXPECT_NEAR(1 + u[far_corner(model)][0] / 4e-3, row[1], 1e-3);
  }
}

TEST_P(Motion, CantileverBendsAsBeamTheorySays)
{
  // The beam has a square section and is ten times as long as high. Gravity deflects its tip by q L^4 / (8 E I) + q L^2
  // / (2 k G A) with k = 5/6 (Timoshenko's theory with shear, small deflections).
  for (const int through : { 1, 2, 4 })
  {
    test::BlockSettings s;
    const double height = 8e-3;
    const double h = height / through;
    s.voxels = { { 10 * through, through, through } };
    s.spacing = { { h, h, h } };
    s.poisson = 0.3;
    s.young = 1e5;
    s.damping = 60;
    Model model = test::block_model(s);
    prescribe(model, 0, false, { { true, true, true } }, { { 0, 0, 0 } }, 0);
    const double gravity = 0.05;
    model.gravity = { { 0, 0, -gravity } };
    const auto solver_ = solver(model);
    solver_->advance(0.5, {});
    settle(*solver_, {}, 0.05, 1e-12, s);
    Vectors u;
    solver_->displacements(u);
    const double length = 10 * height, load = s.density * gravity * height * height;
    const double inertia = std::pow(height, 4) / 12;
    const double exact = load * std::pow(length, 4) / (8 * s.young * inertia) +
                         load * length * length / (2 * (5.0 / 6) * test::shear_modulus(s) * height * height);
    EXPECT_NEAR(-u[far_corner(model)][2] / exact, 1, 0.07) << through << " elements through the thickness";
  }
}

TEST_P(Motion, ComesBackFromActivation)
{
  test::BlockSettings s;
  s.voxels = { { 6, 3, 3 } };
  s.damping = 2000;
  Model model = test::block_model(s);
  symmetry(model);
  Muscle muscle;
  muscle.name = "bar";
  test::add_muscle(model, { { 1, 0, 0 } }, muscle);
  const auto solver_ = solver(model);
  solver_->advance(0.01, Controls{ { 1.0f }, {} });
  settle(*solver_, Controls{ { 1.0f }, {} }, 0.01, 1e-10, s);
  Vectors u;
  solver_->displacements(u);
  EXPECT_LT(u[far_corner(model)][0], -1e-3);
  solver_->advance(0.01, Controls{ { 0.0f }, {} });
  for (int i = 0; i < 20; ++i)
    solver_->advance(0.01, Controls{ { 0.0f }, {} });
  solver_->displacements(u);
  EXPECT_NEAR(u[far_corner(model)][0], 0, 1e-8);
}

TEST_P(Motion, FreeFallIsExact)
{
  Model model = test::block_model();
  model.gravity = { { 0, 0, -9.81 } };
  const auto solver_ = solver(model);
  solver_->advance(0.02, {});
  Vectors u;
  solver_->displacements(u);
  for (const auto& v : u)
    EXPECT_NEAR(v[2], -0.5 * 9.81 * 0.02 * 0.02, 0.5 * 9.81 * 0.02 * solver_->time_step() * 1.1 + 1e-6);
}

TEST_P(Motion, FastNodesMoveLittleInAStep)
{
  const Model model = test::block_model();
  const auto solver_ = solver(model);
  const double slow = solver_->time_step(), speed = 0.6 * model.spacing[0] / slow, seconds = 100 * slow;
  solver_->set_velocities(Vectors(model.nodes.size(), { { 0, 0, speed } }));
  solver_->advance(0.3 * seconds, {});
  EXPECT_NEAR(solver_->time_step(), slow / 4, 0.01 * slow) << "as measured";
  solver_->advance(0.7 * seconds, {});
  EXPECT_NEAR(static_cast<double>(solver_->profile().steps), 400, 40);
  solver_->reset();
  EXPECT_NEAR(solver_->time_step(), slow, 0.01 * slow);
}

TEST_P(Motion, StepsFollowTissueThatStiffensAfterASearch)
{
  Model model = test::block_model();
  model.time_step_estimate = TimeStepEstimate::assembled;
  const auto solver_ = solver(model), reference = make_solver(std::make_shared<const Model>(model), { "reference" });
  const double seconds = 20 * solver_->time_step();
  Vectors v(model.nodes.size());
  for (std::size_t n = 0; n < v.size(); ++n)
    v[n][0] = -test::rest(model, n)[0] / seconds;
  for (Solver* const each : { solver_.get(), reference.get() })
  {
    each->set_velocities(v);
    each->advance(0.1 * seconds, {});
    const double at_search = each->monitor().critical_time_step;
    each->advance(0.9 * seconds, {});
    EXPECT_LT(each->profile().steps, 25) << "no other search is due";
    EXPECT_LT(each->monitor().critical_time_step, 0.95 * at_search);
  }
  EXPECT_NEAR(solver_->monitor().critical_time_step, reference->monitor().critical_time_step, 1e-7);
}

// A soft block vibrates beside a stiff one at rest, which has the highest frequency. What was measured of the soft one
// before a search that found the same no longer counts as growth.
TEST_P(Motion, GrowthThatASearchDoesNotConfirmIsForgotten)
{
  test::BlockSettings s;
  s.voxels = { { 9, 4, 4 } };
  s.keep = [](std::int32_t i, std::int32_t, std::int32_t) { return i != 4; };
  Model model = test::block_model(s);
  model.time_step_estimate = TimeStepEstimate::assembled;
  model.materials.push_back(model.materials[0]);
  for (double& parameter : model.materials[1].parameters)
    parameter *= 0.6;
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
    model.mixture_material[e] = model.voxels[e][0] > 4 ? 1 : 0;
  const double step = 0.5 * solver(model)->time_step();
  Vectors v(model.nodes.size());
  for (std::size_t n = 0; n < v.size(); ++n)
    if (const double x = test::rest(model, n)[0] - 7e-3; x > -3e-3)
      v[n][0] = -0.012 * x / step;
  const auto each = make_solver(std::make_shared<const Model>(model), { GetParam(), 1, step });
  each->set_velocities(v);
  std::vector<double> critical(10, 1);  // shortest in each series of 400 steps
  for (int plan = 0; plan < 500; ++plan)
  {
    each->advance(8 * step, {});
    double& shortest = critical[plan / 50];
    shortest = std::min(shortest, each->monitor().critical_time_step);
  }
  for (std::size_t series = 5; series < critical.size(); ++series)
    EXPECT_GT(critical[series], 1.05 * critical[0]) << series;
}

TEST_P(Motion, BonesCarryTheirNodes)
{
  test::BlockSettings s;
  s.damping = 2000;
  Model model = test::block_model(s);
  model.bones = { "jaw" };
  test::hold_plane(model, 0, 0);
  const auto solver_ = solver(model);
  RigidTransform pose;
  const double a = 0.3;
  pose.rotation = { { std::cos(a), -std::sin(a), 0, std::sin(a), std::cos(a), 0, 0, 0, 1 } };
  pose.translation = { { 1e-3, 0, 2e-3 } };
  solver_->advance(0.02, Controls{ {}, { pose } });
  settle(*solver_, Controls{ {}, { pose } }, 0.01, 1e-11, s);
  // When the block is at rest again, all of it has moved with the bone.
  Vectors u;
  solver_->displacements(u);
  for (std::size_t n = 0; n < u.size(); ++n)
  {
    const auto X = test::rest(model, n);
    EXPECT_NEAR(u[n][0], std::cos(a) * X[0] - std::sin(a) * X[1] + 1e-3 - X[0], 2e-6);
    EXPECT_NEAR(u[n][1], std::sin(a) * X[0] + std::cos(a) * X[1] - X[1], 2e-6);
    EXPECT_NEAR(u[n][2], 2e-3, 2e-6);
  }
}

TEST_P(Motion, RefusesBadControlsAndKeepsItsState)
{
  Model model = test::block_model();
  Muscle muscle;
  muscle.name = "bar";
  test::add_muscle(model, { { 1, 0, 0 } }, muscle);
  model.bones = { "jaw" };
  model.rigid.push_back({ 0, 0 });
  const auto solver_ = solver(model);
  const Controls good{ { 0.5f }, { {} } };
  solver_->advance(1e-3, good);
  Vectors before, after;
  solver_->displacements(before);
  for (const float bad : { -0.1f, 1.1f, std::nanf("") })
    EXPECT_THROW(solver_->advance(1e-3, Controls{ { bad }, { {} } }), Error);
  EXPECT_THROW(solver_->advance(1e-3, Controls{ {}, { {} } }), Error);
  EXPECT_THROW(solver_->advance(1e-3, Controls{ { 0.5f }, {} }), Error);
  for (const double seconds : { -1.0, std::nan(""), HUGE_VAL })
    EXPECT_THROW(solver_->advance(seconds, good), Error);
  Controls bad = good;
  bad.bone[0].translation[1] = std::nan("");
  EXPECT_THROW(solver_->advance(1e-3, bad), Error);
  bad = good;
  bad.bone[0].rotation[4] = std::nan("");
  EXPECT_THROW(solver_->advance(1e-3, bad), Error);
  bad.bone[0].rotation[4] = -1;  // a reflection
  EXPECT_THROW(solver_->advance(1e-3, bad), Error);
  solver_->displacements(after);
  EXPECT_EQ(before, after);
  EXPECT_DOUBLE_EQ(solver_->time(), 1e-3);
  EXPECT_EQ(solver_->controls().activation, good.activation);
  EXPECT_EQ(solver_->controls().bone[0].translation, good.bone[0].translation);
}

TEST_P(Motion, RefusesATimeStepAboveTheCriticalOne)
{
  const auto model = std::make_shared<const Model>(test::block_model());
  const double critical = make_solver(model, { GetParam(), 0, 0 })->monitor().critical_time_step;
  for (const double refused : { critical * 1.01, -critical, std::nan("") })
    EXPECT_THROW(make_solver(model, { GetParam(), 0, refused }), Error) << refused;
  EXPECT_NO_THROW(make_solver(model, { GetParam(), 0, critical * 0.5 }));
}

TEST_P(Motion, SameInputSameBits)
{
  test::BlockSettings s;
  s.voxels = { { 19, 7, 11 } };
  s.keep = [](int i, int j, int k) { return (i + 2 * j + 3 * k) % 17 != 0; };
  Model model = test::block_model(s);
  Muscle muscle;
  muscle.name = "bar";
  test::add_muscle(model, { { 0, 1, 0 } }, muscle);
  Vectors first;
  for (const int threads : { 1, 2, 4, 2 })
  {
    const auto solver_ = solver(model, threads);
    solver_->advance(5e-3, Controls{ { 0.8f }, {} });
    Vectors u;
    solver_->displacements(u);
    if (first.empty())
      first = u;
    EXPECT_EQ(first, u) << threads << " threads";
  }
}

// The upper planes of nodes are rigid, so that the NaN does not spread over the whole block.
TEST_P(Motion, OneNodeWithoutANumberIsFound)
{
  test::BlockSettings settings;
  settings.voxels = { { 6, 2, 3 } };
  Model model = test::block_model(settings);
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
    if (model.nodes[n][2] >= 2)
      model.rigid.push_back({ static_cast<std::int32_t>(n), -1 });
  const auto solver_ = solver(model);
  Vectors u;
  solver_->displacements(u);
  u[0][1] = std::nan("");
  solver_->set_displacements(u);
  EXPECT_FALSE(solver_->monitor().finite);
  EXPECT_THROW(solver_->advance(5e-3, solver_->controls()), Diverged);
}

FRONTALIS_EVERY_BACKEND(Motion);
