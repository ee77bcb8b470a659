// Tissue that touches itself: the forces.

#include "tissues_touch.hpp"

#include "solver/stepping/discretisation.hpp"

namespace frontalis
{
namespace
{

using namespace test;

// Under a pressure of 5 % of Young's modulus: the law says that the sides overlap by 1.4 % of a voxel.
TEST_P(TissuesTouch, two_blocks_press_each_other_evenly_and_hardly_overlap)
{
  BlockSettings settings;
  settings.voxels = { { 5, 4, 4 } };
  settings.damping = 3000;
  for (const double poisson : { 0.3, 0.49 })
  {
    settings.poisson = poisson;
    Model model = two_blocks(settings);
    const double way = -1e-3 - 0.4e-3;
    for (const double value : { 0.0, way })
    {
      Load side;
      side.kind = Load::Kind::displacement;
      side.fixed = { { false, false, true } };
      side.value[2] = value;
      side.ramp = 0.02;
      model.loads.push_back(side);
    }
    for (std::size_t n = 0; n < model.nodes.size(); ++n)
      if (model.nodes[n][2] == 0 || model.nodes[n][2] == model.size[2])
        model.prescribed.push_back({ static_cast<std::int32_t>(n), model.nodes[n][2] == 0 ? 0 : 1 });
    const auto solver = make(model);
    solver->advance(0.2, solver->controls());
    const Vectors u = displacements(*solver);
    // strain of the lower block, and how deep the sides overlap
    double least = 1, most = 0, strain = 0;
    const std::size_t side = 6 * 5;
    for (std::size_t n = 0; n < side; ++n)
    {
      const auto lower = u[4 * side + n][2], upper = u[5 * side + n][2];
      EXPECT_EQ(model.nodes[5 * side + n][2], 5);
      const double overlap = lower - upper - 1e-3;
      least = std::min(least, overlap);
      most = std::max(most, overlap);
      strain += lower / (4e-3 * side);
    }
    for (std::size_t n = 0; n < side; ++n)
      std::printf("%s%.2f(%.2f,%.2f)", n % 6 == 0 ? "\n" : " ", (u[4 * side + n][2] - u[5 * side + n][2] - 1e-3) * 1e6,
                  (u[5 * side + n][0] - u[4 * side + n][0]) * 1e6, (u[5 * side + n][1] - u[4 * side + n][1]) * 1e6);
    std::printf("strain %g overlap %g .. %g mm\n", strain, least * 1e3, most * 1e3);
    EXPECT_NEAR(strain, -0.05, 0.005);
    EXPECT_LT(most, 0.02e-3);
    EXPECT_LT(most - least, 0.05 * most);
    const double pressure = -strain * settings.young;
    EXPECT_NEAR(0.5 * (most + least) * 3.5 * settings.young / 1e-3, pressure, 0.08 * pressure);
  }
}

// Without damping; the blocks meet obliquely and turn.
TEST_P(TissuesTouch, an_impact_keeps_energy_and_momentum)
{
  BlockSettings settings;
  settings.voxels = { { 5, 4, 4 } };
  for (const double friction : { 0.0, 0.4 })
  {
    const Model model = two_blocks(settings, friction);
    const Discretisation discretisation(model);
    const auto solver = make(model, 2, true);
    solver->set_displacements(lowered(model, -0.95e-3));
    Vectors v(model.nodes.size());
    for (std::size_t n = 0; n < v.size(); ++n)
      if (2 * model.nodes[n][2] > model.size[2])
        v[n] = { { 0.1 + 10 * rest(model, n)[1], -0.05, -0.3 - 10 * rest(model, n)[0] } };
    solver->set_velocities(v);
    const auto momenta = [&](const Vectors& place, const Vectors& velocity)
    {
      std::array<double, 6> sum{};
      for (std::size_t n = 0; n < v.size(); ++n)
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
          const std::size_t j = (axis + 1) % 3, k = (axis + 2) % 3;
          const double mass = discretisation.node_mass[n];
          sum[axis] += mass * velocity[n][axis];
          sum[3 + axis] += mass * ((rest(model, n)[j] + place[n][j]) * velocity[n][k] -
                                   (rest(model, n)[k] + place[n][k]) * velocity[n][j]);
        }
      return sum;
    };
    const std::array<double, 6> before = momenta(displacements(*solver), v);
    const double initial = solver->ledger().initial;
    double stored = 0;
    for (int slice = 0; slice < 60; ++slice)
    {
      solver->advance(0.1e-3, solver->controls());
      const EnergyLedger ledger = solver->ledger();
      stored = std::max(stored, ledger["contact_stored"]);
      EXPECT_NEAR(mechanical(ledger) + ledger["friction"], initial, 0.02 * initial) << slice;
      EXPECT_LT(std::abs(ledger.imbalance()), 0.02 * initial);
    }
    const EnergyLedger ledger = solver->ledger();
    std::printf("stored %g friction %g of %g imbalance %g\n", stored, ledger["friction"], initial, ledger.imbalance());
    EXPECT_GT(stored, 0.005 * initial);
    EXPECT_EQ(ledger["contact_stored"], 0);  // they have parted
    EXPECT_EQ(ledger["friction"] > 0.005 * initial, friction > 0);
    const Vectors from = displacements(*solver);
    const double dt = 1e-6;
    solver->advance(dt, solver->controls());
    const Vectors to = displacements(*solver);
    Vectors velocity(v.size()), middle(v.size());
    for (std::size_t n = 0; n < v.size(); ++n)
      for (std::size_t axis = 0; axis < 3; ++axis)
      {
        velocity[n][axis] = (to[n][axis] - from[n][axis]) / dt;
        middle[n][axis] = from[n][axis];
      }
    const std::array<double, 6> after = momenta(middle, velocity);
    for (std::size_t i = 0; i < 6; ++i)
      std::printf("%g ", after[i] / before[i < 3 ? 2 : 4] - before[i] / before[i < 3 ? 2 : 4]);
    std::printf("\n");
  }
}

FRONTALIS_HOST_BACKENDS(TissuesTouch);

}  // namespace
}  // namespace frontalis
