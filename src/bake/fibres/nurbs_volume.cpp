#include "bake/fibres/nurbs_volume.hpp"

#include "bake/messages.hpp"

#include <Eigen/LU>

namespace frontalis
{
namespace
{

using Cubic = Eigen::Spline<double, 3, 3>;
using Quadratic = Eigen::Spline<double, 3, 2>;
using Linear = Eigen::Spline<double, 3, 1>;

template <class Spline, class Knots>
void evaluate(double parameter, int degree, const Knots& knots, SplineAxis::Basis& basis)
{
  const auto values = Spline::BasisFunctionDerivatives(parameter, 1, degree, knots);
  for (int k = 0; k <= degree; ++k)
  {
    basis.value[k] = values(0, k);
    basis.derivative[k] = values(1, k);
  }
}

}  // namespace

SplineAxis::SplineAxis(int degree, int points, bool closed) : degree_(degree), points_(points), closed_(closed)
{
  if (degree < 1 || degree > 3 || points < degree + 1)
    throw failure(
        "a spline of degree {} with {} control points; the degree must be 1 to 3, with at least degree + 1 points",
        degree, points);
  // On a closed axis the first control points are repeated at the end.
  const int spans = closed ? points : points - degree;
  knots_.resize(spans + 2 * degree + 1);
  for (int k = 0; k < knots_.size(); ++k)
  {
    const double knot = static_cast<double>(k - degree) / spans;
    knots_(k) = closed ? knot : std::min(1.0, std::max(0.0, knot));
  }
}

double SplineAxis::within(double parameter) const
{
  return closed_ ? parameter - std::floor(parameter) : std::min(1.0, std::max(0.0, parameter));
}

SplineAxis::Basis SplineAxis::at(double parameter) const
{
  Basis basis;
  const double t = within(parameter);
  const auto span = static_cast<int>(Eigen::Spline<double, 3, Eigen::Dynamic>::Span(t, degree_, knots_));
  if (degree_ == 3)
    evaluate<Cubic>(t, 3, knots_, basis);
  else if (degree_ == 2)
    evaluate<Quadratic>(t, 2, knots_, basis);
  else
    evaluate<Linear>(t, 1, knots_, basis);
  // On a closed axis the basis function of control point j is centred at j / points (degrees 1 and 3).
  const int shift = closed_ ? points_ - (degree_ - 1) / 2 : 0;
  for (int k = 0; k <= degree_; ++k)
    basis.point[k] = closed_ ? (span - degree_ + k + shift) % points_ : span - degree_ + k;
  return basis;
}

NurbsVolume::NurbsVolume(const std::array<SplineAxis, 3>& axes, const std::vector<Vector3d>& points,
                         const std::vector<double>& weights)
    : axes_(axes)
{
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    const double weight = weights.empty() ? 1 : weights[i];
    points_.emplace_back((weight * points[i]).homogeneous());
    points_.back()[3] = weight;
  }
  const std::array<int, 3> count{ { 32, 24, 3 } };
  for (int i = 0; i < count[0]; ++i)
    for (int j = 0; j < count[1]; ++j)
      for (int k = 0; k < count[2]; ++k)
      {
        const Vector3d parameter{ (i + 0.5) / count[0], (j + 0.5) / count[1], (k + 0.5) / count[2] };
        sample_parameters_.push_back(parameter);
        samples_.push_back(at(parameter).position);
      }
}

NurbsVolume::Point NurbsVolume::at(const Vector3d& parameter) const
{
  std::array<SplineAxis::Basis, 3> basis;
  for (std::size_t a = 0; a < 3; ++a)
    basis[a] = axes_[a].at(parameter[a]);
  // Value and three derivatives of the homogeneous coordinates (weight times position, weight).
  std::array<Eigen::Vector4d, 4> sum;
  sum.fill(Eigen::Vector4d::Zero());
  for (int i = 0; i <= axes_[0].degree(); ++i)
    for (int j = 0; j <= axes_[1].degree(); ++j)
    {
      const double value = basis[0].value[i] * basis[1].value[j];
      const double along = basis[0].derivative[i] * basis[1].value[j];
      const double across = basis[0].value[i] * basis[1].derivative[j];
      const int row = (basis[0].point[i] * axes_[1].points() + basis[1].point[j]) * axes_[2].points();
      for (int k = 0; k <= axes_[2].degree(); ++k)
      {
        const Eigen::Vector4d& point = points_[row + basis[2].point[k]];
        const double w = basis[2].value[k];
        sum[0] += value * w * point;
        sum[1] += along * w * point;
        sum[2] += across * w * point;
        sum[3] += value * basis[2].derivative[k] * point;
      }
    }
  Point result;
  result.position = sum[0].head<3>() / sum[0][3];
  for (int d = 0; d < 3; ++d)
    result.derivative[d] = (sum[d + 1].head<3>() - sum[d + 1][3] * result.position) / sum[0][3];
  return result;
}

Vector3d NurbsVolume::closest(const Vector3d& p) const
{
  std::size_t nearest = 0;
  double least = 1e300;
  for (std::size_t s = 0; s < samples_.size(); ++s)
  {
    const double squared = (samples_[s] - p).squaredNorm();
    if (squared < least)
    {
      least = squared;
      nearest = s;
    }
  }
  Vector3d parameter = sample_parameters_[nearest];
  Point point = at(parameter);
  Vector3d residual = p - point.position;
  double damping = 1e-3;
  for (int iteration = 0; iteration < 12; ++iteration)
  {
    Eigen::Matrix3d matrix;
    Vector3d gradient;
    for (int a = 0; a < 3; ++a)
    {
      for (int b = 0; b < 3; ++b)
        matrix(a, b) = point.derivative[a].dot(point.derivative[b]);
      gradient[a] = point.derivative[a].dot(residual);
      // A parameter at 0 or 1 that would leave [0, 1] is not changed.
      if (!axes_[a].closed() && ((parameter[a] <= 0 && gradient[a] < 0) || (parameter[a] >= 1 && gradient[a] > 0)))
        gradient[a] = 0;
    }
    const double scale = matrix.diagonal().maxCoeff();
    for (int a = 0; a < 3; ++a)
      matrix(a, a) += damping * matrix(a, a) + 1e-9 * scale;
    const Vector3d step = (matrix.inverse() * gradient).cwiseMax(-0.2).cwiseMin(0.2);
    Vector3d trial;
    for (int a = 0; a < 3; ++a)
      trial[a] = axes_[a].within(parameter[a] + step[a]);
    const Point there = at(trial);
    const Vector3d rest = p - there.position;
    if (rest.squaredNorm() <= residual.squaredNorm())
    {
      parameter = trial;
      point = there;
      residual = rest;
      damping *= 0.1;
    }
    else
      damping *= 10;
    if (step.cwiseAbs().maxCoeff() < 1e-5)
      break;
  }
  return parameter;
}

Vector3d NurbsVolume::fibre(const Vector3d& p) const { return (at(closest(p)).derivative[0]).normalized(); }

double NurbsVolume::fibre_length() const
{
  constexpr int side = 3, chords = 32;
  double sum = 0;
  for (int fibre = 0; fibre < side * side; ++fibre)
  {
    const int column = fibre % side, row = fibre / side;
    const double v = (0.5 + column) / side, w = (0.5 + row) / side;
    const auto point = [&](int chord) { return at({ static_cast<double>(chord) / chords, v, w }).position; };
    for (int c = 0; c < chords; ++c)
      sum += (point(c + 1) - point(c)).norm();
  }
  return sum / (side * side);
}

}  // namespace frontalis
