#include "cuda/partition/voxel_patches.hpp"
#include "cuda/bench/shell_model.hpp"
#include "frontalis/model/effects.hpp"
#include "parted_block.hpp"
#include "solver/effect_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

using namespace frontalis;

namespace
{

// Checks that all data that the kernel reads from the patches belong to the right voxels and nodes of the model.
void check_patches(const Model& model, const PatchSettings& settings, const BoundWork& bound = {})
{
  const VoxelPatches patches(model, settings, bound);
  ASSERT_EQ(patches.patches.size(), static_cast<std::size_t>(settings.blocks) * settings.turns);
  std::vector<std::uint32_t> node_of(model.nodes.size() + 1, 0);
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
  {
    ASSERT_TRUE(patches.device_node[n] >= 1 && patches.device_node[n] <= model.nodes.size());
    node_of[patches.device_node[n]] = static_cast<std::uint32_t>(n);
  }
  std::vector<std::uint32_t> filled(settings.blocks, patches.most_halo);
  std::vector<int> valence(model.nodes.size(), 0), found(model.nodes.size(), 0);
  for (const auto& corners : model.voxel_nodes)
    for (const auto n : corners)
      ++valence[n];
  std::set<std::uint32_t> border, read;
  std::uint32_t next = 1;
  for (std::size_t p = 0; p < patches.patches.size(); ++p)
  {
    const Patch& patch = patches.patches[p];
    ASSERT_EQ(patch.first_node, next);
    next += patch.nodes;
    ASSERT_LE(patch.halo, patches.most_halo);
    ASSERT_LE(patch.voxels, patches.most_voxels);
    const std::uint32_t first_place = filled[p % settings.blocks];
    filled[p % settings.blocks] += patch.nodes;
    ASSERT_LE(filled[p % settings.blocks], patches.most_halo + patches.most_nodes);
    const auto device_node_at = [&](std::uint32_t place) {
      return place < patches.most_halo ? patches.halo[patch.halo_begin + place]
                                       : patch.first_node + place - first_place;
    };
    for (std::uint32_t v = 0; v < patch.voxels; ++v)
      for (int b = 0; b < 8; ++b)
        ASSERT_EQ(node_of[device_node_at(patches.corner[patch.voxel_begin + v][b])],
                  static_cast<std::uint32_t>(model.voxel_nodes[patches.voxel[patch.voxel_begin + v]][b]));
    for (std::uint32_t v = 0; v < patch.voxels && !bound.beside.empty(); ++v)
      for (const auto other : bound.beside[patches.voxel[patch.voxel_begin + v]])
        for (const auto n : model.voxel_nodes[other])
          ASSERT_EQ(node_of[device_node_at(patches.place_of(p, patches.device_node[n]))],
                    static_cast<std::uint32_t>(n));
    for (std::uint32_t v = 0; v < patch.voxels; ++v)
    {
      const std::uint32_t e = patches.voxel[patch.voxel_begin + v];
      ASSERT_EQ(v < patch.laws, has_law(model, e));
      ASSERT_EQ(v < patch.special,
                has_law(model, e) || is_viscous(model, e) || model.fibre_begin[e] < model.fibre_begin[e + 1]);
    }
    for (std::uint32_t n = patch.first_node; n < patch.first_node + patch.nodes; ++n)
      for (int b = 0; b < 8; ++b)
      {
        const auto v = patches.node_voxel[n][b];
        if (v == patches.most_voxels)
          continue;
        ASSERT_LT(v, patch.voxels);
        ASSERT_EQ(static_cast<std::uint32_t>(model.voxel_nodes[patches.voxel[patch.voxel_begin + v]][b]), node_of[n]);
        ++found[node_of[n]];
      }
    for (std::uint32_t n = 0; n < patch.border; ++n)
      border.insert(patch.first_node + n);
    read.insert(patches.halo.begin() + patch.halo_begin, patches.halo.begin() + patch.halo_begin + patch.halo);
  }
  EXPECT_EQ(next, model.nodes.size() + 1);
  EXPECT_EQ(found, valence);
  EXPECT_TRUE(std::includes(border.begin(), border.end(), read.begin(), read.end()));
}

}  // namespace

TEST(VoxelPatches, GiveEveryNodeOneOwnerWithAllItsVoxels)
{
  ShellSettings settings;
  settings.voxel = 3e-3;
  const Model shell = shell_model(settings);
  for (const int turns : { 1, 2, 3 })
    for (const int blocks : { 1, 7, 132 })
      check_patches(shell, { blocks, turns });
}

// Nodes that follow others are in the patch of their masters, wherever the planes of a flap are in the grid.
TEST(VoxelPatches, KeepGroupsTogether)
{
  test::BlockSettings s;
  s.voxels = { { 12, 9, 6 } };
  Model model = test::block_model(s);
  test::part(model, 3, [](int i) { return i < 8; });
  test::join(model);
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
  {
    const auto& at = model.nodes[n];
    const std::int32_t master = test::node_at(model, { { at[0] / 2 * 2, at[1], 1 } });
    if (at[2] == 0 && master >= 0)
      model.attached.push_back({ static_cast<std::int32_t>(n), master, 0.5, -1, -1, -1 });
  }
  EXPECT_GT(model.joints.size(), 20u);
  for (const int blocks : { 1, 7, 30 })
  {
    check_patches(model, { blocks, 1 });
    const VoxelPatches patches(model, { blocks, 1 });
    const auto patch_of = [&](std::int32_t n) { return patches.patch_of(patches.device_node[n]); };
    for (const auto& node : model.attached)
      EXPECT_EQ(patch_of(node.node), patch_of(node.master));
    for (const auto& joint : model.joints)
      EXPECT_EQ(patch_of(joint.node), patch_of(joint.master));
  }
}

TEST(VoxelPatches, TakeVoxelsThatCostMoreFirst)
{
  for (const unsigned effects : { test::viscosity, test::contraction, test::everything })
    for (const int blocks : { 1, 3 })
      check_patches(test::scene_of(effects), { blocks, 2 });
  Model laws = test::scene_of(test::everything);
  laws.materials.push_back(laws.materials.front());
  laws.materials.back().law = static_cast<Law>(1);
  for (std::size_t e = 0; e < laws.voxels.size(); e += 3)
    laws.mixture_material[laws.mixture_begin[e]] = static_cast<std::int16_t>(laws.materials.size() - 1);
  for (const int blocks : { 1, 3 })
    check_patches(laws, { blocks, 2 });
}

TEST(VoxelPatches, HaveTheNodesOfVoxelsBesideTheirOwn)
{
  test::BlockSettings s;
  s.voxels = { { 9, 5, 4 } };
  const Model block = test::block_model(s);
  BoundWork bound;
  bound.beside.resize(block.voxels.size());
  // Some of the voxels in these lists are far from each other.
  for (std::size_t e = 0; e < bound.beside.size(); e += 3)
    for (const std::size_t other : { (e + 20) % bound.beside.size(), e / 2 })
    {
      bound.beside[e].push_back(static_cast<std::int32_t>(other));
      bound.beside[other].push_back(static_cast<std::int32_t>(e));
    }
  for (const int turns : { 1, 3 })
    for (const int blocks : { 1, 7, 12 })
      check_patches(block, { blocks, turns }, bound);
}

TEST(VoxelPatches, MayBeMoreThanNodes)
{
  test::BlockSettings s;
  s.voxels = { { 2, 1, 1 } };
  check_patches(test::block_model(s), { 132, 2 });
}

TEST(VoxelPatches, CostAboutTheSameEach)
{
  const Model shell = shell_model({});
  const VoxelPatches patches(shell, { 132, 1 });
  const double mean = static_cast<double>(patches.voxel.size()) / 132;
  EXPECT_LT(patches.most_voxels, 1.15 * mean);
  EXPECT_LT(mean * 132, 1.35 * static_cast<double>(shell.voxels.size()));
}

TEST(VoxelPatches, TakeVoxelsWithFibresFirst)
{
  ShellSettings settings;
  settings.voxel = 3e-3;
  const Model shell = shell_model(settings);
  const VoxelPatches patches(shell, { 7, 1 });
  const auto fibres = [&](std::uint32_t e) { return shell.fibre_begin[e + 1] - shell.fibre_begin[e]; };
  std::size_t with = 0;
  for (const Patch& patch : patches.patches)
    for (std::uint32_t v = patch.voxel_begin + 1; v < patch.voxel_begin + patch.voxels; ++v)
    {
      EXPECT_GE(fibres(patches.voxel[v - 1]), fibres(patches.voxel[v]));
      with += fibres(patches.voxel[v]) > 0;
    }
  EXPECT_GT(with, 100u);
}
