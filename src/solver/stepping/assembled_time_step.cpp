#include "solver/stepping/stepping_solver.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace frontalis
{
namespace
{

using Vectors = SteppingSolver::Vectors;

constexpr double margin = 1.05;          // of the frequency squared
constexpr double wide_margin = 1.25;     // soon after activations changed
constexpr std::int64_t good_for = 2000;  // steps; fewer after activations changed
constexpr std::int64_t shortest_good_for = 200;
constexpr float activation_allowed = 0.1F;  // of a muscle since the estimate
constexpr double growth_allowed = 1.02;     // of the bound at nodes since the estimate

// of a mode: its length, and the largest of its components over the root of the mass
struct ModeSize
{
  double squared_length = 0, largest = 0;

  void add(double x, double root)
  {
    squared_length += x * x;
    largest = std::max(largest, std::abs(x) * root);
  }
};

}  // namespace

// held nodes stay; without the other constraints, which only lower it
void SteppingSolver::renew_assembled_bound(const std::vector<float>& target)
{
  // fibres stiffen as they are activated, and what they move stiffens after that: until it has moved, the bound at
  // nodes counts
  bool changed = false;
  assembled_at_activation_.resize(target.size());
  for (std::size_t m = 0; m < target.size(); ++m)
    changed =
        changed || std::abs(std::max(activation_[m], target[m]) - assembled_at_activation_[m]) > activation_allowed;
  if (changed)
  {
    for (std::size_t m = 0; m < target.size(); ++m)
      assembled_at_activation_[m] = std::max(activation_[m], target[m]);
    assembled_share_ = 1;
    assembled_good_for_ = shortest_good_for;
    assembled_at_step_ = profile_.steps;
    return;
  }
  const bool waiting = assembled_good_for_ == shortest_good_for && assembled_share_ == 1;
  if (profile_.steps - assembled_at_step_ < assembled_good_for_ &&
      (waiting || (assembled_at_frequency_ > 0 && frequency_squared_ <= growth_allowed * assembled_at_frequency_)))
    return;
  const double squared = assembled_frequency_squared(assembled_at_frequency_ > 0 ? 16 : 300);
  const double allowance = assembled_good_for_ < good_for ? wide_margin : margin;
  assembled_share_ = std::isfinite(squared) ? std::min(1.0, allowance * squared / frequency_squared_) : 1.0;
  assembled_good_for_ = assembled_good_for_ > 0 ? std::min(2 * assembled_good_for_, good_for) : good_for;
  assembled_at_step_ = profile_.steps;
  assembled_at_frequency_ = frequency_squared_;
}

double mode_amplitude(const Model& model)
{
  return 1e-3 * *std::min_element(model.spacing.begin(), model.spacing.end());
}

bool ModeSearch::settled(double now)
{
  const bool result = ++iterations_ > 8 && std::abs(now - seen_[1]) < 2e-4 * now;
  seen_[1] = seen_[0];
  seen_[0] = now;
  return result;
}

void random_mode(SteppingSolver::Vectors& mode)
{
  std::mt19937 random(1);
  for (auto& p : mode)
    for (double& x : p)
      x = static_cast<double>(random()) / 2147483648.0 - 1;
}

// Products with K are differences of internal forces, so that every law and fibre is in them: one-sided ones, to either
// side in turn, whose curvature takes from one product what it gives to the next.
double SteppingSolver::assembled_frequency_squared(int most_iterations)
{
  std::vector<double> root;  // of the inverse mass; 0: held
  for (const double mass : discretisation_.node_mass)
    root.push_back(1 / std::sqrt(mass));
  for (const auto n : discretisation_.held)
    root[n] = 0;
  Vectors& mode = assembled_mode_;
  if (mode.empty())
  {
    mode.resize(root.size());
    random_mode(mode);
  }
  ModeSize size;
  for (std::size_t n = 0; n < root.size(); ++n)
    for (const double x : mode[n])
      size.add(x, root[n]);
  Vectors u, moved(root.size()), present, forces;
  displacements(u);
  forces_at(u, present);
  double step = mode_amplitude(*model_), squared = 0;
  ModeSearch search;
  for (int iteration = 0; iteration < most_iterations; ++iteration, step = -step)
  {
    const double scale = step / size.largest, length = std::sqrt(size.squared_length);
    for (std::size_t n = 0; n < root.size(); ++n)
      for (int axis = 0; axis < 3; ++axis)
        moved[n][axis] = u[n][axis] + scale * root[n] * mode[n][axis];
    forces_at(moved, forces);
    size = {};
    for (std::size_t n = 0; n < root.size(); ++n)
    {
      const double share = root[n] / (scale * length);
      for (int axis = 0; axis < 3; ++axis)
      {
        mode[n][axis] = share * (forces[n][axis] - present[n][axis]);
        size.add(mode[n][axis], root[n]);
      }
    }
    squared = std::sqrt(size.squared_length);
    if (search.settled(squared) || !std::isfinite(squared))
      break;
  }
  if (!std::isfinite(squared))
    mode.clear();
  return squared;
}

}  // namespace frontalis
