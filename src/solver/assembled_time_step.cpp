#include "stepping_solver.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace frontalis
{
namespace
{

using Vectors = SteppingSolver::Vectors;

constexpr double margin = 1.05;          // of the frequency squared
constexpr std::int64_t good_for = 2000;  // steps
constexpr double growth_allowed = 1.02;  // of the element bound since the estimate

double length(const Vectors& x)
{
  double sum = 0;
  for (const auto& p : x)
    sum += p[0] * p[0] + p[1] * p[1] + p[2] * p[2];
  return std::sqrt(sum);
}

}  // namespace

// largest eigenvalue of M^-1/2 K M^-1/2 at the present state by power iteration; products with K are differences of
// internal forces, so that every law and fibre is in them. Without the constraints, which only lower it.
void SteppingSolver::renew_assembled_bound()
{
  const bool first = assembled_mode_.empty();
  if (assembled_at_frequency_ > 0 && profile_.steps - assembled_at_step_ < good_for &&
      frequency_squared_ <= growth_allowed * assembled_at_frequency_)
    return;
  const auto& mass = discretisation_.node_mass;
  if (first)
  {
    std::mt19937 random(1);
    assembled_mode_.resize(mass.size());
    for (auto& p : assembled_mode_)
      for (double& x : p)
        x = static_cast<double>(random()) / 2147483648.0 - 1;
  }
  Vectors u, moved, plus, minus;
  displacements(u);
  // in units of a thousandth of a voxel: large for float, small for the curvature of the laws
  const double amplitude = 1e-3 * *std::min_element(model_->spacing.begin(), model_->spacing.end());
  double squared = 0;
  const int most = assembled_at_frequency_ > 0 ? 16 : 300;
  for (int iteration = 0; iteration < most; ++iteration)
  {
    double largest = 0;
    for (std::size_t n = 0; n < mass.size(); ++n)
      for (const double x : assembled_mode_[n])
        largest = std::max(largest, std::abs(x) / std::sqrt(mass[n]));
    const double scale = amplitude / largest;
    for (const double sign : { 1.0, -1.0 })
    {
      moved = u;
      for (std::size_t n = 0; n < mass.size(); ++n)
        for (int axis = 0; axis < 3; ++axis)
          moved[n][axis] += sign * scale * assembled_mode_[n][axis] / std::sqrt(mass[n]);
      forces_at(moved, sign > 0 ? plus : minus);
    }
    const double before = length(assembled_mode_);
    for (std::size_t n = 0; n < mass.size(); ++n)
      for (int axis = 0; axis < 3; ++axis)
        assembled_mode_[n][axis] = (plus[n][axis] - minus[n][axis]) / (2 * scale * std::sqrt(mass[n]));
    const double now = length(assembled_mode_) / before;
    for (auto& p : assembled_mode_)
      for (double& x : p)
        x /= now * before;
    const bool settled = std::abs(now - squared) < 1e-4 * now;
    squared = now;
    if (settled && iteration >= 8)
      break;
  }
  assembled_share_ = std::isfinite(squared) ? std::min(1.0, margin * squared / frequency_squared_) : 1.0;
  assembled_at_step_ = profile_.steps;
  assembled_at_frequency_ = frequency_squared_;
}

}  // namespace frontalis
