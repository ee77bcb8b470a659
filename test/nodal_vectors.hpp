#pragma once

#include "frontalis/solver/solver.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace frontalis
{
namespace test
{

/// One vector per node of a model.
using Vectors = std::vector<std::array<double, 3>>;

/// Components between -amplitude and amplitude.
inline Vectors random_vectors(const Model& model, double amplitude, unsigned seed = 11)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> value(-amplitude, amplitude);
  Vectors vectors(model.nodes.size());
  for (auto& vector : vectors)
    for (double& component : vector)
      component = value(random);
  return vectors;
}

/// Largest size of a component.
inline double largest(const Vectors& vectors)
{
  double most = 0;
  for (const auto& vector : vectors)
    for (const double component : vector)
      most = std::max(most, std::abs(component));
  return most;
}

inline Vectors displacements(const Solver& solver)
{
  Vectors u;
  solver.displacements(u);
  return u;
}

}  // namespace test
}  // namespace frontalis
