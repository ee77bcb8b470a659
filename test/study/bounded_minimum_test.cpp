// Checks that the active-set method finds the same minimum as a search over all sets of active limits.

#include "study/fit/bounded_minimum.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace frontalis
{
namespace
{

using Eigen::MatrixXd;
using Eigen::VectorXd;

double value_of(const MatrixXd& h, const VectorXd& g, const VectorXd& x) { return x.dot(h * x) / 2 - g.dot(x); }

// Tries all cases in which each variable is at its lower limit, at its upper limit or free. Returns the smallest of the
// minima that are within the limits.
double least_value(const MatrixXd& h, const VectorXd& g, const VectorXd& lower, const VectorXd& upper)
{
  const auto count = static_cast<int>(g.size());
  double least = INFINITY;
  for (int set = 0; set < std::pow(3, count); ++set)
  {
    MatrixXd system = h;
    VectorXd right = g;
    int digits = set;
    for (int i = 0; i < count; ++i, digits /= 3)
      if (digits % 3 != 2)
      {
        system.row(i).setZero();
        system(i, i) = 1;
        right[i] = digits % 3 == 0 ? lower[i] : upper[i];
      }
    const VectorXd x = system.fullPivLu().solve(right);
    if (((x - lower).array() > -1e-9).all() && ((upper - x).array() > -1e-9).all())
      least = std::min(least, value_of(h, g, x));
  }
  return least;
}

TEST(BoundedMinimum, is_that_of_all_sets_of_active_limits)
{
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const auto number = [&] { return normal(random); };
  for (int trial = 0; trial < 200; ++trial)
  {
    const int count = 1 + trial % 6;
    const MatrixXd a = MatrixXd::NullaryExpr(count + 2, count, number);
    const MatrixXd h = a.transpose() * a + 1e-3 * MatrixXd::Identity(count, count);
    const VectorXd g = 3 * VectorXd::NullaryExpr(count, number);
    const VectorXd lower = VectorXd::NullaryExpr(count, number);
    const VectorXd upper = lower + VectorXd::NullaryExpr(count, number).cwiseAbs();
    const VectorXd x = bounded_minimum(h, g, lower, upper, VectorXd::NullaryExpr(count, number));
    EXPECT_TRUE((x.array() >= lower.array()).all() && (x.array() <= upper.array()).all()) << "trial " << trial;
    const double least = least_value(h, g, lower, upper);
    EXPECT_NEAR(value_of(h, g, x), least, 1e-9 * (1 + std::abs(least))) << "trial " << trial;
  }
}

}  // namespace
}  // namespace frontalis
