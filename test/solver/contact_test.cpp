// Tissue that touches rigid bodies: forces and motion.

#include "bodies_touch.hpp"

#include "solver/stepping/discretisation.hpp"

namespace frontalis
{
namespace
{

using namespace test;

// Under a pressure of 5 % of Young's modulus.
TEST_P(BodiesTouch, a_plate_presses_evenly_and_hardly_goes_in)
{
  BlockSettings settings;
  settings.voxels = { { 5, 4, 4 } };
  settings.damping = 3000;
  for (const double poisson : { 0.3, 0.49 })
  {
    settings.poisson = poisson;
    Model model = block_model(settings);
    Load floor;
    floor.kind = Load::Kind::displacement;
    floor.fixed = { { false, false, true } };
    model.loads.push_back(floor);
    for (std::size_t n = 0; n < model.nodes.size(); ++n)
      if (model.nodes[n][2] == 0)
        model.prescribed.push_back({ static_cast<std::int32_t>(n), 0 });
    model.bones = { "plate" };
    model.contacts.push_back(touching_side(model, true, plate(4e-3, 1)));
    model.contacts[0].bone = 0;
    const auto solver = make(model);
    Controls controls = solver->controls();
    controls.bone[0].translation[2] = -0.206e-3;
    solver->advance(0.02, controls);
    for (int i = 0; i < 8; ++i)
      solver->advance(0.02, controls);
    const double pressure = solver->reactions()[0].force[2] / 20e-6;
    EXPECT_NEAR(pressure, 0.05 * settings.young, 0.1 * 0.05 * settings.young);
    const Vectors u = displacements(*solver);
    double least = 1, most = 0;
    for (std::size_t n = 0; n < u.size(); ++n)
      if (model.nodes[n][2] == 4)
      {
        least = std::min(least, u[n][2] + 0.206e-3);
        most = std::max(most, u[n][2] + 0.206e-3);
      }
    EXPECT_LT(most, 0.02e-3);
    EXPECT_LT(most - least, 0.05 * most);
    // pressure and penetration satisfy the contact law
    EXPECT_NEAR(0.5 * (most + least) * 3.5 * settings.young / 1e-3, pressure, 0.03 * pressure);
  }
}

Model falling_block(double gap)
{
  BlockSettings settings;
  settings.voxels = { { 5, 4, 4 } };
  Model model = block_model(settings);
  model.contacts.push_back(touching_side(model, false, plate(-gap, -1)));
  return model;
}

TEST_P(BodiesTouch, an_impact_keeps_the_energy)
{
  const Model model = falling_block(0.1e-3);
  const auto solver = make(model, 2, true);
  solver->set_velocities(Vectors(model.nodes.size(), { { 0.05, 0, -0.3 } }));
  const double initial = solver->ledger().initial;
  double stored = 0, least = initial, most = initial;
  for (int slice = 0; slice < 60; ++slice)
  {
    solver->advance(0.1e-3, solver->controls());
    const EnergyLedger ledger = solver->ledger();
    stored = std::max(stored, ledger["contact_stored"]);
    least = std::min(least, mechanical(ledger));
    most = std::max(most, mechanical(ledger));
    EXPECT_LT(std::abs(ledger.imbalance()), 0.02 * initial);
  }
  EXPECT_GT(stored, 0.01 * initial);
  EXPECT_GT(least, 0.98 * initial);
  EXPECT_LT(most, 1.02 * initial);
  EXPECT_EQ(solver->reactions()[0].force[2], 0);
  EXPECT_GT(mean(displacements(*solver), 2), 0.05e-3);  // the block has bounced off
}

// The reaction is the opposite of the rate of change of momentum, its moment that of angular momentum. The plate is
// rough and the block arrives obliquely, so that all components of both differ from zero.
TEST_P(BodiesTouch, what_a_body_gets_the_tissue_loses)
{
  Model model = falling_block(1e-6);
  model.contacts[0].friction = 0.4;
  const Discretisation discretisation(model);
  const double dt = 2e-6;
  const auto solver = make(model, 2, false, dt);
  Vectors v(model.nodes.size());
  for (std::size_t n = 0; n < v.size(); ++n)
    v[n] = { { 0.1 + 10 * rest(model, n)[1], -0.05, -0.3 - 20 * rest(model, n)[0] } };
  solver->set_velocities(v);
  std::array<double, 6> gained{}, lost{};
  Vectors before = displacements(*solver), velocity = v;
  for (int step = 0; step < 600; ++step)
  {
    solver->advance(dt, solver->controls());
    const Reaction reaction = solver->reactions()[0];
    const Vectors after = displacements(*solver);
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      gained[axis] += dt * reaction.force[axis];
      gained[3 + axis] += dt * reaction.moment[axis];
    }
    for (std::size_t n = 0; n < v.size(); ++n)
    {
      std::array<double, 3> change{}, place{};
      for (std::size_t axis = 0; axis < 3; ++axis)
      {
        const double now = (after[n][axis] - before[n][axis]) / dt;
        change[axis] = discretisation.node_mass[n] * (velocity[n][axis] - now);
        place[axis] = rest(model, n)[axis] + before[n][axis];
        velocity[n][axis] = now;
      }
      for (std::size_t axis = 0; axis < 3; ++axis)
      {
        const std::size_t j = (axis + 1) % 3, k = (axis + 2) % 3;
        lost[axis] += change[axis];
        lost[3 + axis] += place[j] * change[k] - place[k] * change[j];
      }
    }
    before = after;
  }
  for (std::size_t i = 0; i < 6; ++i)
  {
    EXPECT_GT(std::abs(lost[i]), i < 3 ? 1e-7 : 1e-10) << i;
    EXPECT_NEAR(gained[i], lost[i], 0.01 * std::abs(lost[i])) << i;
  }
}

TEST_P(BodiesTouch, a_block_sticks_below_the_angle_of_friction_and_slides_above_it)
{
  // the angle of friction is 26.6 degrees; gravity starts suddenly, and the block bounces until it has settled
  const double friction = 0.5, damping = 50, gravity = 9.81, settling = 0.15, time = 0.05;
  const auto on_incline = [&](double degrees)
  {
    BlockSettings settings;
    settings.voxels = { { 6, 4, 2 } };
    settings.damping = damping;
    Model model = block_model(settings);
    model.contacts.push_back(touching_side(model, false, plate(0, -1)));
    model.contacts[0].friction = friction;
    model.gravity = { { gravity * std::sin(degrees * degree), 0, -gravity * std::cos(degrees * degree) } };
    auto solver = make(model);
    solver->advance(settling, {});
    return solver;
  };
  const auto way = [&](Solver& solver)
  {
    const double begin = mean(displacements(solver), 0);
    solver.advance(time, {});
    return mean(displacements(solver), 0) - begin;
  };
  EXPECT_LT(std::abs(way(*on_incline(22))), 1e-6);
  for (const double degrees : { 35.0, 60.0 })
  {
    // damping c, acceleration a: if the block moves by w in a time t, it moves by q w + a t (1 - q) / c in the next t,
    // with q = exp(-c t)
    const auto solver = on_incline(degrees);
    const double first = way(*solver), second = way(*solver), q = std::exp(-damping * time);
    const double acceleration = damping * (second - q * first) / (time * (1 - q));
    const double expected = gravity * (std::sin(degrees * degree) - friction * std::cos(degrees * degree));
    EXPECT_NEAR(acceleration, expected, 0.01 * expected) << degrees;
  }
}

TEST_P(BodiesTouch, the_ledger_closes_over_a_stroke)
{
  for (const double friction : { 0.0, 0.4 })
  {
    const auto solver = make(block_and_finger(friction), 2, true);
    press_and_stroke(*solver, 40e-3);
    const EnergyLedger ledger = solver->ledger();
    EXPECT_GT(ledger["contact"], 0.3 * ledger.largest);
    EXPECT_GT(ledger["contact_stored"], 0);
    if (friction > 0)
      EXPECT_GT(ledger["friction"], 0.02 * ledger.largest);
    else
      EXPECT_EQ(ledger["friction"], 0);
    EXPECT_LT(std::abs(ledger.imbalance()), 0.01 * ledger.largest) << friction;
  }
}

TEST_P(BodiesTouch, samples_of_a_sphere_act_as_the_sphere)
{
  const auto exact = make(block_and_finger(0.4)), sampled = make(block_and_finger(0.4, true));
  for (Solver* const solver : { exact.get(), sampled.get() })
    press_and_stroke(*solver, 40e-3);
  for (std::size_t axis : { 0, 2 })
  {
    const double expected = exact->reactions()[0].force[axis];
    EXPECT_GT(std::abs(expected), 1e-3);
    EXPECT_NEAR(sampled->reactions()[0].force[axis], expected, 0.03 * std::abs(expected)) << axis;
  }
}

// The solver skips points that are far from a body, but must notice a body that approaches at a high speed.
TEST_P(BodiesTouch, a_body_that_comes_from_far_is_met)
{
  const auto near = make(block_and_finger(0)), far = make(block_and_finger(0));
  Controls controls = far->controls();
  controls.bone[1].translation[2] = 60e-3;
  far->advance(1e-3, controls);
  controls.bone[1] = rigid_motion({ { 0, 3, 0 } }, { { 20e-3, 0, 30e-3 } });
  far->advance(4e-3, controls);
  for (Solver* const solver : { near.get(), far.get() })
  {
    controls.bone[1] = RigidTransform();
    solver->advance(2e-3, controls);
    EXPECT_EQ(solver->reactions()[0].force[2], 0);
    controls.bone[1].translation[2] = -1e-3;
    solver->advance(10e-3, controls);
    solver->advance(50e-3, controls);
  }
  const double expected = near->reactions()[0].force[2];
  EXPECT_GT(expected, 0.01);
  EXPECT_NEAR(far->reactions()[0].force[2], expected, 1e-3 * expected);
}

// The edge of a wedge jumps into the tissue by a voxel and out again, after which the tissue returns to its shape.
TEST_P(BodiesTouch, a_sharp_edge_jumps_in_and_comes_out)
{
  Model model = block_and_finger(0.3);
  const auto distance = [](const std::array<double, 3>& p)
  {
    // a wedge along y whose edge is 0.2 mm above the tissue
    const double x = std::abs(p[0] - 5.2e-3), z = p[2] - 4.2e-3;
    return z < -x ? std::hypot(x, z) : (x - z) * std::sqrt(0.5);
  };
  model.contacts[0].field =
      sample_band({ { 2e-3, -1e-3, 4.2e-3 } }, { { 8e-3, 9e-3, 7.2e-3 } }, distance, 0.5e-3, 2e-3);
  model.contacts[0].reach = 2e-3;
  model.damping = 500;
  const auto solver = make(model);
  Controls controls = solver->controls();
  controls.bone[1].translation[2] = -1.2e-3;
  solver->advance(20e-6, controls);
  solver->advance(20e-3, controls);
  const Monitor pressed = solver->monitor();
  EXPECT_GT(solver->reactions()[0].force[2], 0.01);
  EXPECT_GT(pressed.internal, 1e-6);
  EXPECT_EQ(pressed.inverted, 0);
  controls.bone[1] = RigidTransform();
  solver->advance(1e-3, controls);
  solver->advance(0.2, controls);
  EXPECT_EQ(solver->reactions()[0].force[2], 0);
  EXPECT_LT(solver->monitor().internal, 1e-4 * pressed.internal);
}

FRONTALIS_HOST_BACKENDS(BodiesTouch);

}  // namespace
}  // namespace frontalis
