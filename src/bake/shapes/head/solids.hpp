#pragma once

#include "bake/vector.hpp"
#include "frontalis/scene/head_template.hpp"

#include <Eigen/Dense>

#include <vector>

namespace frontalis
{

/// Larger of two values, rounded over `radius` where they are equal.
double smooth_max(double a, double b, double radius);
inline double smooth_min(double a, double b, double radius) { return -smooth_max(-a, -b, radius); }

/// A solid of a template as a function: approximately the distance from its surface [m], negative inside.
class HeadSolid
{
public:
  explicit HeadSolid(const HeadTemplate::Solid& solid);

  /// Value at p. `hull`: value of HeadBones::hull() at p.
  double operator()(const Vector3d& p, double hull) const;

private:
  using Kind = HeadTemplate::Solid::Kind;
  struct Tooth
  {
    Vector3d at, along;
    Vector3d size;  ///< width, thickness at the edge and at the neck
  };

  double outline(const Vector3d& p) const;
  double row_of_teeth(const Vector3d& p) const;
  void place_teeth(const std::vector<Vector3d>& arch, const std::vector<Vector3>& sizes);

  Kind kind_;
  int axis_;
  double from_, to_, depth_;
  Vector3d centre_, axes_;
  std::vector<Eigen::Vector2d> polygon_;
  std::vector<Vector3d> line_;
  std::vector<double> radii_;
  std::vector<Tooth> teeth_;
};

}  // namespace frontalis
