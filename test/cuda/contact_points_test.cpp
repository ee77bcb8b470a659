// The GPU's code for points of contact, run on the host. The test needs a CUDA toolkit but no GPU.
#include <gtest/gtest.h>

#if __has_include(<cuda_runtime.h>) && defined(__x86_64__)

#include "cuda/backend/contact_point.hpp"
#include "solver/bodies_touch.hpp"
#include "solver/contact/body_motion.hpp"
#include "solver/energy/energy_ledger_keeper.hpp"

#include "device_on_host.hpp"

#include "cuda/kernels/contact_points.cuh"

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
    g_.contact.samples = samples_.data();
    g_.contact.grips = grips_.data();
    g_.contact.holds = holds_.data();
    g_.contact.forces = forces_.data();
    g_.contact.arms = arms_.data();
    g_.contact.clearances = clearances_.data();
    g_.bones = 2;
    g_.friction_response = physics::friction_response(dt);
  }
  TwoWays(const TwoWays&) = delete;
  TwoWays& operator=(const TwoWays&) = delete;

  // A wave passes through the tissue while the finger presses, strokes and leaves.
  void step(int number)
  {
    const ConstraintStep now{ (number + 1) * dt, dt, number * dt, bones(number + 1), bones(number) };
    std::vector<float> motions;
    for (const RigidTransform& pose : now.bone_before)
      add_bone_motion(pose, pose, 1 / dt, motions);
    std::vector<float4> bones_before(motions.size() / 4);
    std::memcpy(bones_before.data(), motions.data(), motions.size() * sizeof(float));
    g_.bone_motions = bones_before.data();
    std::vector<float> of_bodies;
    for (const ContactBody& body : bodies_)
      add_pose(body, now.bone_before, of_bodies);
    std::vector<float4> rows(of_bodies.size() / 4);
    std::memcpy(rows.data(), of_bodies.data(), of_bodies.size() * sizeof(float));
    g_.contact.poses = rows.data();
    if (number > 0)
      way_ += longest_way(bones(number - 1)[1], bones(number)[1], far_corner(model_));
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
    account.follow(found, now);
    const Components before = u_;
    for (std::size_t n = 0; n < model_.nodes.size(); ++n)
      for (std::size_t axis = 0; axis < 3; ++axis)
        u_[axis][n] = static_cast<float>(
            50e-6 * std::sin(300 * (number + 1) * dt + 700 * test::rest(model_, n)[axis] + double(axis)));
    const double* const old[3] = { before[0].data(), before[1].data(), before[2].data() };
    host.after_step(all, old, pointers().data());
  }
  // Work of bodies and energy lost to friction [J].
  std::array<double, 2> energies(HostContact& of)
  {
    EnergyLedger ledger = empty_ledger();
    std::vector<std::array<double, 3>> none;
    of.add_energies(pointers().data(), bones(steps), false, none, ledger);
    return { { ledger["contact"], ledger["friction"] } };
  }

private:
  using Components = std::array<std::vector<double>, 3>;
  std::array<const double*, 3> pointers() const { return { { u_[0].data(), u_[1].data(), u_[2].data() } }; }
  static std::vector<RigidTransform> bones(int step)
  {
    const double part = double(step) / steps, depth = std::sin(2 * 3.14159265 * part);
    return { RigidTransform(), rigid_motion({ { 0, 0.1 * part, 0.3 * part } }, { { 1e-3 * part, 0, -1e-3 * depth } }) };
  }

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

TEST(ContactPointsOfTheGpu, AreThoseOfTheHost)
{
  for (const std::string body : { "sphere", "samples", "plate" })
    for (const double friction : { 0.0, 0.4 })
    {
      Model model = test::block_and_finger(friction, body == "samples");
      if (body == "plate")
        model.contacts[0].field = test::plate(4.2e-3, 1);
      TwoWays points(model);
      double most_force = 0, most_moment = 0, worst_force = 0, worst_moment = 0;
      for (int step = 0; step < steps; ++step)
      {
        points.step(step);
        const Reaction expected = points.host.reactions()[0], found = points.account.reactions()[0];
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
          most_force = std::max(most_force, std::abs(expected.force[axis]));
          most_moment = std::max(most_moment, std::abs(expected.moment[axis]));
          worst_force = std::max(worst_force, std::abs(expected.force[axis] - found.force[axis]));
          worst_moment = std::max(worst_moment, std::abs(expected.moment[axis] - found.moment[axis]));
        }
      }
      EXPECT_GT(points.touching, 10000);
      EXPECT_GT(points.skips, 10000) << body;
      EXPECT_GT(most_force, 0.1);
      EXPECT_LT(worst_force, 1e-4 * most_force) << body << friction;
      EXPECT_LT(worst_moment, 1e-4 * most_moment) << body << friction;
      const auto expected = points.energies(points.host), found = points.energies(points.account);
      EXPECT_GT(std::abs(expected[0]), 1e-7);
      for (std::size_t i = 0; i < 2; ++i)
        EXPECT_NEAR(found[i], expected[i], 1e-3 * std::abs(expected[i]));
    }
}

#else

TEST(ContactPointsOfTheGpu, NeedATool) { GTEST_SKIP() << "no CUDA toolkit"; }

#endif
