#include "backends.hpp"
#include "block_model.hpp"

#include "frontalis/error.hpp"
#include "frontalis/model/sample_field.hpp"
#include "frontalis/solver/guard.hpp"

#include <algorithm>
#include <cmath>

using namespace frontalis;
using Vectors = std::vector<std::array<double, 3>>;

namespace
{

constexpr double gravity = 9.81;

RigidTransform turned_about_z(double angle, const std::array<double, 3>& centre, const std::array<double, 3>& shift)
{
  const double c = std::cos(angle), s = std::sin(angle);
  RigidTransform pose;
  pose.rotation = { { c, -s, 0, s, c, 0, 0, 0, 1 } };
  pose.translation = { { centre[0] - c * centre[0] + s * centre[1] + shift[0],
                         centre[1] - s * centre[0] - c * centre[1] + shift[1], shift[2] } };
  return pose;
}

constexpr double radius = 4.8e-3;

double from(const std::array<double, 3>& centre, const std::array<double, 3>& p)
{
  return std::hypot(p[0] - centre[0], p[1] - centre[1], p[2] - centre[2]);
}

// A closed shell around a ball that is a bone. The ball's field is sampled or in closed form.
Model shell(const std::array<double, 3>& centre, double friction, bool sampled = false)
{
  test::BlockSettings s;
  s.voxels = { { 14, 14, 14 } };
  s.damping = 20;
  s.keep = [&](std::int32_t i, std::int32_t j, std::int32_t k)
  {
    const double r = from(centre, { { 1e-3 * i + 0.5e-3, 1e-3 * j + 0.5e-3, 1e-3 * k + 0.5e-3 } });
    return r > radius && r < radius + 1.7e-3;
  };
  Model model = test::block_model(s);
  model.bones = { "other", "ball" };
  std::vector<std::int32_t> nodes;
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
    if (std::abs(from(centre, test::rest(model, n)) - radius) < 0.6e-3)
      nodes.push_back(static_cast<std::int32_t>(n));
  if (sampled)
    slide_on(
        model, "ball", [&](const auto& p) { return from(centre, p) - radius; }, nodes);
  else
    slide_on(model, "ball", sphere_field(centre, radius), nodes);
  model.constraint_surfaces[0].bone = 1;
  model.constraint_surfaces[0].friction = friction;
  return model;
}

// Mean rotation about the ball's axis [rad]; nodes close to that axis are left out.
double spin(const Model& model, const Vectors& u, const std::array<double, 3>& centre,
            const std::array<double, 3>& shift)
{
  double angle = 0, weight = 0;
  for (std::size_t n = 0; n < u.size(); ++n)
  {
    const auto p = test::rest(model, n);
    const double x = p[0] - centre[0], y = p[1] - centre[1];
    angle += x * (u[n][1] - shift[1]) - y * (u[n][0] - shift[0]);
    weight += x * x + y * y;
  }
  return angle / weight;
}

// A block on an inclined plane; local axes are those of the plane.
Model block_on_plane(double degrees, double friction)
{
  test::BlockSettings s;
  s.voxels = { { 6, 4, 2 } };
  s.damping = 50;
  Model model = test::block_model(s);
  slide_on(
      model, "plane", [](const auto& p) { return p[2] + 1e-4; }, test::plane_of_nodes(model, 2), 10e-3, 0.5);
  model.constraint_surfaces[0].friction = friction;
  const double angle = degrees * 3.14159265358979 / 180;
  model.gravity = { { gravity * std::sin(angle), 0, -gravity * std::cos(angle) } };
  return model;
}

double mean_x(const Vectors& u)
{
  double sum = 0;
  for (const auto& moved : u)
    sum += moved[0];
  return sum / static_cast<double>(u.size());
}

}  // namespace

class Gliding : public testing::TestWithParam<Backend>
{
protected:
  std::unique_ptr<Solver> solver(const Model& model, int threads = 0) const
  {
    return make_solver(std::make_shared<const Model>(model), { GetParam(), threads, 0 });
  }
};

TEST_P(Gliding, ASurfaceThatTurnsAndTravelsIsFollowedWithoutSpin)
{
  const std::array<double, 3> centre{ { 7e-3, 7e-3, 7e-3 } }, shift{ { 2e-3, -1e-3, 1.5e-3 } };
  const double angle = 1.2;
  for (const auto& [friction, sampled] : { std::pair(0.0, false), std::pair(0.0, true), std::pair(20.0, true) })
  {
    const Model model = shell(centre, friction, sampled);
    const auto solver_ = solver(model);
    Controls controls = solver_->controls();
    Vectors u;
    double worst = 0;
    for (int frame = 1; frame <= 10; ++frame)
    {
      const double part = frame / 10.0;
      controls.bone[1] =
          turned_about_z(part * angle, centre, { { part * shift[0], part * shift[1], part * shift[2] } });
      solver_->advance(4e-3, controls);
      solver_->displacements(u);
      const auto& r = controls.bone[1].rotation;
      for (const auto& node : model.sliding)
      {
        double moved[3], p[3];
        for (int i = 0; i < 3; ++i)
          moved[i] = test::rest(model, node.node)[i] + u[node.node][i] - controls.bone[1].translation[i];
        for (int i = 0; i < 3; ++i)
          p[i] = r[i] * moved[0] + r[3 + i] * moved[1] + r[6 + i] * moved[2];
        const auto& field = model.constraint_surfaces[0].field;
        worst = std::max(worst, std::abs(level_at(field, { { p[0], p[1], p[2] } }) - node.distance));
      }
    }
    EXPECT_LT(worst, 5e-6);
    // The whole body follows the shift.
    EXPECT_NEAR(mean_x(u), shift[0], 0.05e-3 + (friction > 0 ? 0.1e-3 : 0));
    if (friction > 0)
      EXPECT_GT(spin(model, u, centre, shift), 0.5 * std::sin(angle));
    else
      EXPECT_LT(std::abs(spin(model, u, centre, shift)), 0.01 * angle);
  }
}

TEST_P(Gliding, ABlockSticksBelowTheAngleOfFrictionAndSlidesAboveIt)
{
  const double friction = 0.5, settling = 0.05, time = 0.15, damping = 50;  // the friction angle is 26.6 degrees
  Vectors u;
  auto solver_ = solver(block_on_plane(22, friction));
  solver_->advance(time, {});
  solver_->displacements(u);
  double sticking = 0;
  for (std::size_t n = 0; n < 35; ++n)  // lowest plane of nodes
    sticking = std::max(sticking, std::abs(u[n][0]));
  EXPECT_LT(sticking, 20e-6);
  for (const double degrees : { 35.0, 60.0 })
  {
    const double angle = degrees * 3.14159265358979 / 180;
    const double acceleration = gravity * (std::sin(angle) - friction * std::cos(angle));
    const auto travelled = [&](double t)
    { return acceleration / damping * (t - (1 - std::exp(-damping * t)) / damping); };
    const double expected = travelled(time) - travelled(settling);
    solver_ = solver(block_on_plane(degrees, friction));
    solver_->advance(settling, {});
    Vectors settled;
    solver_->displacements(settled);
    solver_->advance(time - settling, {});
    solver_->displacements(u);
    EXPECT_NEAR(mean_x(u) - mean_x(settled), expected, 0.01 * expected) << degrees;
  }
}

TEST_P(Gliding, TheLedgerClosesOverSlipAndFriction)
{
  const std::array<double, 3> centre{ { 7e-3, 7e-3, 7e-3 } };
  for (const double friction : { 0.0, 0.4 })
  {
    Model model = shell(centre, friction);
    for (std::int32_t n = 0; n < 20; ++n)
      model.rigid.push_back({ n, 0 });
    SolverSettings settings{ GetParam(), 0, 0 };
    settings.ledger = true;
    const auto solver_ = make_solver(std::make_shared<const Model>(model), settings);
    Controls controls = solver_->controls();
    controls.bone[0] = turned_about_z(-0.3, centre, { { 0, 0, 0.5e-3 } });
    controls.bone[1] = turned_about_z(1, centre, { { 1e-3, 0, 0 } });
    solver_->advance(20e-3, controls);
    const EnergyLedger ledger = solver_->ledger();
    EXPECT_GT(ledger["constraint"], 0);
    if (friction > 0)
      EXPECT_GT(ledger["friction"], 0.02 * ledger.largest);
    else
      EXPECT_EQ(ledger["friction"], 0);
    EXPECT_LT(std::abs(ledger.imbalance()), 0.01 * ledger.largest) << friction;
  }
}

// Moving nodes back to a surface must not add energy, even if the surface is curved and its tangent plane has an error.
TEST_P(Gliding, PuttingNodesBackToASurfaceAddsNoEnergy)
{
  const std::array<double, 3> centre{ { 7e-3, 7e-3, 7e-3 } };
  for (const bool on_ball : { false, true })
    for (const bool follows_a_bone : { false, true })
    {
      Model model = on_ball ? shell(centre, 0, true) : block_on_plane(0, 0);
      model.damping = 0;
      model.gravity = {};
      model.bones = { "other", "ball" };
      model.constraint_surfaces[0].bone = follows_a_bone ? 1 : -1;
      const auto solver_ = make_solver(std::make_shared<const Model>(model), { GetParam(), 0, 0, true });
      Vectors v(model.nodes.size());
      for (std::size_t n = 0; n < v.size(); ++n)
      {
        const auto p = test::rest(model, n);
        const double x = p[0] - centre[0], y = p[1] - centre[1], z = p[2] - centre[2];
        v[n] = { { -40 * y + 8 * x, 40 * x - 8 * y, 8 * z } };
      }
      solver_->set_velocities(v);
      const double initial = solver_->ledger().initial;
      EXPECT_GT(initial, 0);
      for (int slice = 0; slice < 40; ++slice)
      {
        solver_->advance(1e-3, solver_->controls());
        const EnergyLedger l = solver_->ledger();
        const double now = l["kinetic"] + l["internal"] + l["hourglass"];
        EXPECT_LT(now, 1.001 * initial) << "slice " << slice << (on_ball ? ", ball" : ", plane");
        EXPECT_LT(l["constraint"], 1e-3 * initial) << "slice " << slice;
        EXPECT_LT(std::abs(l.imbalance()), 0.01 * initial) << "slice " << slice;
      }
    }
}

// A shell that spins on a ball. Its nodes change planes; the rotation of their velocities to the new planes is part of
// the reaction. With `parts`, the nodes are on three equal balls (with friction, without friction, with friction and on
// a bone), otherwise on one ball with friction.
class SpinningShell : public Gliding
{
protected:
  static constexpr std::array<double, 3> centre{ { 7e-3, 7e-3, 7e-3 } };

  static Model model_of(bool parts, double friction)
  {
    Model model = shell(centre, friction);
    model.gravity = {};
    ConstraintSurface ball = model.constraint_surfaces[0];
    model.constraint_surfaces[0].bone = -1;
    if (!parts)
      return model;
    model.constraint_surfaces.push_back(ball);
    ball.bone = -1;
    ball.friction = 0;
    model.constraint_surfaces.push_back(ball);
    for (SlidingNode& node : model.sliding)
      node.surface = model.nodes[node.node][2] < 5 ? 0 : model.nodes[node.node][2] > 9 ? 1 : 2;
    return model;
  }

  std::unique_ptr<Solver> spinning(const Model& model, Backend backend, bool ledger = false) const
  {
    auto solver = make_solver(std::make_shared<const Model>(model), { backend, 0, 0, ledger });
    Vectors v(model.nodes.size());
    for (std::size_t n = 0; n < v.size(); ++n)
    {
      const auto p = test::rest(model, n);
      v[n] = { { -60 * (p[1] - centre[1]), 60 * (p[0] - centre[0]), 0 } };
    }
    solver->set_velocities(v);
    return solver;
  }

  static double spin_after(Solver& solver, const Model& model, double seconds)
  {
    Vectors u;
    solver.advance(seconds, solver.controls());
    solver.displacements(u);
    return spin(model, u, centre, { { 0, 0, 0 } });
  }
};

TEST_P(SpinningShell, IsBrakedByFrictionAsInTheReference)
{
  const Model smooth = model_of(false, 0);
  const double free = spin_after(*spinning(smooth, GetParam()), smooth, 20e-3);
  for (const bool parts : { false, true })
  {
    const Model model = model_of(parts, 2);
    const double braked = spin_after(*spinning(model, GetParam()), model, 20e-3);
    EXPECT_LT(braked, (parts ? 0.92 : 0.8) * free);
    EXPECT_NEAR(braked, spin_after(*spinning(model, "reference"), model, 20e-3), 0.01 * braked);
  }
}

TEST_P(SpinningShell, LosesToFrictionWhatItDoesInTheReference)
{
  for (const bool parts : { false, true })
  {
    const Model model = model_of(parts, 2);
    const auto here = spinning(model, GetParam(), true), there = spinning(model, "reference", true);
    here->advance(10e-3, here->controls());
    there->advance(10e-3, there->controls());
    const EnergyLedger ledger = here->ledger();
    EXPECT_GT(ledger["friction"], 0.2 * ledger.initial);
    EXPECT_NEAR(ledger["friction"], there->ledger()["friction"], 0.02 * ledger["friction"]);
    EXPECT_LT(std::abs(ledger.imbalance()), 0.01 * ledger.initial);
  }
}

TEST_P(SpinningShell, GoesOnInAnotherSolverThatHasTheSameFriction)
{
  const Model model = model_of(true, 1.5);
  const auto one = spinning(model, GetParam()), other = spinning(model, GetParam());
  spin_after(*one, model, 5e-3);
  const std::string bytes = one->pack();
  other->unpack(bytes);
  EXPECT_EQ(spin_after(*one, model, 5e-3), spin_after(*other, model, 5e-3));
  EXPECT_THROW(spinning(model_of(true, 0), GetParam())->unpack(bytes), Error);
  EXPECT_THROW(other->unpack(spinning(model_of(true, 0), GetParam())->pack()), Error);
}

// Nodes that leave the samples of a field keep their plane and are counted. If they go far away, the motion stops with
// a report, which tells whether the surface ends there or was not sampled so far from where nodes rest.
TEST_P(Gliding, NodesOutsideTheFieldAreCountedAndStopTheMotion)
{
  for (const auto& [follows_a_bone, ends] : { std::pair(false, true), { true, true }, { true, false } })
  {
    Model model = block_on_plane(90, 0);
    model.damping = 0;
    model.bones = { "bone" };
    model.constraint_surfaces[0].bone = follows_a_bone ? 0 : -1;
    // The plane ends 3 mm in front of the block, or is sampled up to 20 mm from it.
    const auto plane = [ends = ends](const auto& p)
    { return SurfaceDistance(p[2] + 1e-4, ends ? std::max(0.0, p[0] - 9e-3) : 0.0); };
    std::vector<std::array<double, 3>> rest;
    for (const auto& node : model.sliding)
      rest.push_back(test::rest(model, node.node));
    model.constraint_surfaces[0].field = sample_field(rest, plane, 0.25e-3, usual_travel);
    const auto shared = std::make_shared<const Model>(model);
    const auto solver_ = make_solver(shared, { GetParam(), 0, 0 });
    Guard guard(*solver_, shared);
    EXPECT_EQ(solver_->monitor().past_rim, 0);
    std::int64_t counted = 0;
    std::string report;
    Vectors u;
    for (int i = 0; i < 90 && report.empty(); ++i)
    {
      try
      {
        guard.advance(1e-3, solver_->controls());
        guard.check();
      }
      catch (const Unstable& why)
      {
        EXPECT_EQ(why.report.kind, Instability::past_rim);
        report = why.what();
      }
      counted = std::max(counted, solver_->monitor().past_rim);
      solver_->displacements(u);
      for (const auto& node : model.sliding)
        EXPECT_NEAR(u[node.node][2], 0, 1e-6);
    }
    EXPECT_GE(counted, 5);
    EXPECT_NE(report.find(ends ? "sliding past the rim of surface plane: continue the surface"
                               : "sliding on surface plane, 2"),
              std::string::npos)
        << report;
    EXPECT_EQ(report.find("rim") != std::string::npos, ends) << report;
    EXPECT_EQ(report.find("known up to 20 mm): hold the tissue") != std::string::npos, !ends) << report;
    EXPECT_GT(mean_x(u), ends ? 3e-3 : 20e-3);
    EXPECT_LT(mean_x(u), ends ? 8e-3 : 27e-3);
  }
}

TEST_P(Gliding, SameInputSameBits)
{
  const std::array<double, 3> centre{ { 7e-3, 7e-3, 7e-3 } };
  const Model model = shell(centre, 0.3);
  Vectors first, u;
  for (const int threads : { 1, 2, 4, 1 })
  {
    const auto solver_ = solver(model, threads);
    Controls controls = solver_->controls();
    controls.bone[1] = turned_about_z(0.3, centre, { { 1e-3, 0, 0 } });
    solver_->advance(5e-3, controls);
    solver_->displacements(u);
    if (first.empty())
      first = u;
    EXPECT_EQ(u, first) << threads << " threads";
  }
}

INSTANTIATE_TEST_SUITE_P(Backends, Gliding, testing::ValuesIn(available_backends()), test::backend_name);
INSTANTIATE_TEST_SUITE_P(Backends, SpinningShell, testing::ValuesIn(available_backends()), test::backend_name);
