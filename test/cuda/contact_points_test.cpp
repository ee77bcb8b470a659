// The GPU's code for points of contact, run on the host. The test needs a CUDA toolkit but no GPU.
#include <gtest/gtest.h>

#if __has_include(<cuda_runtime.h>) && defined(__x86_64__)

#include "cuda/backend/contact_point.hpp"
#include "solver/bodies_touch.hpp"
#include "solver/contact/body_motion.hpp"
#include "solver/energy/energy_ledger_keeper.hpp"

#include <random>

#include "device_on_host.hpp"

// all threads of a block share these arrays, and blocks run one after another
#undef __shared__
#define __shared__ static
#include "cuda/kernels/contact_points.cuh"
#include "cuda/kernels/pushed_bodies.cuh"

using namespace frontalis;
using namespace frontalis::cuda;

namespace
{

constexpr double dt = 20e-6;
constexpr int steps = 2000;

// Forces on the points of contact of a model whose nodes follow prescribed paths, computed by the host's code and by
// the GPU's code.
class TwoWays
{
public:
  explicit TwoWays(const Model& model)
      : model_(model), discretisation_(model), host(model, discretisation_), account(model, discretisation_)
  {
    for (auto& component : u_)
      component.assign(model.nodes.size(), 0.0);
    for (const Contact& contact : model.contacts)
      bodies_.push_back(contact_body(contact, view(contact.field)));
    for (const auto& point : host.points())
      points_.push_back(contact_point(model.contacts[point.body], bodies_[point.body], point));
    for (const float4& word : no_samples())
      samples_.insert(samples_.end(), points_.size(), word);
    for (auto* const state : { &grips_, &forces_, &arms_, &clearances_ })
      state->assign(points_.size(), float4{ 0, 0, 0, 0 });
    holds_.assign(points_.size(), {});
    looks_.assign(points_.size(), { { 0, 0, 0 }, 0 });
    g_.contact.bodies = bodies_.data();
    g_.contact.points = points_.data();
    g_.contact.point_count = static_cast<std::uint32_t>(points_.size());
    g_.contact.body_count = static_cast<std::uint32_t>(bodies_.size());
    for (std::size_t b = 0; b < bodies_.size(); ++b)
      if (model.contacts[b].mass > 0)
        pushed_.push_back({ pushed_body(model.contacts[b]), static_cast<std::int32_t>(b) });
    motions_.assign(pushed_.size(), {});
    // Each point has a block of its own.
    reactions_.assign(pushed_.size() * points_.size(), { 0, 0, 0 });
    g_.contact.samples = samples_.data();
    g_.contact.grips = grips_.data();
    g_.contact.holds = holds_.data();
    g_.contact.forces = forces_.data();
    g_.contact.arms = arms_.data();
    g_.contact.clearances = clearances_.data();
    g_.friction_response = physics::friction_response(dt);
  }
  TwoWays(const TwoWays&) = delete;
  TwoWays& operator=(const TwoWays&) = delete;

  // A wave passes through the tissue while the finger presses, strokes and leaves.
  void step(int number)
  {
    const ConstraintStep now{ (number + 1) * dt, dt, number * dt, bones(number + 1), bones(number), {} };
    std::vector<float> of_bodies;
    for (const ContactBody& body : bodies_)
      add_pose(body, now.bone_before, of_bodies);
    std::vector<float4> rows(of_bodies.size() / 4);
    std::memcpy(rows.data(), of_bodies.data(), of_bodies.size() * sizeof(float));
    g_.contact.poses = rows.data();
    std::vector<physics::Vec3<double>> held_at;
    for (const PushedBody& pushed : pushed_)
      held_at.push_back(held_centre(model_.contacts[pushed.body], now.bone_before));
    const PushedBodies pushed{ pushed_.data(),
                               static_cast<std::uint32_t>(pushed_.size()),
                               static_cast<std::uint32_t>(points_.size()),
                               rows.data(),
                               held_at.data(),
                               motions_.data(),
                               reactions_.data() };
    for (std::uint32_t i = 0; i < pushed.count; ++i)
      move_body(pushed, i, 0, dt, g_.contact.body_count);
    RigidTransform pose = now.bone_before[1];
    if (!pushed_.empty())
      pose = pushed_pose(model_.contacts[0], motions_[0], now.bone_before);
    if (number > 0)
      way_ += longest_way(pose_, pose, far_corner(model_));
    pose_ = pose;
    const NodeShare all{ 0, 1, 0, model_.size[2] + 1, 0, static_cast<std::int32_t>(model_.nodes.size()) };
    Components unused = u_;
    double* const ignored[3] = { unused[0].data(), unused[1].data(), unused[2].data() };
    host.before_step(all, pointers().data(), now);
    host.add_forces(all, ForceSink<double>(ignored));
    std::vector<HostContact::Found> found;
    for (std::size_t p = 0; p < points_.size(); ++p)
    {
      float weight[8];
      const auto& c = points_[p].coordinates;
      physics::trilinear_weights(c[0], c[1], c[2], weight);
      physics::Vec3<float> moved{ 0, 0, 0 };
      for (int b = 0; b < 8; ++b)
      {
        EXPECT_EQ(weight[b], corner_weight(b, c[0], c[1], c[2]));
        const auto node = model_.voxel_nodes[host.points()[p].voxel][b];
        add_part(moved, weight[b], make_float4(float(u_[0][node]), float(u_[1][node]), float(u_[2][node]), 0));
      }
      const Push push = find_push(g_, points_[p], { static_cast<std::uint32_t>(p), 0, true, moved });
      put_reactions<1>(pushed, static_cast<std::uint32_t>(p), points_[p].body, push.force);
      touching += push.free_way > 0 ? 0 : 1;
      // A point may be skipped until it and the body together have moved by the distance that its latest evaluation
      // returned.
      Look& look = looks_[p];
      const bool skipped = double(norm(moved - look.moved)) < look.until - way_;
      EXPECT_FALSE(skipped && push.free_way == 0);
      skips += skipped ? 1 : 0;
      if (!skipped)
        look = { moved, double(push.free_way) + way_ };
      EXPECT_EQ(push.force.z, holds_[p].touching == int(physics::Touching::no) ? 0 : forces_[p].z);
      found.push_back(found_at(g_.contact, p, host.points()[p]));
    }
    account.follow(found, now, motions_);
    const Components before = u_;
    for (std::size_t n = 0; n < model_.nodes.size(); ++n)
      for (std::size_t axis = 0; axis < 3; ++axis)
        u_[axis][n] = static_cast<float>(
            50e-6 * std::sin(300 * (number + 1) * dt + 700 * test::rest(model_, n)[axis] + double(axis)));
    const double* const old[3] = { before[0].data(), before[1].data(), before[2].data() };
    host.after_step(all, old, pointers().data());
  }
  // Poses at the end of the latest step, `number`.
  std::array<RigidTransform, 2> poses(int number) const
  {
    return { { host.bodies(bones(number + 1))[0], account.bodies(bones(number + 1))[0] } };
  }
  // Work of bodies and energy lost to friction [J].
  std::array<double, 2> energies(HostContact& of)
  {
    EnergyLedger ledger = empty_ledger();
    std::vector<std::array<double, 3>> none;
    of.add_energies(pointers().data(), bones(steps), false, none, ledger);
    return { { ledger["contact"], ledger["friction"] } };
  }

  static std::vector<RigidTransform> bones(int step)
  {
    const double part = double(step) / steps, depth = std::sin(2 * 3.14159265 * part);
    return { RigidTransform(), rigid_motion({ { 0, 0.1 * part, 0.3 * part } }, { { 1e-3 * part, 0, -1e-3 * depth } }) };
  }

private:
  using Components = std::array<std::vector<double>, 3>;
  std::array<const double*, 3> pointers() const { return { { u_[0].data(), u_[1].data(), u_[2].data() } }; }

  const Model& model_;
  const Discretisation discretisation_;
  Components u_;
  struct Look
  {
    physics::Vec3<float> moved;
    double until;
  };
  std::vector<Look> looks_;
  double way_ = 0;
  RigidTransform pose_;
  std::vector<PushedBody> pushed_;
  std::vector<physics::PushedMotion<double>> motions_;
  std::vector<physics::Vec3<double>> reactions_;
  std::vector<ContactBody> bodies_;
  std::vector<ContactPoint> points_;
  std::vector<float4> grips_, forces_, arms_, clearances_, samples_;
  std::vector<ContactHold> holds_;
  StepArguments g_{};

public:
  HostContact host, account;
  std::int64_t touching = 0, skips = 0;
};

}  // namespace

namespace
{

// Moves the finger. Compares forces, moments, energies and, if the body is pushed, its motion; returns the longest way
// of a pushed body from its bone [m].
double compare(const Model& model, const std::string& what)
{
  TwoWays points(model);
  double most_force = 0, most_moment = 0, most_way = 0, worst_force = 0, worst_moment = 0, worst_way = 0;
  for (int step = 0; step < steps; ++step)
  {
    points.step(step);
    const Reaction expected = points.host.reactions()[0], found = points.account.reactions()[0];
    const auto poses = points.poses(step);
    const RigidTransform held = TwoWays::bones(step + 1)[1];
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      most_force = std::max(most_force, std::abs(expected.force[axis]));
      most_moment = std::max(most_moment, std::abs(expected.moment[axis]));
      most_way = std::max(most_way, std::abs(poses[0].translation[axis] - held.translation[axis]));
      worst_force = std::max(worst_force, std::abs(expected.force[axis] - found.force[axis]));
      worst_moment = std::max(worst_moment, std::abs(expected.moment[axis] - found.moment[axis]));
      worst_way = std::max(worst_way, std::abs(poses[0].translation[axis] - poses[1].translation[axis]));
    }
  }
  EXPECT_GT(points.touching, 10000) << what;
  EXPECT_GT(points.skips, 10000) << what;
  EXPECT_GT(most_force, 0.1) << what;
  EXPECT_LT(worst_force, 1e-4 * most_force) << what;
  EXPECT_LT(worst_moment, 1e-4 * most_moment) << what;
  EXPECT_LE(worst_way, 1e-4 * most_way) << what;
  const auto expected = points.energies(points.host), found = points.energies(points.account);
  EXPECT_GT(std::abs(expected[0]), 1e-7) << what;
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_NEAR(found[i], expected[i], 1e-3 * std::abs(expected[i])) << what;
  return most_way;
}

}  // namespace

TEST(ContactPointsOfTheGpu, AreThoseOfTheHost)
{
  for (const std::string body : { "sphere", "samples", "plate" })
    for (const double friction : { 0.0, 0.4 })
    {
      Model model = test::block_and_finger(friction, body == "samples");
      if (body == "plate")
        model.contacts[0].field = test::plate(4.2e-3, 1);
      EXPECT_EQ(compare(model, body), 0);
    }
}

// The finger hangs on a spring, and its bone turns and shifts. Without a bone, a force pushes it.
TEST(ContactPointsOfTheGpu, PushBodiesAsOnTheHost)
{
  for (const bool free : { false, true })
  {
    Model model = test::block_and_finger(0.4, true);
    Contact& contact = model.contacts[0];
    contact.centre = { { 4e-3, 4e-3, 8.2e-3 } };
    contact.mass = 2e-3;
    contact.spring = 400;
    contact.damping = 0.5;
    if (free)
    {
      contact.bone = -1;
      contact.force = { { 0.02, 0, -0.3 } };
    }
    EXPECT_GT(compare(model, free ? "free" : "on a spring"), 0.1e-3);
  }
}

// The threads of several warps in several blocks add the forces of points on three bodies, of which no point touches
// the last; then a warp moves each body. Forces are multiples of 1/8 N, so that any order of addition gives the same
// sum.
TEST(ContactPointsOfTheGpu, AddTheForcesOfAllBlocks)
{
  constexpr std::uint32_t bodies = 3, threads = 96, blocks = 40;
  std::vector<PushedBody> body;
  for (std::uint32_t i = 0; i < bodies; ++i)
    body.push_back({ { 1e-3 * (i + 1), 20, 0.1, { 0, 0, -0.5 } }, static_cast<std::int32_t>(2 * i + 1) });
  std::vector<physics::PushedMotion<double>> motions(bodies, { { 0, 0, 1e-3 }, { 0, 0, 2e-3 }, { 0.1, 0, 0 }, dt, dt });
  const std::vector<physics::Vec3<double>> held_at(bodies, { 0, 1e-3, 2e-3 });
  std::vector<physics::Vec3<double>> reactions(bodies * blocks, { 1, 1, 1 }), sums(bodies, { 0, 0, 0 });
  std::vector<float4> poses(3 * (2 * bodies + 1), float4{ 0, 0, 0, 0 });
  const PushedBodies pushed{
    body.data(), bodies, blocks, poses.data(), held_at.data(), motions.data(), reactions.data()
  };
  std::mt19937 random(3);
  for (std::uint32_t block = 0; block < blocks; ++block)
  {
    std::vector<std::int32_t> of(threads);
    std::vector<physics::Vec3<float>> force(threads);
    for (std::uint32_t t = 0; t < threads; ++t)
    {
      const auto drawn = [&] { return static_cast<float>(random() % 64) / 8 - 4; };
      force[t] = { drawn(), drawn(), drawn() };
      // Threads without a point, points of bodies that are not pushed, and blocks with no point of the second body.
      of[t] = static_cast<std::int32_t>(random() % 5) - 1;
      if (of[t] == 3 && block % 3 == 0)
        of[t] = 0;
      for (std::uint32_t i = 0; i < bodies; ++i)
        if (of[t] == body[i].body)
          sums[i] = sums[i] - physics::Vec3<double>{ force[t].x, force[t].y, force[t].z };
    }
    BlockOnHost([&] { put_reactions<threads>(pushed, block, of[threadIdx.x], force[threadIdx.x]); }, threads);
  }
  EXPECT_GT(norm(sums[0]), 1);
  EXPECT_GT(norm(sums[1]), 1);
  for (std::uint32_t i = 0; i < bodies; ++i)
  {
    const auto expected = moved_on(body[i].law, motions[i], sums[i], held_at[i]);
    BlockOnHost([&] { move_body(pushed, i, 0, 2 * dt, 2 * bodies + 1); });
    for (const auto& [found, right] :
         { std::pair(motions[i].centre, expected.centre), std::pair(motions[i].velocity, expected.velocity) })
    {
      EXPECT_EQ(found.x, right.x) << i;
      EXPECT_EQ(found.y, right.y) << i;
      EXPECT_EQ(found.z, right.z) << i;
    }
    EXPECT_EQ(motions[i].dt, 2 * dt);
  }
}

#else

TEST(ContactPointsOfTheGpu, NeedATool) { GTEST_SKIP() << "no CUDA toolkit"; }

#endif
