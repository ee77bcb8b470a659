#pragma once

#include "frontalis/scene/geometry.hpp"

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace frontalis
{

/// Passive material. Which parameters and directions count depends on the law (physics/materials/).
struct SceneMaterial
{
  std::string name;
  std::string law = "neo_hookean";
  double density = 0;  ///< [kg/m3]
  /// SI units, by the keys of the law's description, and poisson.
  std::map<std::string, double> parameters;
  /// One term of a Prony series: share of the instantaneous isochoric stress that relaxes, and its time constant [s].
  struct ViscousTerm
  {
    double share = 0;
    double time = 0;
  };
  std::vector<ViscousTerm> viscosity;  ///< up to two terms
  std::array<Vector3, 2> families{};   ///< directions of the fibres, as many as the law has; scene axes, length 1
  /// Two families of fibres are turned with this surface, by the shortest rotation from their common normal to its own
  /// at the closest point; empty: they are the same everywhere.
  std::string along;
  int line = 0;
};

/// Skin layer of constant thickness, measured from a surface inwards; layers of one surface follow each other in order.
struct Layer
{
  std::string name;
  std::string surface;
  std::string volume;  ///< the tissue volume that it lies in
  std::string material;
  double thickness = 0;  ///< [m]
  int line = 0;
};

/// Where the fibres of a muscle start or end: the part of the muscle nearest to a surface, or to points and the lines
/// between them.
struct MuscleEnd
{
  std::string surface;          ///< empty: points
  std::vector<Vector3> points;  ///< [m]

  bool given() const { return !surface.empty() || !points.empty(); }
};

/// Control net of a NURBS volume (uniform knots, cubic where it has at least four points) whose fibres run along its
/// first direction.
struct ControlNet
{
  std::array<int, 3> size{ { 0, 0, 0 } };  ///< points along, across and through the muscle, each at least 2
  bool ring = false;                       ///< closed along the fibres
  std::vector<Vector3> points;             ///< [m]; the index through the muscle runs fastest
  std::vector<double> weights;             ///< as many, above 0; empty: all 1
};

struct SceneMuscle
{
  std::string name;
  std::string volume;
  Vector3 fibre{ 0, 0, 0 };         ///< direction in scene coordinates, length 1; 0: by `net`, or found from the shape
  double stress_reference = 0.3e6;  ///< active stress at full activation [Pa]
  bool passive = false;             ///< with the passive fibre stress of Blemker et al. 2005
  bool tension_length = true;       ///< active stress follows the tension-length curve
  int line = 0;
  double rise_time = 0;             ///< time constant of a growing activation [s]; 0: at once
  double fall_time = 0;             ///< the same of a falling one [s]
  MuscleEnd origin{}, insertion{};  ///< both or none
  std::optional<bool> ring{};       ///< whether the fibres run around a hole; absent: by the shape
  std::optional<ControlNet> net{};
};

}  // namespace frontalis
