#include "bake/fibres/coordinate_range.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace frontalis
{

DistanceTable::DistanceTable(const MuscleGrid& grid, const CornerField& field, bool periodic)
{
  std::vector<std::pair<double, double>> cells;  // value, steepness
  double low = periodic ? 0 : 1e300, high = periodic ? 1 : -1e300;
  for (const auto& corners : field)
  {
    const double value = std::accumulate(corners.begin(), corners.end(), 0.0) / 8;
    cells.emplace_back(periodic ? value - std::floor(value) : value, gradient(grid, corners).norm());
    low = std::min(low, cells.back().first);
    high = std::max(high, cells.back().first);
  }
  std::sort(cells.begin(), cells.end());
  const std::size_t bins = std::min<std::size_t>(64, std::max<std::size_t>(1, cells.size() / 20));
  values_.push_back(low);
  distances_.push_back(0);
  for (std::size_t b = 0; b < bins; ++b)
  {
    const std::size_t begin = b * cells.size() / bins, end = (b + 1) * cells.size() / bins;
    double steepness = 0;
    for (std::size_t c = begin; c < end; ++c)
      steepness += cells[c].second / static_cast<double>(end - begin);
    const double value = b + 1 < bins ? cells[end].first : high;
    distances_.push_back(distances_.back() + (steepness > 0 ? (value - values_.back()) / steepness : 0));
    values_.push_back(value);
  }
}

double DistanceTable::operator()(double value) const
{
  const auto above = std::upper_bound(values_.begin() + 1, values_.end() - 1, value);
  const auto k = above - values_.begin();
  const double step = values_[k] - values_[k - 1];
  const double t = step > 0 ? std::min(1.0, std::max(0.0, (value - values_[k - 1]) / step)) : 0;
  return distances_[k - 1] + t * (distances_[k] - distances_[k - 1]);
}

Stretch::Stretch(const MuscleGrid& grid, const std::vector<std::array<double, 2>>& samples, std::size_t stretched,
                 bool closed, double ends)
    : stretched_(stretched), closed_(closed)
{
  std::array<std::vector<std::pair<double, double>>, bins> values;  // value, area
  for (std::size_t s = 0; s < samples.size(); ++s)
    if (grid.samples[s].cell >= 0)
      values[bin(samples[s][1 - stretched])].emplace_back(samples[s][stretched], grid.samples[s].area);

  // the limits leave out the outermost part of each bin's area
  constexpr double outermost = 0.005;
  std::array<double, bins> given{};
  for (std::size_t b = 0; b < bins; ++b)
  {
    std::sort(values[b].begin(), values[b].end());
    double all = 0, sum = 0;
    for (const auto& entry : values[b])
      all += entry.second;
    if (!(all > 0))
      continue;
    given[b] = 1;
    low_[b] = high_[b] = values[b].back().first;
    for (const auto& [value, area] : values[b])
    {
      if (sum < outermost * all)
        low_[b] = value;
      if (sum < (1 - outermost) * all)
        high_[b] = value;
      sum += area;
    }
  }

  const auto first = static_cast<std::size_t>(ends * static_cast<double>(bins));
  for (std::size_t b = 0; b < first; ++b)
    for (const auto& [to, from] : { std::make_pair(b, first), std::make_pair(bins - 1 - b, bins - 1 - first) })
    {
      low_[to] = low_[from];
      high_[to] = high_[from];
      given[to] = given[from];
    }
  for (int repetition = 0; repetition < 4; ++repetition)
    smooth(given);
}

std::size_t Stretch::bin(double value)
{
  return std::min(bins - 1, static_cast<std::size_t>(std::max(0.0, value) * static_cast<double>(bins)));
}

void Stretch::smooth(std::array<double, bins>& given)
{
  const auto low = low_, high = high_, weight = given;
  for (std::size_t b = 0; b < bins; ++b)
  {
    double all = 2 * weight[b];
    low_[b] *= all;
    high_[b] *= all;
    for (const std::size_t n : { before(b), after(b) })
    {
      low_[b] += weight[n] * low[n];
      high_[b] += weight[n] * high[n];
      all += weight[n];
    }
    if (all > 0)
    {
      low_[b] /= all;
      high_[b] /= all;
      given[b] = 1;
    }
  }
}

void Stretch::apply(std::array<double, 2>& coordinates) const
{
  const double place = coordinates[1 - stretched_] * static_cast<double>(bins) - 0.5;
  const double floor = std::floor(place), t = place - floor;
  const std::size_t a = floor < 0 ? before(0) : std::min(bins - 1, static_cast<std::size_t>(floor));
  const std::size_t b = floor < 0 ? 0 : after(a);
  const double low = (1 - t) * low_[a] + t * low_[b], high = (1 - t) * high_[a] + t * high_[b];
  double& value = coordinates[stretched_];
  value = high > low ? std::min(1.0, std::max(0.0, (value - low) / (high - low))) : 0.5;
}

}  // namespace frontalis
