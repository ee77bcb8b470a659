#include "solver/skin/film_equilibrium.hpp"

#include "frontalis/physics/number.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

// Heights are computed where the film's largest compression is at least this fraction of the critical strain.
constexpr double near_critical = 0.5;
// The solution is found if an iteration lowers the energy by less than this fraction.
constexpr double tolerance = 3e-4;

double inner(const std::vector<std::int32_t>& active, const std::vector<float>& a, const std::vector<float>& b)
{
  double sum = 0;
  for (const std::int32_t v : active)
    sum += static_cast<double>(a[v]) * b[v];
  return sum;
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

// Finds the Green-Lagrange strain as means over cells. The gradient of positions is constant in a triangle, so that the
// integral of F^T F is a sum over edges of squared lengths times the tensors edge_. Each end of an edge gets half of
// its contribution.
void FilmEquilibrium::find_strain(const std::vector<std::array<float, 3>>& vertices)
{
  using Vector = physics::Vec3<float>;
  const auto scale = static_cast<float>(k_);
  std::vector<Vector> at;
  at.reserve(order_.size());
  for (const std::int32_t v : order_)
    at.push_back(scale * Vector{ vertices[v][0], vertices[v][1], vertices[v][2] });
  strain_.assign(order_.size(), {});
  for (std::size_t v = 0; v < order_.size(); ++v)
    for (std::int32_t s = begin_[v]; s < begin_[v + 1]; ++s)
    {
      const auto n = static_cast<std::size_t>(neighbour_[s]);
      if (n < v)
        continue;
      const Vector edge = at[n] - at[v];
      const FilmTensor half = 0.25F * (dot(edge, edge) - squared_[s]) * edge_[s];
      strain_[v] += half;
      strain_[n] += half;
    }
  std::vector<FilmTensor> means(cells_.areas().size());
  for (std::size_t v = 0; v < order_.size(); ++v)
    cells_.add(means, v, strain_[v]);
  cells_.divide_by_area(means);
  for (std::size_t v = 0; v < order_.size(); ++v)
    strain_[v] = cells_.at(means, v);
}

// Finds the vertices where the film may have lines and the membrane forces on the edges there. Starts lines from the
// seed where heights are too small to grow or not finite. In units of the film, a compression by the critical strain is
// a force of 3 per length.
void FilmEquilibrium::find_active(Field& w)
{
  const auto poisson = static_cast<float>(law_.poisson), stretch = static_cast<float>(law_.stretch);
  active_.clear();
  std::vector<float> sums(strain_.size());
  for (std::size_t v = 0; v < strain_.size(); ++v)
  {
    // Principal values of a tensor in a plane, from its invariants.
    const float sum = trace(strain_[v]), half = 0.5F * sum;
    const float least = half - std::sqrt(std::max(0.5F * contract(strain_[v], strain_[v]) - half * half, 0.0F));
    const float compression = -((1 - poisson) * least + poisson * sum + (1 + poisson) * stretch);
    sums[v] = poisson * sum + (1 + poisson) * stretch;
    if (!resolved_[v] || !(crease_[v] != 0 || compression > near_critical * critical_))
    {
      w[v] = 0;
      continue;
    }
    active_.push_back(static_cast<std::int32_t>(v));
    if (!std::isfinite(w[v]) || (compression > critical_ && std::abs(w[v]) < 0.1F * std::abs(seed_[v])))
      w[v] = seed_[v];
  }
  const auto scale = static_cast<float>(3 / critical_);
  for (const std::int32_t v : active_)
    for (std::int32_t s = begin_[v]; s < begin_[v + 1]; ++s)
    {
      const std::int32_t n = neighbour_[s];
      membrane_[s] = 0.5F * scale *
                     ((1 - poisson) * (contract(edge_[s], strain_[v]) + contract(edge_[s], strain_[n])) +
                      laplace_[s] * (sums[v] + sums[n]));
    }
}

// Sums over neighbours: `out` is minus the Laplacian of w, times the area of each vertex. `forced`, if it is not null,
// is minus the divergence of the film's membrane force times grad w, times the area.
void FilmEquilibrium::apply(const Field& w, Field& out, Field* forced) const
{
  for (const std::int32_t v : active_)
  {
    float sum = 0, force = 0;
    for (std::int32_t s = begin_[v]; s < begin_[v + 1]; ++s)
    {
      const float difference = w[v] - w[neighbour_[s]];
      sum += laplace_[s] * difference;
      force += membrane_[s] * difference;
    }
    out[v] = sum;
    if (forced != nullptr)
      (*forced)[v] = force;
  }
}

// Means of grad u . grad v at the corners of cells. Integration by parts gives the means of -(u laplace v + v laplace
// u) / 2, because the weights of cells change slowly.
void FilmEquilibrium::mean_products(const Wave& u, const Wave& v, Field& out) const
{
  out.assign(cells_.areas().size(), 0);
  for (const std::int32_t a : active_)
    cells_.add(out, a, 0.5F * (u.height[a] * v.laplace[a] + v.height[a] * u.laplace[a]));
  cells_.divide_by_area(out);
}

// Twice the energy of bending, base and compression.
double FilmEquilibrium::quadratic(const Wave& u) const
{
  double sum = 0;
  for (const std::int32_t v : active_)
  {
    const float bent = u.laplace[v] + area_[v] * u.height[v];
    sum += static_cast<double>(0.75F * bent * bent / area_[v] + u.force[v] * u.height[v]);
  }
  return sum;
}

// The derivative of the energy with respect to the heights. `relief` is the mean of |grad w|^2.
void FilmEquilibrium::gradient(const Wave& u, const Field& relief, Field& out)
{
  for (const std::int32_t v : active_)
  {
    const float mean = cells_.at(relief, v);
    const float bent = 0.75F * (u.laplace[v] / area_[v] + u.height[v]);
    curvature_[v] = bent + 3 * mean * u.height[v];
    local_[v] = area_[v] * bent + 3 * mean * u.laplace[v] + u.force[v];
  }
  apply(curvature_, out, nullptr);
  for (const std::int32_t v : active_)
    out[v] += local_[v] - crease_force_[v];
}

// Inverse of the diagonal of the quadratic energy's matrix.
void FilmEquilibrium::precondition(Field& inverse) const
{
  for (const std::int32_t v : active_)
  {
    float own = area_[v], others = 0, force = 0;
    for (std::int32_t s = begin_[v]; s < begin_[v + 1]; ++s)
    {
      own += laplace_[s];
      others += laplace_[s] * laplace_[s] / area_[neighbour_[s]];
      force += membrane_[s];
    }
    inverse[v] = 1 / (0.75F * (own * own / area_[v] + others) + std::max(force, 0.0F));
  }
}

// Conjugate gradients (Polak & Ribiere) with exact line search: the energy along a line is a polynomial of degree four.
int FilmEquilibrium::solve(const std::vector<std::array<float, 3>>& vertices, std::vector<float>& height)
{
  const std::size_t count = order_.size();
  const auto thickness = static_cast<float>(law_.thickness);
  height.resize(vertices.size(), 0);
  const Field zero(count, 0);
  Wave now{ zero, zero, zero }, step{ zero, zero, zero };
  for (std::size_t v = 0; v < count; ++v)
    now.height[v] = height[order_[v]] / thickness;
  find_strain(vertices);
  find_active(now.height);
  Field gradient_before = zero, gradient_now = zero, inverse = zero, relief, mixed, squared;
  curvature_ = zero;
  precondition(inverse);
  apply(now.height, now.laplace, &now.force);
  mean_products(now, now, relief);
  const auto energy = [&]
  {
    double sum = 0.5 * quadratic(now);
    for (std::size_t c = 0; c < relief.size(); ++c)
      sum += 1.5 * static_cast<double>(cells_.areas()[c] * relief[c] * relief[c]);
    return sum - inner(active_, crease_force_, now.height);
  };
  double before = energy(), norm_before = 0;
  int iteration = 0;
  for (; iteration < most_iterations && !active_.empty(); ++iteration)
  {
    gradient(now, relief, gradient_now);
    double norm = 0, common = 0;
    for (const std::int32_t v : active_)
    {
      norm += static_cast<double>(gradient_now[v] * inverse[v] * gradient_now[v]);
      common += static_cast<double>(gradient_now[v] * inverse[v] * gradient_before[v]);
    }
    auto conjugacy = static_cast<float>(norm_before > 0 ? std::max(0.0, (norm - common) / norm_before) : 0);
    norm_before = norm;
    if (conjugacy * inner(active_, step.height, gradient_now) >= norm)
      conjugacy = 0;
    for (const std::int32_t v : active_)
      step.height[v] = conjugacy * step.height[v] - inverse[v] * gradient_now[v];
    gradient_before.swap(gradient_now);
    const double down = inner(active_, step.height, gradient_before);
    if (!(down < 0))
      break;
    apply(step.height, step.laplace, &step.force);
    mean_products(now, step, mixed);
    mean_products(step, step, squared);
    double second = quadratic(step), third = 0, fourth = 0;
    for (std::size_t c = 0; c < relief.size(); ++c)
    {
      const double area = cells_.areas()[c], a = relief[c], b = mixed[c], d = squared[c];
      second += 6 * area * (2 * b * b + a * d);
      third += 18 * area * b * d;
      fourth += 6 * area * d * d;
    }
    const auto length = static_cast<float>(first_minimum(down, second, third, fourth));
    for (const std::int32_t v : active_)
    {
      now.height[v] += length * step.height[v];
      now.laplace[v] += length * step.laplace[v];
      now.force[v] += length * step.force[v];
    }
    for (std::size_t c = 0; c < relief.size(); ++c)
      relief[c] += length * (2 * mixed[c] + length * squared[c]);
    const double after = energy();
    if (before - after <= tolerance * std::abs(after))
      break;
    before = after;
  }
  for (std::size_t v = 0; v < count; ++v)
    height[order_[v]] = thickness * now.height[v];
  return iteration;
}

}  // namespace frontalis
