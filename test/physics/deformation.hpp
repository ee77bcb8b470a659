#pragma once

#include "frontalis/physics/voxel_element.hpp"

#include <cmath>
#include <random>

namespace frontalis
{
namespace physics
{
namespace test
{

using Matrix = Matrix3<double>;

inline Matrix diagonal(double x, double y, double z) { return { { { x, 0, 0 }, { 0, y, 0 }, { 0, 0, z } } }; }
inline Matrix identity() { return diagonal(1, 1, 1); }

inline Matrix operator*(const Matrix& A, const Matrix& B)
{
  Matrix C{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k)
        C.a[i][j] += A.a[i][k] * B.a[k][j];
  return C;
}

inline Vec3<double> operator*(const Matrix& A, const Vec3<double>& v)
{
  const auto row = [&](int i) { return A.a[i][0] * v.x + A.a[i][1] * v.y + A.a[i][2] * v.z; };
  return { row(0), row(1), row(2) };
}

inline Matrix transposed(const Matrix& A)
{
  Matrix B;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      B.a[i][j] = A.a[j][i];
  return B;
}

inline double largest(const Matrix& A)
{
  double most = 0;
  for (const auto& row : A.a)
    for (const double x : row)
      most = std::max(most, std::abs(x));
  return most;
}

inline double distance(const Matrix& A, const Matrix& B)
{
  Matrix difference;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      difference.a[i][j] = A.a[i][j] - B.a[i][j];
  return largest(difference);
}

/// Kinematics of a deformation gradient. Modes 1, 2 and 4 of the transformed displacements are its rows, with scale 1.
inline Kinematics<double> kinematics_of(const Matrix& F)
{
  double mode[3][8] = {};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      mode[i][gradient_mode(j)] = F.a[i][j] - (i == j);
  const double one[3] = { 1, 1, 1 };
  return kinematics(mode[0], mode[1], mode[2], one);
}

/// One of a series of random deformation gradients. Of three in a row one is crushed (J around 0.1) and one inverted.
inline Matrix random_gradient(std::mt19937& random, int trial)
{
  std::uniform_real_distribution<double> value(-0.35, 0.35);
  Matrix F = diagonal(1, 1, trial % 3 == 0 ? -0.6 : trial % 3 == 1 ? 0.1 : 1);
  for (auto& row : F.a)
    for (auto& x : row)
      x += value(random);
  return F;
}

inline Matrix random_rotation(std::mt19937& random)
{
  std::normal_distribution<double> normal;
  double w = normal(random), x = normal(random), y = normal(random), z = normal(random);
  const double length = std::sqrt(w * w + x * x + y * y + z * z);
  w /= length, x /= length, y /= length, z /= length;
  return { { { 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y) },
             { 2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x) },
             { 2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y) } } };
}

}  // namespace test
}  // namespace physics
}  // namespace frontalis
