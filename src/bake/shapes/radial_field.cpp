#include "bake/shapes/radial_field.hpp"

#include <Eigen/Dense>

namespace frontalis
{

RadialField::RadialField(std::vector<Vector3d> places, const std::vector<double>& values, Polynomial polynomial,
                         double smoothing)
    : places_(std::move(places))
{
  const auto n = static_cast<Eigen::Index>(places_.size());
  const Eigen::Index terms = polynomial == Polynomial::linear ? 4 : 1;
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n + terms, n + terms);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(n + terms);
  for (Eigen::Index i = 0; i < n; ++i)
  {
    for (Eigen::Index j = 0; j < n; ++j)
      a(i, j) = (places_[i] - places_[j]).norm();
    a(i, i) -= smoothing;
    a(i, n) = a(n, i) = 1;
    for (Eigen::Index c = 1; c < terms; ++c)
      a(i, n + c) = a(n + c, i) = places_[i][c - 1];
    b[i] = values[i];
  }
  const Eigen::VectorXd x = a.partialPivLu().solve(b);
  weights_.assign(x.data(), x.data() + n);
  linear_.head(terms) = x.tail(terms);
}

double RadialField::operator()(const Vector3d& p) const
{
  double sum = linear_[0] + linear_.tail<3>().dot(p);
  for (std::size_t i = 0; i < places_.size(); ++i)
    sum += weights_[i] * (p - places_[i]).norm();
  return sum;
}

}  // namespace frontalis
