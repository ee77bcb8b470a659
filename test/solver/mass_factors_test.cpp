// Masses of nodes in models with scaled mass.

#include "block_model.hpp"

#include "solver/stepping/discretisation.hpp"

#include <gtest/gtest.h>

namespace
{

using namespace frontalis;

// A full voxel beside a nearly empty one. The node masses of voxels of 1 mm3 and 1000 kg/m3 are in micrograms.
TEST(MassFactors, nodes_with_little_tissue_get_the_mass_of_a_fifth_of_a_voxel_and_no_weight)
{
  test::BlockSettings settings;
  settings.voxels = { { 2, 1, 1 } };
  Model model = test::block_model(settings);
  model.fill[1] = 0.04F;
  const std::int32_t edge = model.voxel_nodes[1][1], shared = model.voxel_nodes[1][0];
  const auto micrograms = [](const Discretisation& d, std::int32_t node) { return 1e9 * d.node_mass[node]; };
  {
    const Discretisation plain(model);
    EXPECT_NEAR(micrograms(plain, edge), 5, 1e-4) << "without scaled mass they keep their own";
  }
  model.mass_scaling.kind = MassScalingSettings::Kind::uniform;
  {
    const Discretisation unscaled(model);
    EXPECT_NEAR(micrograms(unscaled, edge), 5, 1e-4) << "the factor 1 scales nothing";
  }
  model.mass_scaling.factor = 4;
  const Discretisation scaled(model);
  EXPECT_NEAR(micrograms(scaled, edge), 4 * 200, 1e-3);
  EXPECT_NEAR(scaled.weight_share[edge], 5.0 / 800, 1e-6);
  EXPECT_NEAR(micrograms(scaled, shared), 4 * 200, 1e-3) << "a corner of full tissue has an eighth";
  EXPECT_NEAR(scaled.weight_share[shared], 130.0 / 800, 1e-6);
}

}  // namespace
