#pragma once

#include "solver/stepping/step_backend.hpp"

#include <functional>
#include <vector>

namespace frontalis
{

/// The tridiagonal matrix of a Lanczos iteration. Its largest eigenvalue approaches that of the iterated matrix from
/// below (Golub & Van Loan, Matrix Computations, 4th ed., section 10.1).
class LanczosMatrix
{
public:
  /// Adds the row of an iteration. `diagonal`: the product of the vector with its image. `beside`: length of what
  /// remains of the image without its parts along the vector and the vector before, the next element beside the
  /// diagonal.
  void add_row(double diagonal, double beside);
  std::size_t rows() const { return diagonal_.size(); }
  /// NaN without rows, or if an element is not finite.
  double largest_eigenvalue() const;
  /// Whether further rows would change the largest eigenvalue by little, or by nothing that makes sense.
  bool settled() const;

private:
  std::vector<double> diagonal_, beside_;
  std::vector<double> largest_;  // eigenvalue of the first, first two, first three, ... rows
};

/// Largest number of iterations of a search. With as many, the eigenvalue of 100,000 unknowns is expected to be at most
/// 7 % too low, whatever the matrix (Kuczynski & Wozniakowski 1992, SIAM J. Matrix Anal. Appl. 13:1094).
constexpr int most_lanczos_iterations = 32;

/// random_mode() returns the start of a search, and mode_amplitude() the largest displacement [m] in a product. Single
/// precision resolves this displacement, and over its length the laws are nearly linear. Its sign alternates, so that
/// the curvature of a law does not raise all products.
NodalVectors random_mode(std::size_t nodes);
double mode_amplitude(const Model& model, int iteration);

/// Square root of each node's inverse mass in the search [kg^-1/2]. A master has the mass of its group, and nodes that
/// are held or follow a master have 0.
std::vector<double> roots_for_search(const Discretisation& discretisation);

/// Squared highest frequency [1/s2] of the assembled model at displacements u: the largest eigenvalue of M^-1/2 K
/// M^-1/2 by Lanczos iteration. Products with K are differences of internal forces and therefore include every law and
/// fibre. Held nodes do not move, and held attached nodes follow their masters. Other constraints could only lower the
/// frequency and are omitted. NaN if no node can move or a force is not finite.
double highest_frequency_squared(const Model& model, const Discretisation& discretisation, const NodalVectors& u,
                                 const std::function<void(const NodalVectors& at, NodalVectors& out)>& internal_forces);

}  // namespace frontalis
