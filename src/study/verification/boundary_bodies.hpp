#pragma once

#include "frontalis/scene/scene.hpp"
#include "frontalis/study/voxel_model.hpp"

#include <functional>
#include <limits>
#include <string>

namespace frontalis
{

/// A scene to bake of a body whose sides do not follow the grid, and the exact displacement under small loads.
/// Positions and vectors are in the scene's frame, in SI units.
struct BoundaryBody
{
  /// Symmetry at the planes through the scene's origin that cut the body to an eighth.
  enum class Mirror
  {
    none,
    symmetric,       ///< symmetric at all three planes
    antisymmetric_z  ///< at z = 0 the displacement is along z, as under gravity along z
  };
  std::string name;
  Scene scene;
  Mirror mirror = Mirror::none;
  /// Exact displacement of a point of the skin or of a loaded surface; NaN where it must not be compared.
  std::function<Point(const Point&)> exact;
  /// Traction on the end of a bar [Pa] and the mesh of that end; not set: the scene has all loads.
  std::function<Point(const Point&)> traction;
  TriangleMesh end;
  /// Largest error that passes with voxels of 2 mm and `boundary: true`: twice the largest error with 1 mm; NaN: none.
  double bound = std::numeric_limits<double>::quiet_NaN();
  double period = 0;  ///< approximate period of the slowest vibration [s]
};

/// Area of a triangle of a mesh [m2].
double triangle_area(const TriangleMesh& mesh, const std::array<std::int32_t, 3>& triangle);

/// A layer under gravity on a sphere of radius 60.37 mm, to which it is fixed or on which it slides. The exact
/// displacement is the solution of the radial equations for u = U(r) cos(theta) e_r + W(r) sin(theta) e_theta, by 4000
/// linear elements. `stiff`: the outer millimetre is ten times as stiff.
BoundaryBody curved_layer(double thickness, double poisson, bool slides, bool stiff);

/// A hollow sphere with radii of 20 and 40 mm under internal pressure (solution of Lame).
BoundaryBody pressed_sphere(double poisson);

enum class BarLoad
{
  bending,
  torsion
};
/// A bar that is turned by 30 degrees about two axes. One end is attached to a bone, the other end is loaded. The bar
/// is round (10 mm thick, 30 mm long) or square (8 mm thick, 40 mm long). In bending, Poisson's ratio is 0, so that the
/// closed form holds at the bone too. The meshes of bone and square bar are written to `folder`.
BoundaryBody turned_bar(bool round, BarLoad load, const std::string& folder);

}  // namespace frontalis
