#include "solver/contact/bound_node_way.hpp"

#include "frontalis/physics/trilinear.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace frontalis
{
namespace
{

// Two runs of bound nodes are merged if at most this many other nodes are between them.
constexpr std::int32_t largest_gap = 8;

// Factor on distances found in single precision that outweighs their rounding errors.
constexpr double rounding = 1.00001;

}  // namespace

double spread_at(const std::array<float, 3>& coordinates)
{
  float weight[8], sum = 0;
  physics::trilinear_weights(coordinates[0], coordinates[1], coordinates[2], weight);
  for (const float w : weight)
    sum += std::abs(w);
  return std::max(1.0, double(sum));
}

BoundNodeWay::BoundNodeWay(const Model& model, const Binding& points)
    : plane_runs_(points.voxel.empty() ? 0 : static_cast<std::size_t>(model.size[2]) + 2, 0)
{
  std::vector<bool> bound(model.nodes.size(), false);
  for (std::size_t p = 0; p < points.voxel.size(); ++p)
  {
    spread_ = std::max(spread_, spread_at(points.coordinates[p]));
    for (const auto node : model.voxel_nodes[points.voxel[p]])
      bound[node] = true;
  }
  for (std::size_t n = 0; n < bound.size(); ++n)
  {
    const auto node = static_cast<std::int32_t>(n);
    if (!bound[n])
      continue;
    const auto plane = model.nodes[n][2];
    const bool goes_on =
        !runs_.empty() && node <= runs_.back().last + largest_gap && model.nodes[runs_.back().first][2] == plane;
    if (!goes_on)
    {
      runs_.push_back({ node, node });
      ++plane_runs_[plane + 1];
    }
    runs_.back().last = node + 1;
  }
  std::partial_sum(plane_runs_.begin(), plane_runs_.end(), plane_runs_.begin());
}

template <class Real>
double BoundNodeWay::in_plane(std::int32_t plane, const Real* const before[3], const Real* const after[3]) const
{
  // The largest squared lengths are kept in lanes, so that the compiler can vectorise the loop.
  constexpr std::int32_t width = 8;
  Real longest[width] = {};
  const auto compare = [&](std::int32_t lane, std::int32_t n)
  {
    const Real x = after[0][n] - before[0][n], y = after[1][n] - before[1][n], z = after[2][n] - before[2][n];
    const Real squared = x * x + y * y + z * z;
    longest[lane] = squared > longest[lane] ? squared : longest[lane];
  };
  for (auto run = plane_runs_[plane]; run < plane_runs_[plane + 1]; ++run)
  {
    const auto [begin, end] = runs_[run];
    std::int32_t n = begin;
    for (; n + width <= end; n += width)
      for (std::int32_t lane = 0; lane < width; ++lane)
        compare(lane, n + lane);
    for (; n < end; ++n)
      compare(0, n);
  }
  return rounding * std::sqrt(double(*std::max_element(longest, longest + width)));
}

void BoundNodeWay::list_arrays(ArrayList& list, Effect effect) const
{
  list.add(effect, "bound nodes", runs_);
  list.add(effect, "bound nodes", plane_runs_);
}

template double BoundNodeWay::in_plane(std::int32_t, const float* const[3], const float* const[3]) const;
template double BoundNodeWay::in_plane(std::int32_t, const double* const[3], const double* const[3]) const;

}  // namespace frontalis
