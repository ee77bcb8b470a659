#include "solver/skin/film_energy.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

using Field = FilmEnergy::Field;

// The minimum is found if an iteration lowers the energy by less than this fraction.
constexpr double tolerance = 3e-4;

// Independent sums, so that no addition waits for the one before.
template <class Term>
double sum_of(std::size_t count, const Term& term)
{
  double lane[4] = {};
  std::size_t i = 0;
  for (; i + 4 <= count; i += 4)
    for (std::size_t l = 0; l < 4; ++l)
      lane[l] += static_cast<double>(term(i + l));
  for (; i < count; ++i)
    lane[0] += static_cast<double>(term(i));
  return lane[0] + lane[1] + (lane[2] + lane[3]);
}

// Smallest positive x at which slope + curvature x + third x^2 + fourth x^3 vanishes, for slope < 0.
double first_minimum(double slope, double curvature, double third, double fourth)
{
  const auto derivative = [&](double x) { return slope + x * (curvature + x * (third + x * fourth)); };
  double low = 0, high = 1e-3;
  while (derivative(high) < 0 && high < 1e9)
    high *= 2;
  for (int i = 0; i < 40; ++i)
  {
    const double middle = 0.5 * (low + high);
    (derivative(middle) < 0 ? low : high) = middle;
  }
  return low;
}

}  // namespace

// Inverse of the diagonal of the matrix K + A: minus the Laplacian plus 1, times the area.
Field FilmEnergy::inverse_diagonal() const
{
  Field inverse(vertices());
  for (std::size_t v = 0; v < vertices(); ++v)
  {
    float own = area[v];
    for (std::int32_t s = begin[v]; s < begin[v + 1]; ++s)
      own += laplace[s];
    inverse[v] = 1 / own;
  }
  return inverse;
}

// Solves (K + A) x = b roughly, by Chebyshev iterations for the matrix divided by its diagonal (Saad 2003, Iterative
// methods for sparse linear systems, section 12.3). Eigenvalues are 0.1 to 2 on regular meshes; obtuse triangles raise
// them to 3 at most. The number of passes is odd, because the polynomial is then positive beyond the range, too.
// `change` has a last entry for other vertices.
void FilmEnergy::solve_roughly(const Field& b, const Field& inverse, Field& change, Field& x) const
{
  constexpr int passes = 5;
  constexpr float low = 0.1F, high = 2.1F, middle = 0.5F * (high + low), half = 0.5F * (high - low);
  Field rest(vertices());
  for (std::size_t v = 0; v < vertices(); ++v)
  {
    rest[v] = inverse[v] * b[v];
    x[v] = change[v] = rest[v] / middle;
  }
  float ratio = half / middle;
  for (int pass = 1; pass < passes; ++pass)
  {
    const float next = 1 / (2 * middle / half - ratio);
    for (std::size_t v = 0; v < vertices(); ++v)
    {
      float sum = area[v] * change[v];
      for (std::int32_t s = begin[v]; s < begin[v + 1]; ++s)
        sum += laplace[s] * (change[v] - change[neighbour[s]]);
      rest[v] -= inverse[v] * sum;
    }
    for (std::size_t v = 0; v < vertices(); ++v)
    {
      change[v] = next * ratio * change[v] + 2 * next / half * rest[v];
      x[v] += change[v];
    }
    ratio = next;
  }
}

// Divides by the matrix of the energy of bending and base, 3/4 (K + A) A^-1 (K + A).
void FilmEnergy::precondition(const Field& slope, const Field& inverse, Field& change, Field& x) const
{
  solve_roughly(slope, inverse, change, x);
  Field middle(vertices());
  for (std::size_t v = 0; v < vertices(); ++v)
    middle[v] = 4.0F / 3 * area[v] * x[v];
  solve_roughly(middle, inverse, change, x);
}

void FilmEnergy::apply(Wave& wave) const
{
  const Field& w = wave.height;
  for (std::size_t v = 0; v < vertices(); ++v)
  {
    float sum = 0, force = 0;
    for (std::int32_t s = begin[v]; s < begin[v + 1]; ++s)
    {
      const float difference = w[v] - w[neighbour[s]];
      sum += laplace[s] * difference;
      force += membrane[s] * difference;
    }
    wave.laplace[v] = sum;
    wave.force[v] = force;
  }
}

// Means of grad u . grad v and of grad v . grad v at the corners of cells. Integration by parts gives the means of
// -(u laplace v + v laplace u) / 2, because the weights of cells change slowly.
void FilmEnergy::mean_products(const Wave& u, const Wave& v, Field& mixed, Field& squared) const
{
  mixed.assign(corner_area.size(), 0);
  squared.assign(corner_area.size(), 0);
  std::size_t i = 0;
  while (i < vertices())
  {
    const std::array<std::int32_t, 8>& cell = corner[i];
    std::array<float, 8> of_both{}, of_one{};
    for (; i < vertices() && corner[i][0] == cell[0]; ++i)
    {
      const float both = 0.5F * (u.height[i] * v.laplace[i] + v.height[i] * u.laplace[i]);
      const float one = v.height[i] * v.laplace[i];
      for (std::size_t c = 0; c < 8; ++c)
      {
        of_both[c] += weight[i][c] * both;
        of_one[c] += weight[i][c] * one;
      }
    }
    for (std::size_t c = 0; c < 8; ++c)
    {
      mixed[cell[c]] += of_both[c];
      squared[cell[c]] += of_one[c];
    }
  }
  for (std::size_t c = 0; c < mixed.size(); ++c)
  {
    mixed[c] /= corner_area[c];
    squared[c] /= corner_area[c];
  }
}

// Twice the energy of bending, base and compression.
double FilmEnergy::quadratic(const Wave& u) const
{
  return sum_of(vertices(),
                [&](std::size_t v)
                {
                  const float bent = u.laplace[v] + area[v] * u.height[v];
                  return 0.75F * bent * bent / area[v] + u.force[v] * u.height[v];
                });
}

// The derivative of the energy with respect to the heights. `relief` is the mean of |grad w|^2.
void FilmEnergy::gradient(const Wave& u, const Field& relief, Field& curvature, Field& out) const
{
  for (std::size_t v = 0; v < vertices();)
  {
    const std::array<std::int32_t, 8>& cell = corner[v];
    float of_corner[8];
    for (std::size_t c = 0; c < 8; ++c)
      of_corner[c] = 3 * relief[cell[c]];
    for (; v < vertices() && corner[v][0] == cell[0]; ++v)
    {
      float part[4];
      for (std::size_t c = 0; c < 4; ++c)
        part[c] = weight[v][c] * of_corner[c] + weight[v][c + 4] * of_corner[c + 4];
      const float mean = part[0] + part[1] + (part[2] + part[3]);
      const float bent = 0.75F * (u.laplace[v] / area[v] + u.height[v]);
      curvature[v] = bent + mean * u.height[v];
      out[v] = area[v] * bent + mean * u.laplace[v] + u.force[v] - crease_force[v];
    }
  }
  for (std::size_t v = 0; v < vertices(); ++v)
  {
    float sum = 0;
    for (std::int32_t s = begin[v]; s < begin[v + 1]; ++s)
      sum += laplace[s] * (curvature[v] - curvature[neighbour[s]]);
    out[v] += sum;
  }
}

int FilmEnergy::minimise(Field& height, int most_iterations) const
{
  const std::size_t count = vertices();
  const Field zero(count, 0), with_others(count + 1, 0);
  Wave now{ height, zero, zero }, step{ with_others, zero, zero };
  now.height.push_back(0);
  const Field inverse = inverse_diagonal();
  Field change = with_others, towards = zero;
  Field before_this = zero, slope = zero, curvature = with_others, relief, mixed, squared;
  apply(now);
  mean_products(now, now, mixed, relief);
  const auto energy = [&]
  {
    return 0.5 * quadratic(now) +
           1.5 * sum_of(relief.size(), [&](std::size_t c) { return corner_area[c] * relief[c] * relief[c]; }) -
           sum_of(count, [&](std::size_t v) { return crease_force[v] * now.height[v]; });
  };
  double before = energy(), norm_before = 0;
  int iteration = 0;
  for (; iteration < most_iterations && count > 0; ++iteration)
  {
    gradient(now, relief, curvature, slope);
    precondition(slope, inverse, change, towards);
    const double norm = sum_of(count, [&](std::size_t v) { return towards[v] * slope[v]; }),
                 common = sum_of(count, [&](std::size_t v) { return towards[v] * before_this[v]; }),
                 along = sum_of(count, [&](std::size_t v) { return step.height[v] * slope[v]; });
    auto conjugacy = static_cast<float>(norm_before > 0 ? std::max(0.0, (norm - common) / norm_before) : 0);
    norm_before = norm;
    if (conjugacy * along >= norm)
      conjugacy = 0;
    for (std::size_t v = 0; v < count; ++v)
      step.height[v] = conjugacy * step.height[v] - towards[v];
    const double down = sum_of(count, [&](std::size_t v) { return step.height[v] * slope[v]; });
    before_this.swap(slope);
    if (!(down < 0))
      break;
    apply(step);
    mean_products(now, step, mixed, squared);
    const std::size_t corners = relief.size();
    const double third = 18 * sum_of(corners, [&](std::size_t c) { return corner_area[c] * mixed[c] * squared[c]; }),
                 fourth = 6 * sum_of(corners, [&](std::size_t c) { return corner_area[c] * squared[c] * squared[c]; });
    const double second =
        quadratic(step) + 6 * sum_of(corners, [&](std::size_t c)
                                     { return corner_area[c] * (2 * mixed[c] * mixed[c] + relief[c] * squared[c]); });
    const auto length = static_cast<float>(first_minimum(down, second, third, fourth));
    for (std::size_t v = 0; v < count; ++v)
    {
      now.height[v] += length * step.height[v];
      now.laplace[v] += length * step.laplace[v];
      now.force[v] += length * step.force[v];
    }
    for (std::size_t c = 0; c < corners; ++c)
      relief[c] += length * (2 * mixed[c] + length * squared[c]);
    const double after = energy();
    if (before - after <= tolerance * std::abs(after))
      break;
    before = after;
  }
  height.assign(now.height.begin(), now.height.end() - 1);
  return iteration;
}

}  // namespace frontalis
