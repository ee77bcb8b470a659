#pragma once

#include "frontalis/model/model.hpp"
#include "solver/skin/cell_means.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace frontalis
{

/// Finds the heights of a skin's film over the carried surface, by minimising an energy with one unknown per vertex.
///
/// With k = 2 pi / wavelength, the energy per area of the film's height w over a surface of strain e is
///   3/8 D (k^2 w - laplace w)^2 + 1/2 t grad w . C e . grad w + 1/8 Ef t <|grad w|^2>^2.
/// D = Ef t^3 / 12 and Ef = E / (1 - nu^2); C are the film's moduli in plane stress.
/// - Bending and base: a wave of wave number q costs D q^4 + Es q / 2 on a half-space. In q^2, 3/4 D (q^2 + k^2)^2 has
///   the same value, slope and curvature at k, so that wavelength and critical strain are those of theory. It is the
///   square of a differential operator, so its matrix is sparse and positive.
/// - Compression: moduli C times the strain of the carried surface. It chooses the direction of the lines.
/// - Relief: folding lengthens the film. < > is a mean over about a wavelength, because the film may shift in its
///   surface: then the amplitude is t (e / e_critical - 1)^(1/2), as in theory, and the wave stays a sine.
///
/// All differential operators are those of the skin at rest. In them lengths are in 1/k, heights in t
/// and energies in D (k t)^2.
class FilmEquilibrium
{
public:
  /// The model must have a film; it must outlive this.
  explicit FilmEquilibrium(const Model& model);

  /// Improves `height` ([m], one per vertex of the skin; empty: flat) until the film is in equilibrium, or for a
  /// limited number of iterations, which it returns. `vertices`: those of the skin without lines [m].
  int solve(const std::vector<std::array<float, 3>>& vertices, std::vector<float>& height);

private:
  // symmetric tensor: xx, yy, zz, xy, xz, yz
  using Tensor = std::array<float, 6>;
  using Field = CellMeans::Field;

  // heights and what apply() makes of them, per vertex
  struct Wave
  {
    Field height, laplace, force;
  };

  void make_operators();
  void make_seed();
  void find_strain(const std::vector<std::array<float, 3>>& vertices);
  void find_active(Field& w);
  void precondition(Field& inverse) const;
  void apply(const Field& w, Field& out, Field* forced) const;
  void mean_products(const Wave& u, const Wave& v, Field& out) const;
  double quadratic(const Wave& u) const;
  void gradient(const Wave& u, const Field& relief, Field& out);

  const Model& model_;
  double critical_, k_;
  // Cells of means are at least a wavelength long, so that a mean of a squared wave has no ripple, and a voxel, so that
  // strains that jump between voxels leave no trace.
  CellMeans cells_;
  const std::vector<std::int32_t>& order_;       // vertex of the skin for each vertex here
  std::vector<std::int32_t> begin_, neighbour_;  // neighbours of vertex v: from begin_[v] to begin_[v + 1]
  std::vector<Tensor> edge_;                     // per neighbour: weight of its edge in the operator div N grad, over N
  Field laplace_, membrane_;                     // per neighbour: that weight for N = 1 and for the present N
  Field area_, seed_;                            // per vertex
  std::vector<bool> resolved_;                   // vertices within the mesh, at edges that are short enough
  std::vector<std::int32_t> active_;             // vertices that may have a height
  std::vector<Tensor> strain_;                   // per vertex
  Field curvature_, local_;                      // of gradient()
};

}  // namespace frontalis
