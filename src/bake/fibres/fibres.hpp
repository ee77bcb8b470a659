#pragma once

#include "bake/voxels/local_frame.hpp"
#include "bake/fibres/nurbs_volume.hpp"
#include "bake/mesh/surface.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace frontalis
{

/// Where the fibres of a muscle run: one direction everywhere, or along the first parameter of a NURBS volume.
struct MuscleFibres
{
  Vector3 direction{ 0, 0, 0 };  ///< length 1; used without a volume
  std::optional<NurbsVolume> volume;
  double fitted_size = 0;  ///< of a volume that was fitted [m3]

  Vector3 at(const Vector3& p) const { return volume ? volume->fibre(p) : direction; }
};

/// The fibres of every muscle of the scene, from its surfaces where the scene does not give them; says how well each
/// volume fits. Throws Error naming the muscle, why its fibres cannot be found and what to give instead.
std::vector<MuscleFibres> find_fibres(const Scene& scene, const Volumes& volumes,
                                      const std::vector<std::unique_ptr<PreparedSurface>>& surfaces,
                                      BakeStages& stages);

/// Fills the model's fibre directions, at the centres of voxels. Throws Error where a net has none.
void add_fibres(const Scene& scene, const std::vector<MuscleFibres>& fibres, const LocalFrame& frame, Model& model,
                BakeStages& stages);

}  // namespace frontalis
