#pragma once

#include "frontalis/model/model.hpp"

#include <cstdint>
#include <vector>

namespace frontalis
{

/// What has the largest share of each voxel, in the order of Model::voxels; -1 where there is none.
struct MainParts
{
  explicit MainParts(const Model& model);

  std::vector<std::int32_t> material;  ///< index into Model::materials
  std::vector<std::int32_t> fibres;    ///< entry of Model::fibre_weight, fibre_muscle and fibre_direction
};

}  // namespace frontalis
