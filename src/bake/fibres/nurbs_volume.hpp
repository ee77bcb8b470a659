#pragma once

#include "bake/vector.hpp"

#include <Eigen/Core>
#include <unsupported/Eigen/Splines>

#include <array>
#include <vector>

namespace frontalis
{

/// One direction of a tensor-product B-spline with uniform knots on [0, 1]: clamped at its ends, or closed.
class SplineAxis
{
public:
  static constexpr int most = 4;  ///< basis functions that are not zero at a parameter: cubic at most

  /// Degree 1..3; at least degree + 1 control points.
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
  /// The parameter within [0, 1]: wrapped where the axis is closed, else clamped.
  double within(double parameter) const;

private:
  int degree_, points_;
  bool closed_;
  Eigen::SplineTraits<Eigen::Spline<double, 3, Eigen::Dynamic>>::KnotVectorType knots_;
};

/// Volume (u, v, w) -> position over [0, 1]^3: a rational tensor product, whose fibres run along u.
class NurbsVolume
{
public:
  struct Point
  {
    Vector3 position;
    std::array<Vector3, 3> derivative;
  };

  /// Control points in the order of u, then v, then w (w fastest); weights as many, or none for all equal.
  NurbsVolume(const std::array<SplineAxis, 3>& axes, const std::vector<Vector3>& points,
              const std::vector<double>& weights = {});

  const std::array<SplineAxis, 3>& axes() const { return axes_; }
  Point at(const Vector3& parameter) const;
  /// Parameter of the closest point of the volume, for a point inside it the one that is mapped there: by
  /// Levenberg-Marquardt from the nearest of a table of samples.
  Vector3 closest(const Vector3& p) const;
  /// Unit tangent of the fibre through the closest point to p.
  Vector3 fibre(const Vector3& p) const;

private:
  std::array<SplineAxis, 3> axes_;
  std::vector<std::array<double, 4>> points_;  ///< weight times position, weight
  std::vector<Vector3> sample_parameters_, samples_;
};

}  // namespace frontalis
