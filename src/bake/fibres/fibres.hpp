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
  double fitted_size = 0;    ///< size of `volume` if it was fitted to the muscle [m3], else 0
  bool from_origin = false;  ///< `along` is known to grow from the muscle's origin to its insertion

  /// Coordinate of p along the fibres: from 0 to 1 in a `volume`, otherwise the component along `direction` [m].
  double along(const Vector3d& p) const { return volume ? volume->closest(p)[0] : p.dot(direction); }
  Vector3d at(const Vector3d& p) const { return volume ? volume->fibre(p) : direction; }
};

/// The fibres of every muscle: those given in the scene, or a NURBS volume fitted to the muscle's surfaces. Reports the
/// quality of each fit. Throws Error with the muscle, the reason and the remedy if its fibres cannot be found.
std::vector<MuscleFibres> find_fibres(const Scene& scene, const Volumes& volumes, const PreparedSurfaces& surfaces,
                                      BakeMonitor& monitor);

/// Fills the model's fibre directions at the centres of voxels. Throws Error if a control net gives no direction.
void add_fibres(const Scene& scene, const std::vector<MuscleFibres>& fibres, const LocalFrame& frame, Model& model,
                BakeMonitor& monitor);

/// Spreads the weights of each muscle to the neighbours of its voxels, by 1/4, 1/2 and 1/4 along each axis (the
/// discrete delta function of Peskin 2002, Acta Numerica 11:479, two voxels wide to each side). A muscle thinner than
/// about two voxels then pulls as evenly as a thicker one. The muscle's volume, and so its force, stays the same. Sets
/// the fibre directions anew.
void spread_fibres(Model& model);

/// Scales the reference stress of each muscle for which the scene gives a cross-section, by the given cross-section
/// divided by the model's. The muscle is then as strong as in people. The model's cross-section is the muscle's volume
/// in voxels divided by the mean length of its fibres. Warns of muscles without much of their cross-section. Lists all
/// muscles in the report.
void scale_strength(const Scene& scene, const std::vector<MuscleFibres>& fibres, const LocalFrame& frame, Model& model,
                    BakeMonitor& monitor, BakeReport* report);

}  // namespace frontalis
