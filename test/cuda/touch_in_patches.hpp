#pragma once

#include "cuda/backend/touch_patches.hpp"

#include <gtest/gtest.h>

#include "device_on_host.hpp"

#include "cuda/kernels/patch_touch.cuh"
#include "cuda/kernels/tissue_contact_search.cuh"

#include "frontalis/physics/sliding.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace frontalis
{
namespace test
{

using namespace cuda;

// Contact forces that patches find within their steps. All patches do one part of a step before any does the next part,
// so that none has to wait for another.
class InPatches
{
public:
  using Forces = std::vector<std::array<double, 3>>;

  InPatches(const Model& model, const TouchTables& tables, int blocks)
      : cut_(model, { blocks, 1 }), tables_(tables, cut_)
  {
    for (const TouchPatch& patch : tables_.patches)
      launch_.room.touch_vertices = std::max(launch_.room.touch_vertices, patch.vertices);
    launch_.most_voxels = cut_.most_voxels;
    counts_.resize(2 * cut_.patches.size());
    before_.resize(tables_.vertex_of.size());
    lists_.resize(cut_.patches.size() * tables_.vertices);
    entries_.resize(tables_.most_entries);
    entry_vertex_.resize(tables_.most_entries);
    for (auto& words : words_)
      words.assign(touch_words * tables_.vertices, float4{ 0, 0, 0, 0 });
    // Patches wait for each other.
    const auto watches = [&](std::uint32_t p, std::uint32_t q)
    {
      const auto first = tables_.watched.begin();
      return std::find(first + tables_.watch_begin[p], first + tables_.watch_begin[p + 1], q) !=
             first + tables_.watch_begin[p + 1];
    };
    for (std::uint32_t p = 0; p < cut_.patches.size(); ++p)
      for (std::uint32_t q = 0; q < cut_.patches.size(); ++q)
        EXPECT_EQ(watches(p, q), watches(q, p));
    for (auto& words : ended_)
      words.assign(cut_.patches.size(), float4{ 0, 0, 0, 0 });
    view_ = { tables_.patches.data(),
              std::uint32_t(cut_.patches.size()),
              tables_.corners.data(),
              tables_.vertex_of.data(),
              std::uint32_t(before_.size()),
              before_.data(),
              tables_.voxels.data(),
              tables_.copy_of.data(),
              tables_.near_begin.data(),
              tables_.near.data(),
              tables_.slide,
              tables_.per_newton,
              counts_.data(),
              lists_.data(),
              entries_.data(),
              entry_vertex_.data(),
              { words_[0].data(), words_[1].data() },
              tables_.watch_begin.data(),
              tables_.watched.data(),
              { ended_[0].data(), ended_[1].data() } };
    for (std::size_t p = 0; p < cut_.patches.size(); ++p)
    {
      place_.emplace_back(cut_.most_halo + cut_.most_nodes);
      force_.emplace_back(25 * (cut_.most_voxels + 1), 0.0F);
      touch_.emplace_back(touch_room * launch_.room.touch_vertices);
    }
  }
  InPatches(const InPatches&) = delete;
  InPatches& operator=(const InPatches&) = delete;

  // Lists the pairs before a launch.
  void list(TissueContactArguments& gpu)
  {
    gpu.in_patches = view_;
    std::fill(counts_.begin(), counts_.end(), 0);
    for (std::size_t i = 0; i < before_.size(); ++i)
      before_[i] = gpu.moved[tables_.vertex_of[i] & ~touch_mark];
    for (std::uint32_t v = 0; v < gpu.vertex_count; ++v)
    {
      begin_pairs(gpu, v);
      list_vertex(gpu, v);
    }
    EXPECT_LE(gpu.control->entries, tables_.most_entries);
    gpu.control->entries = 0;
  }
  // Step `step` of a launch of `count` steps of length dt [s]. Returns the forces on nodes.
  Forces step(const TissueContactArguments& gpu, const std::vector<float4>& u, int step, int count, double dt)
  {
    StepArguments g{};
    g.touch = gpu;
    g.friction_response = physics::friction_response(dt);
    g.step_end = count;
    g.steps_before = steps_before_;
    std::vector<TouchStep> touch;
    const auto each_patch = [&](const auto& call)
    {
      for (std::size_t p = 0; p < cut_.patches.size(); ++p)
        call(p, memory(p));
    };
    each_patch(
        [&](std::size_t p, const PatchMemory& memory)
        {
          for (std::size_t n = 0; n < u.size(); ++n)
            if (const auto node = cut_.device_node[n]; is_own(p, node) || is_halo(p, node))
              place_[p][cut_.place_of(p, node)] = u[n];
          std::fill(force_[p].begin(), force_[p].end(), 0.0F);
          if (step == 0)
            clear_touch(launch_, memory);
          touch.push_back(fetch_touch(g, launch_, std::uint32_t(p), step));
          await_touch(g, touch[p]);
          place_touch(g, touch[p], memory);
        });
    Forces forces(u.size());
    each_patch(
        [&](std::size_t p, const PatchMemory& memory)
        {
          find_touch(g, touch[p], memory);
          add_touch(g, touch[p], memory);
          for (std::size_t n = 0; n < u.size(); ++n)
            if (const auto node = cut_.device_node[n]; is_own(p, node))
              for (std::size_t b = 0; b < 8; ++b)
                for (std::size_t axis = 0; axis < 3; ++axis)
                  forces[n][axis] -= double(memory.force[(3 * b + axis) * memory.width + cut_.node_voxel[node][b]]);
        });
    steps_before_ += step + 1 == count ? std::uint32_t(count) : 0;
    return forces;
  }

private:
  bool is_own(std::size_t p, std::uint32_t node) const
  {
    return node >= cut_.patches[p].first_node && node < cut_.patches[p].first_node + cut_.patches[p].nodes;
  }
  bool is_halo(std::size_t p, std::uint32_t node) const
  {
    const auto first = cut_.halo.begin() + cut_.patches[p].halo_begin;
    return std::binary_search(first, first + cut_.patches[p].halo, node);
  }
  PatchMemory memory(std::size_t p)
  {
    PatchMemory memory{};
    memory.place = place_[p].data();
    memory.force = force_[p].data();
    memory.width = cut_.most_voxels + 1;
    memory.touch = touch_[p].data();
    return memory;
  }

  const VoxelPatches cut_;
  const TouchPatchTables tables_;
  StepLaunch launch_{};
  std::vector<std::uint32_t> counts_, lists_, entry_vertex_;
  std::vector<TouchEntry> entries_;
  std::vector<float4> before_, words_[2], ended_[2];
  TouchPatches view_{};
  std::vector<std::vector<float4>> place_, touch_;
  std::vector<std::vector<float>> force_;
  std::uint32_t steps_before_ = 0;
};

}  // namespace test
}  // namespace frontalis
