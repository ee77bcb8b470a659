#pragma once

#include "solver/stepping/step_backend.hpp"

#include <cmath>
#include <functional>

namespace frontalis
{

/// Largest eigenvalue of a matrix by power iteration. `multiply(step)` replaces a mode by its product with the matrix
/// and returns the ratio of their lengths. The product is a difference of forces for a displacement by `step` [m] along
/// the mode. The sign of `step` alternates, so that errors from the curvature of the laws cancel. The iteration stops
/// early if the eigenvalue has settled or is not finite.
template <class Multiply>
double largest_eigenvalue(int most_iterations, double step, const Multiply& multiply)
{
  constexpr int fewest_iterations = 9;
  constexpr double tolerance = 2e-4;  // relative to the previous iteration with the same sign
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

/// random_mode() returns a start mode for largest_eigenvalue(), and mode_amplitude() the step [m]. Single precision
/// resolves this step, and over its length the laws are nearly linear.
NodalVectors random_mode(std::size_t nodes);
double mode_amplitude(const Model& model);

/// Squared highest frequency [1/s2] of the assembled model at displacements u, by power iteration on M^-1/2 K M^-1/2.
/// `mode`: start of the iteration, empty at first; receives the mode found. Products with K are differences of internal
/// forces and therefore include every law and fibre. Held nodes do not move, and held attached nodes follow their
/// masters. Other constraints could only lower the frequency and are omitted.
double highest_frequency_squared(const Model& model, const Discretisation& discretisation, const NodalVectors& u,
                                 const std::function<void(const NodalVectors& at, NodalVectors& out)>& internal_forces,
                                 int most_iterations, NodalVectors& mode);

}  // namespace frontalis
