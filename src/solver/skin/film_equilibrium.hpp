#pragma once

#include "frontalis/model/model.hpp"
#include "solver/skin/cell_means.hpp"
#include "solver/skin/film_energy.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace frontalis
{

/// Symmetric tensor: xx, yy, zz, xy, xz, yz.
struct FilmTensor
{
  std::array<float, 6> a{};

  void operator+=(const FilmTensor& other)
  {
    for (std::size_t i = 0; i < a.size(); ++i)
      a[i] += other.a[i];
  }
  void operator*=(float factor)
  {
    for (float& x : a)
      x *= factor;
  }
  friend FilmTensor operator*(float factor, FilmTensor tensor)
  {
    tensor *= factor;
    return tensor;
  }
};

inline float trace(const FilmTensor& t) { return t.a[0] + t.a[1] + t.a[2]; }
/// t : u
inline float contract(const FilmTensor& t, const FilmTensor& u)
{
  return t.a[0] * u.a[0] + t.a[1] * u.a[1] + t.a[2] * u.a[2] +
         2 * (t.a[3] * u.a[3] + t.a[4] * u.a[4] + t.a[5] * u.a[5]);
}

/// Finds the heights of a film in its region of a skin, over the surface that voxels carry, by minimising an energy
/// with one unknown per vertex. At the border of the region, heights are 0.
///
/// With k = 2 pi / wavelength, the energy per area of the film's height w over a surface of strain e is
///   3/8 D (k^2 w - laplace w)^2 + 1/2 t grad w . C e . grad w + 1/8 Ef t <|grad w|^2>^2.
/// D = Ef t^3 / 12 and Ef = E / (1 - nu^2); C are the film's moduli in plane stress.
/// - Bending and base: on a half-space a wave of wave number q costs D q^4 + Es q / 2. As a function of q^2, the term
/// 3/4 D (q^2 + k^2)^2 has the same value, slope and curvature at k, so that wavelength and critical strain are those
/// of theory. The term is the square of a differential operator, so that its matrix is sparse and positive.
/// - Compression: e is the strain of the carried surface. Compression chooses the direction of the lines.
/// - Creases: a film that is without moment at the heights w0 has the further energy - D laplace w laplace w0. At rest
/// a third of a wave w0 of the length of lines is left.
/// - Relief: folding lengthens the film. < > is a mean over about a wavelength, because the film may shift within its
/// surface. The amplitude is then t (e / e_critical - 1)^(1/2), as in theory, and the wave stays a sine.
///
/// All differential operators are those of the skin at rest. They measure lengths in 1/k, heights in t and energies in
/// D (k t)^2.
class FilmEquilibrium
{
public:
  /// `law`: index in the film's laws, whose region this is. The model must outlive this object.
  FilmEquilibrium(const Model& model, std::size_t law);

  static constexpr int most_iterations = 16;

  /// Improves `height` ([m], one per vertex of the skin; empty: flat) in the region until the film is in equilibrium or
  /// most_iterations have been made. Returns the number of iterations, fewer than that in equilibrium. `vertices`:
  /// those of the skin without lines [m].
  int solve(const std::vector<std::array<float, 3>>& vertices, std::vector<float>& height);

private:
  using Field = CellMeans::Field;

  void make_operators();
  void make_seed();
  void make_creases();
  void find_strain(const std::vector<std::array<float, 3>>& vertices);
  void find_active(Field& w);
  void set_energy();
  void laplacian(const Field& w, Field& out) const;

  FilmEquilibrium(const Model& model, std::size_t law, std::vector<std::int32_t> region);

  const Model& model_;
  const FilmLaw& law_;
  double critical_, k_;
  // The cells of means are at least one wavelength long, so that the mean of a squared wave has no ripple, and at least
  // one voxel edge long, so that strains that jump between voxels are smoothed.
  CellMeans cells_;
  std::vector<std::int32_t> order_;              // index in the skin of each vertex in the order of this class
  std::vector<std::int32_t> begin_, neighbour_;  // neighbours of vertex v: from begin_[v] to begin_[v + 1]
  // per neighbour: weight of the edge in the operator div N grad, as a tensor to be contracted with N
  std::vector<FilmTensor> edge_;
  // An edge at rest: its other vertex, its squared length, and a quarter of its tensor.
  struct RestEdge
  {
    std::int32_t to;
    float squared;
    FilmTensor quarter;
  };
  std::vector<RestEdge> rest_edges_;      // of each vertex, those to later vertices
  std::vector<std::int32_t> edges_from_;  // their number per vertex
  Field laplace_;                         // per neighbour: that weight for N = 1
  Field area_, seed_;                     // per vertex
  Field crease_, crease_force_;           // per vertex: heights w0, and the force that pulls towards them
  std::vector<bool> resolved_;            // whether a vertex is inside the mesh and its edges are short enough
  std::vector<std::int32_t> active_;      // vertices that may have a height
  std::vector<FilmTensor> strain_;        // per vertex; after find_active() valid where known_ is not 0
  std::vector<char> known_;
  std::vector<FilmTensor> mean_strain_;  // per corner of the cells
  FilmEnergy energy_;
  std::vector<std::int32_t> rank_, corner_rank_;  // -1 outside of set_energy()
};

}  // namespace frontalis
