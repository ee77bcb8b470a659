#include "solver/skin/cell_means.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace frontalis
{

CellMeans::CellMeans(const std::vector<std::array<double, 3>>& points, double edge)
    : order_(points.size()), weight_(points.size())
{
  using Place = std::array<std::int32_t, 3>;
  std::vector<Place> places(points.size());
  for (std::size_t v = 0; v < places.size(); ++v)
    for (std::size_t axis = 0; axis < 3; ++axis)
      places[v][axis] = static_cast<std::int32_t>(std::floor(points[v][axis] / edge));
  std::iota(order_.begin(), order_.end(), 0);
  std::stable_sort(order_.begin(), order_.end(), [&](std::int32_t a, std::int32_t b) { return places[a] < places[b]; });
  std::map<Place, std::int32_t> number;
  for (std::size_t v = 0; v < order_.size(); ++v)
  {
    const Place& own = places[order_[v]];
    const bool first = v == 0 || own != places[order_[v - 1]];
    if (first)
    {
      first_.push_back(v);
      corner_.emplace_back();
    }
    cell_.push_back(static_cast<std::int32_t>(corner_.size()) - 1);
    for (std::size_t c = 0; c < 8; ++c)
    {
      Place place = own;
      double weight = 1;
      for (std::size_t axis = 0; axis < 3; ++axis)
      {
        const double share = points[order_[v]][axis] / edge - place[axis];
        const bool upper = (c >> axis & 1U) != 0;
        place[axis] += upper ? 1 : 0;
        weight *= upper ? share : 1 - share;
      }
      if (first)
        corner_.back()[c] = number.emplace(place, static_cast<std::int32_t>(number.size())).first->second;
      weight_[v][c] = static_cast<float>(weight);
    }
  }
  first_.push_back(order_.size());
  area_.resize(number.size());
}

void CellMeans::set_areas(const Field& area)
{
  std::fill(area_.begin(), area_.end(), 0.0F);
  add(area, area_);
}

}  // namespace frontalis
