#pragma once

#include "frontalis/physics/number.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace frontalis
{

/// The film of a region of the skin, and the tissue below it.
struct FilmLaw
{
  double thickness = 0;     ///< [m]
  double modulus = 0;       ///< of the film, E / (1 - nu^2) [Pa]
  double poisson = 0;       ///< of the film
  double base_modulus = 0;  ///< of the tissue below it, E / (1 - nu^2) [Pa]
  /// tensile strain of the film at rest, equal in all directions of the skin; it delays the onset of lines
  double stretch = 0;
};

/// A thin stiff film on the skin, such as epidermis on dermis. It wrinkles in lines that are finer than a voxel. The
/// first vertices of Model::skin, those of the triangles `carried`, follow the voxels; each later vertex is the middle
/// of an edge between two earlier vertices, on a smooth surface through them.
struct SkinFilm
{
  std::vector<FilmLaw> laws;      ///< of the regions of the skin; empty: the skin has no film
  std::vector<std::int32_t> law;  ///< per vertex of Model::skin: index of its law; -1: no film
  /// height [m] per vertex of Model::skin of the shape in which the film has no bending moment; empty: 0
  std::vector<float> crease;
  std::vector<std::array<std::int32_t, 3>> carried;  ///< triangles of the vertices that follow the voxels
  std::vector<std::array<std::int32_t, 2>> parents;  ///< of each later vertex: the two vertices between which it lies
};

/// Wavelength [m] and compressive strain at which a film on a half-space buckles: 2 pi t (Ef / 3 Es)^(1/3) and
/// (3 Es / Ef)^(2/3) / 4, with Ef and Es the moduli of plane strain (Cao & Hutchinson 2012).
double film_wavelength(const FilmLaw& film);
double film_critical_strain(const FilmLaw& film);

/// The middle of the edge between two points with unit normals, on the cubic curve of Vlachos et al. (Curved PN
/// triangles, 2001). `normal` receives its unit normal.
template <class T>
physics::Vec3<T> curved_middle(const physics::Vec3<T>& a, const physics::Vec3<T>& normal_a, const physics::Vec3<T>& b,
                               const physics::Vec3<T>& normal_b, physics::Vec3<T>& normal)
{
  const physics::Vec3<T> edge = b - a, sum = normal_a + normal_b;
  normal = (1 / physics::Number<T>::sqrt(physics::Number<T>::max(dot(sum, sum), T(1e-30)))) * sum;
  return T(0.5) * (a + b) + T(0.125) * (dot(edge, normal_b) * normal_b - dot(edge, normal_a) * normal_a);
}

}  // namespace frontalis
