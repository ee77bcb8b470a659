#pragma once

#include "frontalis/model/model.hpp"
#include "solver/stepping/array_list.hpp"
#include "solver/cpu/point_kernel.hpp"

#include <algorithm>
#include <limits>
#include <vector>

namespace frontalis
{

/// Points of contact in blocks, for a kernel that finds their places beside their bodies. Without a kernel there are no
/// blocks.
template <class Real>
class ContactBlocks
{
public:
  using Vector = physics::Vec3<double>;
  using Block = PointBlock<Real>;

  explicit ContactBlocks(PointKernel<Real> kernel) : kernel_(kernel) {}

  bool present() const { return kernel_ != nullptr; }
  /// `points`: any type with the members voxel, body, coordinates and rest.
  template <class Point>
  void make(const Model& model, const std::vector<Point>& points)
  {
    constexpr std::size_t width = Block::width;
    blocks_.resize(present() ? (points.size() + width - 1) / width : 0);
    for (std::size_t p = 0; p < width * blocks_.size(); ++p)
    {
      const std::size_t lane = p % width;
      const Point& point = points[p < points.size() ? p : p - lane];
      Block& block = blocks_[p / width];
      for (std::size_t two = 0; two < 4; ++two)
        block.node[two][lane] = model.voxel_nodes[point.voxel][2 * two];
      const double rest[3] = { point.rest.x, point.rest.y, point.rest.z };
      for (std::size_t axis = 0; axis < 3; ++axis)
      {
        block.coordinates[axis][lane] = Real(point.coordinates[axis]);
        block.rest[axis][lane] = static_cast<Real>(rest[axis]);
        block.cell[axis][lane] = std::numeric_limits<Real>::quiet_NaN();
      }
      block.body[lane] = static_cast<Real>(point.body);
      block.first_body = lane == 0 ? point.body : std::min(block.first_body, point.body);
      block.last_body = lane == 0 ? point.body : std::max(block.last_body, point.body);
    }
  }

  static PosedBody<Real> posed(const RigidTransform& pose, const physics::DistanceField& field)
  {
    PosedBody<Real> body{};
    std::copy(pose.rotation.begin(), pose.rotation.end(), body.rotation);
    std::copy(pose.translation.begin(), pose.translation.end(), body.translation);
    std::copy(field.origin, field.origin + 3, body.origin);
    body.inverse_spacing = static_cast<Real>(1 / field.spacing);
    body.field = &field;
    return body;
  }

  /// Finds the places of points of a block (PointKernel).
  void find(std::size_t block, const Real* const u[3], const std::vector<PosedBody<Real>>& bodies, std::uint32_t wanted,
            PointPlaces<Real>& places)
  {
    kernel_(blocks_[block], u, bodies.data(), wanted, places);
  }
  /// Reads what find() found for a lane: the field and the position in the body's frame. Returns false if it found no
  /// samples.
  static bool read(const PointPlaces<Real>& places, std::size_t lane, const physics::DistanceField& field,
                   physics::FieldValue<double>& value, Vector& x)
  {
    if (!(places.distance[lane] > Real(0.5) * Block::none))
      return false;
    const auto vector = [lane](const Real(&from)[3][Block::width]) {
      return Vector{ double(from[0][lane]), double(from[1][lane]), double(from[2][lane]) };
    };
    value.value = double(places.distance[lane]);
    value.gradient = (1 / field.spacing) * vector(places.gradient);
    x = Vector{ field.origin[0], field.origin[1], field.origin[2] } + field.spacing * vector(places.offset);
    return true;
  }

  /// Finds the field of point p's body at x, in the frame of the body. Returns false where no samples are stored. The
  /// block keeps the samples for the next call.
  bool sample(const physics::DistanceField& field, std::size_t p, const Vector& x, physics::FieldValue<double>& value)
  {
    physics::FieldPoint<double> point = physics::field_point(field, x);
    if (blocks_.empty() || field.radius > 0)
      return physics::sample(field, point, value);
    Block& block = blocks_[p / Block::width];
    const std::size_t lane = p % Block::width;
    const double inverse_spacing = 1 / field.spacing;
    const Vector place = physics::enter_cell(inverse_spacing, point.offset, point.cell);
    const auto is_kept = [&](std::size_t axis)
    { return block.cell[axis][lane] == static_cast<Real>(point.cell[axis]); };
    if (!is_kept(0) || !is_kept(1) || !is_kept(2))
    {
      const float* const first = field.around(point.cell);
      for (int n = 0; n < 27; ++n)
        block.samples[n][lane] = static_cast<Real>(first == nullptr ? Block::none : physics::gather_one(first, n));
      for (std::size_t axis = 0; axis < 3; ++axis)
        block.cell[axis][lane] = static_cast<Real>(point.cell[axis]);
    }
    physics::FieldSamples samples;
    for (std::size_t n = 0; n < 27; ++n)
      samples.value[n] = static_cast<float>(block.samples[n][lane]);
    if (samples.value[0] == Block::none)
      return false;
    value = physics::spline(samples, inverse_spacing, place);
    return true;
  }

  void list_arrays(ArrayList& list) const { list.add(Effect::contact, "points", blocks_); }

private:
  PointKernel<Real> kernel_;
  std::vector<Block> blocks_;
};

}  // namespace frontalis
