#include "bake/mesh/cluster_search.hpp"

#include "bake/mesh/closest_on_triangle.hpp"

namespace frontalis
{
namespace
{

// Relative margins above the rounding errors of double and of single precision.
constexpr double margin = 1e-9;
constexpr double float_margin = 1e-5;
// Making a list of the triangles near a cube saves time only if many points lie in the cube. The list is made after
// `alone` points in it. After `few_points` points, if the list has more than `few_groups` groups, lists are made for
// the eighths of the cube in which points lie.
constexpr int alone = 4, few_points = 16;
constexpr std::size_t few_groups = 8;

/// Radius of the ball around a cube.
double radius_of(double half) { return std::sqrt(3.0) * half * (1 + margin); }

}  // namespace

ClosestPoint ClusterSearch::closest(const Vector3d& p, double bound)
{
  if (cubes_.empty() || (p - cubes_[0].centre).cwiseAbs().maxCoeff() > cubes_[0].half)
    return begin(p, bound);
  if (++asked_ < alone)
    return tree_->closest(p, bound, first_.triangle);
  if (asked_ == alone)
    gather();
  if (bound + (p - cubes_[0].centre).norm() > reach_)
    return begin(p, bound);
  std::size_t cube = 0;
  if (asked_ > few_points && cubes_[0].end > few_groups)
  {
    std::size_t eighth = 0;
    for (Eigen::Index a = 0; a < 3; ++a)
      eighth |= (p[a] > cubes_[0].centre[a] ? std::size_t{ 1 } : 0) << a;
    if (eighths_[eighth] == 0)
      divide(eighth);
    cube = eighths_[eighth];
  }

  ClosestPoint best;
  best.distance = bound;
  double squared = bound >= 1e150 ? 1e300 : bound * bound;
  const auto ask = [&](std::int32_t index)
  {
    const auto& [a, b, c] = tree_->corners_[index];
    const std::int32_t triangle = tree_->order_[index];
    std::int8_t feature = 0;
    const Vector3d q = closest_on_triangle(p, a, b, c, feature);
    const double d = (q - p).squaredNorm();
    // of triangles that are equally far, take the one with the lowest number, as TriangleTree::closest() does
    if (d < squared || (d == squared && (best.triangle < 0 || triangle < best.triangle)))
    {
      squared = d;
      best = { q, std::sqrt(d), triangle, feature };
      latest_ = index;
    }
  };
  // the triangle found last is probably near; with its distance as limit, few others need a closer look
  if (latest_ >= 0)
    ask(latest_);
  const Eigen::Array3f at = (p - cubes_[cube].centre).cast<float>();
  for (std::size_t g = cubes_[cube].begin; g < cubes_[cube].end; ++g)
  {
    const Group& group = groups_[g];
    const auto limit = static_cast<float>(std::min(best.distance, 1e6));
    const Eigen::Array4f farther =
        group.distance + group.away[0] * at[0] + group.away[1] * at[1] + group.away[2] * at[2] - limit;
    for (std::size_t n = 0; n < 4; ++n)
      if (farther[static_cast<Eigen::Index>(n)] <= 0)
        ask(group.index[n]);
  }
  return best;
}

ClosestPoint ClusterSearch::begin(const Vector3d& p, double bound)
{
  cubes_.assign(1, Cube());
  cubes_[0].centre = p;
  cubes_[0].half = 0.5 * extent_;
  asked_ = 0;
  eighths_.fill(0);
  return first_ = tree_->closest(p, bound, first_.triangle);
}

void ClusterSearch::gather()
{
  const Vector3d p = cubes_[0].centre;
  const double reach = first_.distance + 2 * radius_of(cubes_[0].half);
  tree_->visit([&](std::size_t node) { return tree_->nodes_[node].box.squaredExteriorDistance(p) <= reach * reach; },
               [&](std::size_t i)
               {
                 add(p, static_cast<std::int32_t>(i));
                 return false;
               });
  latest_ = -1;
  groups_.clear();
  add_groups(cubes_[0]);
  // If the first point has no triangle within its bound, triangles beyond `reach` are missing. Otherwise no missing
  // triangle is the closest to a point of the cube.
  reach_ = first_.triangle < 0 ? reach * (1 - margin) : std::numeric_limits<double>::infinity();
}

void ClusterSearch::divide(std::size_t eighth)
{
  Cube part;
  part.half = 0.5 * cubes_[0].half;
  for (Eigen::Index a = 0; a < 3; ++a)
    part.centre[a] = cubes_[0].centre[a] + ((eighth >> a & 1U) != 0 ? part.half : -part.half);
  for (std::size_t g = 0; g < cubes_[0].end; ++g)
    for (const std::int32_t index : groups_[g].index)
      if (index >= 0)
        add(part.centre, index);
  add_groups(part);
  eighths_[eighth] = cubes_.size();
  cubes_.push_back(part);
}

void ClusterSearch::add(const Vector3d& centre, std::int32_t index)
{
  const auto& [a, b, c] = tree_->corners_[index];
  std::int8_t feature = 0;
  const Vector3d away = centre - closest_on_triangle(centre, a, b, c, feature);
  near_.push_back({ index, away.norm(), away });
}

/// Groups the added triangles that can be the closest to a point of the cube.
void ClusterSearch::add_groups(Cube& cube)
{
  const double radius = radius_of(cube.half);
  Near nearest{ -1, std::numeric_limits<double>::infinity(), Vector3d::Zero() };
  for (Near& near : near_)
  {
    // rounding errors spoil the direction of a very short vector
    near.away *= near.distance > 1e-3 * radius ? 1 / near.distance : 0;
    if (near.distance < nearest.distance)
      nearest = near;
  }
  // Let x be the vector from the cube's centre to a point of the cube, |x| <= radius. Let d be the distance of the
  // nearest triangle T from the centre, and t the unit vector from T to the centre; e and a are those of another
  // triangle. The distance of the point from T is at most |d t + x|, which exceeds d + t . x by at most `bend`. Its
  // distance from the other triangle is at least e + a . x. T is therefore nearer to all points of the cube if e > d +
  // bend + |t - a| radius.
  const double d = nearest.distance, bend = d > 0.5 * radius ? 0.5 * radius * radius / d : 2 * (radius - d);
  cube.begin = groups_.size();
  std::size_t used = 4;
  for (const Near& near : near_)
  {
    const bool directed = !nearest.away.isZero(0) && !near.away.isZero(0);
    const double turn = directed ? bend + (nearest.away - near.away).norm() * radius : 2 * radius;
    if (near.distance > (d + std::min(turn, 2 * radius)) * (1 + margin))
      continue;
    if (used == 4)
    {
      Group group;
      group.distance = std::numeric_limits<float>::infinity();
      group.away.fill(Eigen::Array4f::Zero());
      group.index.fill(-1);
      groups_.push_back(group);
      used = 0;
    }
    Group& group = groups_.back();
    const double rounding = float_margin * (near.distance + radius);
    const auto at = static_cast<Eigen::Index>(used);
    group.distance[at] = near.away.isZero(0) ? -1 : static_cast<float>(near.distance - rounding);
    for (std::size_t a = 0; a < 3; ++a)
      group.away[a][at] = static_cast<float>(near.away[static_cast<Eigen::Index>(a)]);
    group.index[used++] = near.index;
  }
  cube.end = groups_.size();
  near_.clear();
}

}  // namespace frontalis
