#include "solver/stepping/highest_frequency_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace frontalis
{
namespace
{

// The eigenvalue has settled after at least `fewest_rows` if the last two rows raised it by less than `tolerance`.
constexpr std::size_t fewest_rows = 8;
constexpr double tolerance = 2e-3;
// The iteration ends where a vector's image lies along itself and the vector before, but for rounding.
constexpr double smallest_remainder = 1e-6;

// A vector of the iteration, its squared length, and the largest displacement of a node along an axis in it.
struct LanczosVector
{
  NodalVectors value;
  double squared_length = 0, largest = 0;

  /// Subtracts `share` of another vector.
  void subtract(double share, const NodalVectors& other, const std::vector<double>& root)
  {
    // Each axis has a sum of its own, so that additions need not wait for each other.
    double sum[3] = {}, most[3] = {};
    for (std::size_t n = 0; n < root.size(); ++n)
      for (std::size_t axis = 0; axis < 3; ++axis)
      {
        const double x = value[n][axis] - share * other[n][axis];
        value[n][axis] = x;
        sum[axis] += x * x;
        most[axis] = std::max(most[axis], std::abs(x) * root[n]);
      }
    squared_length = sum[0] + sum[1] + sum[2];
    largest = std::max({ most[0], most[1], most[2] });
  }
};

}  // namespace

// The largest eigenvalue is found by bisection: a number is above all eigenvalues if all pivots of the matrix minus
// this number are negative.
void LanczosMatrix::add_row(double diagonal, double beside)
{
  diagonal_.push_back(diagonal);
  beside_.push_back(beside);
  largest_.push_back(std::numeric_limits<double>::quiet_NaN());
  double low = 0, high = 0;
  for (std::size_t i = 0; i < rows(); ++i)
  {
    if (!std::isfinite(diagonal_[i]) || !std::isfinite(beside_[i]))
      return;
    low = std::max(low, diagonal_[i]);
    high = std::max(high, diagonal_[i] + (i > 0 ? beside_[i - 1] : 0) + (i + 1 < rows() ? beside_[i] : 0));
  }
  const auto is_above = [this](double number)
  {
    double pivot = diagonal_[0] - number;
    for (std::size_t i = 1; pivot < 0 && i < rows(); ++i)
      pivot = diagonal_[i] - number - beside_[i - 1] * beside_[i - 1] / pivot;
    return pivot < 0;
  };
  while (high - low > 1e-6 * high)
    (is_above(0.5 * (low + high)) ? high : low) = 0.5 * (low + high);
  largest_.back() = high;
}

double LanczosMatrix::largest_eigenvalue() const
{
  return largest_.empty() ? std::numeric_limits<double>::quiet_NaN() : largest_.back();
}

bool LanczosMatrix::settled() const
{
  if (largest_.empty())
    return false;
  const double found = largest_.back();
  if (!std::isfinite(found) || beside_.back() < smallest_remainder * found)
    return true;
  return rows() >= fewest_rows && found - largest_[rows() - 3] < tolerance * found;
}

NodalVectors random_mode(std::size_t nodes)
{
  NodalVectors mode(nodes);
  std::mt19937 random(1);
  for (auto& p : mode)
    for (double& x : p)
      x = static_cast<double>(random()) / 2147483648.0 - 1;
  return mode;
}

double mode_amplitude(const Model& model, int iteration)
{
  const double amplitude = 1e-3 * *std::min_element(model.spacing.begin(), model.spacing.end());
  return iteration % 2 == 0 ? amplitude : -amplitude;
}

std::vector<double> roots_for_search(const Discretisation& discretisation)
{
  std::vector<double> mass = discretisation.node_mass, root;
  for (const auto& node : discretisation.followers)
    mass[node.master] += node.ratio * node.ratio * mass[node.node];
  root.reserve(mass.size());
  for (const double m : mass)
    root.push_back(1 / std::sqrt(m));
  for (const auto& node : discretisation.followers)
    root[node.node] = 0;
  for (const auto n : discretisation.held)
    root[n] = 0;
  return root;
}

double highest_frequency_squared(const Model& model, const Discretisation& discretisation, const NodalVectors& u,
                                 const std::function<void(const NodalVectors& at, NodalVectors& out)>& internal_forces)
{
  const std::vector<double> root = roots_for_search(discretisation);
  const auto& followers = discretisation.followers;
  NodalVectors moved(root.size()), present, forces;
  internal_forces(u, present);
  LanczosVector now{ random_mode(root.size()) }, before{ NodalVectors(root.size()) };
  for (std::size_t n = 0; n < root.size(); ++n)
    if (root[n] == 0)
      now.value[n] = {};
  now.subtract(0, now.value, root);
  double length_before = 1;
  LanczosMatrix matrix;
  for (int iteration = 0; iteration < most_lanczos_iterations && !matrix.settled() && now.largest > 0; ++iteration)
  {
    const double scale = mode_amplitude(model, iteration) / now.largest, length = std::sqrt(now.squared_length);
    for (std::size_t n = 0; n < root.size(); ++n)
      for (int axis = 0; axis < 3; ++axis)
        moved[n][axis] = u[n][axis] + scale * root[n] * now.value[n][axis];
    for (const auto& node : followers)
      for (std::size_t axis = 0; axis < 3; ++axis)
        moved[node.node][axis] += node.ratio * (moved[node.master][axis] - u[node.master][axis]);
    internal_forces(moved, forces);
    for (const auto& node : followers)
      for (std::size_t axis = 0; axis < 3; ++axis)
        forces[node.master][axis] += node.ratio * (forces[node.node][axis] - present[node.node][axis]);
    // image of `now` at unit length, without its part along the vector before
    double parts[3] = {};
    const double back = iteration == 0 ? 0 : length / length_before, to_unit_length = 1 / (scale * length);
    for (std::size_t n = 0; n < root.size(); ++n)
      for (int axis = 0; axis < 3; ++axis)
      {
        const double x = to_unit_length * root[n] * (forces[n][axis] - present[n][axis]) - back * before.value[n][axis];
        before.value[n][axis] = x;
        parts[axis] += x * now.value[n][axis];
      }
    const double along = parts[0] + parts[1] + parts[2];
    before.subtract(along / now.squared_length, now.value, root);
    matrix.add_row(along / length, std::sqrt(before.squared_length));
    length_before = length;
    std::swap(now, before);
  }
  return matrix.largest_eigenvalue();
}

}  // namespace frontalis
