#include "frontalis/study/cut_voxels_model.hpp"

namespace frontalis
{

void cut_at_surface(Model& model, const Condition& inside, int samples)
{
  model.tissue_centre.assign(model.voxels.size(), {});
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    Point sum{};
    int count = 0;
    for (int s = 0; s < samples * samples * samples; ++s)
    {
      const int at[3] = { s % samples, s / samples % samples, s / (samples * samples) };
      Point in_voxel{}, p{};
      for (std::size_t axis = 0; axis < 3; ++axis)
      {
        in_voxel[axis] = (at[axis] + 0.5) / samples;
        p[axis] = model.spacing[axis] * (model.voxels[e][axis] + in_voxel[axis]);
      }
      if (!inside(p))
        continue;
      ++count;
      for (std::size_t axis = 0; axis < 3; ++axis)
        sum[axis] += 2 * in_voxel[axis] - 1;
    }
    for (std::size_t axis = 0; axis < 3 && count > 0; ++axis)
      model.tissue_centre[e][axis] = static_cast<float>(sum[axis] / count);
  }
}

}  // namespace frontalis
