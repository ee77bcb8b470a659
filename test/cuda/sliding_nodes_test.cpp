// The GPU's code for sliding nodes, run on the host. The test needs a CUDA toolkit but no GPU.
#include <gtest/gtest.h>

#if __has_include(<cuda_runtime.h>) && defined(__x86_64__)

#include "cuda/backend/contact_point.hpp"
#include "cuda/kernels/step_kernel.hpp"
#include "frontalis/model/sample_field.hpp"

#include <cmath>
#include <vector>

#include "device_on_host.hpp"

#include "cuda/kernels/sliding_nodes.cuh"

using namespace frontalis;
using namespace frontalis::cuda;

namespace
{

constexpr double radius = 60e-3, dt = 5e-6;
constexpr int steps = 10000;
using Place = std::array<double, 3>;
constexpr Place centre{ { 80e-3, 80e-3, 20e-3 } }, rest{ { 92e-3, 93e-3, 81.8e-3 } };

SampledField sampled()
{
  const auto distance = [](const Place& p)
  { return std::hypot(p[0] - centre[0], p[1] - centre[1], p[2] - centre[2]) - radius; };
  return sample_field({ rest }, distance, 0.5e-3, 20e-3);
}

// One sliding node, on a surface that stands still or on one that moves with a bone.
class OneNode
{
public:
  OneNode(const SampledField& field, bool glides, float friction = 0)
      : glides_(glides), field_(view(field)), level_(level_at(field, rest)), friction_(friction)
  {
    const auto point = physics::field_point(field_, { rest[0], rest[1], rest[2] });
    node_ = { 0, { point.cell[0], point.cell[1], point.cell[2] }, static_cast<float>(level_) };
    at_ = { static_cast<float>(point.offset.x), static_cast<float>(point.offset.y), static_cast<float>(point.offset.z),
            0 };
    if (field.radius > 0)
      samples_[0].x = static_cast<float>(norm(point.offset) - field.radius - level_);
    else
      samples_[sample_words - 1].w = static_cast<float>(1 / field.spacing);
    forget_samples();
    bone_ = { static_cast<float>(rest[0]), static_cast<float>(rest[1]), static_cast<float>(rest[2]), 0 };
    turn(0);
    g_.fields = &field_;
    g_.sliding = &node_;
    g_.sliding_count = 1;
    g_.sliding_at = &at_;
    g_.samples = samples_;
    g_.planes = &plane_;
    g_.friction = &friction_;
    g_.pressing = &pressing_;
    g_.rubbing_count = friction > 0 ? 1 : 0;
    g_.gliding = &bone_;
    g_.bones = 1;
    g_.dt_exact = dt;
    g_.dt = static_cast<float>(dt);
    g_.rate = 1 / dt;
    g_.friction_response = physics::friction_response(dt);
  }
  OneNode(const OneNode&) = delete;
  OneNode& operator=(const OneNode&) = delete;

  // Lets the bone turn about the z axis, and shift [rad/s].
  void turn(double rate)
  {
    rate_ = rate;
    std::vector<float> motions((steps + 1) * bone_motion_entries);
    for (int step = 0; step <= steps; ++step)
      put_bone_motion(pose(std::max(step - 1, 0)), pose(step), 1 / dt, &motions[step * bone_motion_entries]);
    motions_.resize(motions.size() / 4);
    std::memcpy(motions_.data(), motions.data(), motions.size() * sizeof(float));
    g_.bone_motions = motions_.data();
  }
  void forget_samples() { at_.w = __uint_as_float(no_cell); }
  void step(int number)
  {
    for (int axis = 0; axis < 3; ++axis)
      state.u[axis] += g_.dt * state.v[axis];
    const NodeStep at{ { 0, 0, 0, 1 }, 0, number };
    (glides_ ? glide<of_nodes> : keep_distance<of_nodes>)(g_, 0, at, state);
  }
  double energy() const
  {
    return 0.5 * (std::pow(double(state.v[0]), 2) + std::pow(double(state.v[1]), 2) + std::pow(double(state.v[2]), 2));
  }
  double moved() const { return std::hypot(double(state.u[0]), double(state.u[1]), double(state.u[2])); }
  // Distance of the node after `number` steps from the sphere on which it started [m].
  double off_level(int number) const
  {
    const Place at{ { rest[0] + state.u[0], rest[1] + state.u[1], rest[2] + state.u[2] } };
    const RigidTransform bone = pose(number);
    const auto inwards = [&](std::size_t axis)
    {
      double sum = 0;
      for (std::size_t i = 0; i < 3; ++i)
        sum += bone.rotation[3 * i + axis] * (at[i] - bone.translation[i]);
      return sum;
    };
    const physics::Vec3<double> p{ inwards(0), inwards(1), inwards(2) };
    const double start = std::hypot(rest[0] - centre[0], rest[1] - centre[1], rest[2] - centre[2]);
    return std::hypot(p.x - centre[0], p.y - centre[1], p.z - centre[2]) - start;
  }

  NodeState state{};

private:
  RigidTransform pose(int step) const
  {
    const double c = std::cos(rate_ * step * dt), s = std::sin(rate_ * step * dt);
    return { { { c, -s, 0, s, c, 0, 0, 0, 1 } }, { { 0.02 * rate_ * step * dt, 0, -0.05 * rate_ * step * dt } } };
  }

  bool glides_;
  physics::DistanceField field_;
  double level_;
  SlidingNodeField node_{};
  float4 at_{}, samples_[sample_words]{}, plane_{};
  float friction_, pressing_ = 0;
  float4 bone_{};
  std::vector<float4> motions_;
  double rate_ = 0;
  StepArguments g_{};
};

// Calls body(field, glides) for a sampled field and a closed form, each on a still surface and on a bone (`glides`).
template <class Body>
void each_kind(const Body& body)
{
  for (const SampledField& field : { sampled(), sphere_field(centre, radius) })
    for (const bool glides : { false, true })
      body(field, glides);
}

}  // namespace

TEST(SlidingNodesOfTheGpu, KeepTheirLevelAndTheirEnergy)
{
  each_kind(
      [](const SampledField& field, bool glides)
      {
        OneNode node(field, glides);
        node.state = { { 0, 0, 0 }, { 0.06f, -0.08f, 0 } };
        node.step(0);
        const double energy = node.energy();
        double worst = 0;
        for (int step = 1; step < steps; ++step)
        {
          node.step(step);
          worst = std::max(worst, std::abs(node.off_level(step + 1)));
        }
        EXPECT_GT(node.moved(), 4e-3);
        EXPECT_LT(worst, 1e-6);
        EXPECT_NEAR(node.energy(), energy, 1e-4 * energy);
      });
}

TEST(SlidingNodesOfTheGpu, StayWhereTheyRest)
{
  each_kind(
      [](const SampledField& field, bool glides)
      {
        OneNode node(field, glides);
        for (int step = 0; step < steps; ++step)
          node.step(step);
        EXPECT_LT(node.moved(), 0.02e-6);
        EXPECT_EQ(node.energy(), 0);
      });
}

TEST(SlidingNodesOfTheGpu, MoveTheSameWithoutKeptSamples)
{
  const SampledField field = sampled();
  for (const bool glides : { false, true })
  {
    OneNode one(field, glides, 0.1f), other(field, glides, 0.1f);
    one.state = other.state = { { 0, 0, 0 }, { 0.3f, -0.4f, 0 } };
    for (int step = 0; step < steps; ++step)
    {
      one.step(step);
      other.forget_samples();
      other.step(step);
      ASSERT_EQ(std::memcmp(&one.state, &other.state, sizeof(NodeState)), 0) << step;
    }
    EXPECT_GT(one.moved(), 4e-3);
  }
}

TEST(SlidingNodesOfTheGpu, RubAgainstABoneThatTurns)
{
  const SampledField field = sampled();
  OneNode node(field, true, 0.5f);
  node.turn(3);
  for (int step = 0; step < steps; ++step)
    node.step(step);
  EXPECT_GT(node.energy(), 0);
  EXPECT_LT(std::abs(node.off_level(steps)), 0.1e-6);
}

// A node beyond the samples stays on its latest plane.
TEST(SlidingNodesOfTheGpu, KeepTheirPlanePastTheRim)
{
  const SampledField field = sampled();
  OneNode node(field, false);
  node.state = { { 0, 0, 0 }, { 6, 0, 0 } };
  NodeState before{};
  for (int step = 0; step < steps; ++step)
  {
    before = node.state;
    node.step(step);
  }
  EXPECT_TRUE(std::isnan(
      level_at(field, { { rest[0] + node.state.u[0], rest[1] + node.state.u[1], rest[2] + node.state.u[2] } })));
  EXPECT_NEAR(std::sqrt(2 * node.energy()), 6, 0.5);
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(node.state.v[axis], before.v[axis], 1e-5);
}

#else

TEST(SlidingNodesOfTheGpu, NeedATool) { GTEST_SKIP() << "no CUDA toolkit"; }

#endif
