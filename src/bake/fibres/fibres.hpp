#pragma once

#include "bake/voxels/model_stages.hpp"
#include "bake/fibres/nurbs_volume.hpp"

namespace frontalis
{

/// Fibre direction of a muscle: the same everywhere, or along the first parameter of a NURBS volume.
struct MuscleFibres
{
  Vector3d direction{ 0, 0, 0 };  ///< unit vector; used if there is no `volume`
  std::optional<NurbsVolume> volume;
  double fitted_size = 0;  ///< size of `volume` if it was fitted to the muscle [m3], else 0

  Vector3d at(const Vector3d& p) const { return volume ? volume->fibre(p) : direction; }
};

/// The fibres of every muscle: those given in the scene, or a NURBS volume fitted to the muscle's surfaces. Reports the
/// quality of each fit. Throws Error with the muscle, the reason and the remedy if its fibres cannot be found.
std::vector<MuscleFibres> find_fibres(const Scene& scene, const Volumes& volumes, const PreparedSurfaces& surfaces,
                                      BakeMonitor& monitor);

/// Fills the model's fibre directions at the centres of voxels. Throws Error if a control net gives no direction.
void add_fibres(const Scene& scene, const std::vector<MuscleFibres>& fibres, const LocalFrame& frame, Model& model,
                BakeMonitor& monitor);

}  // namespace frontalis
