#pragma once

#include <Eigen/Core>

namespace frontalis
{

/// Minimises x'Hx / 2 - g'x with lower <= x <= upper for a symmetric, positive definite H, by the active-set method of
/// Stark & Parker, "Bounded-variable least squares" (1995). The search begins at `x`.
Eigen::VectorXd bounded_minimum(const Eigen::MatrixXd& h, const Eigen::VectorXd& g, const Eigen::VectorXd& lower,
                                const Eigen::VectorXd& upper, Eigen::VectorXd x);

}  // namespace frontalis
