#include "solver/skin/film_equilibrium.hpp"

#include "frontalis/physics/number.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace frontalis
{
namespace
{

using Vector = physics::Vec3<double>;

constexpr double pi = 3.14159265358979323846;

// edges longer than this part of the wavelength do not resolve it
constexpr double longest_edge = 1.0 / 3;
// Heights are computed where the film's largest compression is at least this part of the critical one.
constexpr double near_critical = 0.5;
constexpr int most_iterations = 40;
// the solution is found if an iteration lowers the energy by less than this part of it
constexpr double tolerance = 3e-4;
constexpr int seed_iterations = 150;
constexpr double seed_height = 0.05;  // root mean square, over the film's thickness

template <class Number>
Vector vector_of(const std::array<Number, 3>& p)
{
  return { p[0], p[1], p[2] };
}

std::array<float, 6> product(const Vector& a, const Vector& b, double scale)
{
  const auto part = [&](double x) { return static_cast<float>(scale * x); };
  return { { part(a.x * b.x), part(a.y * b.y), part(a.z * b.z), part(0.5 * (a.x * b.y + a.y * b.x)),
             part(0.5 * (a.x * b.z + a.z * b.x)), part(0.5 * (a.y * b.z + a.z * b.y)) } };
}

template <class Tensor>
float trace(const Tensor& a)
{
  return a[0] + a[1] + a[2];
}

template <class Tensor>
float contract(const Tensor& a, const Tensor& b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + 2 * (a[3] * b[3] + a[4] * b[4] + a[5] * b[5]);
}

double inner(const std::vector<std::int32_t>& active, const std::vector<float>& a, const std::vector<float>& b)
{
  double sum = 0;
  for (const std::int32_t v : active)
    sum += static_cast<double>(a[v]) * b[v];
  return sum;
}

// The positive x at which slope + x curvature + cubic terms first vanish, for slope < 0.
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

FilmEquilibrium::FilmEquilibrium(const Model& model) : model_(model), critical_(film_critical_strain(model.film))
{
  const double wavelength = film_wavelength(model.film);
  make_cells(std::max(wavelength, *std::max_element(model.spacing.begin(), model.spacing.end())));
  make_operators(wavelength);
  strain_.resize(order_.size());
  for (Field* field : { &seed_, &mixed_, &local_ })
    field->resize(order_.size());
  make_seed();
}

// Vertices are numbered by cell, so that neighbours are near each other in memory. Cells are at least a wavelength long,
// so that a mean of a squared wave has no ripple, and a voxel, so that strains that jump between voxels leave no trace.
void FilmEquilibrium::make_cells(double edge)
{
  const auto& at = model_.skin.vertices;
  const auto place_of = [&](std::size_t v)
  {
    std::array<std::int32_t, 3> place{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      place[axis] = static_cast<std::int32_t>(std::floor(at[v][axis] / edge));
    return place;
  };
  order_.resize(at.size());
  std::iota(order_.begin(), order_.end(), 0);
  std::stable_sort(order_.begin(), order_.end(),
                   [&](std::int32_t a, std::int32_t b) { return place_of(a) < place_of(b); });
  std::map<std::array<std::int32_t, 3>, std::int32_t> number;
  for (const std::int32_t v : order_)
  {
    Cell cell{};
    for (std::size_t c = 0; c < 8; ++c)
    {
      std::array<std::int32_t, 3> place = place_of(v);
      double weight = 1;
      for (std::size_t axis = 0; axis < 3; ++axis)
      {
        const double share = at[v][axis] / edge - place[axis];
        const bool upper = (c >> axis & 1U) != 0;
        place[axis] += upper ? 1 : 0;
        weight *= upper ? share : 1 - share;
      }
      cell.corner[c] = number.emplace(place, static_cast<std::int32_t>(number.size())).first->second;
      cell.weight[c] = static_cast<float>(weight);
    }
    cell_.push_back(cell);
  }
  corner_strain_.resize(number.size());
}

// Linear finite elements: the edge opposite to corner c of a triangle has the weight -A grad_a . N . grad_b, where a, b
// are its ends. The area of a vertex is a third of that of its triangles.
void FilmEquilibrium::make_operators(double wavelength)
{
  const double k = 2 * pi / wavelength;
  const std::size_t count = order_.size();
  std::vector<std::int32_t> rank(count);
  for (std::size_t v = 0; v < count; ++v)
    rank[order_[v]] = static_cast<std::int32_t>(v);
  std::vector<std::map<std::int32_t, std::pair<Tensor, int>>> edges(count);
  std::vector<double> length(count, 0), area(count, 0);
  for (const auto& triangle : model_.skin.triangles)
  {
    std::int32_t t[3];
    Vector at[3];
    for (std::size_t c = 0; c < 3; ++c)
    {
      t[c] = rank[triangle[c]];
      at[c] = vector_of(model_.skin.vertices[triangle[c]]);
    }
    const Vector normal = cross(at[1] - at[0], at[2] - at[0]);
    const double twice = std::sqrt(dot(normal, normal));
    for (int c = 0; c < 3; ++c)
    {
      const int a = (c + 1) % 3, b = (c + 2) % 3;
      const Vector edge = at[b] - at[a];
      const double size = std::sqrt(dot(edge, edge));
      // gradients times 2 A are edges turned by a right angle
      const Tensor weight = product((1 / twice) * cross(normal, at[c] - at[b]), (1 / twice) * cross(normal, at[a] - at[c]),
                                    twice > 0 ? -0.5 / twice : 0);
      for (const auto& [from, to] : { std::pair{ t[a], t[b] }, std::pair{ t[b], t[a] } })
      {
        auto& [sum, triangles] = edges[from][to];
        for (std::size_t i = 0; i < sum.size(); ++i)
          sum[i] += weight[i];
        ++triangles;
        length[from] = std::max(length[from], size);
      }
      area[t[c]] += twice / 6;
    }
  }
  begin_.assign(1, 0);
  for (std::size_t v = 0; v < count; ++v)
  {
    bool inside = !edges[v].empty();
    for (const auto& [to, edge] : edges[v])
    {
      neighbour_.push_back(to);
      edge_.push_back(edge.first);
      laplace_.push_back(trace(edge.first));
      inside = inside && edge.second == 2;
    }
    begin_.push_back(static_cast<std::int32_t>(neighbour_.size()));
    area_.push_back(static_cast<float>(area[v] * k * k));
    resolved_.push_back(inside && length[v] < longest_edge * wavelength);
  }
  membrane_.resize(laplace_.size());
  cell_area_.assign(corner_strain_.size(), 0);
  for (std::size_t v = 0; v < count; ++v)
    for (std::size_t c = 0; c < 8; ++c)
      cell_area_[cell_[v].corner[c]] += cell_[v].weight[c] * area_[v];
}

// Green-Lagrange strain of the carried triangles, as means at vertices, halved along edges, then smoothed over cells.
void FilmEquilibrium::find_strain(const std::vector<std::array<float, 3>>& vertices)
{
  const auto& rest = model_.skin.vertices;
  std::vector<Tensor> strain(rest.size(), Tensor{});
  Field sum(rest.size(), 0);
  for (const auto& t : model_.film.carried)
  {
    const Vector a = vector_of(rest[t[1]]) - vector_of(rest[t[0]]), b = vector_of(rest[t[2]]) - vector_of(rest[t[0]]);
    const Vector c = vector_of(vertices[t[1]]) - vector_of(vertices[t[0]]);
    const Vector d = vector_of(vertices[t[2]]) - vector_of(vertices[t[0]]);
    const double aa = dot(a, a), ab = dot(a, b), bb = dot(b, b), determinant = aa * bb - ab * ab;
    if (!(determinant > 0))
      continue;
    const Vector dual_a = (1 / determinant) * (bb * a - ab * b), dual_b = (1 / determinant) * (aa * b - ab * a);
    const double area = 0.5 * std::sqrt(determinant);
    const Tensor of_a = product(dual_a, dual_a, 0.5 * area * (dot(c, c) - aa));
    const Tensor of_b = product(dual_b, dual_b, 0.5 * area * (dot(d, d) - bb));
    const Tensor of_both = product(dual_a, dual_b, area * (dot(c, d) - ab));
    for (const std::int32_t v : t)
    {
      for (std::size_t i = 0; i < 6; ++i)
        strain[v][i] += of_a[i] + of_b[i] + of_both[i];
      sum[v] += static_cast<float>(area);
    }
  }
  const std::size_t carried = rest.size() - model_.film.parents.size();
  for (std::size_t v = 0; v < carried; ++v)
    for (float& x : strain[v])
      x = sum[v] > 0 ? x / sum[v] : 0;
  for (std::size_t v = carried; v < rest.size(); ++v)
  {
    const auto& [a, b] = model_.film.parents[v - carried];
    for (std::size_t i = 0; i < 6; ++i)
      strain[v][i] = 0.5F * (strain[a][i] + strain[b][i]);
  }
  std::fill(corner_strain_.begin(), corner_strain_.end(), Tensor{});
  for (std::size_t v = 0; v < rest.size(); ++v)
    for (std::size_t c = 0; c < 8; ++c)
      for (std::size_t i = 0; i < 6; ++i)
        corner_strain_[cell_[v].corner[c]][i] += cell_[v].weight[c] * area_[v] * strain[order_[v]][i];
  for (std::size_t c = 0; c < corner_strain_.size(); ++c)
    for (float& x : corner_strain_[c])
      x /= std::max(cell_area_[c], 1e-20F);
  for (std::size_t v = 0; v < rest.size(); ++v)
  {
    strain_[v] = Tensor{};
    for (std::size_t c = 0; c < 8; ++c)
      for (std::size_t i = 0; i < 6; ++i)
        strain_[v][i] += cell_[v].weight[c] * corner_strain_[cell_[v].corner[c]][i];
  }
}

// Turns strains into forces of the film over those of strain 1, finds the vertices to be computed, and sets lines off.
void FilmEquilibrium::find_active(Field& w)
{
  const auto poisson = static_cast<float>(model_.film.poisson), stretch = static_cast<float>(model_.film.stretch);
  active_.clear();
  std::vector<float> sums(strain_.size());
  for (std::size_t v = 0; v < strain_.size(); ++v)
  {
    // principal values of a tensor in a plane, by its invariants
    const float sum = trace(strain_[v]), half = 0.5F * sum;
    const float least = half - std::sqrt(std::max(0.5F * contract(strain_[v], strain_[v]) - half * half, 0.0F));
    const float compression = -((1 - poisson) * least + poisson * sum + (1 + poisson) * stretch);
    sums[v] = poisson * sum + (1 + poisson) * stretch;
    if (!resolved_[v] || !(compression > near_critical * critical_))
    {
      w[v] = 0;
      continue;
    }
    active_.push_back(static_cast<std::int32_t>(v));
    if (compression > critical_ && std::abs(w[v]) < 0.1F * std::abs(seed_[v]))
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


// Sums over neighbours: out = laplace of w times area, with the sign that makes it positive, and if `forced` the same for
// the film's force.
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

// Means at the corners of cells of grad u . grad v, as those of (u laplace v + v laplace u) / 2.
void FilmEquilibrium::mean_products(const Wave& u, const Wave& v, Field& out) const
{
  out.assign(cell_area_.size(), 0);
  for (const std::int32_t a : active_)
  {
    const float product = 0.5F * (u.height[a] * v.laplace[a] + v.height[a] * u.laplace[a]);
    for (std::size_t c = 0; c < 8; ++c)
      out[cell_[a].corner[c]] += cell_[a].weight[c] * product;
  }
  for (std::size_t c = 0; c < out.size(); ++c)
    out[c] /= std::max(cell_area_[c], 1e-20F);
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

// The derivative of the energy.
void FilmEquilibrium::gradient(const Wave& u, const Field& stretch, Field& out)
{
  for (const std::int32_t v : active_)
  {
    float mean = 0;
    for (std::size_t c = 0; c < 8; ++c)
      mean += cell_[v].weight[c] * stretch[cell_[v].corner[c]];
    const float bent = 0.75F * (u.laplace[v] / area_[v] + u.height[v]);
    mixed_[v] = bent + 3 * mean * u.height[v];
    local_[v] = area_[v] * bent + 3 * mean * u.laplace[v] + u.force[v];
  }
  apply(mixed_, out, nullptr);
  for (const std::int32_t v : active_)
    out[v] += local_[v];
}

// Noise in which waves near the film's wavelength prevail, of all directions: what a steepest descent leaves of white
// noise in a film that is at its critical compression in all directions. The same in every run.
void FilmEquilibrium::make_seed()
{
  std::uint32_t state = 1;
  for (std::size_t v = 0; v < area_.size(); ++v)
  {
    state = state * 1664525U + 1013904223U;
    seed_[v] = resolved_[v] ? static_cast<float>(state >> 8U) / 8388608.0F - 1 : 0;
    if (resolved_[v])
      active_.push_back(static_cast<std::int32_t>(v));
  }
  Wave wave{ seed_, seed_, seed_ };
  const Field flat(cell_area_.size(), 0);
  Field slope(seed_.size(), 0), inverse(seed_.size(), 0);
  std::transform(laplace_.begin(), laplace_.end(), membrane_.begin(), [](float x) { return -3 * x; });
  precondition(inverse);
  for (int i = 0; i < seed_iterations; ++i)
  {
    apply(wave.height, wave.laplace, &wave.force);
    gradient(wave, flat, slope);
    for (const std::int32_t v : active_)
      wave.height[v] -= 0.7F * inverse[v] * slope[v];
  }
  const double mean = std::sqrt(inner(active_, wave.height, wave.height) / static_cast<double>(active_.size() + 1));
  for (std::size_t v = 0; v < seed_.size(); ++v)
    seed_[v] = mean > 0 ? static_cast<float>(seed_height * wave.height[v] / mean) : 0;
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

// Conjugate gradients (Polak & Ribiere) with exact line search: along a line the energy is a polynomial of degree four.
int FilmEquilibrium::solve(const std::vector<std::array<float, 3>>& vertices, std::vector<float>& height)
{
  const std::size_t count = order_.size();
  const auto thickness = static_cast<float>(model_.film.thickness);
  height.resize(count, 0);
  const Field zero(count, 0);
  Wave now{ zero, zero, zero }, step{ zero, zero, zero };
  for (std::size_t v = 0; v < count; ++v)
    now.height[v] = height[order_[v]] / thickness;
  find_strain(vertices);
  find_active(now.height);
  Field slope = zero, fresh = zero, inverse = zero, stretch, mixed, squared;
  mixed_ = zero;
  precondition(inverse);
  apply(now.height, now.laplace, &now.force);
  mean_products(now, now, stretch);
  const auto energy = [&]
  {
    double sum = 0.5 * quadratic(now);
    for (std::size_t c = 0; c < stretch.size(); ++c)
      sum += 1.5 * static_cast<double>(cell_area_[c] * stretch[c] * stretch[c]);
    return sum;
  };
  double before = energy(), slope_before = 0;
  int iteration = 0;
  for (; iteration < most_iterations && !active_.empty(); ++iteration)
  {
    gradient(now, stretch, fresh);
    double own = 0, common = 0;
    for (const std::int32_t v : active_)
    {
      own += static_cast<double>(fresh[v] * inverse[v] * fresh[v]);
      common += static_cast<double>(fresh[v] * inverse[v] * slope[v]);
    }
    auto keep = static_cast<float>(slope_before > 0 ? std::max(0.0, (own - common) / slope_before) : 0);
    slope_before = own;
    if (keep * inner(active_, step.height, fresh) >= own)
      keep = 0;
    for (const std::int32_t v : active_)
      step.height[v] = keep * step.height[v] - inverse[v] * fresh[v];
    slope.swap(fresh);
    const double down = inner(active_, step.height, slope);
    if (!(down < 0))
      break;
    apply(step.height, step.laplace, &step.force);
    mean_products(now, step, mixed);
    mean_products(step, step, squared);
    double second = quadratic(step), third = 0, fourth = 0;
    for (std::size_t c = 0; c < stretch.size(); ++c)
    {
      const double area = cell_area_[c], a = stretch[c], b = mixed[c], d = squared[c];
      second += 6 * area * (2 * b * b + a * d);
      third += 18 * area * b * d;
      fourth += 6 * area * d * d;
    }
    const auto far = static_cast<float>(first_minimum(down, second, third, fourth));
    for (const std::int32_t v : active_)
    {
      now.height[v] += far * step.height[v];
      now.laplace[v] += far * step.laplace[v];
      now.force[v] += far * step.force[v];
    }
    for (std::size_t c = 0; c < stretch.size(); ++c)
      stretch[c] += far * (2 * mixed[c] + far * squared[c]);
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
