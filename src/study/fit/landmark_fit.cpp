#include "study/fit/landmark_fit.hpp"

#include "study/fit/bounded_minimum.hpp"

#include <Eigen/Cholesky>

#include <cmath>

namespace frontalis
{
namespace
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int iterations = 30;          // largest number of Gauss-Newton iterations
constexpr int halvings = 8;             // largest number of halvings of a step that does not lower the cost
constexpr double smallest_step = 1e-6;  // iterations end if unknowns change by less than this fraction of their range

}  // namespace

LandmarkFit::LandmarkFit(const Model& model, const Influence& influence, const std::vector<Unknown>& unknowns,
                         double deviation)
    : law_(model, influence, unknowns),
      deviation_(deviation),
      lower_(static_cast<Index>(unknowns.size())),
      upper_(lower_.size()),
      correction_(MatrixXd::Zero(influence.rest.size(), lower_.size()))
{
  for (Index i = 0; i < lower_.size(); ++i)
  {
    lower_[i] = unknowns[static_cast<std::size_t>(i)].lower;
    upper_[i] = unknowns[static_cast<std::size_t>(i)].upper;
  }
  preference_ = (upper_ - lower_) / 2;
}

void LandmarkFit::set_targets(const VectorXd& displacements) { targets_ = displacements; }

void LandmarkFit::learn(const VectorXd& values, const VectorXd& displacements)
{
  if (learned_)
  {
    // Broyden's update: the smallest change of the derivative that explains the latest difference.
    const VectorXd way = values - at_;
    if (const double length = way.squaredNorm(); length > 0)
      correction_ += (displacements - predicted(values)) * way.transpose() / length;
  }
  learned_ = true;
  at_ = values;
  displaced_ = displacements;
}

VectorXd LandmarkFit::predicted(const VectorXd& values) const
{
  const VectorXd by_influence = law_.displacement(values);
  return learned_ ? VectorXd(displaced_ + by_influence - law_.displacement(at_) + correction_ * (values - at_))
                  : by_influence;
}

VectorXd LandmarkFit::weighted_residual(const VectorXd& displacements) const
{
  VectorXd residual = (targets_ - displacements) / deviation_;
  for (double& r : residual)
    if (std::isnan(r))
      r = 0;
  return residual;
}

MatrixXd LandmarkFit::weighted_derivative(const VectorXd& values) const
{
  MatrixXd derivative = (law_.derivative(values) + correction_) / deviation_;
  for (Index i = 0; i < targets_.size(); ++i)
    if (std::isnan(targets_[i]))
      derivative.row(i).setZero();
  return derivative;
}

double LandmarkFit::cost(const VectorXd& values, const VectorXd& displacements) const
{
  return weighted_residual(displacements).squaredNorm() +
         (values - rest_values()).cwiseQuotient(preference_).squaredNorm();
}

VectorXd LandmarkFit::solve(const VectorXd& begin) const
{
  VectorXd values = begin.cwiseMax(lower_).cwiseMin(upper_);
  double best = cost(values, predicted(values));
  const VectorXd preferred = preference_.cwiseAbs2().cwiseInverse();
  for (int i = 0; i < iterations; ++i)
  {
    const MatrixXd j = weighted_derivative(values);
    MatrixXd h = j.transpose() * j;
    h.diagonal() += preferred;
    const VectorXd g =
        j.transpose() * weighted_residual(predicted(values)) + preferred.cwiseProduct(rest_values() - values);
    VectorXd step = bounded_minimum(h, g, lower_ - values, upper_ - values, VectorXd::Zero(values.size()));
    int halved = 0;
    VectorXd next = values + step;
    for (; halved < halvings && !(cost(next, predicted(next)) < best); ++halved)
    {
      step /= 2;
      next = values + step;
    }
    if (halved == halvings)
      break;
    values = next;
    best = cost(values, predicted(values));
    if (step.cwiseQuotient(upper_ - lower_).cwiseAbs().maxCoeff() < smallest_step)
      break;
  }
  return values;
}

MatrixXd LandmarkFit::covariance(const VectorXd& values) const
{
  const MatrixXd j = weighted_derivative(values);
  MatrixXd h = j.transpose() * j;
  h.diagonal() += preference_.cwiseAbs2().cwiseInverse();
  return h.ldlt().solve(MatrixXd::Identity(h.rows(), h.cols()));
}

}  // namespace frontalis
