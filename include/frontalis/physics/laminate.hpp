#pragma once

#include "frontalis/physics/materials/description.hpp"
#include "frontalis/physics/voxel_element.hpp"

namespace frontalis
{
namespace physics
{

// A voxel that contains layers of several materials is a laminate. Along the layers all materials have the same strain,
// across them the same stress. For linear elastic layers with one Poisson's ratio this is exactly the sum of two parts
// (Backus 1962, J. Geophys. Res. 67:4427): an isotropic solid with the harmonic means of the moduli, and a sheet in
// plane stress that has the difference between the arithmetic and the harmonic means. The sheet has no stiffness
// against shear across the layers and against compression along their normal.

/// The value of LawPart::law for a sheet, which is no entry of the table of materials.
constexpr Law sheet_law = static_cast<Law>(255);

/// A sheet with the normal n at rest. With the in-plane stretches s1 and s2 its energy per volume is
///   shear / 2 (s1 - s2)^2 + area / 2 (s1 s2 - 1)^2.
/// For small strains it is linear elasticity in plane stress with the shear modulus `shear` and area = shear (1 + nu) /
/// (1 - nu). Shear and area may be multiplied by a volume.
template <class T>
struct Sheet
{
  T shear, area;
  Vec3<T> normal;  ///< unit vector
};

/// Deformation of a sheet.
template <class T>
struct SheetStretch
{
  T across[3];   ///< F n
  T turned[3];   ///< cof(F) n: the normal, times the ratio of the areas
  T area;        ///< s1 s2
  T squared;     ///< s1^2 + s2^2
};

template <class T>
FRONTALIS_LAW SheetStretch<T> stretch_of(const Sheet<T>& sheet, const Kinematics<T>& k)
{
  using N = Number<T>;
  const T n[3] = { sheet.normal.x, sheet.normal.y, sheet.normal.z };
  SheetStretch<T> s;
  T area_squared = N::of(1e-12);  // so that the direction of a collapsed sheet stays finite
  s.squared = k.I1;
  for (int i = 0; i < 3; ++i)
  {
    s.across[i] = k.F.a[i][0] * n[0] + k.F.a[i][1] * n[1] + k.F.a[i][2] * n[2];
    s.turned[i] = k.cofactor.a[i][0] * n[0] + k.cofactor.a[i][1] * n[1] + k.cofactor.a[i][2] * n[2];
    s.squared = s.squared - s.across[i] * s.across[i];
    area_squared = area_squared + s.turned[i] * s.turned[i];
  }
  s.area = N::sqrt(area_squared);
  return s;
}

/// Adds the first Piola-Kirchhoff stress to P. With m the deformed normal, the derivative of the area by row k of F is
/// n x (row k of [m]x F).
template <class T>
FRONTALIS_LAW void add_stress(const Sheet<T>& sheet, const Kinematics<T>& k, Matrix3<T>& P)
{
  const T n[3] = { sheet.normal.x, sheet.normal.y, sheet.normal.z };
  const SheetStretch<T> s = stretch_of(sheet, k);
  const T on_area = (sheet.area * (s.area - Number<T>::of(1)) - sheet.shear) / s.area;
  for (int i = 0; i < 3; ++i)
  {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
    T turned[3];
    for (int j = 0; j < 3; ++j)
      turned[j] = s.turned[i1] * k.F.a[i2][j] - s.turned[i2] * k.F.a[i1][j];
    for (int j = 0; j < 3; ++j)
    {
      const int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      P.a[i][j] = P.a[i][j] + sheet.shear * (k.F.a[i][j] - s.across[i] * n[j]) +
                  on_area * (n[j1] * turned[j2] - n[j2] * turned[j1]);
    }
  }
}

template <class T>
FRONTALIS_LAW T energy(const Sheet<T>& sheet, const Kinematics<T>& k)
{
  using N = Number<T>;
  const SheetStretch<T> s = stretch_of(sheet, k);
  const T grown = s.area - N::of(1);
  return N::of(0.5) * (sheet.shear * (s.squared - N::of(2) * s.area) + sheet.area * grown * grown);
}

/// Bound of half of the second derivative of the energy along any unit change dF, as for the laws of materials. Let t be
/// area (s1 s2 - 1). In the plane, |d2(s1 s2)| <= |dF|^2 and |d(s1 s2)|^2 <= (s1^2 + s2^2) |dF|^2. Out of the plane, a
/// change along stretch 1 has the stiffness shear (1 - s2 / s1) + t s2 / s1, and s2 / s1 <= (s1^2 + s2^2) / (s1 s2).
template <class T>
FRONTALIS_LAW T tangent_stiffness(const Sheet<T>& sheet, const Kinematics<T>& k)
{
  using N = Number<T>;
  const SheetStretch<T> s = stretch_of(sheet, k);
  const T t = sheet.area * (s.area - N::of(1)), tension = t - sheet.shear;
  const T in_plane = N::max(tension, -tension) + sheet.area * s.squared;
  const T out_of_plane = N::max(t, -t) * s.squared / s.area;
  return N::of(0.5) * (sheet.shear + N::max(in_plane, out_of_plane));
}

}  // namespace physics
}  // namespace frontalis
