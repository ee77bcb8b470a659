#include "frontalis/model/model.hpp"

#include "model/effect_description.hpp"
#include "model/model_checks.hpp"
#include "model/model_layout.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

EffectPresence found(const Model& model)
{
  const auto& centres = model.tissue_centre;
  const auto voxels = static_cast<std::size_t>(
      std::count_if(centres.begin(), centres.end(), [](const auto& c) { return c != std::array<float, 3>(); }));
  return { voxels > 0, voxels > 0 ? "boundary: true" : "no voxel has a centroid of its tissue", voxels, 0 };
}

void check(const Model& model)
{
  using namespace checks;
  if (!model.tissue_centre.empty() && model.tissue_centre.size() != model.voxels.size())
    fail("tissue_centre", "has {} entries; there must be none, or one for each of the {} voxels",
         model.tissue_centre.size(), model.voxels.size());
  for (std::size_t e = 0; e < model.tissue_centre.size(); ++e)
    for (const float x : model.tissue_centre[e])
      if (!(std::abs(x) <= 1))
        fail("tissue_centre", "entry {} is {}; coordinates run from -1 to 1", e, x);
}

// Writes or reads the tissue centroids of a model file. The file of a model without cut voxels has no array for them.
template <class Archive, class Centres>
void exchange_centres(Archive& archive, Centres& centres)
{
  if (archive.group_if(!centres.empty(), "cut_voxels"))
    archive("cut_voxels/tissue_centre", centres);
}

}  // namespace

EffectDescription cut_voxels_description()
{
  return { Effect::cut_voxels,
           found,
           [](Model& model, EffectSet) { model.tissue_centre.clear(); },
           check,
           [](ModelWriter& archive, const Model& model) { exchange_centres(archive, model.tissue_centre); },
           [](ModelReader& archive, Model& model) { exchange_centres(archive, model.tissue_centre); } };
}

}  // namespace frontalis
