#pragma once

#include "nodal_vectors.hpp"

#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

namespace frontalis
{
namespace test
{

// Largest eigenvalue of a symmetric matrix, by power iteration with a shift that makes the matrix positive definite.
inline double largest_eigenvalue(const std::vector<std::vector<double>>& K)
{
  double shift = 0;
  for (const auto& row : K)
    for (const double x : row)
      shift += x * x;
  shift = 0.3 * std::sqrt(shift);
  std::vector<double> mode(K.size()), next(K.size());
  for (std::size_t i = 0; i < mode.size(); ++i)
    mode[i] = std::sin(1.0 + 3.0 * static_cast<double>(i));
  double value = 0;
  for (int iteration = 0; iteration < 300; ++iteration)
  {
    double length = 0;
    for (std::size_t i = 0; i < K.size(); ++i)
    {
      next[i] = shift * mode[i];
      for (std::size_t j = 0; j < K.size(); ++j)
        next[i] += 0.5 * (K[i][j] + K[j][i]) * mode[j];
      length += next[i] * next[i];
    }
    value = std::sqrt(length);
    for (std::size_t i = 0; i < K.size(); ++i)
      mode[i] = next[i] / value;
  }
  return value - shift;
}

// The true highest squared frequency divided by its bound, at given displacements and with every muscle at full
// activation. `mass` [kg]: of each node; `free`: indices of the free degrees of freedom.
inline double true_over_bound(const Model& model, const Vectors& u, const std::vector<double>& mass,
                              const std::vector<std::size_t>& free)
{
  const auto solver = make_solver(std::make_shared<const Model>(model), { "reference", 1, 0 });
  solver->advance(1e-12, { std::vector<float>(model.muscles.size(), 1), {} });
  solver->set_displacements(u);
  const double critical = solver->monitor().critical_time_step;
  Vectors moved, plus, minus;
  std::vector<std::vector<double>> K(free.size(), std::vector<double>(free.size()));
  for (std::size_t a = 0; a < free.size(); ++a)
  {
    const double step = 1e-8;
    for (const double sign : { 1.0, -1.0 })
    {
      moved = u;
      moved[free[a] / 3][free[a] % 3] += sign * step;
      solver->set_displacements(moved);
      solver->internal_forces(sign > 0 ? plus : minus);
    }
    for (std::size_t b = 0; b < free.size(); ++b)
      K[a][b] = (plus[free[b] / 3][free[b] % 3] - minus[free[b] / 3][free[b] % 3]) /
                (2 * step * std::sqrt(mass[free[a] / 3] * mass[free[b] / 3]));
  }
  return largest_eigenvalue(K) * critical * critical / 4;
}

}  // namespace test
}  // namespace frontalis
