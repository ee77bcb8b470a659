// The functions of RestrictedNodes that find the tangent planes of sliding nodes and move them with bones.

#include "frontalis/physics/element/sliding_node.hpp"
#include "solver/contact/bone_pose.hpp"
#include "solver/cpu/prefetch.hpp"
#include "solver/stepping/restricted_nodes.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <type_traits>
#include <utility>

namespace frontalis
{
namespace
{

using Point = physics::Vec3<double>;
using Bend = physics::SymmetricMatrix<double>;

template <class Array>
void put(const Point& p, Array& components, int lane)
{
  using Real = std::decay_t<decltype(components[0][0])>;
  components[0][lane] = static_cast<Real>(p.x);
  components[1][lane] = static_cast<Real>(p.y);
  components[2][lane] = static_cast<Real>(p.z);
}

template <class Real>
void put(const Bend& bend, Real (&components)[6][RoughBlock<Real>::width], int lane)
{
  const double all[6] = { bend.xx, bend.yy, bend.zz, bend.xy, bend.xz, bend.yz };
  for (int i = 0; i < 6; ++i)
    components[i][lane] = static_cast<Real>(all[i]);
}

// The matrix in the scene's frame.
Bend turned(const physics::Pose& pose, const Bend& bend)
{
  const auto row = [&](const Point& axis) { return pose.turned(bend * pose.turned_back(axis)); };
  const Point x = row({ 1, 0, 0 }), y = row({ 0, 1, 0 }), z = row({ 0, 0, 1 });
  return { x.x, y.y, z.z, x.y, x.z, y.z };
}

template <class Real>
void set(SlidingBlock<Real>& block, int lane, const Point& normal, double offset, const Point& reference, double speed)
{
  put(normal, block.normal, lane);
  put(reference, block.reference, lane);
  block.offset[lane] = static_cast<Real>(offset);
  block.speed[lane] = static_cast<Real>(speed);
}

}  // namespace

// Moves the tangent planes of nodes that slide on a bone with the bone. A plane that was found at one pose of the bone
// is valid at the others, because it is stored in the frame of the bone.
template <class Real>
void RestrictedNodes<Real>::carry(Carrier& carrier, const Real* const u[3], const ConstraintStep& step)
{
  const RigidTransform& now = step.bone[carrier.bone];
  const std::int64_t moves = now == step.bone_before[carrier.bone] ? 0 : 1;
  if (moves + carrier.moves == 0 && now == carrier.pose)
    return;
  const physics::Pose pose = pose_of(now), before = pose_of(step.bone_before[carrier.bone]);
  Block& b = contacts_.blocks[carrier.block];
  for (int lane = 0; lane < Block::width; ++lane)
  {
    const std::int32_t index = block_sliding_[carrier.block][lane], n = block_node_[carrier.block] + lane;
    if (index < 0 || sliding_[index].bone != carrier.bone || b.slip_squared[lane] < 0)
      continue;
    const Sliding& s = sliding_[index];
    const Carried& plane = contacts_.carried[s.carried];
    const Point normal = pose.turned(plane.normal), shift{ pose.t[0], pose.t[1], pose.t[2] };
    const Point place = s.rest + Point{ u[0][n], u[1][n], u[2][n] };
    const Point reference = pose.outwards(plane.found_at) - s.rest;
    const Point velocity = physics::surface_velocity(pose, before, 1 / step.dt, pose.inwards(place));
    set(b, lane, normal, plane.height + dot(normal, shift - s.rest), reference, dot(normal, velocity));
    if (contacts_.rough.empty())
      continue;
    RoughBlock<Real>& rough = contacts_.rough[carrier.block];
    const Point outward{ rough.outward[0][lane], rough.outward[1][lane], rough.outward[2][lane] };
    put(pose.turned(before.turned_back(outward)), rough.outward, lane);
    put(velocity, rough.surface_velocity, lane);
    put(turned(pose, plane.bend), rough.bend, lane);
  }
  carrier.pose = now;
  carrier.moves = moves;
}

// Finds new planes for the nodes of blocks that have left the range of theirs, sixteen at a time.
template <class Real>
void RestrictedNodes<Real>::renew(const WaitingBlock* waiting, std::int32_t count, Real* const u[3], Real* const v[3],
                                  const ConstraintStep& step)
{
  Renewal renewals[PlaneBatch::width];
  int filled = 0;
  for (std::int32_t i = 0; i < count; ++i)
    for (std::uint32_t lanes = waiting[i].lanes; lanes != 0; lanes &= lanes - 1)
    {
      const int lane = __builtin_ctz(lanes);
      const std::int32_t block = waiting[i].block, index = block_sliding_[block][lane];
      // A node that does not slide waits if its displacement is infinite.
      if (index < 0)
        continue;
      prefetch(&sliding_[index]);
      renewals[filled++] = { block, lane, index, {} };
      if (filled == PlaneBatch::width)
        renew_batch(renewals, std::exchange(filled, 0), u, v, step);
    }
  renew_batch(renewals, filled, u, v, step);
}

// Each loop needs data that the loop before it has begun to fetch.
template <class Real>
void RestrictedNodes<Real>::renew_batch(Renewal* renewals, int count, Real* const u[3], Real* const v[3],
                                        const ConstraintStep& step)
{
  constexpr int width = PlaneBatch::width;
  PlaneBatch batch{};
  std::int32_t cell[width][3];
  int filled = 0;
  for (int l = 0; l < count; ++l)
  {
    Renewal renewal = renewals[l];
    const Sliding& s = sliding_[renewal.index];
    const std::int32_t n = block_node_[renewal.block] + renewal.lane;
    const Point at = s.rest + Point{ u[0][n], u[1][n], u[2][n] };
    renewal.place = s.bone < 0 ? at : pose_of(step.bone[s.bone]).inwards(at);
    const physics::DistanceField& field = *s.level.field;
    if (kernels_.planes == nullptr || field.radius > 0)
    {
      if (physics::LevelPlane<double> plane{}; s.level.plane_at(renewal.place, plane))
        take(renewal, plane, u, v, step);
      else
        flatten(renewal, u, v, step);
      continue;
    }
    auto point = physics::field_point(field, renewal.place);
    const double inverse_spacing = 1 / field.spacing;
    const Point place = physics::enter_cell(inverse_spacing, point.offset, point.cell);
    std::copy(point.cell, point.cell + 3, cell[filled]);
    batch.place[0][filled] = static_cast<float>(place.x);
    batch.place[1][filled] = static_cast<float>(place.y);
    batch.place[2][filled] = static_cast<float>(place.z);
    batch.inverse_spacing[filled] = static_cast<float>(inverse_spacing);
    batch.level[filled] = static_cast<float>(s.level.level);
    renewals[filled++] = renewal;
  }
  bool sampled[width] = {};
  const float* some = nullptr;
  for (int l = 0; l < filled; ++l)
  {
    batch.first[l] = sliding_[renewals[l].index].level.field->around(cell[l]);
    prefetch_samples(batch.first[l]);
    sampled[l] = batch.first[l] != nullptr;
    some = sampled[l] ? batch.first[l] : some;
  }
  // Lanes without samples take those of another, and the result is not used.
  for (int l = 0; l < width; ++l)
    batch.first[l] = sampled[l] ? batch.first[l] : some;
  if (some != nullptr)
    kernels_.planes(batch);
  for (int l = 0; l < filled; ++l)
    if (sampled[l] && batch.slope[l] > static_cast<float>(physics::least_gradient))
      take(renewals[l],
           { { double(batch.normal[0][l]), double(batch.normal[1][l]), double(batch.normal[2][l]) },
             double(batch.distance[l]),
             double(batch.slip[l]),
             { double(batch.bend[0][l]), double(batch.bend[1][l]), double(batch.bend[2][l]), double(batch.bend[3][l]),
               double(batch.bend[4][l]), double(batch.bend[5][l]) } },
           u, v, step);
    else
      flatten(renewals[l], u, v, step);
}

// Where no new plane can be found, a node keeps its latest one. One that turned with its level set does so no more.
template <class Real>
void RestrictedNodes<Real>::flatten(const Renewal& renewal, Real* const u[3], Real* const v[3],
                                    const ConstraintStep& step)
{
  const int lane = renewal.lane;
  const Block& b = contacts_.blocks[renewal.block];
  if (contacts_.rough.empty() || b.slip_squared[lane] < 0)
    return;
  const RoughBlock<Real>& rough = contacts_.rough[renewal.block];
  const std::int32_t bone = sliding_[renewal.index].bone, n = block_node_[renewal.block] + lane;
  const bool turns =
      std::any_of(std::begin(rough.bend), std::end(rough.bend), [&](const auto& of) { return of[lane] != 0; });
  if (!turns || !std::isfinite(u[0][n] + u[1][n] + u[2][n]))
    return;
  const physics::CurvedLevel<double> level{ { b.normal[0][lane], b.normal[1][lane], b.normal[2][lane] },
                                            b.offset[lane],
                                            { b.reference[0][lane], b.reference[1][lane], b.reference[2][lane] },
                                            { rough.bend[0][lane], rough.bend[1][lane], rough.bend[2][lane],
                                              rough.bend[3][lane], rough.bend[4][lane], rough.bend[5][lane] },
                                            { 0, 0, 0 } };
  physics::LevelPlane<double> plane{};
  level.at({ u[0][n], u[1][n], u[2][n] }, plane.normal, plane.distance);
  if (bone >= 0)
    plane.normal = pose_of(step.bone[bone]).turned_back(plane.normal);
  take(renewal, plane, u, v, step);
}

// Gives a node a new plane. Without friction its velocity is turned with the plane; physics::glide() does so in each
// step.
template <class Real>
void RestrictedNodes<Real>::take(const Renewal& renewal, const physics::LevelPlane<double>& plane, Real* const u[3],
                                 Real* const v[3], const ConstraintStep& step)
{
  const int lane = renewal.lane;
  const std::int32_t n = block_node_[renewal.block] + lane;
  const Sliding& s = sliding_[renewal.index];
  Block& b = contacts_.blocks[renewal.block];
  const physics::Pose pose = s.bone < 0 ? physics::Pose() : pose_of(step.bone[s.bone]);
  Point surface_velocity{ 0, 0, 0 };
  if (s.bone >= 0)
  {
    const physics::Pose before = pose_of(step.bone_before[s.bone]);
    surface_velocity = physics::surface_velocity(pose, before, 1 / step.dt, renewal.place);
    contacts_.carried[s.carried] = { plane.normal, dot(plane.normal, renewal.place) - plane.distance, renewal.place,
                                     plane.bend };
  }
  const Point normal = pose.turned(plane.normal), moved{ u[0][n], u[1][n], u[2][n] };
  if (contacts_.rough.empty())
  {
    const Point velocity =
        surface_velocity + physics::turned_with_normal({ b.normal[0][lane], b.normal[1][lane], b.normal[2][lane] },
                                                       normal, Point{ v[0][n], v[1][n], v[2][n] } - surface_velocity);
    v[0][n] = static_cast<Real>(velocity.x);
    v[1][n] = static_cast<Real>(velocity.y);
    v[2][n] = static_cast<Real>(velocity.z);
  }
  else
  {
    RoughBlock<Real>& rough = contacts_.rough[renewal.block];
    put(surface_velocity, rough.surface_velocity, lane);
    put(turned(pose, plane.bend), rough.bend, lane);
  }
  set(b, lane, normal, dot(normal, moved) - plane.distance, moved, dot(normal, surface_velocity));
  b.slip_squared[lane] = static_cast<Real>(plane.slip * plane.slip);
}

template void RestrictedNodes<float>::carry(Carrier&, const float* const[3], const ConstraintStep&);
template void RestrictedNodes<double>::carry(Carrier&, const double* const[3], const ConstraintStep&);
template void RestrictedNodes<float>::renew(const WaitingBlock*, std::int32_t, float* const[3], float* const[3],
                                            const ConstraintStep&);
template void RestrictedNodes<double>::renew(const WaitingBlock*, std::int32_t, double* const[3], double* const[3],
                                             const ConstraintStep&);

}  // namespace frontalis
