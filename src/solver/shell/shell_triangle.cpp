#include "solver/shell/shell_triangle.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

using Vector = physics::Vec3<double>;
using Matrix = std::array<std::array<double, 3>, 3>;

// Fraction of the squared size of T below which squared singular values are damped. In an equilateral triangle the
// singular values are 0.7, 0.7 and 1.
constexpr double regularisation = 4e-4;

Matrix product(const Matrix& a, const Matrix& b)
{
  Matrix c{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t k = 0; k < 3; ++k)
        c[i][j] += a[i][k] * b[k][j];
  return c;
}

Matrix transposed(const Matrix& a)
{
  Matrix t;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      t[i][j] = a[j][i];
  return t;
}

Matrix inverse(const Matrix& a)
{
  Matrix b;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      b[j][i] = a[(i + 1) % 3][(j + 1) % 3] * a[(i + 2) % 3][(j + 2) % 3] -
                a[(i + 1) % 3][(j + 2) % 3] * a[(i + 2) % 3][(j + 1) % 3];
  const double determinant = a[0][0] * b[0][0] + a[0][1] * b[1][0] + a[0][2] * b[2][0];
  for (auto& row : b)
    for (double& x : row)
      x /= determinant;
  return b;
}

}  // namespace

Vector BentTriangle::per_vertex(std::size_t i) const
{
  if (i >= 3)
    return per_height[i - 3];
  return -share[0][i] * per_height[0] - share[1][i] * per_height[1] - share[2][i] * per_height[2];
}

void BentTriangle::set_bending()
{
  triangle.bending = 0;
  for (std::size_t j = 0, at = 0; j < 3; ++j)
    for (std::size_t k = j; k < 3; ++k)
    {
      const double element = dot(per_height[j], per_height[k] + change * per_height[k]);
      triangle.rest.bending[at++] = element;
      const double *const p = share[j], *const q = share[k];
      triangle.bending += (j == k ? 1 : 2) * element * ((j == k ? 1 : 0) + p[0] * q[0] + p[1] * q[1] + p[2] * q[2]);
    }
}

BentTriangle bent_triangle(const std::array<Vector, 6>& x, const std::array<bool, 3>& beyond, double thickness,
                           double young, double poisson)
{
  BentTriangle out{};
  out.beyond = beyond;
  auto& rest = out.triangle.rest;
  const Vector a = x[1] - x[0], b = x[2] - x[0], area = cross(a, b);
  const double area_twice = norm(area);
  rest.inverse_area = 1 / area_twice;
  const Vector normal = (1 / area_twice) * area, across_a = cross(b, normal), across_b = cross(normal, a);
  const double per_area = 1 / (area_twice * area_twice);
  rest.metric[0] = per_area * dot(b, b);
  rest.metric[1] = -per_area * dot(a, b);
  rest.metric[2] = per_area * dot(a, a);
  const double volume = 0.5 * area_twice * thickness;
  rest.shear = volume * young / (2 * (1 + poisson));
  rest.dilatation = volume * young * poisson / (1 - poisson * poisson);
  // The membrane energy is at most (shear + dilatation) |grad u|^2. The term |grad u|^2 is a quadratic form of rank 2
  // in the corners' displacements; `trace` and `eigenvalues` are the sum and the product of its two eigenvalues.
  const double trace = 2 * (rest.metric[0] + rest.metric[1] + rest.metric[2]), eigenvalues = 3 * per_area;
  out.triangle.membrane =
      (rest.shear + rest.dilatation) * (trace + std::sqrt(std::max(0.0, trace * trace - 4 * eigenvalues)));

  const double plate = young * std::pow(thickness, 3) / (12 * (1 - poisson * poisson));
  const double mean = std::sqrt(0.5 * (1 + poisson)), difference = std::sqrt(0.5 * (1 - poisson));
  const Vector e1 = (1 / norm(a)) * a, e2 = cross(normal, e1);
  const auto quadratic = [&](const Vector& at)
  {
    const double s = dot(at, e1), t = dot(at, e2);
    return std::array<double, 3>{ { 0.5 * s * s / area_twice, 0.5 * t * t / area_twice, 0.5 * s * t / area_twice } };
  };
  const auto of_a = quadratic(a), of_b = quadratic(b);
  const Vector corner[3] = { { 0, 0, 0 }, a, b };
  rest.from_corner[0] = a;
  rest.from_corner[1] = b;
  out.area = 0.5 * area_twice;
  Matrix T;
  for (std::size_t i = 0; i < 3; ++i)
  {
    const Vector along = corner[(i + 2) % 3] - corner[(i + 1) % 3];
    const double s = dot(along, e1) / norm(along), t = dot(along, e2) / norm(along);
    out.direction[i] = std::atan2(t, s);
    if (!beyond[i])
    {
      // No moment passes through this edge, instead of a height.
      T[i] = { { t * t + poisson * s * s, s * s + poisson * t * t, -(1 - poisson) * s * t } };
      continue;
    }
    const Vector outer = x[i + 3] - x[0];
    rest.from_corner[i + 2] = outer;
    rest.height[i] = dot(outer, normal);
    const double on_a = dot(outer, across_a) / area_twice, on_b = dot(outer, across_b) / area_twice;
    out.share[i][0] = 1 - on_a - on_b;
    out.share[i][1] = on_a;
    out.share[i][2] = on_b;
    const auto of_outer = quadratic(outer);
    for (std::size_t k = 0; k < 3; ++k)
      T[i][k] = of_outer[k] - on_a * of_a[k] - on_b * of_b[k];
  }
  Matrix squared = product(transposed(T), T);
  for (std::size_t k = 0; k < 3; ++k)
    squared[k][k] += regularisation;
  // matrix that converts heights to curvatures times twice the area
  const Matrix curvature = product(inverse(squared), transposed(T));
  const double scale = std::sqrt(0.5 * plate / area_twice);
  for (std::size_t i = 0; i < 3; ++i)
    if (beyond[i])
      out.per_height[i] = { scale * mean * (curvature[0][i] + curvature[1][i]),
                            scale * difference * (curvature[0][i] - curvature[1][i]),
                            scale * difference * curvature[2][i] };
  out.set_bending();
  return out;
}

ShellMesh::Triangle shell_triangle(const std::array<Vector, 6>& x, const std::array<bool, 3>& beyond, double thickness,
                                   double young, double poisson)
{
  return bent_triangle(x, beyond, thickness, young, poisson).triangle;
}

}  // namespace frontalis
