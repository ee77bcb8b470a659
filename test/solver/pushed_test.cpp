// Bodies that forces push into tissue, and bodies that get too deep into tissue.

#include "bodies_touch.hpp"

#include "frontalis/solver/guard.hpp"
#include "solver/stepping/discretisation.hpp"

#include <numeric>

namespace frontalis
{
namespace
{

using namespace test;

// The model block_and_finger() with a finger that moves freely under forces.
Model block_and_pushed_finger(double mass, double spring, double damping)
{
  Model model = block_and_finger(0.3);
  Contact& contact = model.contacts[0];
  contact.centre = { { 4e-3, 4e-3, 8.2e-3 } };
  contact.mass = mass;
  contact.spring = spring;
  contact.damping = damping;
  return model;
}

std::array<double, 3> offset(const Solver& solver)
{
  std::array<double, 3> way = solver.bodies()[0].translation;
  for (std::size_t axis = 0; axis < 3; ++axis)
    way[axis] -= solver.controls().bone[1].translation[axis];
  return way;
}

// A block that flies against a free plate of 40 mg.
Model block_and_free_plate(double friction)
{
  BlockSettings settings;
  settings.voxels = { { 5, 4, 4 } };
  Model model = block_model(settings);
  model.contacts.push_back(touching_side(model, true, plate(4.05e-3, 1)));
  model.contacts[0].mass = 40e-6;
  model.contacts[0].friction = friction;
  return model;
}

TEST_P(BodiesTouch, momentum_goes_over_to_a_body_that_is_pushed)
{
  const Model model = block_and_free_plate(0.4);
  const Discretisation discretisation(model);
  const auto solver = make(model);
  const std::array<double, 3> velocity{ { 0.05, -0.02, 0.3 } };
  solver->set_velocities(Vectors(model.nodes.size(), velocity));
  const auto weighted = [&]
  {
    std::array<double, 3> sum{};
    const Vectors u = displacements(*solver);
    for (std::size_t n = 0; n < u.size(); ++n)
      for (std::size_t axis = 0; axis < 3; ++axis)
        sum[axis] += discretisation.node_mass[n] * u[n][axis];
    return sum;
  };
  solver->advance(4e-3, solver->controls());
  EXPECT_EQ(solver->reactions()[0].force[2], 0);  // block and plate have parted
  const double mass = std::accumulate(discretisation.node_mass.begin(), discretisation.node_mass.end(), 0.0);
  const double initial = mass * 0.3, time = 2e-3;
  const auto block = weighted();
  const auto body = solver->bodies()[0].translation;
  solver->advance(time, solver->controls());
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    const double of_block = (weighted()[axis] - block[axis]) / time;
    const double of_body = 40e-6 * (solver->bodies()[0].translation[axis] - body[axis]) / time;
    EXPECT_NEAR(of_block + of_body, mass * velocity[axis], 1e-5 * initial) << axis;
    if (axis == 2)
    {
      EXPECT_GT(of_body, 0.3 * initial);
    }
  }
}

// The ledger has the work of the tissue on a body, which is the body's kinetic energy.
TEST_P(BodiesTouch, work_goes_over_to_a_body_that_is_pushed)
{
  const Model model = block_and_free_plate(0);
  const auto solver = make(model, 2, true);
  solver->set_velocities(Vectors(model.nodes.size(), { { 0, 0, 0.3 } }));
  const double initial = mechanical(solver->ledger());
  solver->advance(4e-3, solver->controls());
  EXPECT_EQ(solver->reactions()[0].force[2], 0);  // block and plate have parted
  const double before = solver->bodies()[0].translation[2], time = 1e-3;
  solver->advance(time, solver->controls());
  const double speed = (solver->bodies()[0].translation[2] - before) / time;
  const double gained = 0.5 * 40e-6 * speed * speed;
  EXPECT_GT(gained, 0.1 * initial);
  EXPECT_NEAR(solver->ledger()["contact"], -gained, 1e-4 * gained);
  EXPECT_NEAR(mechanical(solver->ledger()), initial - gained, 0.02 * initial);
}

// A body brings in the energy of its force, and what it has already.
TEST_P(BodiesTouch, the_guard_leaves_a_body_alone_that_is_pushed)
{
  for (const double spring : { 0.0, 20.0 })
  {
    Model made = block_and_pushed_finger(10e-3, spring, 0);
    made.contacts[0].force = { { 0, 0, -0.1 } };
    const auto model = std::make_shared<const Model>(made);
    const auto solver = make_solver(model, { GetParam(), 2 });
    GuardSettings settings;
    settings.interval = 64;
    Guard guard(*solver, model, settings);
    for (int part = 0; part < 8; ++part)
      guard.advance(5e-3, solver->controls());
    EXPECT_GT(guard.counts().checks, 8);
    EXPECT_EQ(guard.counts().rollbacks, 0) << words_for(guard.counts().latest);
    EXPECT_GT(guard.latest().bodies, 0);
  }
}

// A finger moves beside a thumb that rests.
TEST_P(BodiesTouch, the_guard_knows_each_of_two_bones_that_touch_the_same_tissue)
{
  Model made = block_and_finger(0);
  made.bones.push_back("thumb");
  Contact thumb = touching_side(made, true, sphere_field({ { 4e-3, 4e-3, 13e-3 } }, 4e-3));
  thumb.bone = 2;
  made.contacts.push_back(thumb);
  const auto model = std::make_shared<const Model>(made);
  const auto solver = make_solver(model, { GetParam(), 2 });
  GuardSettings settings;
  settings.interval = 16;
  Guard guard(*solver, model, settings);
  Controls controls = solver->controls();
  for (int part = 1; part <= 4; ++part)
  {
    controls.bone[1] = rigid_motion({ { 0, 0, 0 } }, { { 0, 0, -0.4e-3 * part } });
    guard.advance(1e-3, controls);
  }
  EXPECT_EQ(guard.counts().rollbacks, 0) << words_for(guard.counts().latest);
  EXPECT_GT(std::abs(solver->reactions()[0].force[2]), 1e-3);
}

// An effect that is switched off forgets: the body is back at its bone, at rest.
TEST_P(BodiesTouch, a_pushed_body_starts_anew_when_contact_is_switched_on)
{
  const Model model = block_and_pushed_finger(2e-3, 200, 0.5);
  const auto solver = make(model);
  press_and_stroke(*solver, 4e-3);
  const auto farthest = [&]
  {
    double most = 0;
    for (const double way : offset(*solver))
      most = std::max(most, std::abs(way));
    return most;
  };
  EXPECT_GT(farthest(), 1e-5);
  solver->switch_effect(Effect::contact, false);
  EXPECT_EQ(farthest(), 0);
  solver->advance(1e-3, solver->controls());
  EXPECT_EQ(farthest(), 0);
  solver->switch_effect(Effect::contact, true);
  EXPECT_EQ(farthest(), 0);
  solver->advance(1e-3, solver->controls());
  EXPECT_GT(farthest(), 1e-7);
}

TEST_P(BodiesTouch, a_pushed_body_comes_to_rest_where_its_forces_balance)
{
  // The finger is pushed by a constant force.
  Model model = block_and_pushed_finger(2e-3, 0, 0.5);
  model.contacts[0].force = { { 0, 0, -0.02 } };
  auto solver = make(model);
  solver->advance(0.4, solver->controls());
  EXPECT_NEAR(solver->reactions()[0].force[2], 0.02, 0.01 * 0.02);

  // A spring pulls the finger to its bone, which moves down. The origin of the bone's motion is elsewhere.
  model = block_and_pushed_finger(2e-3, 40, 0.5);
  solver = make(model);
  Controls controls = solver->controls();
  controls.bone[1] = rigid_motion({ { 0, 0.02, 0 } }, { { 0, 0, -1e-3 } });
  solver->advance(20e-3, controls);
  solver->advance(0.4, controls);
  for (const std::size_t axis : { 0, 2 })
    EXPECT_NEAR(solver->reactions()[0].force[axis], 40 * offset(*solver)[axis], 1e-4) << axis;
  EXPECT_GT(offset(*solver)[2], 0.1e-3);
  EXPECT_EQ(solver->bodies()[0].rotation, controls.bone[1].rotation);
}

TEST_P(BodiesTouch, a_pushed_body_goes_on_with_the_same_bits)
{
  const Model model = block_and_pushed_finger(2e-3, 200, 0.5);
  const auto solver = make(model), other = make(model, 3);
  for (Solver* const one : { solver.get(), other.get() })
    press_and_stroke(*one, 10e-3);
  EXPECT_EQ(displacements(*solver), displacements(*other));
  std::unique_ptr<Snapshot> snapshot;
  solver->save(snapshot);
  press_and_stroke(*solver, 4e-3);
  const Vectors expected = displacements(*solver);
  const RigidTransform body = solver->bodies()[0];
  solver->restore(*snapshot);
  press_and_stroke(*solver, 4e-3);
  EXPECT_EQ(displacements(*solver), expected);
  EXPECT_EQ(solver->bodies()[0].translation, body.translation);
  solver->reset();
  EXPECT_EQ(solver->bodies()[0].translation, RigidTransform().translation);
}

// A body with little mass compared with the stiffness of contact shortens the time step; the motion stays stable.
TEST_P(BodiesTouch, a_light_body_is_pushed_in_short_steps)
{
  Model light = block_and_pushed_finger(0.5e-6, 40, 0), heavy = block_and_pushed_finger(2e-3, 40, 0);
  light.damping = heavy.damping = 0;
  const auto solver = make(light), other = make(heavy);
  for (Solver* const one : { solver.get(), other.get() })
    press_and_stroke(*one, 4e-3);
  EXPECT_GT(solver->profile().steps, 2 * other->profile().steps);
  for (int i = 0; i < 20; ++i)
  {
    solver->advance(0.5e-3, solver->controls());
    for (const double way : offset(*solver))
      EXPECT_LT(std::abs(way), 2e-3);
  }
}

// The field of this plate has samples up to 0.3 mm below its surface.
TEST_P(BodiesTouch, tissue_deep_inside_of_a_body_is_reported)
{
  Model model = block_and_finger(0);
  model.contacts[0].field = sample_band(
      { { -1e-3, -1e-3, 4.2e-3 } }, { { 11e-3, 9e-3, 4.3e-3 } }, [](const auto& p) { return 4.2e-3 - p[2]; }, 0.05e-3,
      0.2e-3);
  model.contacts[0].reach = 0.2e-3;
  const auto shared = std::make_shared<const Model>(model);
  const auto solver = make_solver(shared, { GetParam(), 2 });
  Guard guard(*solver, shared);
  Controls controls = solver->controls();
  controls.bone[1].translation[2] = -2.5e-3;
  std::string report;
  try
  {
    for (int i = 0; i < 50; ++i)
    {
      guard.advance(1e-3, controls);
      guard.check();
    }
  }
  catch (const Unstable& why)
  {
    EXPECT_EQ(why.report.kind, Instability::inside_body);
    report = why.what();
  }
  EXPECT_NE(report.find("press less deep"), std::string::npos) << report;
}

FRONTALIS_EVERY_BACKEND(BodiesTouch);

}  // namespace
}  // namespace frontalis
