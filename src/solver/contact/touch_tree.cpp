#include "solver/contact/touch_tree.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

namespace frontalis
{
namespace
{

using Point = std::array<double, 6>;
using Vector = physics::Vec3<double>;

// A vertex is not near if the cosine between its normal and that of corner 0 is above this value. Both may turn a
// little between place() and near().
constexpr double same_way = touch_search::same_way + 0.1;

// Rounding errors of angles, by which cones are narrower than they could be.
constexpr double least_angle = 1e-3;

// Change of barycentric coordinates between place() and near() that is allowed for.
constexpr double slip = touch_search::margin - 1;

// If the cosine between the normals of a triangle's plane and a corner is below this value, vertices beyond its edges
// are near, too.
constexpr double least_cosine = 0.3;

// Larger than any barycentric coordinate.
constexpr double anywhere = 1e6;

Vector centre_of(const physics::SurfaceTriangle<double>& at)
{
  return (1.0 / 3) * (at.corner[0] + at.corner[1] + at.corner[2]);
}

// Sorts a range of triangles so that each series of `touch_width`, of touch_width^2, ... from its begin are close
// together: divides the range across its longest extent.
void divide(const std::vector<Point>& points, std::int32_t* begin, std::int32_t* end)
{
  const std::ptrdiff_t count = end - begin;
  if (count <= touch_width)
    return;
  std::ptrdiff_t block = touch_width;
  while (block * touch_width < count)
    block *= touch_width;
  const std::ptrdiff_t half = (count + block - 1) / block / 2 * block;
  std::size_t longest = 0;
  double extent = -1;
  for (std::size_t axis = 0; axis < 6; ++axis)
  {
    const auto [low, high] = std::minmax_element(
        begin, end, [&](std::int32_t a, std::int32_t b) { return points[a][axis] < points[b][axis]; });
    if (const double length = points[*high][axis] - points[*low][axis]; length > extent)
    {
      extent = length;
      longest = axis;
    }
  }
  std::nth_element(begin, begin + half, end,
                   [&](std::int32_t a, std::int32_t b) {
                     return points[a][longest] != points[b][longest] ? points[a][longest] < points[b][longest] : a < b;
                   });
  divide(points, begin, begin + half);
  divide(points, begin + half, end);
}

}  // namespace

template <class Real>
void TouchTree<Real>::make(const std::vector<Triangle>& at_rest, const std::vector<Corners>& corners, double span)
{
  std::vector<Point> points;
  for (const Triangle& t : at_rest)
  {
    const Vector c = centre_of(t.at), n = span * t.at.normal[0];
    points.push_back({ c.x, c.y, c.z, n.x, n.y, n.z });
  }
  order_.resize(at_rest.size());
  std::iota(order_.begin(), order_.end(), 0);
  divide(points, order_.data(), order_.data() + order_.size());
  std::size_t blocks = 0, lanes = order_.size();
  levels_.clear();
  while (lanes > 1 || (lanes == 1 && blocks == 0))
  {
    levels_.push_back(blocks);
    lanes = (lanes + touch_width - 1) / touch_width;
    blocks += lanes;
  }
  balls_.resize(blocks);
  facets_.resize((order_.size() + touch_width - 1) / touch_width);
  vertices_.clear();
  begin_.assign(1, 0);
  for (std::size_t first = 0; first < order_.size(); first += touch_width)
  {
    std::set<std::int32_t> block;
    for (std::size_t n = first; n < std::min(first + touch_width, order_.size()); ++n)
      block.insert(corners[order_[n]].begin(), corners[order_[n]].end());
    vertices_.insert(vertices_.end(), block.begin(), block.end());
    begin_.push_back(vertices_.size());
  }
  corners_.clear();
  for (const auto t : order_)
    corners_.push_back(corners[t]);
  // The empty lanes remain as they are made here.
  GroupBoxes<Real> none;
  for (auto* const box : { &none.place, &none.way })
  {
    std::fill_n(box->least[0], 3 * touch_width, Real(1e3));
    std::fill_n(box->most[0], 3 * touch_width, Real(-1e3));
  }
  blocks_.assign((facets_.size() + touch_width - 1) / touch_width, none);
  triangles_.assign(facets_.size(), none);
  boxed_.assign(facets_.size(), 0);
  reset();
}

template <class Real>
void TouchTree<Real>::reset()
{
  std::fill(balls_.begin(), balls_.end(), BallBlock<Real>{});  // nothing is near balls of radius 0
  std::fill(facets_.begin(), facets_.end(), FacetBlock<Real>{});
  placed_.assign(1, {});
}

template <class Real>
void TouchTree<Real>::list_arrays(ArrayList& list, Effect effect)
{
  list.add(effect, "tree", order_);
  list.add(effect, "tree", vertices_);
  list.add(effect, "tree", begin_);
  list.add(effect, "tree", corners_);
  list.add(effect, "tree", blocks_);
  list.add(effect, "tree", triangles_);
  list.add(effect, "tree", boxed_);
  list.add_state(effect, "tree", balls_);
  list.add_state(effect, "tree", facets_);
  list.add_state(effect, "tree", placed_);
}

template <class Real>
void TouchTree<Real>::place_triangle(std::size_t n, const Triangle& triangle)
{
  const auto& [corner, normal] = triangle.at;
  const Vector centre = centre_of(triangle.at);
  const double radius = std::max({ norm(corner[0] - centre), norm(corner[1] - centre), norm(corner[2] - centre) });
  const double farthest = placed_[0].reach + touch_search::margin * radius;
  placed_[0].largest = std::max(placed_[0].largest, farthest);
  set_ball(n, centre, farthest, normal[0]);
  const Vector ab = corner[1] - corner[0], ac = corner[2] - corner[0], area = cross(ab, ac);
  const double squared = std::max(dot(area, area), 1e-30);
  const Vector facet = (1 / std::sqrt(squared)) * area;
  const Vector slope[2] = { (1 / squared) * cross(ac, area), (1 / squared) * cross(area, ab) };
  // The way from a foot to its vertex is along a mean of the corners' normals. The vertex is thus not farther beyond
  // the foot, seen along the facet's normal, than its height above the facet times the largest tangent.
  const double cosine = std::min({ dot(facet, normal[0]), dot(facet, normal[1]), dot(facet, normal[2]) });
  const bool limited = !triangle.rim && cosine > least_cosine;
  const double tangent = limited ? std::sqrt(std::max(1 - cosine * cosine, 0.0)) / cosine : 0;
  FacetBlock<Real>& block = facets_[n / touch_width];
  const std::size_t lane = n % touch_width;
  const auto store = [&](const Vector& v, Real(&to)[3][touch_width])
  {
    to[0][lane] = static_cast<Real>(v.x);
    to[1][lane] = static_cast<Real>(v.y);
    to[2][lane] = static_cast<Real>(v.z);
  };
  store(facet, block.normal);
  store(slope[0], block.slope[0]);
  store(slope[1], block.slope[1]);
  store(tangent * Vector{ norm(slope[0] + slope[1]), norm(slope[0]), norm(slope[1]) }, block.lean);
  block.beyond[lane] = static_cast<Real>(limited ? touch_search::foot_error + slip : anywhere);
  // The surface that belongs to the normals bulges above the facet by at most the product of radius and sine.
  const double bulge = std::sqrt(std::max(1 - cosine * cosine, 0.0)) * radius;
  block.highest[lane] = static_cast<Real>(limited ? placed_[0].reach + touch_search::margin * bulge : anywhere);
}

// `normal`: a vertex is not near if the component of its normal along this one is above `same_way`.
template <class Real>
void TouchTree<Real>::set_ball(std::size_t ball, const Vector& centre, double farthest, const Vector& normal)
{
  BallBlock<Real>& block = balls_[ball / touch_width];
  const std::size_t lane = ball % touch_width;
  const double at[3] = { centre.x, centre.y, centre.z };
  const Vector facing = (1 / same_way) * normal;
  const double away[3] = { facing.x, facing.y, facing.z };
  // A ball whose coordinates are not finite must not hide the other balls of its block.
  const bool finite = std::isfinite(centre.x + centre.y + centre.z + farthest);
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    block.centre[axis][lane] = finite ? static_cast<Real>(at[axis]) : 0;
    block.away[axis][lane] = static_cast<Real>(away[axis]);
  }
  block.farthest[lane] = finite ? static_cast<Real>(farthest * farthest) : 0;
}

// Sets the balls of the levels above the triangles. Their normals are the axes of cones: a vertex that points the same
// way as such a cone points the same way as all triangles.
template <class Real>
void TouchTree<Real>::place_blocks()
{
  constexpr double infinity = std::numeric_limits<double>::infinity(), rounding = 1 + 1e-5;
  const auto in_lane = [](const Real(&v)[3][touch_width], int lane) {
    return Vector{ double(v[0][lane]), double(v[1][lane]), double(v[2][lane]) };
  };
  for (std::size_t level = 1; level < levels_.size(); ++level)
    for (std::size_t b = levels_[level - 1]; b < levels_[level]; ++b)
    {
      const BallBlock<Real>& block = balls_[b];
      Vector least{ infinity, infinity, infinity }, most = -1.0 * least, axis{ 0, 0, 0 };
      for (int lane = 0; lane < touch_width; ++lane)
        if (block.farthest[lane] > 0)
        {
          const Vector c = in_lane(block.centre, lane);
          least = { std::min(least.x, c.x), std::min(least.y, c.y), std::min(least.z, c.z) };
          most = { std::max(most.x, c.x), std::max(most.y, c.y), std::max(most.z, c.z) };
          axis = axis + in_lane(block.away, lane);
        }
      const Vector middle = 0.5 * (least + most);
      axis = (1 / std::max(norm(axis), 1e-30)) * axis;
      double farthest = 0, angle = infinity;
      for (int lane = 0; lane < touch_width; ++lane)
        if (block.farthest[lane] > 0)
        {
          farthest =
              std::max(farthest, norm(in_lane(block.centre, lane) - middle) + std::sqrt(double(block.farthest[lane])));
          const Vector away = in_lane(block.away, lane);
          const double length = std::max(norm(away), 1.0);
          angle = std::min(angle, std::acos(1 / length) - std::acos(std::min(dot(axis, away) / length, 1.0)));
        }
      const bool points = angle > least_angle && angle < infinity;
      const Vector cone = (points ? same_way / std::cos(angle - least_angle) : 0) * axis;
      set_ball(levels_[level] * touch_width + (b - levels_[level - 1]), middle, rounding * farthest, cone);
    }
}

template class TouchTree<float>;
template class TouchTree<double>;

}  // namespace frontalis
