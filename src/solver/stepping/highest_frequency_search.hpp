#pragma once

#include "solver/stepping/step_backend.hpp"

#include <cmath>
#include <functional>

namespace frontalis
{

/// Largest eigenvalue of a matrix by power iteration. `multiply(step)` replaces a mode by the product of the matrix
/// with it and returns the ratio of their lengths. It takes the product from the difference of forces that a
/// displacement by `step` [m] along the mode makes: to either side in turn, because the laws' curvature takes from one
/// product what it gives to the next. Ends early where the eigenvalue has settled or is not finite.
template <class Multiply>
double largest_eigenvalue(int most_iterations, double step, const Multiply& multiply)
{
  constexpr int fewest_iterations = 9;
  constexpr double tolerance = 2e-4;  // against the iteration before the last, whose product was to the same side
  double eigenvalue = 0, last = 0, before_last = 0;
  for (int iteration = 1; iteration <= most_iterations; ++iteration, step = -step)
  {
    eigenvalue = multiply(step);
    const bool settled = std::abs(eigenvalue - before_last) < tolerance * eigenvalue;
    if ((iteration >= fewest_iterations && settled) || !std::isfinite(eigenvalue))
      break;
    before_last = last;
    last = eigenvalue;
  }
  return eigenvalue;
}

/// A random mode to begin with, and the displacement for a product [m]: large enough for single precision, small
/// against the curvature of the laws.
NodalVectors random_mode(std::size_t nodes);
double mode_amplitude(const Model& model);

/// Highest frequency squared [1/s2] of the assembled model at displacements u: power iteration on M^-1/2 K M^-1/2 from
/// `mode`, where the latest search ended; empty: it begins. Products with K are differences of internal forces, so that
/// every law and fibre is in them. Held nodes stay; other constraints could only lower the frequency and are left out.
double highest_frequency_squared(const Model& model, const Discretisation& discretisation, const NodalVectors& u,
                                 const std::function<void(const NodalVectors& at, NodalVectors& out)>& internal_forces,
                                 int most_iterations, NodalVectors& mode);

}  // namespace frontalis
