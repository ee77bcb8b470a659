// What a film's equilibrium (film_equilibrium.cpp) has from the skin at rest.

#include "solver/skin/film_equilibrium.hpp"

#include "frontalis/solver/rigid_motion.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace frontalis
{
namespace
{

using Point = physics::Vec3<double>;

// Edges longer than this fraction of the wavelength do not resolve it.
constexpr double longest_edge = 1.0 / 3;
constexpr double seed_height = 0.05;  // root mean square of the initial heights, divided by the film's thickness

FilmTensor product(const Point& a, const Point& b, double scale)
{
  const auto part = [&](double x) { return static_cast<float>(scale * x); };
  return { { part(a.x * b.x), part(a.y * b.y), part(a.z * b.z), part(0.5 * (a.x * b.y + a.y * b.x)),
             part(0.5 * (a.x * b.z + a.z * b.x)), part(0.5 * (a.y * b.z + a.z * b.y)) } };
}

std::vector<std::int32_t> region_of(const SkinFilm& film, std::size_t law)
{
  std::vector<std::int32_t> region;
  for (std::size_t v = 0; v < film.law.size(); ++v)
    if (film.law[v] == static_cast<std::int32_t>(law))
      region.push_back(static_cast<std::int32_t>(v));
  return region;
}

std::vector<std::array<double, 3>> places_of(const Model& model, const std::vector<std::int32_t>& vertices)
{
  std::vector<std::array<double, 3>> places;
  places.reserve(vertices.size());
  for (const std::int32_t v : vertices)
    places.push_back(model.skin.vertices[v]);
  return places;
}

}  // namespace

FilmEquilibrium::FilmEquilibrium(const Model& model, std::size_t law)
    : FilmEquilibrium(model, law, region_of(model.film, law))
{
}

FilmEquilibrium::FilmEquilibrium(const Model& model, std::size_t law, std::vector<std::int32_t> region)
    : model_(model),
      law_(model.film.laws[law]),
      critical_(film_critical_strain(law_)),
      k_(2 * physics::pi / film_wavelength(law_)),
      cells_(places_of(model, region),
             std::max(2 * physics::pi / k_, *std::max_element(model.spacing.begin(), model.spacing.end())))
{
  for (const std::int32_t v : cells_.order())
    order_.push_back(region[v]);
  for (Field* field : { &seed_, &crease_, &crease_force_ })
    field->resize(order_.size());
  make_operators();
  make_seed();
  if (!model.film.crease.empty())
    make_creases();
}

// Sets the weights of linear finite elements for the operator div N grad with a tensor N: a triangle of area A
// contributes -A grad_a . N . grad_b to the edge between its corners a and b. The area of a vertex is that of its
// Voronoi region; of an obtuse triangle half is given to the obtuse corner and a quarter to each of the others (Meyer,
// Desbrun, Schroeder & Barr 2003, Discrete differential-geometry operators for triangulated 2-manifolds). With a third
// for each corner, heights would alternate on meshes whose diagonals do.
void FilmEquilibrium::make_operators()
{
  const std::size_t count = order_.size();
  std::vector<std::int32_t> rank(model_.skin.vertices.size(), -1);
  for (std::size_t v = 0; v < count; ++v)
    rank[order_[v]] = static_cast<std::int32_t>(v);
  struct Edge
  {
    FilmTensor sum;
    float squared = 0;
    int triangles = 0;
  };
  std::vector<std::map<std::int32_t, Edge>> edges(count);
  std::vector<double> length(count, 0), area(count, 0);
  for (const auto& triangle : model_.skin.triangles)
  {
    std::int32_t t[3];
    Point at[3];
    for (std::size_t c = 0; c < 3; ++c)
    {
      t[c] = rank[triangle[c]];
      at[c] = vector_of(model_.skin.vertices[triangle[c]]);
    }
    if (std::min({ t[0], t[1], t[2] }) < 0)
      continue;
    const Point normal = cross(at[1] - at[0], at[2] - at[0]);
    const double twice = std::sqrt(dot(normal, normal));
    if (!(twice > 0))
      continue;
    double cotangent[3];
    for (int c = 0; c < 3; ++c)
      cotangent[c] = dot(at[(c + 1) % 3] - at[c], at[(c + 2) % 3] - at[c]) / twice;
    const bool obtuse = *std::min_element(cotangent, cotangent + 3) < 0;
    for (int c = 0; c < 3; ++c)
    {
      const int a = (c + 1) % 3, b = (c + 2) % 3;
      const Point edge = at[b] - at[a];
      const double size = std::sqrt(dot(edge, edge));
      // A gradient times twice the area is an edge turned by a right angle.
      const FilmTensor weight =
          product((1 / twice) * cross(normal, at[c] - at[b]), (1 / twice) * cross(normal, at[a] - at[c]), -0.5 / twice);
      for (const auto& [from, to] : { std::pair{ t[a], t[b] }, std::pair{ t[b], t[a] } })
      {
        Edge& shared = edges[from][to];
        shared.sum += weight;
        shared.squared = static_cast<float>(k_ * k_ * size * size);
        ++shared.triangles;
        length[from] = std::max(length[from], size);
        area[from] += obtuse ? 0 : cotangent[c] * size * size / 8;
      }
      if (obtuse)
        area[t[c]] += (cotangent[c] < 0 ? 0.25 : 0.125) * twice;
    }
  }
  begin_.assign(1, 0);
  for (std::size_t v = 0; v < count; ++v)
  {
    bool inside = !edges[v].empty();
    const std::size_t earlier = rest_edges_.size();
    for (const auto& [to, edge] : edges[v])
    {
      neighbour_.push_back(to);
      edge_.push_back(edge.sum);
      if (to > static_cast<std::int32_t>(v))
        rest_edges_.push_back({ to, edge.squared, 0.25F * edge.sum });
      laplace_.push_back(trace(edge.sum));
      inside = inside && edge.triangles == 2;
    }
    edges_from_.push_back(static_cast<std::int32_t>(rest_edges_.size() - earlier));
    begin_.push_back(static_cast<std::int32_t>(neighbour_.size()));
    area_.push_back(static_cast<float>(area[v] * k_ * k_));
    resolved_.push_back(inside && length[v] * k_ < 2 * physics::pi * longest_edge);
  }
  cells_.set_areas(area_);
}

// Makes the seed from which lines grow: the sum of plane waves in many directions of space, with the film's wavelength.
// On a surface most of these waves have nearly that length. The seed depends on the position alone, so that lines
// return to the same places.
void FilmEquilibrium::make_seed()
{
  constexpr int waves = 64;
  Point along[waves];
  for (int i = 0; i < waves; ++i)
  {
    // The directions of the waves are spread evenly over a sphere.
    const double z = 1 - (2 * i + 1.0) / waves, turn = physics::pi * (3 - std::sqrt(5.0)) * i, r = std::sqrt(1 - z * z);
    along[i] = { r * std::cos(turn), r * std::sin(turn), z };
  }
  for (std::size_t v = 0; v < order_.size(); ++v)
  {
    const Point at = vector_of(model_.skin.vertices[order_[v]]);
    double sum = 0;
    for (int i = 0; i < waves; ++i)
      sum += std::cos(k_ * dot(along[i], at) + i * i);
    seed_[v] = static_cast<float>(seed_height * sum / std::sqrt(0.5 * waves));
  }
}

// The energy - laplace w laplace w0 is minus the heights times forces that do not depend on them.
void FilmEquilibrium::make_creases()
{
  for (std::size_t v = 0; v < order_.size(); ++v)
    crease_[v] = model_.film.crease[order_[v]] / static_cast<float>(law_.thickness);
  Field curvature(order_.size());
  laplacian(crease_, curvature);
  // The film has no energy at vertices without heights, such as those of its border. Nor must creases have, whose slope
  // ends there: it would make a line.
  for (std::size_t v = 0; v < curvature.size(); ++v)
    curvature[v] = resolved_[v] && crease_[v] != 0 && area_[v] > 0 ? curvature[v] / area_[v] : 0;
  laplacian(curvature, crease_force_);
}

// Minus the Laplacian of w, times the area of each vertex.
void FilmEquilibrium::laplacian(const Field& w, Field& out) const
{
  for (std::size_t v = 0; v < w.size(); ++v)
  {
    out[v] = 0;
    for (std::int32_t s = begin_[v]; s < begin_[v + 1]; ++s)
      out[v] += laplace_[s] * (w[v] - w[neighbour_[s]]);
  }
}

}  // namespace frontalis
