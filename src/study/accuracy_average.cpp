#include "accuracy_average.hpp"

#include <cmath>

namespace frontalis
{

SkinAverage::SkinAverage(const VariantMotion& motion, double deviation) : weights_(motion.area.size())
{
  constexpr double reach = 3;  // deviations
  const auto& rest = motion.phases.at(0).vertices;
  const auto square = [&](std::size_t a, std::size_t b)
  {
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis)
      sum += std::pow(static_cast<double>(rest[a][axis]) - rest[b][axis], 2);
    return sum / (deviation * deviation);
  };
  for (std::size_t v = 0; v < weights_.size(); ++v)
  {
    float sum = 0;
    for (std::size_t other = 0; other < weights_.size(); ++other)
      if (const double s = square(v, other); s < reach * reach)
      {
        weights_[v].emplace_back(other, static_cast<float>(std::exp(-0.5 * s)) * motion.area[other]);
        sum += weights_[v].back().second;
      }
    for (auto& weight : weights_[v])
      weight.second = sum > 0 ? weight.second / sum : static_cast<float>(weight.first == v);
  }
}

VariantMotion SkinAverage::of(const VariantMotion& motion) const
{
  VariantMotion averaged = motion;
  const auto& rest = motion.phases[0].vertices;
  for (std::size_t p = 1; p < motion.phases.size(); ++p)
    for (std::size_t v = 0; v < weights_.size(); ++v)
    {
      auto place = rest[v];
      for (const auto& [other, weight] : weights_[v])
        for (int axis = 0; axis < 3; ++axis)
          place[axis] += weight * (motion.phases[p].vertices[other][axis] - rest[other][axis]);
      averaged.phases[p].vertices[v] = place;
    }
  return averaged;
}

}  // namespace frontalis
