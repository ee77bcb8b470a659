// Which triangles a vertex may touch.

#include "solver/contact/tissue_contact.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

using Vector = physics::Vec3<double>;

// How deep behind a triangle a vertex is found, in shortest voxel edges: deeper than in one motion between two
// searches.
constexpr double deepest_found = 0.5;

// In barycentric coordinates, more than the error of a foot, so that none falls between two triangles.
constexpr double foot_error = 0.02;

// Cosine between the normals of a vertex and of a triangle's corner from which on they surely do not face each other.
constexpr double same_way = 0.5;

// Way of a vertex over the surface between two steps, in triangles.
constexpr int most_hops = 16;

// Triangles around one that a vertex holds on to, whose corners are placed in each step.
constexpr int rings = 3;

// Motion between the sorting of triangles and the search, over the reach.
constexpr double margin = 1.1;

}  // namespace

// The surface's triangle under x, from one near it. Triangles whose corners are not placed are not entered.
template <class Real>
typename TissueContact<Real>::Foot TissueContact<Real>::follow(std::int32_t& t, const Vector& x,
                                                               const std::vector<Placed>& placed) const
{
  Foot foot = physics::surface_foot(surface_.triangle(t, placed), x);
  for (int hop = 0; hop < most_hops; ++hop)
  {
    std::int32_t to = -1;
    double least = -1e-9;
    for (std::size_t i = 0; i < 3; ++i)
    {
      const std::int32_t across = surface_.triangles[t].neighbour[i];
      if (across < 0 || foot.weight[i] >= least)
        continue;
      const auto& corners = surface_.triangles[across].vertex;
      if (!std::all_of(corners.begin(), corners.end(), [&](std::int32_t v) { return live_[v] != 0; }))
        continue;
      least = foot.weight[i];
      to = across;
    }
    if (to < 0)
      break;
    t = to;
    foot = physics::surface_foot(surface_.triangle(t, placed), x);
  }
  return foot;
}

template <class Real>
void TissueContact<Real>::sort_triangles()
{
  std::vector<Vector> centres;
  double largest = 0;
  for (const auto& triangle : surface_.triangles)
  {
    const Vector &a = placed_[triangle.vertex[0]].place, &b = placed_[triangle.vertex[1]].place,
                 &c = placed_[triangle.vertex[2]].place;
    centres.push_back((1.0 / 3) * (a + b + c));
    for (const Vector* const corner : { &a, &b, &c })
    {
      const Vector way = *corner - centres.back();
      largest = std::max(largest, dot(way, way));
    }
  }
  grid_.build(margin * (reach_ + std::sqrt(largest)), centres);
}

// Whether a vertex has a triangle of a facing surface in front of it within the reach, or just behind.
template <class Real>
bool TissueContact<Real>::meets(std::size_t p, std::int32_t t, double& gap) const
{
  const auto& triangle = surface_.triangles[t];
  const Placed &point = placed_[p], &a = placed_[triangle.vertex[0]];
  const Vector way = point.place - a.place;
  const double farthest = 2 * grid_.reach() - margin * reach_;
  if (dot(way, way) > farthest * farthest || dot(point.normal, a.normal) > same_way ||
      surface_.vertices[p].contact != surface_.vertices[triangle.vertex[0]].contact)
    return false;
  const Foot foot = physics::surface_foot(surface_.triangle(t, placed_), point.place);
  gap = foot.gap - double(overlap_[p]);
  if (gap > reach_ || gap < -deepest_found * surface_.edge || dot(foot.normal, point.normal) > 0)
    return false;
  for (std::size_t i = 0; i < 3; ++i)
  {
    const double beyond = triangle.neighbour[i] < 0 ? reach_ * norm(foot.slope[i]) : foot_error;
    if (foot.weight[i] < -beyond)
      return false;
  }
  return !surface_.inseparable(p, t);
}

template <class Real>
void TissueContact<Real>::search(std::size_t p)
{
  Track* const tracks = tracks_.data() + p * most_tracks;
  std::array<double, most_tracks> away;
  for (std::size_t k = 0; k < most_tracks; ++k)
  {
    // what touches is held in any case
    const bool held = tracks[k].touches != Touching::no || tracks[k].pressed > 0;
    if (!held)
      tracks[k] = {};
    away[k] = held ? -1 : 2 * reach_;
  }
  const auto adjoin = [&](std::int32_t t, std::int32_t s)
  {
    const auto &a = surface_.triangles[t].vertex, &b = surface_.triangles[s].vertex;
    return std::any_of(a.begin(), a.end(), [&](auto v) { return std::find(b.begin(), b.end(), v) != b.end(); });
  };
  grid_.near(placed_[p].place,
             [&](std::int32_t t)
             {
               double gap;
               if (!meets(p, t, gap))
                 return;
               // it replaces the triangle of the same surface there, or the farthest
               std::size_t k = away[0] > away[1] ? 0 : 1;
               for (std::size_t same = 0; same < most_tracks; ++same)
                 if (tracks[same].triangle >= 0 && adjoin(t, tracks[same].triangle))
                   k = same;
               if (std::abs(gap) >= away[k])
                 return;
               away[k] = std::abs(gap);
               tracks[k].triangle = t;
             });
  due_[p] = 0;
}

template <class Real>
void TissueContact<Real>::mark_live()
{
  std::fill(live_.begin(), live_.end(), std::uint8_t(0));
  const auto mark = [&](const auto& self, std::int32_t t, int left) -> void
  {
    for (const auto v : surface_.triangles[t].vertex)
      live_[v] = 1;
    for (const auto across : surface_.triangles[t].neighbour)
      if (left > 0 && across >= 0)
        self(self, across, left - 1);
  };
  for (std::size_t k = 0; k < tracks_.size(); ++k)
    if (tracks_[k].triangle >= 0)
    {
      live_[k / most_tracks] = 1;
      mark(mark, tracks_[k].triangle, rings);
    }
}

// Surfaces that meet at rest, such as closed lips, may overlap by as much as their triangles err.
template <class Real>
void TissueContact<Real>::find_overlap_at_rest()
{
  sort_triangles();
  std::vector<float> overlap(overlap_.size(), 0);
  for (std::size_t p = 0; p < overlap.size(); ++p)
  {
    search(p);
    for (std::size_t k = p * most_tracks; k < (p + 1) * most_tracks; ++k)
      if (tracks_[k].triangle >= 0)
        overlap[p] =
            std::min(overlap[p], static_cast<float>(follow(tracks_[k].triangle, placed_[p].place, placed_).gap));
  }
  reset();
  overlap_ = overlap;
}

#define FRONTALIS_TISSUE_CONTACT_SEARCH(Real)                                                       \
  template TissueContact<Real>::Foot TissueContact<Real>::follow(std::int32_t&, const Vector&,      \
                                                                 const std::vector<Placed>&) const; \
  template void TissueContact<Real>::sort_triangles();                                              \
  template void TissueContact<Real>::search(std::size_t);                                           \
  template void TissueContact<Real>::mark_live();                                                   \
  template void TissueContact<Real>::find_overlap_at_rest();
FRONTALIS_TISSUE_CONTACT_SEARCH(float)
FRONTALIS_TISSUE_CONTACT_SEARCH(double)

}  // namespace frontalis
