// The GPU's code for strips with cut voxels, run on the host. The test needs a CUDA toolkit but no GPU.
#include <gtest/gtest.h>

#if __has_include(<cuda_runtime.h>) && defined(__x86_64__)

#include "frontalis/solver/solver.hpp"
#include "solver/stepping/step_bound.hpp"

#include "block_model.hpp"
#include "nodal_vectors.hpp"

#include <cmath>
#include <random>
#include <vector>

#include "device_on_host.hpp"

// strips call only some of the functions that their headers define
#pragma GCC diagnostic ignored "-Wunused-function"
#include "cuda/kernels/strip_sweep.cuh"

using namespace frontalis;
using namespace frontalis::cuda;

namespace
{

using test::Vectors;

// Three layers of voxels with a hole, most of them cut.
Model cut_layers(HourglassControl hourglass)
{
  test::BlockSettings s;
  s.voxels = { { 37, 7, 3 } };
  s.spacing = { { 1e-3, 1.2e-3, 0.9e-3 } };
  s.keep = [](int i, int j, int) { return i < 12 || i > 15 || j > 4; };
  Model model = test::block_model(s);
  model.materials[0].parameters[physics::slot_of(1)] = 0.3;  // stiffening
  model.hourglass = hourglass;
  std::mt19937 random(5);
  std::uniform_real_distribution<float> value(-0.9F, 0.9F);
  model.tissue_centre.resize(model.voxels.size());
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
    if (e % 4 != 0)
    {
      model.tissue_centre[e] = { value(random), value(random), value(random) };
      model.fill[e] = 0.05F + 0.5F * std::abs(value(random));
    }
  return model;
}

// Internal forces in single precision at each node of the model, and the bound of the squared highest frequency. If
// `chosen` is a node, the bound is that of this node with a mass of 1 kg.
template <Effects With>
struct Swept
{
  Swept(const Model& model, const Vectors& at, std::int32_t chosen = -1)
  {
    const Discretisation d(model);
    const VoxelStrips strips(model, { 2, 3 });
    std::vector<StripSlot> slots = strips.slots;
    slots.resize(slots.size() + planes_ahead * 4 * 32, StripSlot{ 0, 0 });
    std::vector<uint2> words;
    for (const StripSlot& slot : slots)
      words.push_back({ slot.node, slot.voxel });
    std::vector<float4> palette(1), stabilisation(1), centres(1), corners(2);
    std::vector<float> bounds(1);
    VoxelProperties voxel;
    const auto word = [](double x, double y, double z, double w) {
      return float4{ static_cast<float>(x), static_cast<float>(y), static_cast<float>(z), static_cast<float>(w) };
    };
    for (std::size_t e = 0; e < model.voxels.size(); ++e)
    {
      d.voxel(e, voxel);
      const auto& form = voxel.stabilisation;
      palette.push_back(
          word(voxel.mu * voxel.tissue_volume, voxel.kappa * voxel.tissue_volume, voxel.hourglass, voxel.stiffening));
      bounds.push_back(static_cast<float>(voxel.stiffness));
      stabilisation.push_back(word(form.bending, form.coupling, form.torsion, form.warping));
      centres.push_back(word(voxel.centre.x, voxel.centre.y, voxel.centre.z, 0));
      const auto& factor = d.corner_stiffness[e];
      corners.push_back({ factor[0], factor[1], factor[2], factor[3] });
      corners.push_back({ factor[4], factor[5], factor[6], factor[7] });
    }
    std::vector<float4> u(model.nodes.size() + 1, float4{ 0, 0, 0, 0 }), next = u;
    std::vector<float> v(u.size(), 0);
    for (std::size_t n = 0; n < at.size(); ++n)
      u[strips.device_node[n]] = word(at[n][0], at[n][1], at[n][2], 1 / d.node_mass[n]);
    std::vector<float> mobility(u.size(), 0);
    StepArguments g{};
    if (chosen >= 0)
    {
      mobility[strips.device_node[chosen]] = 1;
      g.mobility = mobility.data();
    }
    g.slots = words.data();
    g.palette = palette.data();
    g.stiffness_bounds = bounds.data();
    g.stabilisation = d.assumed_strain ? stabilisation.data() : nullptr;
    g.centres = centres.data();
    g.corner_stiffness = corners.data();
    for (float*& component : g.v)
      component = v.data();
    g.forces_only = true;
    g.stretch_half_sum = static_cast<float>(d.stretch_half_sum);
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      g.scale[axis] = static_cast<float>(0.25 / model.spacing[axis]);
      g.stretch_weight[axis] = static_cast<float>(d.stretch_weight[axis]);
      g.hourglass_weight[axis] = static_cast<float>(d.hourglass_weight[axis]);
    }
    std::uint32_t most = 0;
    for (const Strip& strip : strips.strips)
      BlockOnHost(
          [&]
          {
            std::uint32_t bits = 0;
            sweep_strip<2, With>(g, strip, g.slots + strip.slot_begin + threadIdx.x, nullptr, nullptr, u.data(),
                                 next.data(), Activations{ nullptr, 1 }, true, bits);
            most = std::max(most, bits);
          });
    frequency_squared = double(__uint_as_float(most));
    for (std::size_t n = 0; n < at.size(); ++n)
    {
      const float4& f = next[strips.device_node[n]];
      forces.push_back({ { double(f.x), double(f.y), double(f.z) } });
    }
  }

  Vectors forces;
  double frequency_squared = 0;
};

template <Effects With>
void compare(HourglassControl hourglass)
{
  const Model model = cut_layers(hourglass);
  const Vectors u = test::random_vectors(model, 1e-4, 3);
  Vectors expected;
  const auto reference = make_solver(std::make_shared<const Model>(model), { "reference", 1, 0 });
  reference->set_displacements(u);
  reference->internal_forces(expected);
  const Swept<With> swept(model, u);
  double size = 0, apart = 0;
  for (std::size_t n = 0; n < u.size(); ++n)
    for (int axis = 0; axis < 3; ++axis)
    {
      size = std::max(size, std::abs(expected[n][axis]));
      apart = std::max(apart, std::abs(swept.forces[n][axis] - expected[n][axis]));
    }
  EXPECT_GT(size, 0);
  EXPECT_LT(apart, 2e-5 * size);
  const double critical = reference->monitor().critical_time_step;
  EXPECT_NEAR(std::sqrt(swept.frequency_squared) * critical / 2, 1, 1e-4);
}

}  // namespace

TEST(CutVoxelsOfTheGpu, HaveTheForcesAndTheBoundOfTheReference)
{
  compare<Effects::cut>(HourglassControl::scalar);
  constexpr Effects general = static_cast<Effects>(int(Effects::cut) | int(Effects::general_element));
  compare<general>(HourglassControl::assumed_strain);
}

TEST(CutVoxelsOfTheGpu, AddTheBoundsOfTheirCorners)
{
  const Model model = cut_layers(HourglassControl::scalar);
  const Discretisation d(model);
  VoxelProperties voxel;
  const auto count = static_cast<std::int32_t>(model.nodes.size());
  for (std::int32_t n = 0; n < count; n += 41)
  {
    double sum = 0;
    for (std::size_t e = 0; e < model.voxels.size(); ++e)
      for (std::size_t corner = 0; corner < 8; ++corner)
        if (model.voxel_nodes[e][corner] == n)
        {
          d.voxel(e, voxel);
          sum += voxel.stiffness * d.factor_at(static_cast<std::int32_t>(e), corner);
        }
    const Swept<Effects::cut> swept(model, Vectors(model.nodes.size()), n);
    EXPECT_NEAR(swept.frequency_squared / sum, 1, 1e-5) << n;
  }
}

#else

TEST(CutVoxelsOfTheGpu, NeedATool) { GTEST_SKIP() << "no CUDA toolkit"; }

#endif
