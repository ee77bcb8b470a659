// The GPU's code for attached nodes and joints, run on the host. The test needs a CUDA toolkit but no GPU.
#include <gtest/gtest.h>

#if __has_include(<cuda_runtime.h>) && defined(__x86_64__)

#include "cuda/backend/contact_point.hpp"
#include "cuda/backend/device_attachment.hpp"
#include "frontalis/model/sample_field.hpp"

#include "block_model.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "device_on_host.hpp"

#include "cuda/kernels/attached_group.cuh"

using namespace frontalis;
using namespace frontalis::cuda;

namespace
{

using Place = std::array<double, 3>;
constexpr double dt = 1e-5, edge = 1e-3, surface = 0.4e-3;
constexpr Place centre{ { 2.5e-3, 2e-3, surface - 30e-3 } };

double level(const Place& p) { return std::hypot(p[0] - centre[0], p[1] - centre[1], p[2] - centre[2]) - 30e-3; }

// A block whose lowest two layers of nodes follow the third. Nodes at x < 2 edges are held by a bone that turns,
// further ones slide on a ball, which stands still up to x = 3 edges and moves with the bone beyond. At the last x,
// one node of each pair slides and the other is held, by masters with a prescribed height. The highest layer is joined
// to the one below it.
Model attached_block(bool sampled)
{
  test::BlockSettings s;
  s.voxels = { { 5, 4, 6 } };
  Model model = test::block_model(s);
  model.bones = { "jaw" };
  std::vector<Place> rest;
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
    rest.push_back(rest_position(model, n));
  for (const std::int32_t bone : { -1, 0 })
  {
    ConstraintSurface ball;
    ball.bone = bone;
    ball.field = sampled ? sample_field(rest, level, 0.5e-3, 5e-3) : sphere_field(centre, 30e-3);
    model.constraint_surfaces.push_back(ball);
  }
  Load path;
  path.kind = Load::Kind::displacement;
  path.fixed = { { false, true, false } };
  model.loads = { path };
  const auto above = [&](std::size_t n, std::int32_t k)
  {
    auto place = model.nodes[n];
    place[2] = k;
    return static_cast<std::int32_t>(std::find(model.nodes.begin(), model.nodes.end(), place) - model.nodes.begin());
  };
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
  {
    const auto& at = model.nodes[n];
    const auto node = static_cast<std::int32_t>(n);
    if (at[2] == 6)
      model.joints.push_back({ node, above(n, 5) });
    if (at[2] > 1)
      continue;
    const std::int32_t master = above(n, 2);
    const bool slides = at[0] == 5 ? at[2] == 0 : at[0] > 1;
    const double ratio =
        slides ? level(rest[n]) / level(rest[master]) : (at[2] * edge - surface) / (2 * edge - surface);
    model.attached.push_back(
        { node, master, std::clamp(ratio, -1.0, 1.0), slides ? -1 : 0, slides ? (at[0] > 3 ? 1 : 0) : -1, -1 });
    if (at[0] == 5 && at[2] == 0)
      model.prescribed.push_back({ master, 0 });
  }
  return model;
}

RigidTransform pose(int step)
{
  const double a = 4 * dt * step;
  return { { { std::cos(a), 0, std::sin(a), 0, 1, 0, -std::sin(a), 0, std::cos(a) } },
           { { 30 * a * edge, 10 * a * edge, -0.2 * a * edge } } };
}

// The nodes of a model as the GPU stores them.
struct Device
{
  explicit Device(const Model& model, const std::vector<double>& mass)
      : tables(model, mass, numbers(model.nodes.size()), nullptr), planes(tables.places.size())
  {
    for (const ConstraintSurface& of : model.constraint_surfaces)
      fields.push_back(view(of.field));
    for (auto& component : v)
      component.assign(model.nodes.size() + 1, 0);
    u.assign(model.nodes.size() + 1, float4{ 0, 0, 0, 1 });
    g.u[1] = u.data();
    for (int axis = 0; axis < 3; ++axis)
      g.v[axis] = v[axis].data();
    g.fields = fields.data();
    g.bones = 1;
    g.dt = static_cast<float>(dt);
  }

  void step(int number)
  {
    std::vector<float> motions(2 * bone_motion_entries);
    for (int s = 0; s < 2; ++s)
      put_bone_motion(pose(std::max(0, number + s - 1)), pose(number + s), 1 / dt, &motions[s * bone_motion_entries]);
    std::vector<float4> words(motions.size() / 4);
    std::memcpy(words.data(), motions.data(), motions.size() * sizeof(float));
    g.bone_motions = words.data();
    g.attached = { tables.groups.data(),
                   static_cast<std::uint32_t>(tables.groups.size()),
                   tables.ties.data(),
                   tables.places.data(),
                   planes.data(),
                   nullptr,
                   nullptr };
    for (std::uint32_t group = 0; group < g.attached.count; ++group)
    {
      keep_planes<1>(g, group_tables(g.attached), group, g.u[1], 1);
      follow_master<1>(g, group_tables(g.attached), group, 0, g.u[1], g.v);
    }
  }

  static std::vector<std::uint32_t> numbers(std::size_t count)
  {
    std::vector<std::uint32_t> device_node;
    for (std::size_t n = 0; n < count; ++n)
      device_node.push_back(static_cast<std::uint32_t>(count - n));
    return device_node;
  }

  AttachedTables tables;
  std::vector<physics::KeptLevel<float>> planes;
  std::vector<physics::DistanceField> fields;
  std::vector<float4> u;
  std::vector<float> v[3];
  StepArguments g{};
};

}  // namespace

// Both get the same random forces for some time.
TEST(AttachedNodesOfTheGpu, MoveAsOnTheHost)
{
  for (const bool sampled : { false, true })
  {
    const Model model = attached_block(sampled);
    const std::size_t count = model.nodes.size();
    std::mt19937 random(7);
    const auto between = [&](double low, double high)
    { return low + (high - low) * (static_cast<double>(random()) / 4294967296.0); };
    std::vector<double> mass;
    for (std::size_t n = 0; n < count; ++n)
      mass.push_back(between(0.2e-6, 2e-6));
    AttachedNodes<double> host(model, mass);
    Device device(model, mass);
    std::vector<double> u[3], v[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      u[axis].assign(count, 0);
      v[axis].assign(count, 0);
    }
    double* const to_u[3] = { u[0].data(), u[1].data(), u[2].data() };
    double* const to_v[3] = { v[0].data(), v[1].data(), v[2].data() };
    const auto number = Device::numbers(count);
    double farthest = 0, apart = 0, apart_in_speed = 0;
    for (int step = 0; step < 400; ++step)
    {
      for (std::size_t n = 0; n < count; ++n)
      {
        float4& moved = device.u[number[n]];
        float* const component[3] = { &moved.x, &moved.y, &moved.z };
        for (int axis = 0; axis < 3; ++axis)
        {
          const auto push = static_cast<float>(between(-0.01, 0.01) + (axis == 0 ? 2e-3 : 0));
          v[axis][n] += double(push);
          device.v[axis][number[n]] += push;
          u[axis][n] += dt * v[axis][n];
          *component[axis] += static_cast<float>(dt) * device.v[axis][number[n]];
        }
      }
      const ConstraintStep now{ (step + 1) * dt, dt, step * dt, { pose(step + 1) }, { pose(step) }, {} };
      host.constrain_groups({ 0, 1, 0, 7, 0, static_cast<std::int32_t>(count) }, to_u, to_v, now);
      device.step(step);
      for (std::size_t n = 0; n < count; ++n)
      {
        const float4 moved = device.u[number[n]];
        const double found[3] = { double(moved.x), double(moved.y), double(moved.z) };
        for (int axis = 0; axis < 3; ++axis)
        {
          farthest = std::max(farthest, std::abs(u[axis][n]));
          apart = std::max(apart, std::abs(found[axis] - u[axis][n]));
          apart_in_speed = std::max(apart_in_speed, std::abs(double(device.v[axis][number[n]]) - v[axis][n]));
        }
        ASSERT_EQ(moved.w, 1) << "inverse masses are kept";
      }
    }
    EXPECT_GT(farthest, 1e-3);
    EXPECT_LT(apart, 1e-3 * farthest) << (sampled ? "sampled" : "closed form");
    EXPECT_LT(apart_in_speed, 5e-3) << (sampled ? "sampled" : "closed form");
    for (const Model::Joint& joint : model.joints)
      EXPECT_EQ(device.u[number[joint.node]].x, device.u[number[joint.master]].x);
  }
}

#else

TEST(AttachedNodesOfTheGpu, NeedATool) { GTEST_SKIP() << "no CUDA toolkit"; }

#endif
