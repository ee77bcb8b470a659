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

// Number of nodes that are processed together.
constexpr std::int32_t width = 8;

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

BoundNodeWay::BoundNodeWay(const Model& model, const Binding& points, Of of)
    : factor_(points.voxel.empty() ? 0 : model.nodes.size(), 0),
      plane_runs_(points.voxel.empty() ? 0 : static_cast<std::size_t>(model.size[2]) + 2, 0)
{
  std::vector<bool> bound(model.nodes.size(), false);
  for (std::size_t p = 0; p < points.voxel.size(); ++p)
  {
    spread_ = std::max(spread_, spread_at(points.coordinates[p]));
    const auto& at = points.coordinates[p];
    float weight[8], roots = 0;
    physics::trilinear_weights(at[0], at[1], at[2], weight);
    for (const float w : weight)
      roots += std::sqrt(std::abs(w));
    for (std::size_t corner = 0; corner < 8; ++corner)
    {
      const auto node = model.voxel_nodes[points.voxel[p]][corner];
      bound[node] = true;
      factor_[node] = of == Of::nodes ? 1 : std::max(factor_[node], std::abs(weight[corner]) * roots * roots);
    }
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
    // Whole groups of lanes are faster; nodes to which no point is bound have the factor 0.
    auto& [first, last] = runs_.back();
    last = std::max(last, first + (node - first + width) / width * width);
  }
  // A run must not reach into the next plane, which another thread may be changing.
  std::size_t end = 0;
  for (Run& run : runs_)
  {
    while (end < bound.size() && model.nodes[end][2] <= model.nodes[run.first][2])
      ++end;
    run.last = std::min(run.last, static_cast<std::int32_t>(end));
  }
  std::partial_sum(plane_runs_.begin(), plane_runs_.end(), plane_runs_.begin());
}

template <class Real>
double BoundNodeWay::in_plane(std::int32_t plane, const Real* const before[3], const Real* const after[3]) const
{
  // The largest squared lengths are kept in lanes, so that the compiler can vectorise the loop.
  Real longest[width] = {};
  const auto compare = [&](std::int32_t lane, std::int32_t n)
  {
    const Real x = after[0][n] - before[0][n], y = after[1][n] - before[1][n], z = after[2][n] - before[2][n];
    const Real squared = Real(factor_[n]) * (x * x + y * y + z * z);
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
  list.add(effect, "bound nodes", factor_);
  list.add(effect, "bound nodes", runs_);
  list.add(effect, "bound nodes", plane_runs_);
}

template double BoundNodeWay::in_plane(std::int32_t, const float* const[3], const float* const[3]) const;
template double BoundNodeWay::in_plane(std::int32_t, const double* const[3], const double* const[3]) const;

}  // namespace frontalis
