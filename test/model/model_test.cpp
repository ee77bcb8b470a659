#include "frontalis/error.hpp"
#include "frontalis/model/model.hpp"
#include "model/model_block.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

namespace
{

using namespace frontalis;

std::string fault_of(const Model& model)
{
  try
  {
    check_model(model);
  }
  catch (const Error& error)
  {
    return error.what();
  }
  return "";
}

TEST(BuildNodes, NumbersTheCornersOfABlockByPlaneThenRow)
{
  const Model model = full_block(3, 2, 2);
  ASSERT_EQ(model.nodes.size(), 4u * 3u * 3u);
  std::size_t n = 0;
  for (std::int32_t k = 0; k < 3; ++k)
    for (std::int32_t j = 0; j < 3; ++j)
      for (std::int32_t i = 0; i < 4; ++i)
        EXPECT_EQ(model.nodes[n++], (std::array<std::int32_t, 3>{ i, j, k }));
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    for (int b = 0; b < 8; ++b)
    {
      const auto& corner = model.nodes[static_cast<std::size_t>(model.voxel_nodes[e][static_cast<std::size_t>(b)])];
      EXPECT_EQ(corner[0], model.voxels[e][0] + (b & 1));
      EXPECT_EQ(corner[1], model.voxels[e][1] + (b >> 1 & 1));
      EXPECT_EQ(corner[2], model.voxels[e][2] + (b >> 2));
    }
  }
}

TEST(BuildNodes, SharesNodesOnlyWhereVoxelsTouch)
{
  Model model;
  model.size = { 6, 5, 4 };
  // Two voxels share one corner, a third is far away in the same layer, and the last is two layers above.
  model.voxels = { { 0, 0, 0 }, { 5, 4, 0 }, { 1, 1, 1 }, { 1, 1, 3 } };
  build_nodes(model);
  EXPECT_EQ(model.nodes.size(), 4u * 8u - 1u);
  EXPECT_EQ(model.voxel_nodes[0][7], model.voxel_nodes[2][0]);
  for (std::size_t n = 1; n < model.nodes.size(); ++n)
  {
    const auto& a = model.nodes[n - 1];
    const auto& b = model.nodes[n];
    EXPECT_TRUE(std::make_tuple(a[2], a[1], a[0]) < std::make_tuple(b[2], b[1], b[0]));
  }
}

TEST(BuildNodes, RefusesVoxelsOutOfOrderTwiceOrOutside)
{
  Model model;
  model.size = { 2, 2, 2 };
  model.voxels = { { 1, 0, 0 }, { 0, 0, 0 } };
  EXPECT_THROW(build_nodes(model), Error);
  model.voxels = { { 1, 0, 0 }, { 1, 0, 0 } };
  EXPECT_THROW(build_nodes(model), Error);
  model.voxels = { { 0, 0, 2 } };
  EXPECT_THROW(build_nodes(model), Error);
}

TEST(BuildNodes, RefusesSizesThatNoGridHas)
{
  Model model = full_block(1, 1, 1);
  model.size = { -1, 1, 1 };
  EXPECT_THROW(build_nodes(model), Error);
  model.size = { 1, 1, 1 << 21 };
  EXPECT_THROW(build_nodes(model), Error);
  model.size = { 1 << 20, 1 << 20, 1 };
  EXPECT_THROW(build_nodes(model), Error);
}

TEST(CheckModel, AcceptsAFullModelAndNamesTheArrayAtFault)
{
  const Model good = full_block(2, 2, 2);
  EXPECT_EQ(fault_of(good), "");
  const auto fault = [&good](auto&& spoil)
  {
    Model model = good;
    spoil(model);
    return fault_of(model);
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_NE(fault([](Model& m) { m.fill.pop_back(); }).find("fill"), std::string::npos);
  EXPECT_NE(fault([&](Model& m) { m.fill[3] = nan; }).find("fill: entry 3"), std::string::npos);
  EXPECT_NE(fault([](Model& m) { m.mixture_material[2] = 2; }).find("mixture_material"), std::string::npos);
  EXPECT_NE(fault([](Model& m) { m.mixture_proportion[0] = 0.5f; }).find("add up"), std::string::npos);
  EXPECT_NE(fault([](Model& m) { m.material_directions.pop_back(); }).find("material_directions"), std::string::npos);
  EXPECT_NE(fault([](Model& m) { m.material_directions[1][4] = 2; }).find("entry 1 has length 2"), std::string::npos);
  EXPECT_NE(fault([](Model& m) { m.fibre_begin[1] = 100; }).find("fibre_begin"), std::string::npos);
  EXPECT_NE(fault([](Model& m) { m.fibre_direction[0] = { 0, 0, 2 }; }).find("fibre_direction"), std::string::npos);
  EXPECT_NE(fault([](Model& m) { m.rigid[0].bone = 2; }).find("rigid"), std::string::npos);
  EXPECT_NE(fault([](Model& m) { m.sliding[0].surface = 1; }).find("sliding"), std::string::npos);
  EXPECT_NE(fault([](Model& m) { m.attached[0].ratio = 1.5; }).find("attached (ratio)"), std::string::npos);
  EXPECT_NE(fault([](Model& m) { m.attached[1].node = 2; }).find("attached (node)"), std::string::npos);
  EXPECT_NE(fault([](Model& m) { m.attached[1].master = 4; }).find("attached (master)"), std::string::npos);
  EXPECT_NE(fault([](Model& m) { m.tissue_centre.pop_back(); }).find("tissue_centre"), std::string::npos);
  EXPECT_NE(fault([](Model& m) { m.tissue_centre[2][1] = 1.5F; }).find("tissue_centre: entry 2"), std::string::npos);
  EXPECT_NE(fault([](Model& m) { m.prescribed[0].load = -1; }).find("prescribed"), std::string::npos);
  EXPECT_NE(fault([](Model& m) { m.skin.triangles[0][1] = 3; }).find("skin"), std::string::npos);
  EXPECT_NE(fault([](Model& m) { m.skin_binding.voxel[0] = 8; }).find("skin_binding"), std::string::npos);
  EXPECT_NE(fault([](Model& m) { m.landmarks.push_back("x"); }).find("landmark"), std::string::npos);
  EXPECT_NE(fault([](Model& m) { m.materials[1].parameters[1] = -1; }).find("bulk modulus"), std::string::npos);
  EXPECT_NE(fault([](Model& m) { m.time_step_share = 1.1; }).find("time_step_share"), std::string::npos);
  EXPECT_NE(fault([](Model& m) { m.damping = -1; }).find("damping"), std::string::npos);
  EXPECT_NE(fault([](Model& m) { m.spacing[1] = 0; }).find("spacing"), std::string::npos);
  EXPECT_NE(fault([](Model& m) { m.expressions[0].activation[0].second = 2; }).find("raise"), std::string::npos);
}

}  // namespace
