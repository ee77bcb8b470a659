#pragma once

#include "frontalis/solver/solver.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
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

/// Checks the internal forces of a solver against differences of the energy, at every `stride`-th node. Energies are
/// those of the reference in double precision.
inline void expect_forces_from_energy(const Model& model, Solver& solver, const Vectors& u, std::size_t stride = 1)
{
  const auto energies = make_solver(std::make_shared<const Model>(model), { "reference", 0, 0 });
  solver.set_displacements(u);
  Vectors f;
  solver.internal_forces(f);
  const double most = largest(f), step = 1e-8;
  EXPECT_GT(most, 0);
  for (std::size_t n = 0; n < u.size(); n += stride)
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      double energy[2];
      for (const int side : { 0, 1 })
      {
        Vectors moved = u;
        moved[n][axis] += side == 0 ? -step : step;
        energies->set_displacements(moved);
        const Monitor m = energies->monitor();
        energy[side] = m.internal + m.hourglass;
      }
      EXPECT_NEAR(f[n][axis], (energy[1] - energy[0]) / (2 * step), most * 2e-5) << n << " " << axis;
    }
}

}  // namespace test
}  // namespace frontalis
