#pragma once

#include "bake/vector.hpp"

#include <Eigen/Core>
#include <unsupported/Eigen/Splines>

namespace frontalis
{

/// One direction of a tensor-product B-spline with uniform knots on [0, 1]: clamped at its ends, or closed.
class SplineAxis
{
public:
  static constexpr int most = 4;  ///< largest number of basis functions that are not 0 at a parameter (degree 3)

  /// Degree 1 to 3; at least degree + 1 control points.
  SplineAxis(int degree, int points, bool closed);

  struct Basis
  {
    std::array<int, most> point{};
    std::array<double, most> value{}, derivative{};
  };
  Basis at(double parameter) const;

  int degree() const { return degree_; }
  int points() const { return points_; }
  bool closed() const { return closed_; }
  /// The parameter in [0, 1]: wrapped around if the axis is closed, otherwise clamped.
  double within(double parameter) const;

private:
  int degree_, points_;
  bool closed_;
  Eigen::SplineTraits<Eigen::Spline<double, 3, Eigen::Dynamic>>::KnotVectorType knots_;
};

/// Rational tensor-product volume that maps (u, v, w) in [0, 1]^3 to positions. Fibres run along u.
class NurbsVolume
{
public:
  struct Point
  {
    Vector3d position;
    std::array<Vector3d, 3> derivative;
  };

  /// The index of control points runs fastest along w and slowest along u. `weights`: one per point; empty: all equal.
  NurbsVolume(const std::array<SplineAxis, 3>& axes, const std::vector<Vector3d>& points,
              const std::vector<double>& weights = {});

  const std::array<SplineAxis, 3>& axes() const { return axes_; }
  Point at(const Vector3d& parameter) const;
  /// Parameters of the volume's point closest to p, by Levenberg-Marquardt iteration from the nearest of samples_.
  Vector3d closest(const Vector3d& p) const;
  /// Unit tangent of the fibre through the closest point to p.
  Vector3d fibre(const Vector3d& p) const;
  /// Mean length of the fibres [m], from 3 x 3 fibres of 32 chords each.
  double fibre_length() const;

private:
  std::array<SplineAxis, 3> axes_;
  std::vector<Eigen::Vector4d> points_;  ///< homogeneous coordinates: weight times position, weight
  std::vector<Vector3d> sample_parameters_, samples_;
};

}  // namespace frontalis
