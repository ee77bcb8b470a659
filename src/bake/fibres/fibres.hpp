#pragma once

#include "bake/voxels/model_stages.hpp"
#include "bake/fibres/nurbs_volume.hpp"

namespace frontalis
{

/// Where the fibres of a muscle run: one direction everywhere, or along the first parameter of a NURBS volume.
struct MuscleFibres
{
  Vector3d direction{ 0, 0, 0 };  ///< of length 1; used where there is no volume
  std::optional<NurbsVolume> volume;
  double fitted_size = 0;  ///< of a volume that was fitted to the muscle [m3]

  Vector3d at(const Vector3d& p) const { return volume ? volume->fibre(p) : direction; }
};

/// The fibres of every muscle: those that the scene gives, or a NURBS volume fitted to the muscle's surfaces, whose fit
/// is reported. Throws Error naming the muscle, why its fibres cannot be found and what to give instead.
std::vector<MuscleFibres> find_fibres(const Scene& scene, const Volumes& volumes, const PreparedSurfaces& surfaces,
                                      BakeMonitor& monitor);

/// Fills the model's fibre directions at the centres of voxels. Throws Error if a control net gives no direction.
void add_fibres(const Scene& scene, const std::vector<MuscleFibres>& fibres, const LocalFrame& frame, Model& model,
                BakeMonitor& monitor);

}  // namespace frontalis
