#pragma once

#include "frontalis/scene/scene.hpp"
#include "frontalis/study/voxel_model.hpp"

#include <functional>
#include <limits>
#include <string>

namespace frontalis
{

/// A body whose sides do not follow the grid, as a scene that a bake makes a model of, and its displacement under small
/// loads. Positions and vectors are in the scene's frame, in SI units.
struct BoundaryBody
{
  /// The planes through the origin of the scene that cut the body to an eighth.
  enum class Mirror
  {
    none,
    symmetric,       ///< all three
    antisymmetric_z  ///< at z = 0 the displacement is along z, as under gravity along z
  };
  std::string name;
  Scene scene;
  Mirror mirror = Mirror::none;
  /// Displacement of a point of the skin or of a loaded surface; not a number where it is not to be compared.
  std::function<Point(const Point&)> exact;
  /// Traction on the end of a bar [Pa] and the mesh of that end; not set: the scene has all loads.
  std::function<Point(const Point&)> traction;
  TriangleMesh end;
  /// Largest error that passes at 2 mm with the boundary at its true place, twice the largest one at 1 mm; NaN: none.
  double bound = std::numeric_limits<double>::quiet_NaN();
  double period = 0;  ///< approximate period of the slowest vibration [s]
};

/// Area of a triangle of a mesh [m2].
double triangle_area(const TriangleMesh& mesh, const std::array<std::int32_t, 3>& triangle);

/// A layer under gravity on a sphere of 60.37 mm, in which it is held or slides. The exact displacement is the solution
/// of the radial equations for u = U(r) cos(theta) e_r + W(r) sin(theta) e_theta, by 4000 linear elements. `stiff`: the
/// outer millimetre is ten times as stiff.
BoundaryBody curved_layer(double thickness, double poisson, bool slides, bool stiff);

/// A hollow sphere, radii 20 and 40 mm, under pressure inside (Lame).
BoundaryBody pressed_sphere(double poisson);

enum class BarLoad
{
  bending,
  torsion
};
/// A bar that is turned by 30 degrees about two axes, ends at a bone that it is attached to, and is loaded at its other
/// end: a round one, 10 mm thick and 30 mm long, or a square one, 8 mm thick and 40 mm long. In bending Poisson's ratio
/// is 0, so that the closed form holds at the bone too. `folder`: where the mesh of the square bar is written.
BoundaryBody turned_bar(bool round, BarLoad load, const std::string& folder);

}  // namespace frontalis
