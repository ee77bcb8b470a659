#include "cuda/partition/voxel_strips.hpp"
#include "frontalis/error.hpp"
#include "parted_block.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

using namespace frontalis;

namespace
{

constexpr int lanes = 32;

// A thin curved layer of voxels with a hole. It has short and long rows along x, and pieces that share a warp.
Model shell()
{
  test::BlockSettings s;
  s.voxels = { { 80, 37, 40 } };
  s.keep = [](int i, int j, int k)
  {
    const double r = std::sqrt((i - 40.0) * (i - 40.0) / 2 + (j - 18.0) * (j - 18.0) + k * k);
    return r > 30 && r < 34.5 && !(i > 50 && i < 55 && k > 20);
  };
  return test::block_model(s);
}

// Compares the corners of each voxel in the strips with those in the model.
void check_strips(const Model& model, const StripSettings& settings)
{
  const VoxelStrips strips(model, settings);
  const int rows = settings.rows;
  std::map<std::uint32_t, std::uint32_t> node_of;  // device node to model node
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
    node_of[strips.device_node[n]] = static_cast<std::uint32_t>(n);
  ASSERT_EQ(node_of.size(), model.nodes.size());
  ASSERT_EQ(node_of.begin()->first, 1u);

  std::vector<int> owners(model.nodes.size(), 0), valence(model.nodes.size(), 0);
  for (const auto& corners : model.voxel_nodes)
    for (const auto n : corners)
      ++valence[n];
  for (std::size_t s = 0; s < strips.strips.size(); ++s)
  {
    const Strip& strip = strips.strips[s];
    const auto place = [&](std::uint32_t plane, int row, int lane) -> const StripSlot&
    { return strips.slots[strip.slot_begin + (plane * (rows + 2) + row) * lanes + lane]; };
    // For each node that the strip owns, the voxels around it that the node's lane can read.
    std::map<std::uint32_t, std::set<std::uint32_t>> voxels_of;
    for (std::uint32_t plane = 0; plane < strip.planes; ++plane)
      for (int row = 0; row < rows + 2; ++row)
        for (int lane = 0; lane < lanes; ++lane)
        {
          const StripSlot& here = place(plane, row, lane);
          if (here.node & StripSlot::owned)
          {
            ASSERT_TRUE(row >= 1 && row <= rows);
            const auto n = node_of.at(here.node & StripSlot::node_mask);
            ++owners[n];
          }
          if (here.voxel == 0)
            continue;
          ASSERT_TRUE(row <= rows && lane < lanes - 1 && plane + 1 < strip.planes);
          for (int b = 0; b < 8; ++b)
          {
            const StripSlot& corner = place(plane + (b >> 2), row + ((b >> 1) & 1), lane + (b & 1));
            const auto node = corner.node & StripSlot::node_mask;
            ASSERT_EQ(node_of.at(node), static_cast<std::uint32_t>(model.voxel_nodes[here.voxel - 1][b]));
            if (corner.node & StripSlot::owned)
              voxels_of[node_of.at(node)].insert(here.voxel - 1);
          }
        }
    for (const auto& entry : voxels_of)
      for (const auto voxel : entry.second)
        EXPECT_EQ(std::count(model.voxel_nodes[voxel].begin(), model.voxel_nodes[voxel].end(),
                             static_cast<std::int32_t>(entry.first)),
                  1);
    // Every voxel around a node that the strip owns is present.
    for (const auto& entry : voxels_of)
      EXPECT_EQ(entry.second.size(), static_cast<std::size_t>(valence[entry.first]));
  }
  for (std::size_t n = 0; n < owners.size(); ++n)
    EXPECT_EQ(owners[n], 1) << "node " << n;
}

// Adds a fibre to every n-th voxel along x, with n = `every`.
Model with_fibres(Model model, int every)
{
  Muscle muscle;
  muscle.name = "m";
  model.muscles.push_back(muscle);
  model.fibre_begin.assign(1, 0);
  for (const auto& voxel : model.voxels)
  {
    for (int i = 0; i < voxel[0] / every; ++i)
    {
      model.fibre_muscle.push_back(0);
      model.fibre_weight.push_back(0.5f);
      model.fibre_direction.push_back({ { 1, 0, 0 } });
    }
    model.fibre_begin.push_back(static_cast<std::int32_t>(model.fibre_muscle.size()));
  }
  return model;
}

}  // namespace

TEST(VoxelStrips, GiveEveryNodeOneOwnerWithAllItsVoxels)
{
  const Model model = shell();
  for (const int rows : { 1, 2, 3, 4 })
    for (const int planes : { 1, 2, 3, 64 })
      check_strips(model, { rows, planes });
}

TEST(VoxelStrips, CutRowsThatAreLongerThanAWarp)
{
  for (const int length : { 30, 31, 32, 33, 61, 62, 63, 64, 95 })
  {
    test::BlockSettings s;
    s.voxels = { { length, 3, 3 } };
    check_strips(test::block_model(s), { 4, 2 });
  }
}

// Voxels on the second side of a gap have planes of their own, although they rest at the places of other voxels.
TEST(VoxelStrips, KeepTheSidesOfAGapApart)
{
  test::BlockSettings s;
  s.voxels = { { 7, 6, 5 } };
  Model model = test::block_model(s);
  const std::size_t whole = model.nodes.size();
  test::part(model, 2, [](int i) { return i < 4; });
  EXPECT_EQ(rest_place(model, model.nodes.back()), (std::array<std::int32_t, 3>{ { 4, 6, 5 } }));
  EXPECT_GT(model.nodes.size(), whole);
  for (const int rows : { 2, 3 })
    for (const int planes : { 1, 3, 64 })
      check_strips(model, { rows, planes });
}

TEST(VoxelStrips, FillALargeBlock)
{
  test::BlockSettings s;
  s.voxels = { { 89, 31, 31 } };
  const VoxelStrips strips(test::block_model(s), { 4, 64 });
  // There are 90 columns, of which strips own 31, 30 and 29.
  EXPECT_GT(strips.filled(), 0.9);
}

TEST(VoxelStrips, CarryTheFibresOfTheVoxelsThatHaveThem)
{
  const Model model = with_fibres(shell(), 30);
  const VoxelStrips strips(model, { 4, 8 });
  std::size_t with = 0, without = 0;
  for (const Strip& strip : strips.strips)
  {
    with += strip.fibre_begin != Strip::none;
    without += strip.fibre_begin == Strip::none;
    for (std::uint32_t plane = 0; plane < strip.planes; ++plane)
      for (int row = 0; row < 5; ++row)
        for (int lane = 0; lane < lanes; ++lane)
        {
          const auto voxel = strips.slots[strip.slot_begin + (plane * 6 + row) * lanes + lane].voxel;
          const std::int32_t count =
              voxel == 0 ? 0 : model.fibre_begin[voxel] - model.fibre_begin[static_cast<std::size_t>(voxel) - 1];
          if (strip.fibre_begin == Strip::none)
          {
            EXPECT_EQ(count, 0);
            continue;
          }
          const auto word = strips.fibre_words[strip.fibre_begin + (plane * 5 + row) * lanes + lane];
          EXPECT_EQ(word & 15u, static_cast<std::uint32_t>(count));
          if (count > 0)
          {
            EXPECT_EQ(word >> 4, static_cast<std::uint32_t>(model.fibre_begin[static_cast<std::size_t>(voxel) - 1]));
          }
        }
  }
  EXPECT_GT(with, 0u);
  EXPECT_GT(without, 0u);
}

TEST(VoxelStrips, TellHowManyLanesHaveFibres)
{
  test::BlockSettings s;
  s.voxels = { { 29, 5, 6 } };
  const Model block = test::block_model(s);
  EXPECT_EQ(VoxelStrips(block, { 2, 4 }).filled_by_fibres(), 0);
  // The 14 last voxels of each row have a fibre.
  EXPECT_DOUBLE_EQ(VoxelStrips(with_fibres(block, 15), { 2, 4 }).filled_by_fibres(), 14.0 / lanes);
}

// The most expensive strips must start first.
TEST(VoxelStrips, BeginWithThoseThatHaveFibres)
{
  test::BlockSettings s;
  s.voxels = { { 60, 20, 30 } };
  const Model model = with_fibres(test::block_model(s), 31);
  check_strips(model, { 2, 8 });
  check_strips(with_fibres(shell(), 30), { 2, 5 });
  bool plain = false;
  const VoxelStrips strips(model, { 2, 8 });
  for (const Strip& strip : strips.strips)
    if (strip.planes == strips.strips.front().planes)
    {
      const bool fibres = strip.fibre_begin != Strip::none;
      EXPECT_FALSE(plain && fibres);
      plain = plain || !fibres;
    }
  EXPECT_TRUE(plain);
}
