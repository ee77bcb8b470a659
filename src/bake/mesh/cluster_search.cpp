#include "bake/mesh/cluster_search.hpp"

#include "bake/mesh/closest_on_triangle.hpp"

namespace frontalis
{
namespace
{

// relative, for rounding in double and in single precision
constexpr double margin = 1e-9;
constexpr float float_margin = 1e-5f;

}  // namespace

ClosestPoint ClusterSearch::closest(const Vector3d& p, double bound)
{
  const Vector3d from_centre = p - centre_;
  const double way = from_centre.norm();
  ClosestPoint best;
  best.distance = bound;
  double squared = bound >= 1e150 ? 1e300 : bound * bound;
  const auto ask = [&](std::int32_t index, double radius)
  {
    const auto& [a, b, c] = tree_->corners_[index];
    // a triangle is not nearer than its plane, nor than the disc in this plane in which it lies
    const Vector3d normal = (b - a).cross(c - a), away = p - (1.0 / 3) * (a + b + c);
    const double projected = away.dot(normal);
    const double height = (1 - margin) * projected * projected / normal.squaredNorm();
    const double beside = radius + std::sqrt(squared - height);
    if (height > squared || away.squaredNorm() - height > beside * beside)
      return;
    const std::int32_t triangle = tree_->order_[index];
    std::int8_t feature = 0;
    const Vector3d q = closest_on_triangle(p, a, b, c, feature);
    const double d = (q - p).squaredNorm();
    // as in TriangleTree::closest(): of triangles equally far the one with the lowest number
    if (d < squared || (d == squared && (best.triangle < 0 || triangle < best.triangle)))
    {
      squared = d;
      best = { q, std::sqrt(d), triangle, feature };
      latest_ = index;
    }
  };
  // the triangle of the latest point is probably near, so that most others need no closer look
  if (latest_ >= 0)
    ask(latest_, std::numeric_limits<double>::infinity());
  const auto x = static_cast<float>(from_centre[0]), y = static_cast<float>(from_centre[1]),
             z = static_cast<float>(from_centre[2]);
  for (const Group& group : groups_)
  {
    if (group.least - way > best.distance)
      break;
    const auto near = static_cast<float>(std::min(best.distance, 1e6)) * (1 + float_margin);
    std::array<bool, Group::size> meets{};
    for (std::size_t n = 0; n < Group::size; ++n)
    {
      const float dx = x - group.x[n], dy = y - group.y[n], dz = z - group.z[n], sum = near + group.radius[n];
      meets[n] = dx * dx + dy * dy + dz * dz <= sum * sum;
    }
    for (std::size_t n = 0; n < Group::size; ++n)
      if (meets[n])
        ask(group.index[n], double{ group.radius[n] });
  }
  // a triangle that is not kept is farther than reach_ from centre_
  if (best.distance + way < reach_)
    return best;
  best = tree_->closest(p, bound);
  gather(p, best.distance + extent_);
  return best;
}

void ClusterSearch::gather(const Vector3d& p, double reach)
{
  std::vector<std::pair<double, std::int32_t>> found;  // distance, index
  tree_->visit([&](std::size_t node) { return tree_->nodes_[node].box.squaredExteriorDistance(p) <= reach * reach; },
               [&](std::size_t i)
               {
                 const auto& [a, b, c] = tree_->corners_[i];
                 std::int8_t feature = 0;
                 const double distance = (closest_on_triangle(p, a, b, c, feature) - p).norm();
                 if (distance <= reach)
                   found.emplace_back(distance, static_cast<std::int32_t>(i));
                 return false;
               });
  std::sort(found.begin(), found.end());
  centre_ = p;
  reach_ = reach * (1 - margin);
  latest_ = found.empty() ? -1 : found.front().second;
  groups_.clear();
  for (std::size_t n = 0; n < found.size(); ++n)
  {
    const std::size_t at = n % Group::size;
    if (at == 0)
    {
      groups_.emplace_back();
      groups_.back().least = found[n].first - margin * reach;
      groups_.back().x.fill(std::numeric_limits<float>::quiet_NaN());
    }
    Group& group = groups_.back();
    const auto& [a, b, c] = tree_->corners_[found[n].second];
    const Vector3d middle = (1.0 / 3) * (a + b + c);
    const double radius =
        std::sqrt(std::max({ (a - middle).squaredNorm(), (b - middle).squaredNorm(), (c - middle).squaredNorm() }));
    group.x[at] = static_cast<float>(middle[0] - p[0]);
    group.y[at] = static_cast<float>(middle[1] - p[1]);
    group.z[at] = static_cast<float>(middle[2] - p[2]);
    group.radius[at] = static_cast<float>(radius) * (1 + float_margin);
    group.index[at] = found[n].second;
  }
}

}  // namespace frontalis
