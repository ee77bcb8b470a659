#include "solver/stepping/highest_frequency_search.hpp"

#include <algorithm>
#include <random>

namespace frontalis
{
namespace
{

// Squared length of a mode, and the largest displacement of a node along an axis in the mode.
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

NodalVectors random_mode(std::size_t nodes)
{
  NodalVectors mode(nodes);
  std::mt19937 random(1);
  for (auto& p : mode)
    for (double& x : p)
      x = static_cast<double>(random()) / 2147483648.0 - 1;
  return mode;
}

double mode_amplitude(const Model& model)
{
  return 1e-3 * *std::min_element(model.spacing.begin(), model.spacing.end());
}

double highest_frequency_squared(const Model& model, const Discretisation& discretisation, const NodalVectors& u,
                                 const std::function<void(const NodalVectors& at, NodalVectors& out)>& internal_forces,
                                 int most_iterations, NodalVectors& mode)
{
  std::vector<double> root;  // square root of each node's inverse mass; 0: the node is held
  for (const double mass : discretisation.node_mass)
    root.push_back(1 / std::sqrt(mass));
  for (const auto n : discretisation.held)
    root[n] = 0;
  const auto& followers = discretisation.followers;
  for (const auto& node : followers)
  {
    root[node.node] = 0;
    if (root[node.master] > 0)
      root[node.master] = 1 / std::sqrt(1 / (root[node.master] * root[node.master]) +
                                        node.ratio * node.ratio * discretisation.node_mass[node.node]);
  }
  if (mode.empty())
    mode = random_mode(root.size());
  ModeSize size;
  for (std::size_t n = 0; n < root.size(); ++n)
    for (const double x : mode[n])
      size.add(x, root[n]);
  NodalVectors moved(root.size()), present, forces;
  internal_forces(u, present);
  const auto multiply = [&](double step)
  {
    const double scale = step / size.largest, length = std::sqrt(size.squared_length);
    for (std::size_t n = 0; n < root.size(); ++n)
      for (int axis = 0; axis < 3; ++axis)
        moved[n][axis] = u[n][axis] + scale * root[n] * mode[n][axis];
    for (const auto& node : followers)
      for (std::size_t axis = 0; axis < 3; ++axis)
        moved[node.node][axis] += node.ratio * (moved[node.master][axis] - u[node.master][axis]);
    internal_forces(moved, forces);
    for (const auto& node : followers)
      for (std::size_t axis = 0; axis < 3; ++axis)
        forces[node.master][axis] += node.ratio * (forces[node.node][axis] - present[node.node][axis]);
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
    return std::sqrt(size.squared_length);
  };
  const double squared = largest_eigenvalue(most_iterations, mode_amplitude(model), multiply);
  if (!std::isfinite(squared))
    mode.clear();
  return squared;
}

}  // namespace frontalis
