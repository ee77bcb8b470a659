#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace frontalis
{

/// The energy of a film (film_equilibrium.hpp) as a function of the heights at some of its vertices. All other heights
/// are 0. Units are those of FilmEquilibrium.
struct FilmEnergy
{
  using Field = std::vector<float>;

  /// neighbours of vertex v: from begin[v] to begin[v + 1]; a vertex without a height of its own has the number of
  /// vertices as its index
  std::vector<std::int32_t> begin, neighbour;
  Field laplace, membrane;   ///< per neighbour: weights of the operators div grad and div N grad, N the membrane force
  Field area, crease_force;  ///< per vertex
  /// Per vertex: corners of its cell, and its weights there. Vertices of a cell follow each other.
  std::vector<std::array<std::int32_t, 8>> corner;
  std::vector<std::array<float, 8>> weight;
  Field corner_area;  ///< per corner: area that belongs to it

  std::size_t vertices() const { return area.size(); }

  /// Lowers the energy, until an iteration lowers it by little or the most iterations have been made, by conjugate
  /// gradients (Polak & Ribiere) with exact line search, preconditioned by the energy of bending and base. Returns the
  /// number of iterations, fewer than the most if the minimum was found.
  int minimise(Field& height, int most_iterations) const;

private:
  // Heights, minus their Laplacian and minus the divergence of the membrane force times their gradient, both times the
  // area. Heights have a last entry for other vertices: 0.
  struct Wave
  {
    Field height, laplace, force;
  };
  Field inverse_diagonal() const;
  void solve_roughly(const Field& b, const Field& inverse, Field& change, Field& x) const;
  void precondition(const Field& slope, const Field& inverse, Field& change, Field& x) const;
  void apply(Wave& wave) const;
  void mean_products(const Wave& u, const Wave& v, Field& mixed, Field& squared) const;
  void gradient(const Wave& u, const Field& relief, Field& curvature, Field& out) const;
  double quadratic(const Wave& wave) const;
};

}  // namespace frontalis
