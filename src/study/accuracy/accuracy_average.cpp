#include "study/accuracy/accuracy_average.hpp"

#include <cmath>
#include <unordered_map>

namespace frontalis
{
namespace
{

using Point = std::array<float, 3>;

constexpr double reach = 3;  // standard deviations

// vertices sorted into cubes, to find neighbours
class Cubes
{
public:
  Cubes(const std::vector<Point>& points, double edge) : edge_(edge)
  {
    for (std::size_t v = 0; v < points.size(); ++v)
      members_[key(cube(points[v]))].push_back(v);
  }

  // visits the vertices in the cube of a point and in the 26 cubes around it
  template <class Visit>
  void visit_near(const Point& point, Visit&& visit) const
  {
    const auto middle = cube(point);
    for (int i = 0; i < 27; ++i)
    {
      const auto found =
          members_.find(key({ { middle[0] + i % 3 - 1, middle[1] + i / 3 % 3 - 1, middle[2] + i / 9 - 1 } }));
      if (found != members_.end())
        for (const std::size_t v : found->second)
          visit(v);
    }
  }

private:
  std::array<std::int64_t, 3> cube(const Point& p) const
  {
    const auto place = [this](float x) { return static_cast<std::int64_t>(std::floor(x / edge_)); };
    return { { place(p[0]), place(p[1]), place(p[2]) } };
  }
  // unique within half a million cubes of the origin
  static std::int64_t key(const std::array<std::int64_t, 3>& c)
  {
    constexpr std::int64_t stride = 1 << 20;
    return (c[2] * stride + c[1]) * stride + c[0];
  }

  double edge_;
  std::unordered_map<std::int64_t, std::vector<std::size_t>> members_;
};

}  // namespace

SkinAverage::SkinAverage(const VariantMotion& reference, double deviation) : weights_(reference.area.size())
{
  const auto& rest = reference.phases.at(0).vertices;
  const Cubes cubes(rest, reach * deviation);
  for (std::size_t v = 0; v < weights_.size(); ++v)
  {
    float sum = 0;
    cubes.visit_near(rest[v],
                     [&](std::size_t other)
                     {
                       double square = 0;
                       for (int axis = 0; axis < 3; ++axis)
                       {
                         const double d = (static_cast<double>(rest[v][axis]) - rest[other][axis]) / deviation;
                         square += d * d;
                       }
                       if (square > reach * reach)
                         return;
                       weights_[v].emplace_back(other,
                                                static_cast<float>(std::exp(-0.5 * square)) * reference.area[other]);
                       sum += weights_[v].back().second;
                     });
    for (auto& weight : weights_[v])
      weight.second = sum > 0 ? weight.second / sum : static_cast<float>(weight.first == v);
  }
  reference_ = of(reference);
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

SkinError SkinAverage::error(const VariantMotion& motion) const { return worst(skin_errors(of(motion), reference_)); }

}  // namespace frontalis
