// Mass that is added while a motion shortens the time step (mass_scaling: in_motion).

#include "backends.hpp"
#include "block_model.hpp"

#include "solver/stepping/added_mass.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

using Vectors = std::vector<std::array<double, 3>>;

// A block in which two voxels far from each other are a hundred times as stiff as the others.
Model block_with_stiff_spots()
{
  test::BlockSettings settings;
  settings.voxels = { { 20, 7, 7 } };
  settings.poisson = 0.4;
  Model model = test::block_model(settings);
  test::hold_plane(model, 0);
  Material stiff = model.materials[0];
  stiff.parameters[0] *= 100;
  stiff.parameters[1] *= 100;
  model.materials.push_back(stiff);
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
    if (const auto& at = model.voxels[e]; at[1] == 3 && at[2] == 3 && (at[0] == 6 || at[0] == 14))
      model.mixture_material[e] = 1;
  model.time_step_estimate = TimeStepEstimate::assembled;
  return model;
}

Model with_mass_in_motion(Model model, double time_step)
{
  model.mass_scaling.kind = MassScalingSettings::Kind::uniform;
  model.mass_scaling.in_motion = time_step;
  return model;
}

class MassOfMotion : public test::EveryBackend
{
protected:
  std::unique_ptr<Solver> accounting(const Model& model) const
  {
    return make_solver(std::make_shared<const Model>(model), { GetParam(), 0, 0, true });
  }
  // The block swings freely. Returns the displacement of its end after each slice.
  static std::vector<double> swing(Solver& solver, const Model& model)
  {
    Vectors v(model.nodes.size());
    for (std::size_t n = 0; n < v.size(); ++n)
      v[n][2] = 0.02 * model.nodes[n][0] / model.size[0];
    solver.set_velocities(v);
    std::vector<double> at;
    for (int slice = 0; slice < 20; ++slice)
    {
      solver.advance(2e-3, {});
      Vectors u;
      solver.displacements(u);
      at.push_back(u.back()[2]);
    }
    return at;
  }
};

TEST_P(MassOfMotion, makes_steps_as_long_as_wanted_and_changes_the_motion_little)
{
  const Model plain_model = block_with_stiff_spots();
  const auto plain = accounting(plain_model);
  const std::vector<double> expected = swing(*plain, plain_model);
  const double wanted = 1.15 * plain->time_step();
  const Model model = with_mass_in_motion(plain_model, wanted);
  const auto solver = accounting(model);
  const std::vector<double> found = swing(*solver, model);
  EXPECT_GT(solver->time_step(), 0.95 * wanted);
  EXPECT_LT(solver->profile().steps, 0.92 * plain->profile().steps);
  const double largest = std::abs(*std::max_element(expected.begin(), expected.end()));
  for (std::size_t slice = 0; slice < found.size(); ++slice)
    EXPECT_NEAR(found[slice], expected[slice], 0.02 * largest) << slice;
  const EnergyLedger ledger = solver->ledger();
  EXPECT_LT(std::abs(ledger.imbalance()), 2e-3 * ledger.largest) << "what comes with the mass is known";
}

TEST_P(MassOfMotion, is_not_added_where_steps_are_long_enough)
{
  const Model plain_model = block_with_stiff_spots();
  const auto plain = solver(plain_model);
  const std::vector<double> expected = swing(*plain, plain_model);
  const Model model = with_mass_in_motion(plain_model, 0.5 * plain->time_step());
  const auto other = solver(model);
  EXPECT_EQ(swing(*other, model), expected);
}

TEST_P(MassOfMotion, is_limited_so_that_steps_stay_short_where_much_would_be_needed)
{
  const Model plain_model = block_with_stiff_spots();
  const auto plain = solver(plain_model);
  const std::vector<double> expected = swing(*plain, plain_model);
  const double short_step = plain->time_step();
  const Model model = with_mass_in_motion(plain_model, 100 * short_step);
  const auto other = solver(model);
  const std::vector<double> found = swing(*other, model);
  EXPECT_LT(other->time_step(), 10 * short_step);
  const double largest = std::abs(*std::max_element(expected.begin(), expected.end()));
  for (std::size_t slice = 0; slice < found.size(); ++slice)
    EXPECT_NEAR(found[slice], expected[slice], 0.1 * largest) << slice;
}

FRONTALIS_EVERY_BACKEND(MassOfMotion);

Model large_block()
{
  test::BlockSettings settings;
  settings.voxels = { { 20, 20, 20 } };
  return test::block_model(settings);
}

// A mode of two nodes with equal shares: its frequency is divided by 1 + the sum of share times relative growth.
TEST(AddedMass, is_what_a_mode_needs)
{
  Model model = with_mass_in_motion(large_block(), 1e-4);
  const Discretisation discretisation(model);
  const MassInMotion mass(model, discretisation);
  std::vector<double> node_mass = discretisation.node_mass;
  std::vector<AddedMass> added;
  EXPECT_FALSE(mass.limits(0.99 * mass.allowed(), added));
  EXPECT_TRUE(mass.limits(1.01 * mass.allowed(), added));
  EXPECT_FALSE(mass.limits(std::nan(""), added));
  const FoundMode mode{ 2 * mass.allowed(), { { 3, 0.5F }, { 7, 0.5F } } };
  const auto first = mass.raise({ mode }, node_mass, added);
  ASSERT_EQ(first.size(), 2u);
  double divided = 1;
  for (const AddedMass& node : first)
    divided += 0.5 * (node.now / node.before - 1);
  EXPECT_GT(2 / divided, 0.7);
  EXPECT_LT(2 / divided, 1);
  EXPECT_EQ(node_mass[3], first[0].now);
  EXPECT_EQ(node_mass[4], discretisation.node_mass[4]);
  // A node that gets mass again is listed once, with its mass at rest, in ascending order.
  const auto second = mass.raise({ { 2 * mass.allowed(), { { 5, 0.9F }, { 7, 0.1F } } } }, node_mass, added);
  EXPECT_EQ(second[1].before, first[1].now);
  EXPECT_EQ(nodes_of(added), (std::vector<std::int32_t>{ 3, 5, 7 }));
  EXPECT_EQ(added[2].before, discretisation.node_mass[7]);
  EXPECT_EQ(added[2].now, node_mass[7]);
  double sum = 0;
  for (std::size_t n = 0; n < node_mass.size(); ++n)
    sum += node_mass[n] - discretisation.node_mass[n];
  EXPECT_NEAR(mass.proportion(added), sum / 8e-3, 1e-12) << "8000 voxels of 1 mm3 and 1000 kg/m3 are 8 g";
}

TEST(AddedMass, never_exceeds_ten_times_the_mass_of_a_node_and_a_hundredth_of_the_model)
{
  Model model = with_mass_in_motion(large_block(), 1e-4);
  const Discretisation discretisation(model);
  const MassInMotion mass(model, discretisation);
  std::vector<double> node_mass = discretisation.node_mass;
  std::vector<AddedMass> added;
  mass.raise({ { 1e6 * mass.allowed(), { { 3, 1 } } } }, node_mass, added);
  EXPECT_LE(node_mass[3] / discretisation.node_mass[3], 10 + 1e-9);
  EXPECT_GT(node_mass[3] / discretisation.node_mass[3], 5);
  FoundMode broad{ 10 * mass.allowed(), {} };
  for (std::int32_t n = 0; n < 8000; ++n)
    broad.shares.push_back({ n, 1.0F / 8000 });
  mass.raise({ broad }, node_mass, added);
  EXPECT_NEAR(mass.proportion(added), 0.01, 1e-4);
  EXPECT_FALSE(mass.limits(10 * mass.allowed(), added)) << "no more may be added";
}

TEST(AddedMass, fades_once_much_was_added)
{
  const Model model = with_mass_in_motion(large_block(), 1e-4);
  const Discretisation discretisation(model);
  const MassInMotion mass(model, discretisation);
  std::vector<double> node_mass = discretisation.node_mass;
  std::vector<AddedMass> added;
  FoundMode mode{ 1.1 * mass.allowed(), { { 3, 0.5F }, { 4, 0.5F } } };
  mass.raise({ mode }, node_mass, added);
  EXPECT_TRUE(mass.fade(node_mass, added).empty()) << "little was added";
  mode.shares.clear();
  for (std::int32_t n = 5; n < 4000; ++n)
    mode.shares.push_back({ n, 1.0F / 4000 });
  mass.raise({ mode }, node_mass, added);
  const double much = mass.proportion(added);
  EXPECT_GT(much, 0.0075);
  const auto faded = mass.fade(node_mass, added);
  EXPECT_NEAR(faded[0].now - discretisation.node_mass[3], 0.9 * (faded[0].before - discretisation.node_mass[3]), 1e-12);
  EXPECT_EQ(node_mass[3], faded[0].now);
  EXPECT_EQ(added[0].now, faded[0].now);
  EXPECT_LT(mass.proportion(added), 0.91 * much);
  for (std::size_t n = 5; n < 4000; ++n)
    EXPECT_GE(node_mass[n], discretisation.node_mass[n]);
}

}  // namespace
}  // namespace frontalis
