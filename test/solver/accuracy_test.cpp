#include "backends.hpp"
#include "block_model.hpp"

#include "frontalis/error.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

using Vectors = std::vector<std::array<double, 3>>;

Model cantilever(std::int32_t thick, double poisson)
{
  test::BlockSettings settings;
  settings.voxels = { { 10 * thick, thick, thick } };
  const double edge = 10e-3 / thick;
  settings.spacing = { { edge, edge, edge } };
  settings.poisson = poisson;
  Model model = test::block_model(settings);
  test::hold_plane(model, 0);
  model.gravity = { { 0, 0, -0.05 } };
  return model;
}

double tip(const Solver& solver, const Model& model)
{
  Vectors u;
  solver.displacements(u);
  double sum = 0, count = 0;
  for (std::size_t n = 0; n < u.size(); ++n)
    if (model.nodes[n][0] == model.size[0])
    {
      sum += u[n][2];
      ++count;
    }
  return sum / count;
}

class Accuracy : public test::EveryBackend
{
};

// A weight w per length deflects the tip by w L^4 / (8 E I) = 3 rho g L^4 / (2 E h^2); shear adds a little.
TEST_P(Accuracy, selective_reduced_integration_bends_and_does_not_lock)
{
  for (const double poisson : { 0.3, 0.49 })
  {
    Model model = cantilever(2, poisson);
    model.integration = Integration::selective_reduced;
    const auto solver = make_solver(std::make_shared<const Model>(model), { GetParam(), 0, 0 });
    const Equilibrium found = solver->settle({}, 1e-3, 20);
    EXPECT_TRUE(found.reached) << found.residual << " left after " << found.seconds << " s";
    const double exact = -1.5 * 1000 * 0.05 * std::pow(0.1, 4) / (34e3 * 1e-4);
    // Full integration of two linear elements through the thickness is stiff in bending, but far from locked.
    EXPECT_GT(tip(*solver, model) / exact, 0.6) << poisson;
    EXPECT_LT(tip(*solver, model) / exact, 1.02) << poisson;
  }
}

TEST_P(Accuracy, equilibrium_is_that_of_a_damped_run)
{
  Model model = cantilever(2, 0.45);
  const auto settled = solver(model);
  const Equilibrium found = settled->settle({}, 1e-3, 60);
  EXPECT_TRUE(found.reached) << found.residual;
  model.damping = 5;
  const auto damped = solver(model);
  damped->advance(6, {});
  EXPECT_NEAR(tip(*settled, model) / tip(*damped, model), 1, 5e-3);
}

TEST_P(Accuracy, equilibrium_out_of_reach_is_told)
{
  const auto swinging = solver(cantilever(2, 0.45));
  const Equilibrium found = swinging->settle({}, 1e-9, 0.01);
  EXPECT_FALSE(found.reached);
  EXPECT_GT(found.residual, 1e-9);
  EXPECT_THROW(swinging->settle({}, 0, 1), Error);
}

TEST_P(Accuracy, a_stiff_layer_among_soft_ones_steps_longer_by_the_assembled_bound)
{
  test::BlockSettings settings;
  settings.voxels = { { 6, 6, 6 } };
  Model model = test::block_model(settings);
  Material tendon = model.materials[0];
  tendon.parameters = { { 700 * tendon.parameters[0], 700 * tendon.parameters[1] } };
  model.materials.push_back(tendon);
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
    model.mixture_material[e] = model.voxels[e][2] == 3 ? 1 : 0;
  const auto element = solver(model);
  model.time_step_estimate = TimeStepEstimate::assembled;
  const auto assembled = solver(model);
  const double before = assembled->time_step();
  EXPECT_EQ(before, element->time_step()) << "known before anything is assembled";
  Vectors v(model.nodes.size());
  for (std::size_t n = 0; n < v.size(); ++n)
    v[n] = { { 0, 0, std::sin(2.0 * static_cast<double>(n)) } };
  assembled->set_velocities(v);
  assembled->advance(200 * before, {});
  EXPECT_GT(assembled->time_step() / before, 1.1);
  model.time_step_estimate = TimeStepEstimate::element;
  for (auto& material : model.mixture_material)
    material = 1;
  EXPECT_GT(before / solver(model)->time_step(), 1.3) << "a layer one voxel thick has half its nodes' mass from others";
  const double early = assembled->monitor().kinetic;
  assembled->advance(20000 * before, {});
  EXPECT_LT(assembled->monitor().kinetic, 2 * early) << "and is stable";
}

// Mass scaling adds mass to a stiff voxel among soft ones until the wanted time step is allowed. The weight stays the
// same.
TEST_P(Accuracy, mass_scaling_up_to_a_wanted_time_step_leaves_weight_alone)
{
  Model model = cantilever(2, 0.45);
  model.materials.push_back(model.materials[0]);
  for (double& parameter : model.materials[1].parameters)
    parameter *= 9;
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
    model.mixture_material[e] = model.voxels[e][0] < 2 ? 1 : 0;
  const auto plain = solver(model);
  model.mass_scaling.kind = MassScalingSettings::Kind::selective;
  model.mass_scaling.time_step = 2.5 * plain->time_step();
  const auto scaled = solver(model);
  EXPECT_NEAR(scaled->time_step() / model.mass_scaling.time_step, 1, 1e-6);
  model.mass_scaling = {};
  model.mass_scaling.kind = MassScalingSettings::Kind::uniform;
  model.mass_scaling.factor = 4;
  const auto uniform = solver(model);
  EXPECT_NEAR(uniform->time_step() / plain->time_step(), 2, 1e-6);
  EXPECT_TRUE(plain->settle({}, 1e-3, 30).reached);
  for (const auto& heavier : { scaled.get(), uniform.get() })
  {
    EXPECT_TRUE(heavier->settle({}, 1e-3, 60).reached);
    EXPECT_NEAR(tip(*heavier, model) / tip(*plain, model), 1, 5e-3);
  }
}

TEST_P(Accuracy, muscles_answer_with_their_rise_and_fall_times)
{
  test::BlockSettings settings;
  settings.voxels = { { 2, 2, 2 } };
  Model model = test::block_model(settings);
  Muscle muscle;
  muscle.name = "slow";
  muscle.stress_reference = 1e3;
  muscle.rise_time = 0.01;
  muscle.fall_time = 0.03;
  test::add_muscle(model, { { 1, 0, 0 } }, muscle);
  const auto s = solver(model);
  s->advance(1e-9, { { 1 }, {} });
  s->advance(0.01, { { 1 }, {} });
  EXPECT_NEAR(s->activation()[0], 1 - std::exp(-1.0), 2e-3);
  EXPECT_EQ(s->controls().activation[0], 1);
  const float reached = s->activation()[0];
  s->advance(1e-9, { { 0 }, {} });
  s->advance(0.03, { { 0 }, {} });
  EXPECT_NEAR(s->activation()[0] / reached, std::exp(-1.0), 2e-3);
}

TEST_P(Accuracy, activation_changes_no_faster_than_its_slew_limit)
{
  test::BlockSettings settings;
  settings.voxels = { { 2, 2, 2 } };
  Model model = test::block_model(settings);
  Muscle muscle;
  muscle.name = "quick";
  muscle.stress_reference = 1e3;
  test::add_muscle(model, { { 1, 0, 0 } }, muscle);
  const auto free = solver(model);
  free->advance(1e-9, { { 1 }, {} });
  EXPECT_EQ(free->activation()[0], 1);
  model.activation_slew = 10;
  const auto s = solver(model);
  s->advance(1e-9, { { 1 }, {} });
  s->advance(0.03, { { 1 }, {} });
  EXPECT_NEAR(s->activation()[0], 0.3, 1e-5);
  EXPECT_EQ(s->controls().activation[0], 1);
  s->advance(0.1, { { 1 }, {} });
  EXPECT_EQ(s->activation()[0], 1);
  s->advance(1e-9, { { 0.2f }, {} });
  s->advance(0.05, { { 0.2f }, {} });
  EXPECT_NEAR(s->activation()[0], 0.5, 1e-5);
  s->advance(0.05, { { 0.2f }, {} });
  EXPECT_EQ(s->activation()[0], 0.2f);
}

FRONTALIS_EVERY_BACKEND(Accuracy);

// Creep of 0.2 um/s in steps of 2 us is lost in single precision, but not in compensated and double precision.
TEST(Precision, slow_motion_far_from_rest_is_kept_by_compensation)
{
  test::BlockSettings settings;
  settings.voxels = { { 4, 2, 2 } };
  settings.young = 300;
  Model model = test::block_model(settings);
  const double speed = 2e-7;
  Vectors far(model.nodes.size(), { { 4e-3, 0, 0 } }), slow(model.nodes.size(), { { speed, 0, 0 } });
  const auto lost = [&](Precision precision)
  {
    model.precision = precision;
    const auto solver = make_solver(std::make_shared<const Model>(model), { "cpu", 1, 2e-6 });
    solver->set_displacements(far);
    solver->set_velocities(slow);
    solver->advance(0.5, {});
    Vectors u;
    solver->displacements(u);
    double mean = 0;
    for (const auto& p : u)
      mean += p[0] / static_cast<double>(u.size());
    return std::abs(mean - 4e-3 - 0.5 * speed) / (0.5 * speed);
  };
  EXPECT_GT(lost(Precision::single), 0.5);
  EXPECT_LT(lost(Precision::compensated), 0.02);
  EXPECT_LT(lost(Precision::double_precision), 1e-6);
}

TEST(Precision, double_agrees_with_the_reference)
{
  Model model = cantilever(2, 0.49);
  model.gravity = { { 0, 0, -1 } };
  model.precision = Precision::double_precision;
  Vectors a, b;
  for (const auto form : { HourglassControl::scalar, HourglassControl::assumed_strain })
  {
    model.hourglass = form;
    const auto shared = std::make_shared<const Model>(model);
    const auto fast = make_solver(shared, { "cpu", 2, 0 });
    const auto plain = make_solver(shared, { "reference", 0, 0 });
    fast->advance(0.02, {});
    plain->advance(0.02, {});
    fast->displacements(a);
    plain->displacements(b);
    double largest = 0, difference = 0;
    for (std::size_t n = 0; n < a.size(); ++n)
      for (int axis = 0; axis < 3; ++axis)
      {
        largest = std::max(largest, std::abs(b[n][axis]));
        difference = std::max(difference, std::abs(a[n][axis] - b[n][axis]));
      }
    EXPECT_LT(difference, 1e-5 * largest);
  }
}

}  // namespace
}  // namespace frontalis
