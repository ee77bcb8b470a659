#pragma once

#include "frontalis/scene/geometry.hpp"

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace frontalis
{

/// A passive material. Its law (physics/materials/) determines which parameters and directions it has.
struct SceneMaterial
{
  std::string name;
  std::string law = "neo_hookean";
  double density = 0;  ///< [kg/m3]
  /// Values in SI units by key. The keys are those of the law's description, and `poisson`.
  std::map<std::string, double> parameters;
  /// One term of a Prony series: share of the instantaneous isochoric stress that relaxes, and its time constant [s].
  struct ViscousTerm
  {
    double share = 0;
    double time = 0;
  };
  std::vector<ViscousTerm> viscosity;  ///< up to two terms
  std::array<Vector3, 2> families{};   ///< unit vectors along the fibres in scene axes, as many as the law uses
  /// Surface that two fibre families follow: they are turned by the shortest rotation from their common normal to the
  /// surface's normal at the closest point. Empty: the directions are the same everywhere.
  std::string along;
  /// Muscle about whose fibres the two families lie, parallel to the surface `along`: both at `angle` [rad] from the
  /// fibres, on either side. Empty: `families` are given.
  std::string about;
  double angle = 0;
  double tension = 0;       ///< stress at rest, along the fibres of each muscle with `tension_of` [Pa]
  bool of_library = false;  ///< whether it comes from the file `tissues`; left out if nothing uses it
  int line = 0;
};

/// Skin layer of constant thickness below a surface. The layers of one surface follow each other inwards in list order.
struct Layer
{
  std::string name;
  std::string surface;
  std::string volume;  ///< the tissue volume that contains the layer
  std::string material;
  double thickness = 0;  ///< [m]
  int line = 0;
  bool shell = false;  ///< whether the layer is a shell that voxels carry, instead of a part of the voxels
};

/// Origin or insertion of a muscle's fibres: the region of the muscle nearest to a surface or to a polyline.
struct MuscleEnd
{
  std::string surface;          ///< surface at this end; empty: `points` are used
  std::vector<Vector3> points;  ///< vertices of the polyline [m]

  bool given() const { return !surface.empty() || !points.empty(); }
};

/// Control net of a NURBS volume with uniform knots; its fibres run along the first direction. Its degree
/// along each axis is 3 if there are at least four points, otherwise the number of points - 1.
struct ControlNet
{
  std::array<int, 3> size{ { 0, 0, 0 } };  ///< numbers of points along, across and through the muscle, each at least 2
  bool ring = false;                       ///< whether the net is closed along the fibres
  std::vector<Vector3> points;             ///< [m]; the index through the muscle runs fastest
  std::vector<double> weights;             ///< one positive weight per point; empty: all 1
};

struct SceneMuscle
{
  std::string name;
  std::string volume;
  Vector3 fibre{ 0, 0, 0 };         ///< unit vector in scene axes; 0: the fibres follow `net` or the shape
  double stress_reference = 0.3e6;  ///< active stress at full activation [Pa]
  bool passive = false;             ///< whether the fibres have the passive stress of Blemker et al. 2005
  bool tension_length = true;       ///< whether the active stress follows the tension-length curve
  int line = 0;
  double rise_time = 0;      ///< time constant of increasing activation [s]; 0: no delay
  double fall_time = 0;      ///< time constant of decreasing activation [s]; 0: no delay
  double tone = 0;           ///< activation at rest, 0..1
  double cross_section = 0;  ///< total cross-section of the fibres in people [m2]; 0: that of the muscle's volume
  MuscleEnd origin{}, insertion{};  ///< ends of the fibres; both or neither are given
  std::optional<bool> ring{};       ///< whether the fibres run around a hole; absent: the shape decides
  std::optional<ControlNet> net{};
  bool of_rest = false;  ///< whether it stands for the tension of a material at rest (`tension_of`)
};

/// Loss of strength by palsy or a toxin. The active stress at a place is multiplied by the factors of all weaknesses
/// that apply there.
struct SceneWeakness
{
  std::vector<std::string> muscles;  ///< muscles that are weakened; empty: all
  double keeps = 0;                  ///< fraction of the active stress that is left, 0..1
  Vector3 centre{ 0, 0, 0 };         ///< scene coordinates [m]
  double radius = 0;                 ///< [m]; 0: everywhere
  bool dose = false;                 ///< the loss falls as exp(-(distance / radius)^2) instead of ending at the radius
};

}  // namespace frontalis
