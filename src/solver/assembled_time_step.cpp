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

// without the constraints, which only lower it
void SteppingSolver::renew_assembled_bound()
{
  if (assembled_at_frequency_ > 0 && profile_.steps - assembled_at_step_ < good_for &&
      frequency_squared_ <= growth_allowed * assembled_at_frequency_)
    return;
  const double squared = assembled_frequency_squared(assembled_at_frequency_ > 0 ? 16 : 300);
  assembled_share_ = std::isfinite(squared) ? std::min(1.0, margin * squared / frequency_squared_) : 1.0;
  assembled_at_step_ = profile_.steps;
  assembled_at_frequency_ = frequency_squared_;
}

double mode_amplitude(const Model& model)
{
  return 1e-3 * *std::min_element(model.spacing.begin(), model.spacing.end());
}

bool mode_has_settled(int iteration, double before, double now)
{
  return iteration >= 8 && std::abs(now - before) < 1e-4 * now;
}

void random_mode(SteppingSolver::Vectors& mode)
{
  std::mt19937 random(1);
  for (auto& p : mode)
    for (double& x : p)
      x = static_cast<double>(random()) / 2147483648.0 - 1;
}

// products with K are differences of internal forces, so that every law and fibre is in them
double SteppingSolver::assembled_frequency_squared(int most_iterations)
{
  const auto& mass = discretisation_.node_mass;
  if (assembled_mode_.empty())
  {
    assembled_mode_.resize(mass.size());
    random_mode(assembled_mode_);
  }
  Vectors u, moved, plus, minus;
  displacements(u);
  const double amplitude = mode_amplitude(*model_);
  double squared = 0;
  for (int iteration = 0; iteration < most_iterations; ++iteration)
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
    const bool settled = mode_has_settled(iteration, squared, now);
    squared = now;
    if (settled)
      break;
  }
  return squared;
}

}  // namespace frontalis
