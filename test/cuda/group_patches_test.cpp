// The GPU's kernel for patches with groups and cut voxels, run on the host by one block. The test needs a CUDA toolkit
// but no GPU.
#include <gtest/gtest.h>

#if __has_include(<cuda_runtime.h>) && defined(__x86_64__)

#include "cuda/backend/device_attachment.hpp"
#include "cuda/partition/voxel_patches.hpp"
#include "frontalis/model/sample_field.hpp"
#include "frontalis/solver/solver.hpp"
#include "solver/stepping/step_bound.hpp"

#include "parted_block.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "device_on_host.hpp"

#undef __launch_bounds__
#define __launch_bounds__(...)
static const dim3 blockIdx(0), gridDim(1);
namespace frontalis
{
namespace cuda
{
float4 all[1 << 14];  // the shared memory of the block
}
}  // namespace frontalis

// The kernel calls only some of the functions that its headers define, some of which have variables named like the
// shared memory.
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wshadow"
// the kernel reads what it has fetched only for the tasks for which it has fetched it
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#include "cuda/kernels/patch_kernel.cuh"

using namespace frontalis;
using namespace frontalis::cuda;

namespace
{

constexpr double dt = 4e-6, edge = 1e-3;
constexpr int steps = 150;
constexpr Effects kernel_effects = static_cast<Effects>(int(of_nodes) | int(Effects::cut) | int(Effects::groups));

// A block of cut voxels whose lowest nodes follow those above them, two each, held at small x, else sliding on a slope.
// Its right half is parted from the lower voxels, but joined to them at its end.
Model whole_model()
{
  test::BlockSettings s;
  s.voxels = { { 6, 4, 5 } };
  s.poisson = 0.45;
  Model model = test::block_model(s);
  model.materials[0].parameters[physics::slot_of(1)] = 0.3;  // stiffening
  test::part(model, 3, [](int i) { return i >= 3; });
  test::join(model, [](int i) { return i == 3 || i == 6; });
  const auto level = [](const std::array<double, 3>& p) { return 0.96 * p[2] + 0.28 * p[0] - 0.4 * edge; };
  std::vector<std::array<double, 3>> rest;
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
    rest.push_back(rest_position(model, n));
  ConstraintSurface slope;
  slope.field = sample_field(rest, level, 0.5e-3, 8e-3);
  model.constraint_surfaces = { slope };
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
  {
    const auto& at = model.nodes[n];
    const auto node = static_cast<std::int32_t>(n);
    if (at[2] > 0)
      continue;
    const std::int32_t master = test::node_at(model, { { at[0] / 2 * 2, at[1], 1 } });
    const bool slides = at[0] > 2;
    model.attached.push_back({ node, master,
                               slides ? std::clamp(level(rest[n]) / level(rest[master]), -1.0, 1.0) : -0.6, -1,
                               slides ? 0 : -1, -1 });
  }
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    model.tissue_centre.push_back({ { 0.1F * static_cast<float>(e % 7) - 0.3F, 0.4F, e % 2 == 0 ? -0.5F : 0.2F } });
    model.fill[e] = 0.4F + 0.1F * static_cast<float>(e % 5);
  }
  model.gravity = { { 20, 5, -98.1 } };
  model.damping = 30;
  return model;
}

template <class To, class From>
std::vector<To> words_of(const std::vector<From>& from)
{
  static_assert(sizeof(To) == sizeof(From));
  std::vector<To> to(from.size());
  std::memcpy(static_cast<void*>(to.data()), from.data(), from.size() * sizeof(To));
  return to;
}

// Compares the motion with that on the reference backend. `turns`: number of patches of the block. `shared`: whether
// shared memory holds the tables of groups.
void compare(int turns, bool shared)
{
  const Model model = whole_model();
  const Discretisation d(model);
  const VoxelPatches patches(model, { 1, turns });
  const std::size_t nodes = model.nodes.size() + 1;
  PatchRoom room{};
  room.group_words = shared ? most_group_words(model, patches) : 0;
  ASSERT_LT(patch_bytes(patches.most_voxels, patches.most_halo, patches.most_nodes, room), sizeof frontalis::cuda::all);

  const auto word = [](double x, double y, double z, double w) {
    return float4{ static_cast<float>(x), static_cast<float>(y), static_cast<float>(z), static_cast<float>(w) };
  };
  std::vector<float4> palette(1), centres(1), corners(2);
  std::vector<float> bounds(1);
  std::vector<uint2> properties;
  VoxelProperties voxel;
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    d.voxel(e, voxel);
    palette.push_back(
        word(voxel.mu * voxel.tissue_volume, voxel.kappa * voxel.tissue_volume, voxel.hourglass, voxel.stiffening));
    bounds.push_back(static_cast<float>(voxel.stiffness));
    centres.push_back(word(voxel.centre.x, voxel.centre.y, voxel.centre.z, 0));
    const auto& factor = d.corner_stiffness[e];
    corners.push_back({ factor[0], factor[1], factor[2], factor[3] });
    corners.push_back({ factor[4], factor[5], factor[6], factor[7] });
  }
  for (const std::uint32_t e : patches.voxel)
    properties.push_back({ e + 1, 0 });
  const std::vector<uint4> corner = words_of<uint4>(patches.corner), node_voxel = words_of<uint4>(patches.node_voxel);
  std::vector<float4> u(nodes, float4{ 0, 0, 0, 0 }), next = u;
  std::vector<float> v[3], mobility(nodes, 0);
  const std::vector<float> of_node = frontalis::mobility(d);
  for (std::size_t n = 0; n + 1 < nodes; ++n)
  {
    u[patches.device_node[n]].w = static_cast<float>(1 / d.node_mass[n]);
    mobility[patches.device_node[n]] = of_node[n];
  }
  const std::vector<std::int32_t> tasks(nodes, patch_task::none);
  const AttachedTables tables(model, d.node_mass, patches.device_node, &patches);
  std::vector<physics::KeptLevel<float>> planes(tables.places.size());
  const physics::DistanceField field = view(model.constraint_surfaces[0].field);
  std::uint32_t bound = 0;

  StepArguments g{};
  static_cast<physics::Kick<float>&>(g) = physics::kick_of<float>(model.damping, dt, model.gravity);
  g.patches = patches.patches.data();
  g.patch_count = static_cast<std::uint32_t>(turns);
  g.patch_corners = corner.data();
  g.patch_properties = properties.data();
  g.halo = patches.halo.data();
  g.node_voxels = node_voxel.data();
  g.patch_tasks = tasks.data();
  g.u[0] = u.data();
  g.u[1] = next.data();
  for (int axis = 0; axis < 3; ++axis)
  {
    v[axis].assign(nodes, 0);
    g.v[axis] = v[axis].data();
  }
  g.mobility = mobility.data();
  g.palette = palette.data();
  g.stiffness_bounds = bounds.data();
  g.centres = centres.data();
  g.corner_stiffness = corners.data();
  g.fields = &field;
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    g.scale[axis] = static_cast<float>(0.25 / model.spacing[axis]);
    g.stretch_weight[axis] = static_cast<float>(d.stretch_weight[axis]);
    g.hourglass_weight[axis] = static_cast<float>(d.hourglass_weight[axis]);
  }
  g.stretch_half_sum = static_cast<float>(d.stretch_half_sum);
  g.dt = static_cast<float>(dt);
  g.dt_exact = dt;
  g.rate = 1 / dt;
  g.step_end = g.steps = steps;
  g.frequency_bound = &bound;
  g.attached = { tables.groups.data(), static_cast<std::uint32_t>(tables.groups.size()),
                 tables.ties.data(),   tables.places.data(),
                 planes.data(),        tables.patch_groups.data(),
                 tables.grouped.data() };
  StepLaunch launch{};
  launch.room = room;
  launch.most_voxels = patches.most_voxels;
  launch.most_halo = patches.most_halo;
  launch.most_nodes = patches.most_nodes;
  BlockOnHost([&] { patch_kernel<int(kernel_effects)>(g, launch); });

  const auto reference = make_solver(std::make_shared<const Model>(model), { "reference", 1, dt });
  reference->advance(steps * dt, reference->controls());
  std::vector<std::array<double, 3>> expected;
  reference->displacements(expected);
  const std::vector<float4>& found = steps % 2 == 0 ? u : next;
  double size = 0, apart = 0;
  for (std::size_t n = 0; n < expected.size(); ++n)
  {
    const float4& at = found[patches.device_node[n]];
    const double moved[3] = { double(at.x), double(at.y), double(at.z) };
    for (int axis = 0; axis < 3; ++axis)
    {
      size = std::max(size, std::abs(expected[n][axis]));
      apart = std::max(apart, std::abs(moved[axis] - expected[n][axis]));
    }
  }
  EXPECT_GT(size, 1e-5);
  EXPECT_LT(apart, 1e-3 * size);
  const double critical = reference->monitor().critical_time_step;
  EXPECT_NEAR(std::sqrt(double(__uint_as_float(bound))) * critical / 2, 1, 1e-2);
}

}  // namespace

TEST(PatchesOfTheGpu, MoveGroupsAndCutVoxelsAsTheReference)
{
  for (const int turns : { 1, 2, 3 })
    for (const bool shared : { true, false })
      compare(turns, shared);
}

#else

TEST(PatchesOfTheGpu, NeedATool) { GTEST_SKIP() << "no CUDA toolkit"; }

#endif
