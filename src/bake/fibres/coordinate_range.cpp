#include "bake/fibres/grid_field.hpp"

#include <numeric>

namespace frontalis
{
namespace
{

constexpr std::size_t bins = 32;

std::size_t before(std::size_t b, bool closed) { return b > 0 ? b - 1 : (closed ? bins - 1 : 0); }
std::size_t after(std::size_t b, bool closed) { return b + 1 < bins ? b + 1 : (closed ? 0 : b); }

/// Lower and upper limit of one coordinate on the muscle's surface, for each of `bins` intervals of the other.
struct Limits
{
  std::array<double, bins> low{}, high{}, given{};  ///< given: 1 if the bin has limits, else 0

  Limits(const MuscleGrid& grid, const std::vector<std::array<double, 2>>& samples, std::size_t stretched, double ends)
  {
    std::array<std::vector<std::pair<double, double>>, bins> values;  // value, area
    for (std::size_t s = 0; s < samples.size(); ++s)
    {
      const double place = std::max(0.0, samples[s][1 - stretched]) * static_cast<double>(bins);
      if (grid.samples[s].cell >= 0)
        values[std::min(bins - 1, static_cast<std::size_t>(place))].emplace_back(samples[s][stretched],
                                                                                 grid.samples[s].area);
    }
    // Fraction of a bin's area beyond each limit. It keeps single outliers from determining the limits.
    constexpr double outermost = 0.005;
    for (std::size_t b = 0; b < bins; ++b)
    {
      std::sort(values[b].begin(), values[b].end());
      double all = 0, sum = 0;
      for (const auto& entry : values[b])
        all += entry.second;
      if (!(all > 0))
        continue;
      given[b] = 1;
      low[b] = high[b] = values[b].back().first;
      for (const auto& [value, area] : values[b])
      {
        if (sum < outermost * all)
          low[b] = value;
        if (sum < (1 - outermost) * all)
          high[b] = value;
        sum += area;
      }
    }
    const auto first = static_cast<std::size_t>(ends * static_cast<double>(bins));
    for (auto* list : { &low, &high, &given })
    {
      std::fill_n(list->begin(), first, (*list)[first]);
      std::fill_n(list->rbegin(), first, (*list)[bins - 1 - first]);
    }
  }

  /// Averages limits over neighbouring bins, with weights 1, 2, 1, and fills empty bins.
  void smooth(bool closed)
  {
    const Limits old = *this;
    for (std::size_t b = 0; b < bins; ++b)
    {
      double all = 2 * old.given[b];
      low[b] *= all;
      high[b] *= all;
      for (const std::size_t n : { before(b, closed), after(b, closed) })
      {
        low[b] += old.given[n] * old.low[n];
        high[b] += old.given[n] * old.high[n];
        all += old.given[n];
      }
      if (!(all > 0))
        continue;
      low[b] /= all;
      high[b] /= all;
      given[b] = 1;
    }
  }

  /// Maps a value of the coordinate from its limits to 0..1, where the other coordinate has the value `across`.
  double stretched(double value, double across, bool closed) const
  {
    const double place = across * static_cast<double>(bins) - 0.5;
    const double floor = std::floor(place), t = place - floor;
    const std::size_t a = floor < 0 ? before(0, closed) : std::min(bins - 1, static_cast<std::size_t>(floor));
    const std::size_t b = floor < 0 ? 0 : after(a, closed);
    const double lower = (1 - t) * low[a] + t * low[b], upper = (1 - t) * high[a] + t * high[b];
    return upper > lower ? std::min(1.0, std::max(0.0, (value - lower) / (upper - lower))) : 0.5;
  }
};

}  // namespace

DistanceTable::DistanceTable(const MuscleGrid& grid, const CornerField& field, bool periodic)
{
  std::vector<std::pair<double, double>> cells;  // value, norm of the gradient [1/m]
  double low = periodic ? 0 : 1e300, high = periodic ? 1 : -1e300;
  for (const auto& corners : field)
  {
    const double value = std::accumulate(corners.begin(), corners.end(), 0.0) / 8;
    cells.emplace_back(periodic ? value - std::floor(value) : value, gradient(grid, corners).norm());
    low = std::min(low, cells.back().first);
    high = std::max(high, cells.back().first);
  }
  std::sort(cells.begin(), cells.end());
  const std::size_t intervals = std::min<std::size_t>(64, std::max<std::size_t>(1, cells.size() / 20));
  values_.push_back(low);
  distances_.push_back(0);
  for (std::size_t b = 0; b < intervals; ++b)
  {
    const std::size_t begin = b * cells.size() / intervals, end = (b + 1) * cells.size() / intervals;
    double steepness = 0;
    for (std::size_t c = begin; c < end; ++c)
      steepness += cells[c].second / static_cast<double>(end - begin);
    const double value = b + 1 < intervals ? cells[end].first : high;
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

void stretch(const MuscleGrid& grid, std::size_t stretched, bool closed, double ends, FibreCoordinates& coordinates)
{
  Limits limits(grid, coordinates.samples, stretched, ends);
  for (int repetition = 0; repetition < 4; ++repetition)
    limits.smooth(closed);
  for (auto* points : { &coordinates.cells, &coordinates.samples })
    for (auto& point : *points)
      if (!std::isnan(point[0]))
        point[stretched] = limits.stretched(point[stretched], point[1 - stretched], closed);
}

}  // namespace frontalis
