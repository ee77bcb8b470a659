// Forces of rigid bodies that tissue touches. Pressure, impact, wrench and friction are cases of `frontalis verify`.

#include "bodies_touch.hpp"

namespace frontalis
{
namespace
{

using namespace test;

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

// Friction depends on the history of each point. The plate is a sphere with a radius of 1 km, which is nearly flat.
// With fibres, the kernel that finds their stress in strips on a GPU finds the forces of contact as well.
TEST_P(BodiesTouch, forces_and_friction_are_those_of_the_reference)
{
  for (const bool flat : { false, true })
  {
    Model model = block_and_finger(0.4);
    if (flat)
      model.contacts[0].field = plate(4.2e-3, 1);
    else
    {
      Muscle muscle;
      muscle.name = "muscle";
      muscle.stress_reference = 2e3;
      add_muscle(model, { { 1, 0, 0 } }, muscle);
    }
    const double time_step = 0.9 * make(model)->time_step();
    const auto found = make(model, 2, true, time_step);
    const auto expected = make_solver(std::make_shared<const Model>(model), { "reference", 1, time_step, true });
    for (Solver* const solver : { found.get(), expected.get() })
    {
      Controls controls = solver->controls();
      std::fill(controls.activation.begin(), controls.activation.end(), 0.5F);
      solver->advance(1e-3, controls);
      press_and_stroke(*solver, 20e-3);
    }
    const std::array<double, 3> force = expected->reactions()[0].force;
    for (std::size_t axis : { 0, 2 })
    {
      EXPECT_GT(std::abs(force[axis]), 1e-3);
      EXPECT_NEAR(found->reactions()[0].force[axis], force[axis], 2e-3 * std::abs(force[axis])) << flat << axis;
    }
    const double lost = expected->ledger()["friction"];
    EXPECT_NEAR(found->ledger()["friction"], lost, 5e-3 * lost) << flat;
  }
}

// The solver skips points that are far from a body, but must notice a body that approaches at a high speed.
TEST_P(BodiesTouch, a_body_without_points_does_nothing)
{
  Model model = block_and_finger(0);
  model.time_step_estimate = TimeStepEstimate::assembled;
  Contact& shown = model.contacts[0];
  shown.points.clear();
  shown.area.clear();
  shown.binding = {};
  Model without = model;
  without.contacts.clear();
  const auto solver = make(model), other = make(without);
  for (Solver* const one : { solver.get(), other.get() })
    one->advance(1e-3, one->controls());
  EXPECT_EQ(displacements(*solver), displacements(*other));
}

TEST_P(BodiesTouch, a_body_that_comes_from_far_is_met)
{
  const auto near = make(block_and_finger(0)), far = make(block_and_finger(0));
  Controls controls = far->controls();
  controls.bone[1].translation[2] = 60e-3;
  far->advance(10e-3, controls);
  controls.bone[1] = rigid_motion({ { 0, 3, 0 } }, { { 20e-3, 0, 30e-3 } });
  far->advance(40e-3, controls);
  for (Solver* const solver : { near.get(), far.get() })
  {
    controls.bone[1] = RigidTransform();
    solver->advance(20e-3, controls);
    EXPECT_EQ(solver->reactions()[0].force[2], 0);
    controls.bone[1].translation[2] = -1e-3;
    solver->advance(10e-3, controls);
    solver->advance(50e-3, controls);
  }
  const double expected = near->reactions()[0].force[2];
  EXPECT_GT(expected, 0.01);
  EXPECT_NEAR(far->reactions()[0].force[2], expected, 1e-3 * expected);
}

// A point far outside of its voxel moves many times as far as the voxel's nodes, and must be evaluated as early.
TEST_P(BodiesTouch, a_point_far_outside_its_voxel_is_met)
{
  Model model = block_and_finger(0);
  Contact& contact = model.contacts[0];
  const std::size_t p = contact.points.size() / 2;
  contact.points = { contact.points[p] };
  contact.points[0][2] += 20 * model.spacing[2];
  contact.area = { contact.area[p] };
  contact.binding = { { contact.binding.voxel[p] }, { contact.binding.coordinates[p] } };
  contact.binding.coordinates[0][2] = 21;
  contact.field = plate(contact.points[0][2] + 1e-3, 1);
  const auto solver = make(model);
  // The upper plane of the voxel moves upwards and carries the point with it, 21 times as fast.
  Vectors v(model.nodes.size());
  for (std::size_t n = 0; n < v.size(); ++n)
    v[n][2] = model.nodes[n][2] == model.size[2] ? 5 : 0;
  solver->set_velocities(v);
  double z = 0;
  for (int step = 0; step < 100 && z < 1.1e-3; ++step)
  {
    EXPECT_EQ(solver->reactions()[0].force[2], 0);
    solver->advance(10e-6, solver->controls());
    const Vectors u = displacements(*solver);
    const auto& nodes = model.voxel_nodes[contact.binding.voxel[0]];
    z = 0;
    for (int corner = 0; corner < 4; ++corner)
      z += (21 * u[nodes[corner + 4]][2] - 20 * u[nodes[corner]][2]) / 4;
  }
  EXPECT_GT(z, 1.1e-3);
  solver->advance(20e-6, solver->controls());
  EXPECT_NE(solver->reactions()[0].force[2], 0);
}

// The edge of a wedge jumps into the tissue by a voxel and out again. The tissue then returns to its shape.
TEST_P(BodiesTouch, a_sharp_edge_jumps_in_and_comes_out)
{
  Model model = block_and_finger(0.3);
  const auto distance = [](const std::array<double, 3>& p)
  {
    // A wedge along y whose edge is 0.2 mm above the tissue.
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

FRONTALIS_EVERY_BACKEND(BodiesTouch);

}  // namespace
}  // namespace frontalis
