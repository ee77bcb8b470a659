// The hourglass stiffness of voxels that are nearly empty.

#include "block_model.hpp"

#include "solver/stepping/sliver_hourglass.hpp"

#include <gtest/gtest.h>

namespace
{

using namespace frontalis;

TEST(SliverHourglass, IsThreeTimesThatOfTheSoftestMaterialInTheVoxels)
{
  Model model = test::block_model(test::BlockSettings());
  const double own = least_hourglass(model);
  EXPECT_GT(own, 0);
  // a material of a film on the skin, of which no voxel has any
  model.materials.push_back(model.materials[0]);
  model.materials[1].parameters[0] *= 0.5f;
  model.materials[1].parameters[1] *= 0.5f;
  EXPECT_EQ(least_hourglass(model), own);
  model.mixture_material.back() = 1;
  EXPECT_NEAR(least_hourglass(model), 0.5 * own, 1e-6 * own);
}

TEST(SliverHourglass, FadesWithTheTissue)
{
  EXPECT_EQ(sliver_hourglass(0.05, 2, 1e3), 2);
  EXPECT_NEAR(sliver_hourglass(0.15, 2, 1e3), 1, 1e-12);
  EXPECT_EQ(sliver_hourglass(0.2, 2, 1e3), 0);
  EXPECT_EQ(sliver_hourglass(0.05, 2, 16), 1) << "half of what the time step allows";
}

}  // namespace
