#pragma once

#include "study/fit/influence.hpp"

#include <string>
#include <vector>

namespace frontalis
{

/// The least-squares problem of a fit: unknowns, the coordinates of landmarks that are given, and a weak preference for
/// rest, which decides what the targets leave open. Its standard deviation is half of an unknown's range.
class LandmarkFit
{
public:
  LandmarkFit(const Model& model, const Influence& influence, const std::vector<Unknown>& unknowns, double deviation);

  /// The targets: displacements from rest of all landmarks [m], of which those that are NaN are free.
  void set_targets(const Eigen::VectorXd& displacements);
  /// What a simulation with `values` has shown. From then on displacements are those that were simulated, and
  /// differences from there are predicted, by the influence and by what the simulations so far differed from it.
  void learn(const Eigen::VectorXd& values, const Eigen::VectorXd& displacements);

  /// The best values, by a damped Gauss-Newton iteration from `begin`.
  Eigen::VectorXd solve(const Eigen::VectorXd& begin) const;
  Eigen::VectorXd predicted(const Eigen::VectorXd& values) const;
  /// Sum of squares over standard deviations of displacements (NaN in targets: left out) and preferences.
  double cost(const Eigen::VectorXd& values, const Eigen::VectorXd& displacements) const;
  Eigen::MatrixXd covariance(const Eigen::VectorXd& values) const;

  const Eigen::VectorXd& targets() const { return targets_; }
  const Eigen::VectorXd& rest_values() const { return law_.rest_values(); }

private:
  /// Matrix and right side of the linear problem at some values: weighted residuals below, preferences in H's diagonal.
  Eigen::MatrixXd weighted_derivative(const Eigen::VectorXd& values) const;
  Eigen::VectorXd weighted_residual(const Eigen::VectorXd& displacements) const;

  InfluenceLaw law_;
  double deviation_;
  Eigen::VectorXd lower_, upper_, preference_;  // preference: standard deviation of each unknown
  Eigen::VectorXd targets_;
  bool learned_ = false;
  Eigen::VectorXd at_, displaced_;  // of the latest simulation
  Eigen::MatrixXd correction_;      // of the derivative
};

}  // namespace frontalis
