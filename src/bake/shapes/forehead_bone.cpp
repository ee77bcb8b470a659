#include "bake/shapes/forehead_bone.hpp"

#include <cmath>

namespace frontalis
{
namespace
{

double bell(double x, double width) { return std::exp(-(x / width) * (x / width)); }

/// 0 below 0, 1 above 1, smooth (twice differentiable) between.
double smooth_step(double x)
{
  const double t = std::min(1.0, std::max(0.0, x));
  return t * t * t * (t * (6 * t - 15) + 10);
}

}  // namespace

ForeheadMap::ForeheadMap(const ForeheadDimensions& dimensions)
    : dimensions_(dimensions),
      // the radius of curvature of an ellipse at its front is half_breadth^2 / depth_axis
      depth_axis_(dimensions.half_breadth * dimensions.half_breadth / dimensions.front_radius)
{
  // the skin lies along the normal from the bone, so that its height 0 is not the bone's: iterate
  double z = 0;
  for (int i = 0; i < 20; ++i)
    z -= at(0, z, 0)[2];
  shift_ = -at(0, z, 0)[0];
}

Vector3d ForeheadMap::bone(double s, double z) const
{
  const ForeheadDimensions& d = dimensions_;
  const double angle = s / d.half_breadth;
  const double lean = std::tan(5 * pi / 180);
  const double above = z - d.brow_height;
  // the profile leans and curves backwards above the brow; below it, it is straight
  const double setback = above > 0 ? lean * above + above * above / (2 * d.profile_radius) : lean * above;

  // relief along the horizontal normal: the brow ridge, strongest above the medial half of the orbit; the glabella; the
  // nasal root; the temples
  const double arc = std::abs(s);
  const double ridge =
      d.ridge * bell(above, 9e-3) * (0.45 + 0.55 * bell(arc - 22e-3, 18e-3)) * (1 - smooth_step((arc - 45e-3) / 25e-3));
  const double glabella = d.glabella * bell(z - 0.75 * d.brow_height, 9e-3) * bell(s, 11e-3);
  const double root = 5e-3 * smooth_step((0.7 * d.brow_height - z) / d.brow_height) * bell(s, 20e-3);
  const double temple = d.temple_flattening * smooth_step((arc - 40e-3) / 35e-3);
  const double relief = ridge + glabella - root - temple;

  const Vector3d normal = Vector3d{ std::cos(angle) / depth_axis_, std::sin(angle) / d.half_breadth, 0 }.normalized();
  return Vector3d{ depth_axis_ * std::cos(angle) - setback + shift_, d.half_breadth * std::sin(angle), z } +
         relief * normal;
}

double ForeheadMap::thickness(double z) const
{
  const double over = z - dimensions_.brow_height;
  return dimensions_.hairline_thickness +
         (dimensions_.brow_thickness - dimensions_.hairline_thickness) * bell(over, 28e-3);
}

Vector3d ForeheadMap::at(double s, double z, double depth) const
{
  constexpr double step = 1e-5;
  const Vector3d across = bone(s + step, z) - bone(s - step, z);
  const Vector3d up = bone(s, z + step) - bone(s, z - step);
  return bone(s, z) + ((1 - depth) * thickness(z)) * across.cross(up).normalized();
}

double ForeheadMap::lower_edge(double s) const
{
  const double arc = std::abs(s);
  const double brow = dimensions_.brow_height;
  // nasal root, then the orbital rim, then down towards the cheek bone
  return -2e-3 + (0.55 * brow + 2e-3) * smooth_step((arc - 4e-3) / 20e-3) -
         0.35 * brow * smooth_step((arc - 42e-3) / 30e-3);
}

double ForeheadMap::upper_edge(double s) const
{
  const double share = std::abs(s) / half_width();
  return dimensions_.brow_height + dimensions_.height * (1 - 0.35 * smooth_step((share - 0.3) / 0.7));
}

}  // namespace frontalis
