#pragma once

#include "study/fit/influence.hpp"

#include <string>
#include <vector>

namespace frontalis
{

/// The least-squares problem of a fit: unknowns, given coordinates of landmarks, and a weak preference for rest, which
/// determines what the targets leave open. The standard deviation of the preference is half an unknown's range.
class LandmarkFit
{
public:
  LandmarkFit(const Model& model, const Influence& influence, const std::vector<Unknown>& unknowns, double deviation);

  /// Sets the targets: displacements of all landmarks from rest [m]. NaN stands for a free coordinate.
  void set_targets(const Eigen::VectorXd& displacements);
  /// Learns the displacements that a simulation with `values` has shown. Later predictions start from them and add
  /// changes by the influence, corrected by the errors of earlier predictions.
  void learn(const Eigen::VectorXd& values, const Eigen::VectorXd& displacements);

  /// The best values, found by a damped Gauss-Newton iteration from `begin`.
  Eigen::VectorXd solve(const Eigen::VectorXd& begin) const;
  Eigen::VectorXd predicted(const Eigen::VectorXd& values) const;
  /// Sum of the squared errors of displacements, without free coordinates, and of the squared distances from rest. Each
  /// is divided by its standard deviation before squaring.
  double cost(const Eigen::VectorXd& values, const Eigen::VectorXd& displacements) const;
  Eigen::MatrixXd covariance(const Eigen::VectorXd& values) const;

  const Eigen::VectorXd& rest_values() const { return law_.rest_values(); }

private:
  /// Matrix and right side of the linear problem at some values, divided by the standard deviation; 0 for free
  /// coordinates.
  Eigen::MatrixXd weighted_derivative(const Eigen::VectorXd& values) const;
  Eigen::VectorXd weighted_residual(const Eigen::VectorXd& displacements) const;

  InfluenceLaw law_;
  double deviation_;
  // preference_: standard deviation of the preference for rest of each unknown
  Eigen::VectorXd lower_, upper_, preference_;
  Eigen::VectorXd targets_;
  bool learned_ = false;
  Eigen::VectorXd at_, displaced_;  // values and displacements of the latest simulation
  Eigen::MatrixXd correction_;      // correction of the influence's derivative
};

}  // namespace frontalis
