#include "backends.hpp"
#include "effect_scene.hpp"
#include "nodal_vectors.hpp"

#include <cmath>

namespace frontalis
{
namespace
{

using test::Vectors;

class Monitors : public test::EveryBackend
{
};

TEST_P(Monitors, agree_with_the_reference)
{
  for (const auto hourglass : { HourglassControl::scalar, HourglassControl::assumed_strain })
    for (const auto integration : { Integration::one_point, Integration::selective_reduced })
      for (const double size : { 1e-7, 2e-4 })
      {
        const Model model = test::scene_of(test::but_friction, hourglass, integration);
        Monitor seen[2];
        for (const bool own : { false, true })
        {
          const auto solver = make_solver(std::make_shared<const Model>(model), { own ? GetParam() : "reference", 2 });
          solver->set_displacements(test::random_vectors(model, size, 1));
          auto velocities = test::random_vectors(model, 0.1, 2);
          // A backend may omit nodes that cannot move.
          for (const auto& node : model.rigid)
            velocities[node.node] = { 0, 0, 0 };
          solver->set_velocities(velocities);
          seen[own] = solver->monitor();
        }
        EXPECT_NEAR(seen[1].kinetic, seen[0].kinetic, 1e-5 * seen[0].kinetic);
        EXPECT_NEAR(seen[1].internal, seen[0].internal, 1e-5 * seen[0].internal);
        EXPECT_NEAR(seen[1].hourglass, seen[0].hourglass, 1e-5 * seen[0].hourglass);
        EXPECT_NEAR(seen[1].worst_jacobian, seen[0].worst_jacobian, 1e-6);
        EXPECT_NEAR(seen[1].critical_time_step, seen[0].critical_time_step, 1e-5 * seen[0].critical_time_step);
        EXPECT_EQ(seen[1].worst_voxel, seen[0].worst_voxel);
        EXPECT_EQ(seen[1].stiffest_voxel, seen[0].stiffest_voxel);
        EXPECT_EQ(seen[1].inverted, seen[0].inverted);
        EXPECT_TRUE(seen[1].finite);
      }
}

TEST_P(Monitors, find_voxels_inside_out_and_numbers_that_are_none)
{
  test::BlockSettings settings;
  settings.voxels = { { 20, 4, 4 } };
  const Model model = test::block_model(settings);
  const auto solver = this->solver(model, 2);
  Vectors u(model.nodes.size());
  // Moving one corner of the block through its voxel inverts this voxel and no other.
  u[0] = { { 3.5e-3, 3.5e-3, 3.5e-3 } };
  solver->set_displacements(u);
  const Monitor crushed = solver->monitor();
  EXPECT_TRUE(crushed.finite);
  EXPECT_EQ(crushed.inverted, 1);
  EXPECT_EQ(crushed.worst_voxel, 0);
  EXPECT_LT(crushed.worst_jacobian, 0);
  u.back()[1] = std::nan("");
  solver->set_displacements(u);
  EXPECT_FALSE(solver->monitor().finite);
  EXPECT_EQ(solver->monitor().worst_voxel, static_cast<std::int32_t>(model.voxels.size()) - 1);
}

TEST(CpuMonitor, same_input_same_bits_on_any_number_of_threads)
{
  const Model model = test::scene_of(test::but_friction);
  Monitor seen[2];
  for (const int threads : { 1, 4 })
  {
    const auto solver = make_solver(std::make_shared<const Model>(model), { "cpu", threads });
    solver->set_displacements(test::random_vectors(model, 2e-4, 1));
    seen[threads / 4] = solver->monitor();
  }
  EXPECT_EQ(seen[0].internal, seen[1].internal);
  EXPECT_EQ(seen[0].hourglass, seen[1].hourglass);
  EXPECT_EQ(seen[0].critical_time_step, seen[1].critical_time_step);
}

FRONTALIS_EVERY_BACKEND(Monitors);

}  // namespace
}  // namespace frontalis
