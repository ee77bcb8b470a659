#pragma once

#include "frontalis/solver/shell_mesh.hpp"

namespace frontalis
{

/// A symmetric 3 x 3 matrix: 11, 12, 13, 22, 23, 33.
using Symmetric = std::array<double, 6>;

inline physics::Vec3<double> operator*(const Symmetric& m, const physics::Vec3<double>& v)
{
  return { m[0] * v.x + m[1] * v.y + m[2] * v.z, m[1] * v.x + m[3] * v.y + m[4] * v.z,
           m[2] * v.x + m[4] * v.y + m[5] * v.z };
}

/// A triangle of a shell with what its bending energy is made of. Curvatures k are written as bending vectors
///   b = sqrt(D / 2) (sqrt(1 + nu) (k11 + k22), sqrt(1 - nu) (k11 - k22), sqrt(1 - nu) 2 k12),
/// so that the energy of a plate is 1/2 |b|^2 per area. When axes turn by an angle, the last two components turn by
/// twice the angle.
struct BentTriangle
{
  ShellMesh::Triangle triangle;
  std::array<bool, 3> beyond;           ///< whether there is a vertex beyond each edge
  double area;                          ///< [m2]
  physics::Vec3<double> per_height[3];  ///< bending vector times sqrt(area) per height of an outer vertex
  double share[3][3];   ///< share[i][j]: weight of corner j in the height of the triangle's plane at vertex 3 + i
  double direction[3];  ///< angle from the triangle's first axis to each edge, which runs anticlockwise [rad]
  Symmetric change{};   ///< Z, where 1/2 area b (1 + Z) b is the bending energy

  /// Bending vector times sqrt(area) per displacement of one of the six vertices along the normal.
  physics::Vec3<double> per_vertex(std::size_t i) const;
  /// Sets the matrix of the bending energy, and its bound, from `per_height` and `change`.
  void set_bending();
};

/// Makes the triangle that shell_triangle() returns. Arguments are those of shell_triangle().
BentTriangle bent_triangle(const std::array<physics::Vec3<double>, 6>& x, const std::array<bool, 3>& beyond,
                           double thickness, double young, double poisson);

}  // namespace frontalis
