#include "backends.hpp"
#include "block_model.hpp"

#include "frontalis/model/sample_field.hpp"

#include <algorithm>
#include <cmath>
#include <random>

using namespace frontalis;
using Vectors = std::vector<std::array<double, 3>>;

namespace
{

// surface: height of the bone's surface, within the lowest row of voxels
constexpr double edge = 1e-3, surface = 0.4e-3;

std::array<std::int32_t, 3> above(const std::array<std::int32_t, 3>& node, std::int32_t k)
{
  return { { node[0], node[1], k } };
}

std::int32_t index_of(const Model& model, const std::array<std::int32_t, 3>& node)
{
  return static_cast<std::int32_t>(std::find(model.nodes.begin(), model.nodes.end(), node) - model.nodes.begin());
}

// A block whose nodes at z = 0 and z = 1 edge follow those at z = 2 edges, if part(node) is true.
template <class Part>
Model attached_block(std::int32_t bone, std::int32_t slides_on, const Part& part)
{
  test::BlockSettings s;
  s.voxels = { { 5, 4, 6 } };
  s.poisson = 0.45;
  Model model = test::block_model(s);
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
    if (model.nodes[n][2] < 2 && part(model.nodes[n]))
      model.attached.push_back({ static_cast<std::int32_t>(n), index_of(model, above(model.nodes[n], 2)),
                                 (model.nodes[n][2] * edge - surface) / (2 * edge - surface), bone, slides_on, -1 });
  return model;
}

Model held_block(std::int32_t bone = -1)
{
  return attached_block(bone, -1, [](const auto&) { return true; });
}

// The block lies on a ball whose top is at the height `surface`. Nodes up to x = 1 edge are held by a bone.
Model sliding_block(bool sampled, std::int32_t bone)
{
  Model model = attached_block(-1, 0, [](const auto&) { return true; });
  const std::array<double, 3> centre{ { 2.5e-3, 2e-3, surface - 30e-3 } };
  const auto level = [=](const std::array<double, 3>& p)
  { return std::hypot(p[0] - centre[0], p[1] - centre[1], p[2] - centre[2]) - 30e-3; };
  ConstraintSurface ball;
  ball.name = "ball";
  ball.bone = bone;
  std::vector<std::array<double, 3>> rest;
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
    if (model.nodes[n][2] < 3)
      rest.push_back(test::rest(model, n));
  ball.field = sampled ? sample_field(rest, level, 0.5e-3, 5e-3) : sphere_field(centre, 30e-3);
  model.constraint_surfaces = { ball };
  for (AttachedNode& node : model.attached)
  {
    node.ratio = std::clamp(level(test::rest(model, node.node)) / level(test::rest(model, node.master)), -1.0, 1.0);
    if (model.nodes[node.node][0] < 2)
      node.surface = -1;
  }
  return model;
}

RigidTransform turned(double angle, const std::array<double, 3>& shift)
{
  RigidTransform pose;
  pose.rotation = { { std::cos(angle), 0, std::sin(angle), 0, 1, 0, -std::sin(angle), 0, std::cos(angle) } };
  pose.translation = shift;
  return pose;
}

class Attached : public test::EveryBackend
{
};

}  // namespace

// The displacement of a node relative to the bone is its ratio times that of its master, so that the tissue follows the
// bone at the surface.
TEST_P(Attached, NodesFollowTheirMastersOnABoneThatMoves)
{
  Model model = held_block(0);
  model.bones = { "jaw" };
  model.gravity = { { 3, 0, -9.81 } };
  const auto solver = this->solver(model);
  Controls target = solver->controls();
  target.bone[0] = turned(0.2, { { 1e-3, 0, 2e-3 } });
  solver->advance(0.01, target);
  Vectors u;
  solver->displacements(u);
  double largest = 0;
  for (const AttachedNode& node : model.attached)
  {
    const auto apart = [&](std::int32_t n)
    {
      const auto p = test::rest(model, n), g = target.bone[0](p);
      return std::array<double, 3>{ { u[n][0] - g[0] + p[0], u[n][1] - g[1] + p[1], u[n][2] - g[2] + p[2] } };
    };
    const auto own = apart(node.node), of_master = apart(node.master);
    for (int axis = 0; axis < 3; ++axis)
    {
      EXPECT_NEAR(own[axis], node.ratio * of_master[axis], single_precision() ? 2e-9 : 1e-15);
      largest = std::max(largest, std::abs(of_master[axis]));
    }
  }
  EXPECT_GT(largest, 1e-6) << "the masters move";
}

// The forces of attached nodes act on their masters. Momentum is conserved between two parts that a rigid link joins.
TEST_P(Attached, ForcesAreHandedOnWithoutALossOfMomentum)
{
  Model model = held_block();
  for (AttachedNode& node : model.attached)
    node.ratio = 1;
  const auto solver = this->solver(model);
  Vectors v(model.nodes.size()), u;
  std::mt19937 random(3);
  for (auto& velocity : v)
    for (double& component : velocity)
      component = 1e-2 * (static_cast<double>(random()) / 2147483648.0 - 1);
  for (const AttachedNode& node : model.attached)
    v[node.node] = v[node.master];
  solver->set_velocities(v);
  std::vector<double> mass(model.nodes.size(), 0);
  for (const auto& corners : model.voxel_nodes)
    for (const auto node : corners)
      mass[node] += 1;
  const auto momentum = [&](const Vectors& of, int axis)
  {
    double sum = 0;
    for (std::size_t n = 0; n < mass.size(); ++n)
      sum += mass[n] * of[n][axis];
    return sum;
  };
  solver->advance(0.02, solver->controls());
  solver->displacements(u);
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(momentum(u, axis), 0.02 * momentum(v, axis), (single_precision() ? 1e-5 : 1e-12) * 0.02 * 960 * 1e-2);
}

TEST_P(Attached, EnergiesBalanceOnABoneThatMoves)
{
  for (const bool slides : { false, true })
  {
    Model model = slides ? sliding_block(false, 0) : held_block(0);
    for (AttachedNode& node : model.attached)
      node.bone = 0;
    model.bones = { "jaw" };
    model.gravity = { { 1, 0, -9.81 } };
    const auto solver = make_solver(std::make_shared<const Model>(model), { GetParam(), 0, 0, true });
    Controls target = solver->controls();
    target.bone[0] = turned(0.1, { { 1e-3, 0, 0 } });
    solver->advance(0.01, target);
    solver->advance(0.02, target);
    const EnergyLedger ledger = solver->ledger();
    EXPECT_GT(ledger.largest, 0);
    EXPECT_LT(std::abs(ledger.imbalance()), 0.01 * ledger.largest) << (slides ? "sliding" : "held");
  }
}

// The level of a node stays in proportion to the level of its master, wherever the nodes slide.
TEST_P(Attached, SlidingNodesKeepTheExtrapolatedSurface)
{
  for (const bool sampled : { false, true })
  {
    Model model = sliding_block(sampled, -1);
    model.bones = { "jaw" };
    for (AttachedNode& node : model.attached)
      node.bone = node.surface < 0 ? 0 : -1;
    const auto solver = this->solver(model);
    Controls target = solver->controls();
    target.bone[0].translation = { { -1.5e-3, 0.5e-3, 0 } };
    solver->advance(0.02, target);
    Vectors u;
    solver->displacements(u);
    double farthest = 0, dragged = 0;
    const SampledField& field = model.constraint_surfaces[0].field;
    for (const AttachedNode& node : model.attached)
    {
      if (node.surface < 0)
        continue;
      const auto level = [&](std::int32_t n, double moved)
      {
        auto p = test::rest(model, n);
        for (int axis = 0; axis < 3; ++axis)
          p[axis] += moved * u[n][axis];
        return level_at(field, p);
      };
      const double offset = level(node.node, 0) - node.ratio * level(node.master, 0);
      farthest = std::max(farthest, std::abs(level(node.node, 1) - node.ratio * level(node.master, 1) - offset));
      dragged = std::max(dragged, std::abs(u[node.node][0]));
    }
    EXPECT_GT(dragged, 0.3e-3);
    EXPECT_LT(farthest, 5e-6) << (sampled ? "sampled" : "closed form");
  }
}

// At the bound of the time step the energy of a vibration does not grow.
TEST_P(Attached, TheBoundOfTheTimeStepHolds)
{
  for (const bool slides : { false, true })
  {
    Model model = slides ? sliding_block(false, -1) : held_block();
    // The lowest voxels have little tissue, like voxels below the bone's surface in a baked model.
    for (std::size_t e = 0; e < model.voxels.size(); ++e)
      if (model.voxels[e][2] == 0)
        model.fill[e] = e % 3 == 0 ? 0.02F : 0.6F;
    model.time_step_share = 0.99;
    const auto solver = this->solver(model);
    Vectors v(model.nodes.size());
    std::mt19937 random(5);
    for (auto& velocity : v)
      for (double& component : velocity)
        component = 1e-3 * (static_cast<double>(random()) / 2147483648.0 - 1);
    for (const AttachedNode& node : model.attached)
      v[node.node] = {};
    solver->set_velocities(v);
    solver->advance(0.002, solver->controls());
    const auto energy = [&]
    {
      const Monitor monitor = solver->monitor();
      return monitor.kinetic + monitor.internal + monitor.hourglass;
    };
    const double before = energy();
    solver->advance(0.1, solver->controls());
    EXPECT_LT(energy(), 1.3 * before) << (slides ? "sliding" : "held");
  }
}

// Held and sliding nodes, on surfaces that stand still and on a bone that moves, and nodes that are joined.
TEST_P(Attached, MoveAsInTheReference)
{
  for (const std::int32_t bone : { -1, 0 })
    for (const bool sampled : { false, true })
    {
      Model model = sliding_block(sampled, bone);
      model.bones = { "jaw" };
      for (AttachedNode& node : model.attached)
        node.bone = node.surface < 0 ? bone : -1;
      for (std::size_t n = 0; n < model.nodes.size(); ++n)
        if (model.nodes[n][2] == 6)
          model.joints.push_back({ static_cast<std::int32_t>(n), index_of(model, above(model.nodes[n], 5)) });
      model.flaps = { { 6, 1 } };  // joined nodes rest at the same place
      model.gravity = { { 2, 1, -9.81 } };
      std::vector<Vectors> found;
      for (const Backend& backend : { GetParam(), Backend("reference") })
      {
        const auto solver = make_solver(std::make_shared<const Model>(model), { backend, 2, 4e-6 });
        Controls target = solver->controls();
        target.bone[0] = turned(0.02, { { 1e-4, 0, 2e-4 } });
        solver->advance(4e-3, target);
        solver->displacements(found.emplace_back());
      }
      double size = 0, apart = 0;
      for (std::size_t n = 0; n < found[0].size(); ++n)
        for (int axis = 0; axis < 3; ++axis)
        {
          apart = std::max(apart, std::abs(found[0][n][axis] - found[1][n][axis]));
          size = std::max(size, std::abs(found[1][n][axis]));
        }
      EXPECT_GT(size, 1e-5);
      EXPECT_LT(apart, 1e-3 * size) << bone << (sampled ? " sampled" : " closed form");
    }
}

// In the assembled model, held nodes move with their masters.
TEST_P(Attached, TheAssembledStepIsThatOfTheReference)
{
  Model model = held_block();
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
    if (model.voxels[e][2] == 0)
      model.fill[e] = e % 3 == 0 ? 0.02F : 0.6F;
  model.time_step_estimate = TimeStepEstimate::assembled;
  double step[2], before = 0;
  for (int b = 0; b < 2; ++b)
  {
    const auto solver = make_solver(std::make_shared<const Model>(model), { b == 0 ? GetParam() : "reference", 2, 0 });
    before = solver->time_step();
    solver->advance(0.01, solver->controls());
    step[b] = solver->time_step();
  }
  EXPECT_NEAR(step[0] / step[1], 1, 5e-3);
  EXPECT_GT(step[1], 1.05 * before) << "a search was made";
}

TEST(AttachedOnCpu, ThreadsDoNotChangeABit)
{
  Model model = sliding_block(true, -1);
  model.bones = { "jaw" };
  for (AttachedNode& node : model.attached)
    node.bone = node.surface < 0 ? 0 : -1;
  model.gravity = { { 2, 1, -9.81 } };
  std::vector<Vectors> found;
  for (const int threads : { 1, 2, 5 })
  {
    const auto solver = make_solver(std::make_shared<const Model>(model), { "cpu", threads, 0 });
    Controls target = solver->controls();
    target.bone[0].translation = { { -1e-3, 0, 0 } };
    solver->advance(0.01, target);
    solver->displacements(found.emplace_back());
  }
  EXPECT_EQ(found[0], found[1]);
  EXPECT_EQ(found[0], found[2]);
}

// Nodes at surfaces that stand still are processed in blocks, nodes at bones one by one. Both must give the same
// motion.
TEST(AttachedOnCpu, ABoneThatRestsIsAsGoodAsNone)
{
  for (const bool sampled : { false, true })
  {
    std::vector<Vectors> found;
    for (const std::int32_t bone : { -1, 0 })
    {
      Model model = sliding_block(sampled, bone);
      model.precision = Precision::double_precision;
      model.bones = { "jaw" };
      model.gravity = { { 2, 1, -9.81 } };
      for (AttachedNode& node : model.attached)
        node.bone = node.surface < 0 ? bone : -1;
      const auto solver = make_solver(std::make_shared<const Model>(model), { "cpu", 2, 2e-5 });
      solver->advance(0.01, solver->controls());
      solver->displacements(found.emplace_back());
    }
    double size = 0;
    for (std::size_t n = 0; n < found[0].size(); ++n)
      for (int axis = 0; axis < 3; ++axis)
      {
        EXPECT_NEAR(found[0][n][axis], found[1][n][axis], 1e-8);
        size = std::max(size, std::abs(found[0][n][axis]));
      }
    EXPECT_GT(size, 1e-5);
  }
}

TEST(AttachedOnCpu, MovesAsTheReferenceDoes)
{
  for (const bool slides : { false, true })
  {
    Model model = slides ? sliding_block(false, -1) : held_block();
    model.precision = Precision::double_precision;
    model.gravity = { { 2, 1, -9.81 } };
    std::vector<Vectors> found;
    for (const char* const backend : { "cpu", "reference" })
    {
      const auto solver = make_solver(std::make_shared<const Model>(model), { backend, 2, 2e-5 });
      solver->advance(0.004, solver->controls());
      solver->displacements(found.emplace_back());
    }
    for (std::size_t n = 0; n < found[0].size(); ++n)
      for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(found[0][n][axis], found[1][n][axis], 1e-9);
  }
}

FRONTALIS_EVERY_BACKEND(Attached);
