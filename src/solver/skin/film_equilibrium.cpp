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
// Larger heights, in thicknesses of the film, are no heights of lines.
constexpr float highest = 1e3F;

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
  const RestEdge* rest = rest_edges_.data();
  for (std::size_t v = 0; v < order_.size(); ++v)
  {
    FilmTensor own = strain_[v];
    for (std::int32_t left = edges_from_[v]; left > 0; --left, ++rest)
    {
      const Vector edge = at[rest->to] - at[v];
      const FilmTensor half = (dot(edge, edge) - rest->squared) * rest->quarter;
      own += half;
      strain_[rest->to] += half;
    }
    strain_[v] = own;
  }
  cells_.find_means(strain_, mean_strain_);
}

// Finds the vertices where the film may have lines. Starts lines from the seed where heights are too small to grow or
// no heights of lines. Cells are passed over if a bound of the largest compression is small at all their corners:
// strains within a cell are means of those at its corners, and the bound is a convex function of the strain.
void FilmEquilibrium::find_active(Field& w)
{
  const auto poisson = static_cast<float>(law_.poisson), stretch = static_cast<float>(law_.stretch);
  const auto least_compression = static_cast<float>(near_critical * critical_);
  const auto compression = [&](float sum, float least)
  { return -((1 - poisson) * least + poisson * sum + (1 + poisson) * stretch); };
  std::vector<bool> compressed(mean_strain_.size());
  for (std::size_t c = 0; c < mean_strain_.size(); ++c)
  {
    const FilmTensor& strain = mean_strain_[c];
    const float sum = trace(strain);
    compressed[c] = !(compression(sum, 0.5F * sum - std::sqrt(0.5F * contract(strain, strain))) <= least_compression);
  }
  active_.clear();
  known_.assign(order_.size(), 0);
  cells_.each_cell(
      [&](std::size_t first, std::size_t last, const std::array<std::int32_t, 8>& corners)
      {
        const bool passed = std::none_of(corners.begin(), corners.end(), [&](std::int32_t c) { return compressed[c]; });
        for (std::size_t v = first; v < last; ++v)
        {
          float most = 0;
          if (!passed)
          {
            // Principal values of a tensor in a plane, from its invariants.
            strain_[v] = cells_.at(mean_strain_, v);
            known_[v] = 1;
            const float sum = trace(strain_[v]), half = 0.5F * sum;
            const float squared = 0.5F * contract(strain_[v], strain_[v]) - half * half;
            most = compression(sum, half - std::sqrt(std::max(squared, 0.0F)));
          }
          if (!resolved_[v] || !(crease_[v] != 0 || most > least_compression))
          {
            w[v] = 0;
            continue;
          }
          active_.push_back(static_cast<std::int32_t>(v));
          if (!(std::abs(w[v]) < highest) || (most > critical_ && std::abs(w[v]) < 0.1F * std::abs(seed_[v])))
            w[v] = seed_[v];
        }
      });
}

// Collects what the energy of the active vertices needs. In units of the film, a compression by the critical strain is
// a force of 3 per length.
void FilmEquilibrium::set_energy()
{
  const auto poisson = static_cast<float>(law_.poisson), stretch = static_cast<float>(law_.stretch);
  const auto scale = static_cast<float>(3 / critical_);
  const auto sum_of = [&](const FilmTensor& strain) { return poisson * trace(strain) + (1 + poisson) * stretch; };
  const auto strain_of = [&](std::int32_t v) { return known_[v] != 0 ? strain_[v] : cells_.at(mean_strain_, v); };
  const auto count = static_cast<std::int32_t>(active_.size());
  rank_.resize(order_.size(), -1);
  corner_rank_.resize(mean_strain_.size(), -1);
  for (auto* const list : { &energy_.begin, &energy_.neighbour })
    list->clear();
  for (auto* const list :
       { &energy_.laplace, &energy_.membrane, &energy_.area, &energy_.crease_force, &energy_.corner_area })
    list->clear();
  energy_.corner.clear();
  energy_.weight.clear();
  energy_.begin.push_back(0);
  for (std::int32_t i = 0; i < count; ++i)
    rank_[active_[i]] = i;
  for (const std::int32_t v : active_)
  {
    const FilmTensor strain = strain_of(v);
    for (std::int32_t s = begin_[v]; s < begin_[v + 1]; ++s)
    {
      const std::int32_t n = neighbour_[s];
      const FilmTensor beside = strain_of(n);
      energy_.neighbour.push_back(rank_[n] < 0 ? count : rank_[n]);
      energy_.laplace.push_back(laplace_[s]);
      energy_.membrane.push_back(0.5F * scale *
                                 ((1 - poisson) * (contract(edge_[s], strain) + contract(edge_[s], beside)) +
                                  laplace_[s] * (sum_of(strain) + sum_of(beside))));
    }
    energy_.begin.push_back(static_cast<std::int32_t>(energy_.neighbour.size()));
    energy_.area.push_back(area_[v]);
    energy_.crease_force.push_back(crease_force_[v]);
    energy_.weight.push_back(cells_.weights(v));
    std::array<std::int32_t, 8> corners = cells_.corners(v);
    for (std::int32_t& corner : corners)
    {
      std::int32_t& rank = corner_rank_[corner];
      if (rank < 0)
      {
        rank = static_cast<std::int32_t>(energy_.corner_area.size());
        energy_.corner_area.push_back(std::max(cells_.areas()[corner], 1e-20F));
      }
      corner = rank;
    }
    energy_.corner.push_back(corners);
  }
  for (const std::int32_t v : active_)
  {
    rank_[v] = -1;
    for (const std::int32_t corner : cells_.corners(v))
      corner_rank_[corner] = -1;
  }
}

int FilmEquilibrium::solve(const std::vector<std::array<float, 3>>& vertices, std::vector<float>& height)
{
  const std::size_t count = order_.size();
  const auto thickness = static_cast<float>(law_.thickness);
  height.resize(vertices.size(), 0);
  Field heights(count, 0);
  for (std::size_t v = 0; v < count; ++v)
    heights[v] = height[order_[v]] / thickness;
  find_strain(vertices);
  find_active(heights);
  set_energy();
  Field of_active;
  for (const std::int32_t v : active_)
    of_active.push_back(heights[v]);
  const int iterations = energy_.minimise(of_active, most_iterations);
  for (std::size_t i = 0; i < active_.size(); ++i)
    heights[active_[i]] = of_active[i];
  for (std::size_t v = 0; v < count; ++v)
    height[order_[v]] = thickness * heights[v];
  return iterations;
}

}  // namespace frontalis
