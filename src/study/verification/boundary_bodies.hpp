#pragma once

#include "frontalis/scene/scene.hpp"
#include "frontalis/study/voxel_model.hpp"

#include <array>
#include <cmath>
#include <functional>
#include <string>

namespace frontalis
{

/// A body whose sides do not follow the grid, as a scene to bake, and its exact displacement under small loads.
/// Positions and vectors are in the scene's frame, in SI units.
struct BoundaryBody
{
  /// Symmetry of a body of which only one eighth is modelled, cut out by three planes through the scene's origin.
  enum class Mirror
  {
    none,
    symmetric,       ///< symmetric at all three planes
    antisymmetric_z  ///< at z = 0 the displacement is along z, as under gravity along z
  };
  std::string name;
  Scene scene;
  Mirror mirror = Mirror::none;
  /// Exact displacement of a point of the skin or of a loaded surface; NaN where the displacement must not be compared.
  std::function<Point(const Point&)> exact;
  /// Traction on the end of a bar [Pa] and the mesh of that end. Not set if the scene has all loads.
  std::function<Point(const Point&)> traction;
  TriangleMesh end;
  /// Largest errors that pass with voxels of 2 mm and of 1 mm and `boundary: true`. NaN: no bound.
  std::array<double, 2> bounds{ { std::nan(""), std::nan("") } };
  /// Whether the order of convergence with `boundary: true` has a bound: 1.4, or errors of 1 % at 2 mm and 0.5 % at 1
  /// mm
  bool converges = true;
  double period = 0;  ///< approximate period of the slowest vibration [s]
};

/// A layer under gravity on a sphere of radius 60.37 mm, to which it is fixed or on which it slides. The exact
/// displacement solves the radial equations for u = U(r) cos(theta) e_r + W(r) sin(theta) e_theta, found with 4000
/// linear elements. `stiff`: the outer millimetre is ten times as stiff.
BoundaryBody curved_layer(double thickness, double poisson, bool slides, bool stiff);

/// A layer, 5 mm deep with Poisson's ratio 0.49, whose expected displacement CalculiX computes on a fitted mesh.
struct FittedLayer
{
  BoundaryBody body;
  double mesh_error = 0;  ///< RMS difference of CalculiX with elements twice as large, divided by RMS displacement
};
/// The layer of curved_layer(). `mixed`: held where z > 0.8 r and sliding elsewhere, under weak gravity; else held,
/// under gravity that shears the layer by 30 % on average where it is steepest. Throws Error if CalculiX fails.
FittedLayer fitted_layer(bool mixed);

/// A hollow sphere with radii of 20 and 40 mm under internal pressure (Lame's solution).
BoundaryBody pressed_sphere(double poisson);

enum class BarLoad
{
  bending,
  torsion
};
/// A bar that is turned by 30 degrees about two axes, attached to a bone at one end and loaded at the other. A round
/// bar is 10 mm thick and 30 mm long, a square one 8 mm thick and 40 mm long. In bending, Poisson's ratio is 0, so that
/// the closed form also holds at the bone. The meshes of the bone and of a square bar are written to `folder`.
BoundaryBody turned_bar(bool round, BarLoad load, const std::string& folder);

}  // namespace frontalis
