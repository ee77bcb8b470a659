// Tissue that touches itself: the forces.

#include "tissues_touch.hpp"

#include "solver/stepping/discretisation.hpp"

namespace frontalis
{
namespace
{

using namespace test;

using Point = std::array<double, 3>;

// Holds the side z = 0 of a model along z and moves the opposite side by `way` [m].
void press(Model& model, double way, double ramp)
{
  for (const double value : { 0.0, way })
  {
    Load side;
    side.kind = Load::Kind::displacement;
    side.fixed = { { false, false, true } };
    side.value[2] = value;
    side.ramp = ramp;
    model.loads.push_back(side);
  }
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
    if (model.nodes[n][2] == 0 || model.nodes[n][2] == model.size[2])
      model.prescribed.push_back({ static_cast<std::int32_t>(n), model.nodes[n][2] == 0 ? 0 : 1 });
}

// Under a pressure of 5 % of Young's modulus, the sides overlap by 1.4 % of a voxel according to the law of contact.
// The surfaces lie on the sides of voxels, or inside voxels that are filled to two thirds.
TEST_P(TissuesTouch, two_blocks_press_each_other_evenly_and_hardly_overlap)
{
  BlockSettings settings;
  settings.voxels = { { 5, 4, 4 } };
  settings.damping = 3000;
  for (const double beyond : { 0.0, -1.0 / 3 })
    for (const double poisson : { 0.3, 0.49 })
    {
      settings.poisson = poisson;
      Model model = two_blocks(settings, 0, beyond);
      for (std::size_t e = 0; e < model.voxels.size(); ++e)
        if (model.voxels[e][2] == 3 || model.voxels[e][2] == 5)
          model.fill[e] = static_cast<float>(1 + beyond);
      press(model, -(1 - 2 * beyond) * 1e-3 - 0.412e-3, 0.02);
      const auto solver = make(model);
      solver->advance(0.08, solver->controls());
      const Vectors u = displacements(*solver);
      // Strain of the lower block, and smallest and largest overlap of the sides [m].
      double least = 1, most = 0, strain = 0;
      const std::size_t side = 6 * 5;
      for (std::size_t n = 0; n < side; ++n)
      {
        const auto at = [&](std::size_t layer) { return u[layer * side + n][2]; };
        const double lower = at(4) + beyond * (at(4) - at(3)), upper = at(5) - beyond * (at(6) - at(5));
        const double overlap = lower - upper - (1 - 2 * beyond) * 1e-3;
        least = std::min(least, overlap);
        most = std::max(most, overlap);
        strain -= at(3) / (3e-3 * side);
      }
      EXPECT_NEAR(strain, 0.05, 0.004);
      EXPECT_LT(most, 0.02e-3);
      EXPECT_GT(least, 0);
      EXPECT_LT(most - least, 0.05 * most) << beyond << ' ' << poisson;
      // Neo-Hookean tissue stiffens under compression: pressure / E = strain (1 + strain), to second order.
      const double pressure = strain * (1 + strain) * settings.young;
      EXPECT_NEAR(0.5 * (most + least) * 3.5 * settings.young / 1e-3, pressure, 0.03 * pressure);
    }
}

// The blocks meet obliquely and rotate, without damping.
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
    EXPECT_GT(stored, 0.005 * initial);
    EXPECT_EQ(ledger["contact_stored"], 0);  // the blocks have parted
    EXPECT_EQ(ledger["friction"] > 0.005 * initial, friction > 0);
    const Vectors from = displacements(*solver);
    const double begin = solver->time();
    solver->advance(0.5 * solver->time_step(), solver->controls());
    const double dt = solver->time() - begin;
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
      EXPECT_NEAR(after[i], before[i], (single_precision() ? 1e-5 : 1e-11) * std::abs(before[i < 3 ? 2 : 4])) << i;
  }
}

// Balls of voxels have smooth surfaces outside the staircases of their voxels. The balls collide off centre, or glance
// off each other at 1 m/s, without damping.
TEST_P(TissuesTouch, balls_of_voxels_collide_as_smooth_ones)
{
  const double radius = 5.2, middle = 6.5;
  BlockSettings settings;
  settings.voxels = { { 26, 13, 13 } };
  settings.poisson = 0.45;
  settings.keep = [&](std::int32_t i, std::int32_t j, std::int32_t k)
  { return std::hypot((i < 13 ? i : i - 13) + 0.5 - middle, j + 0.5 - middle, k + 0.5 - middle) < radius; };
  for (const auto& [friction, glances] : { std::make_pair(0.0, false), { 0.3, false }, { 0.0, true } })
  {
    Model model = block_model(settings);
    SelfContact contact;
    contact.friction = friction;
    for (const double x : { middle, middle + 13 })
      add_sphere(model, contact, { { 1e-3 * x, 1e-3 * middle, 1e-3 * middle } }, 1e-3 * radius);
    model.self_contacts.push_back(contact);
    const auto solver = make(model, 2, true);
    Vectors u(model.nodes.size()), v(model.nodes.size());
    for (std::size_t n = 0; n < u.size(); ++n)
      if (model.nodes[n][0] > 13)
      {
        u[n] = glances ? Point{ { -4.5e-3, 9e-3, 0.7e-3 } } : Point{ { -2.4e-3, 2.3e-3, 0.7e-3 } };
        v[n] = glances ? Point{ { 0, -1, 0 } } : Point{ { -0.3, 0.06, 0.03 } };
      }
    solver->set_displacements(u);
    solver->set_velocities(v);
    const double initial = solver->ledger().initial;
    double stored = 0;
    for (int slice = 0; slice < 24; ++slice)
    {
      solver->advance(0.5e-3, solver->controls());
      const EnergyLedger ledger = solver->ledger();
      stored = std::max(stored, ledger["contact_stored"]);
      EXPECT_NEAR(mechanical(ledger) + ledger["friction"], initial, (friction > 0 ? 0.01 : 1e-3) * initial) << slice;
    }
    EXPECT_GT(stored, (glances ? 0.003 : 0.03) * initial);
    EXPECT_EQ(solver->ledger()["contact_stored"], 0);
  }
}

// A small block lies on a long one under oblique gravity, whose pressure is 5 % of Young's modulus. The block slides
// slowly, because friction on vertices that come under the block follows the pressure with a delay of 1 ms.
TEST_P(TissuesTouch, a_block_sticks_below_the_angle_of_friction_and_slides_above_it)
{
  const double friction = 0.5, damping = 3000, gravity = 981, settling = 15e-3, time = 5e-3;
  const auto on_incline = [&](double degrees)
  {
    BlockSettings settings;
    settings.voxels = { { 20, 4, 4 } };
    settings.damping = damping;
    settings.keep = [](std::int32_t i, std::int32_t, std::int32_t k) { return k == 0 || (k > 1 && i > 1 && i < 7); };
    Model model = block_model(settings);
    SelfContact contact;
    contact.friction = friction;
    add_side(model, contact, 0, true);
    add_side(model, contact, 2, false, 0, 2, 7);
    model.self_contacts.push_back(contact);
    for (std::size_t n = 0; n < model.nodes.size(); ++n)
      if (model.nodes[n][2] <= 1)
        model.rigid.push_back({ static_cast<std::int32_t>(n) });
    model.gravity = { { gravity * std::sin(degrees * degree), 0, -gravity * std::cos(degrees * degree) } };
    auto solver = make(model);
    Vectors u(model.nodes.size());
    for (std::size_t n = 0; n < u.size(); ++n)
      u[n][2] = model.nodes[n][2] > 1 ? -0.999e-3 : 0;
    solver->set_displacements(u);
    solver->advance(settling, {});
    return std::make_pair(std::move(solver), model.nodes.size());
  };
  const auto place = [](const std::pair<std::unique_ptr<Solver>, std::size_t>& block)
  {
    // The nodes of the small block are the last ones.
    const Vectors u = displacements(*block.first);
    return mean(Vectors(u.end() - 6 * 5 * 3, u.end()), 0);
  };
  const auto way = [&](const std::pair<std::unique_ptr<Solver>, std::size_t>& block)
  {
    const double begin = place(block);
    block.first->advance(time, {});
    return place(block) - begin;
  };
  EXPECT_LT(std::abs(way(on_incline(22))), 1e-6);
  for (const double degrees : { 35.0, 50.0 })
  {
    const auto block = on_incline(degrees);
    const double first = way(block), second = way(block), q = std::exp(-damping * time);
    const double acceleration = damping * (second - q * first) / (time * (1 - q));
    const double braking = friction * gravity * std::cos(degrees * degree);
    EXPECT_NEAR(acceleration, gravity * std::sin(degrees * degree) - braking, 0.01 * braking) << degrees;
  }
}

// The arms of a folded sheet are pressed together. Their outer sides, one voxel away, do not take part in the contact.
TEST_P(TissuesTouch, a_folded_sheet_touches_itself)
{
  BlockSettings settings;
  settings.voxels = { { 12, 4, 3 } };
  settings.damping = 2000;
  Model model = folded_sheet(settings, 10, 0.2);
  Load push;
  push.kind = Load::Kind::pressure;
  push.ramp = 0.02;
  push.value[0] = 400;
  SelfContact top;
  add_side(model, top, 2, true, 0, 0, 6);
  push.mesh = top.surface;
  push.binding = top.binding;
  model.loads.push_back(push);
  hold_plane(model, 2);
  const auto solver = make(model, 2, true);
  solver->advance(1e-3, solver->controls());
  EXPECT_EQ(solver->ledger()["contact_stored"], 0);
  solver->advance(0.15, solver->controls());
  EXPECT_GT(solver->ledger()["contact_stored"], 0);
  const Vectors u = displacements(*solver);
  double deepest = -1;
  for (std::size_t n = 0; n < u.size(); ++n)
    if (model.nodes[n][2] == 2 && model.nodes[n][0] < 6)
      for (std::size_t m = 0; m < u.size(); ++m)
        if (model.nodes[m] == std::array<std::int32_t, 3>{ { model.nodes[n][0], model.nodes[n][1], 1 } })
        {
          deepest = std::max(deepest, u[m][2] - u[n][2] - 1e-3);
        }
  EXPECT_GT(deepest, 0);
  EXPECT_LT(deepest, 0.02e-3);
}

// A strip is bent into three quarters of a ring. Neighbours on one surface do not touch.
TEST_P(TissuesTouch, bending_alone_is_no_contact)
{
  BlockSettings settings;
  settings.voxels = { { 24, 3, 1 } };
  Model model = block_model(settings);
  SelfContact contact;
  add_side(model, contact, 0, true);
  add_side(model, contact, 0, false);
  model.self_contacts.push_back(contact);
  const auto solver = make(model, 2, true);
  for (const double angle : { 60.0, 180.0, 270.0, -270.0 })
  {
    const double length = 24e-3, radius = length / (angle * degree);
    Vectors u(model.nodes.size());
    for (std::size_t n = 0; n < u.size(); ++n)
    {
      const auto p = rest(model, n);
      const double turn = (p[0] - 0.5 * length) / radius, arm = radius - (p[2] - 0.5e-3);
      u[n] = { { 0.5 * length + arm * std::sin(turn) - p[0], 0, radius - arm * std::cos(turn) + 0.5e-3 - p[2] } };
    }
    solver->set_displacements(u);
    for (int step = 0; step < 5; ++step)
    {
      solver->advance(1e-6, solver->controls());
      EXPECT_EQ(solver->ledger()["contact_stored"], 0) << angle;
    }
  }
}

FRONTALIS_EVERY_BACKEND(TissuesTouch);

}  // namespace
}  // namespace frontalis
