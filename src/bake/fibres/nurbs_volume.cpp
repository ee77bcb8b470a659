#include "bake/fibres/nurbs_volume.hpp"

#include "frontalis/error.hpp"

#include <Eigen/LU>

#include <cmath>

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
    basis.value[static_cast<std::size_t>(k)] = values(0, k);
    basis.derivative[static_cast<std::size_t>(k)] = values(1, k);
  }
}

}  // namespace

SplineAxis::SplineAxis(int degree, int points, bool closed) : degree_(degree), points_(points), closed_(closed)
{
  if (degree < 1 || degree > 3 || points < degree + 1)
    throw Error("a spline of degree " + std::to_string(degree) + " with " + std::to_string(points) +
                " control points; degrees 1 to 3 with at least degree + 1 points are meant");
  // a closed axis has its first control points again at the end
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
  // on a closed axis control point j has its basis function centred at j / points (degrees 1 and 3)
  const int shift = closed_ ? points_ - (degree_ - 1) / 2 : 0;
  for (int k = 0; k <= degree_; ++k)
    basis.point[static_cast<std::size_t>(k)] = closed_ ? (span - degree_ + k + shift) % points_ : span - degree_ + k;
  return basis;
}

NurbsVolume::NurbsVolume(const std::array<SplineAxis, 3>& axes, const std::vector<Vector3>& points,
                         const std::vector<double>& weights)
    : axes_(axes)
{
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    const double weight = weights.empty() ? 1 : weights[i];
    points_.push_back({ weight * points[i][0], weight * points[i][1], weight * points[i][2], weight });
  }
  const std::array<int, 3> count{ { 32, 24, 3 } };
  for (int i = 0; i < count[0]; ++i)
  {
    for (int j = 0; j < count[1]; ++j)
    {
      for (int k = 0; k < count[2]; ++k)
      {
        const Vector3 parameter{ (i + 0.5) / count[0], (j + 0.5) / count[1], (k + 0.5) / count[2] };
        sample_parameters_.push_back(parameter);
        samples_.push_back(at(parameter).position);
      }
    }
  }
}

NurbsVolume::Point NurbsVolume::at(const Vector3& parameter) const
{
  std::array<SplineAxis::Basis, 3> basis;
  for (std::size_t a = 0; a < 3; ++a)
    basis[a] = axes_[a].at(parameter[a]);
  // value and derivatives of weight times position, and of the weight
  std::array<std::array<double, 4>, 4> sum{};
  for (std::size_t i = 0; i <= static_cast<std::size_t>(axes_[0].degree()); ++i)
  {
    for (std::size_t j = 0; j <= static_cast<std::size_t>(axes_[1].degree()); ++j)
    {
      const double value = basis[0].value[i] * basis[1].value[j];
      const double along = basis[0].derivative[i] * basis[1].value[j];
      const double across = basis[0].value[i] * basis[1].derivative[j];
      const int row = (basis[0].point[i] * axes_[1].points() + basis[1].point[j]) * axes_[2].points();
      for (std::size_t k = 0; k <= static_cast<std::size_t>(axes_[2].degree()); ++k)
      {
        const auto& point = points_[static_cast<std::size_t>(row + basis[2].point[k])];
        const double w = basis[2].value[k];
        const std::array<double, 4> factor{ { value * w, along * w, across * w, value * basis[2].derivative[k] } };
        for (std::size_t d = 0; d < 4; ++d)
          for (std::size_t c = 0; c < 4; ++c)
            sum[d][c] += factor[d] * point[c];
      }
    }
  }
  Point result;
  for (std::size_t c = 0; c < 3; ++c)
    result.position[c] = sum[0][c] / sum[0][3];
  for (std::size_t d = 0; d < 3; ++d)
    for (std::size_t c = 0; c < 3; ++c)
      result.derivative[d][c] = (sum[d + 1][c] - sum[d + 1][3] * result.position[c]) / sum[0][3];
  return result;
}

Vector3 NurbsVolume::closest(const Vector3& p) const
{
  std::size_t nearest = 0;
  double least = 1e300;
  for (std::size_t s = 0; s < samples_.size(); ++s)
  {
    const Vector3 d = samples_[s] - p;
    const double squared = dot(d, d);
    if (squared < least)
    {
      least = squared;
      nearest = s;
    }
  }
  Vector3 parameter = sample_parameters_[nearest];
  Point point = at(parameter);
  Vector3 fault = p - point.position;
  double damping = 1e-3;
  for (int iteration = 0; iteration < 12; ++iteration)
  {
    Eigen::Matrix3d matrix;
    Eigen::Vector3d force;
    double scale = 0;
    for (std::size_t a = 0; a < 3; ++a)
    {
      const auto row = static_cast<Eigen::Index>(a);
      for (std::size_t b = 0; b < 3; ++b)
        matrix(row, static_cast<Eigen::Index>(b)) = dot(point.derivative[a], point.derivative[b]);
      force(row) = dot(point.derivative[a], fault);
      scale = std::max(scale, matrix(row, row));
      // a side that the point pulls out of: stay on it
      if (!axes_[a].closed() && ((parameter[a] <= 0 && force(row) < 0) || (parameter[a] >= 1 && force(row) > 0)))
        force(row) = 0;
    }
    for (Eigen::Index a = 0; a < 3; ++a)
      matrix(a, a) += damping * matrix(a, a) + 1e-9 * scale;
    const Eigen::Vector3d step = matrix.inverse() * force;
    Vector3 trial;
    double change = 0;
    for (std::size_t a = 0; a < 3; ++a)
    {
      const double limited = std::min(0.2, std::max(-0.2, step(static_cast<Eigen::Index>(a))));
      trial[a] = axes_[a].within(parameter[a] + limited);
      change = std::max(change, std::abs(limited));
    }
    const Point there = at(trial);
    const Vector3 left = p - there.position;
    if (dot(left, left) <= dot(fault, fault))
    {
      parameter = trial;
      point = there;
      fault = left;
      damping *= 0.1;
    }
    else
      damping *= 10;
    if (change < 1e-5)
      break;
  }
  return parameter;
}

Vector3 NurbsVolume::fibre(const Vector3& p) const { return normalised(at(closest(p)).derivative[0]); }

}  // namespace frontalis
