#pragma once

#include "cuda/kernels/bone_pose.cuh"
#include "frontalis/physics/element/sliding_node.hpp"
#include "cuda/kernels/warp_search.cuh"

namespace frontalis
{
namespace cuda
{

// Nodes that slide on surfaces: the step on a tangent plane, and the change to another plane.

struct NodeState
{
  float u[3];
  float v[3];
  bool leaves = false;  ///< in the next step it leaves the range in which its plane is valid
  bool asks = false;    ///< it will leave that range within StepArguments::lead
};

__device__ __forceinline__ physics::Vec3<float> normal_of(const float4& normal_offset)
{
  return { normal_offset.x, normal_offset.y, normal_offset.z };
}

__device__ __forceinline__ SurfaceContact::Point place_of(const SlidingContact& s, const float* u)
{
  return { s.rest[0] + u[0], s.rest[1] + u[1], s.rest[2] + u[2] };
}

__device__ __forceinline__ float squared(const float* v) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; }

/// How far ahead of a node its next plane is searched, as a fraction of a plan: half the distance over which its last
/// plane was valid, at most half a plan. `goes`: distance per plan [m]; `served`: squared distance of validity [m2].
__device__ __forceinline__ float share_before(float goes, float served)
{
  // a node may have had no plane, and may not move
  const float far = sqrtf(fmaxf(served, 0.0f));
  return goes > far ? 0.5f * far / goes : 0.5f;
}

/// The same as a time [s].
__device__ __forceinline__ float time_before(const StepArguments& g, const float* v, float served)
{
  const float plan = g.steps * g.dt;
  return plan * share_before(plan * sqrtf(squared(v)), served);
}

/// Converts the plane that was found at `at` to the form that a step needs. `serves`: see SlidingContact.
__device__ __forceinline__ TangentPlane tangent_plane(const SlidingContact& s, const ContactPlane& plane,
                                                      const SurfaceContact::Point& at, float& serves)
{
  serves = static_cast<float>(plane.slip * plane.slip);
  const SurfaceContact::Point& n = plane.normal;
  const SurfaceContact::Point rest{ s.rest[0], s.rest[1], s.rest[2] }, u = at - rest;
  return { make_float4(n.x, n.y, n.z, dot(n, rest) - plane.height),
           make_float4(u.x, u.y, u.z, plane.limit * plane.limit) };
}

/// Whether a sliding node has friction.
__device__ __forceinline__ bool rubs(const StepArguments& g, std::int32_t index)
{
  return static_cast<std::uint32_t>(index) < g.rubbing_count;
}

/// Gives a node another plane and turns its velocity with it. `With`: effects of nodes.
template <Effects With>
__device__ __forceinline__ void change_plane(const StepArguments& g, std::int32_t index, const TangentPlane& to,
                                             float* v)
{
  physics::Vec3<float> turned{ v[0], v[1], v[2] };
  const float taken =
      physics::turn_with_plane(normal_of(g.contact_planes[index].normal_offset), normal_of(to.normal_offset), turned);
  v[0] = turned.x;
  v[1] = turned.y;
  v[2] = turned.z;
  if (has<With, Effects::friction> && rubs(g, index))
    g.rubbing[index].turning += taken;
  g.contact_planes[index] = to;
}

/// The same for a plane that was found at `at`.
template <Effects With>
__device__ __forceinline__ void put_on(const StepArguments& g, std::int32_t index, const ContactPlane& found,
                                       const SurfaceContact::Point& at, float* v)
{
  SlidingContact& s = g.sliding[index];
  change_plane<With>(g, index, tangent_plane(s, found, at, s.serves), v);
}

__device__ __forceinline__ float slip_squared(const float4& reference, const float* u)
{
  const float x = u[0] - reference.x, y = u[1] - reference.y, z = u[2] - reference.z;
  return x * x + y * y + z * z;
}

/// Data of a sliding node's contact, read before the step.
struct SlidingFetch
{
  TangentPlane plane;
  RubbingContact rubbing;  ///< only if the node has friction
};

template <Effects With>
__device__ __forceinline__ SlidingFetch fetch_contact(const StepArguments& g, std::int32_t index)
{
  SlidingFetch contact{ g.contact_planes[index], {} };
  if (has<With, Effects::friction> && rubs(g, index))
    contact.rubbing = g.rubbing[index];
  return contact;
}

/// A node in a step. `before`: displacement before the step, and inverse mass.
struct NodeStep
{
  float4 before;
  std::uint32_t node;
  int step;
};

/// Energy dissipated by friction at a node [J]; see physics::friction_work().
static __device__ __forceinline__ double lost_to_friction(const StepArguments& g, const NodeStep& at,
                                                          const SurfaceContact::Point& normal,
                                                          const SurfaceContact::Point& surface_velocity,
                                                          const SurfaceContact::Point& free,
                                                          const SurfaceContact::Point& v)
{
  const SurfaceContact::Point old{ g.velocity_before[0][at.node], g.velocity_before[1][at.node],
                                   g.velocity_before[2][at.node] };
  return physics::friction_work(normal, surface_velocity, old, free, v) / double(at.before.w);
}

/// Applies friction on a fixed surface. `taken`: normal speed that the plane removed in this step.
static __device__ __forceinline__ void rub(const StepArguments& g, std::int32_t index, const NodeStep& at,
                                           const SlidingFetch& contact, float taken, physics::Vec3<float>& u,
                                           physics::Vec3<float>& v, const float (&free)[3])
{
  const RubbingContact& s = contact.rubbing;
  const float reaction = (s.turning + taken) * static_cast<float>(g.rate);
  float pressing = s.pressing;
  physics::rub(s.friction, static_cast<float>(g.friction_response), g.dt, reaction, pressing, u, v);
  g.rubbing[index].pressing = pressing;
  g.rubbing[index].turning = 0;
  const float4& normal = contact.plane.normal_offset;
  if (g.friction_work != nullptr)
    g.friction_work[index] += lost_to_friction(g, at, { normal.x, normal.y, normal.z }, { 0, 0, 0 },
                                               { free[0], free[1], free[2] }, { v.x, v.y, v.z });
}

/// Step of a node that slides on a fixed surface.
template <Effects With>
__device__ __forceinline__ void slide(const StepArguments& g, std::int32_t index, const NodeStep& at,
                                      const SlidingFetch& contact, NodeState& n)
{
  physics::Vec3<float> u{ n.u[0], n.u[1], n.u[2] }, v{ n.v[0], n.v[1], n.v[2] };
  const TangentPlane& plane = contact.plane;
  const float4& p = plane.normal_offset;
  const float taken = physics::slide(normal_of(p), -p.w, u, v);
  if (has<With, Effects::friction> && rubs(g, index))
    rub(g, index, at, contact, taken, u, v, n.v);
  const auto leaves_within = [&](float seconds)
  {
    const float then[3] = { u.x + seconds * v.x, u.y + seconds * v.y, u.z + seconds * v.z };
    return slip_squared(plane.reference, then) > plane.reference.w;
  };
  const bool leaves = leaves_within(g.dt);
  n = { { u.x, u.y, u.z }, { v.x, v.y, v.z }, leaves, !leaves && leaves_within(g.dt + g.lead) };
}

template <Effects With>
static __device__ __noinline__ void keep_distance(const StepArguments& g, std::int32_t index, const NodeStep& at,
                                                  NodeState& n)
{
  slide<With>(g, index, at, fetch_contact<With>(g, index), n);
}

/// Step of a node that slides on a surface moving with a bone, in double precision as in gliding_nodes.cpp.
template <Effects With>
static __device__ __noinline__ void glide(const StepArguments& g, std::int32_t index, const NodeStep& at, NodeState& n)
{
  using Point = SurfaceContact::Point;
  const std::int32_t bone = g.gliding[index].bone;
  const Pose now = pose_at(g, at.step + 1, bone), before = pose_at(g, at.step, bone);
  GlidingContact& s = g.gliding[index];
  const Point rest{ s.rest[0], s.rest[1], s.rest[2] }, free{ n.v[0], n.v[1], n.v[2] };
  const physics::RelativeMotion motion =
      physics::relative_to(now, before, g.rate, rest + Point{ n.u[0], n.u[1], n.u[2] }, free);
  Point p = motion.place, w = motion.velocity;
  const Point& normal = s.plane.normal;
  double taken = 0;
  if (normal.x != s.turned_to.x || normal.y != s.turned_to.y || normal.z != s.turned_to.z)
  {
    taken = physics::turn_with_plane(s.turned_to, normal, w);
    s.turned_to = normal;
  }
  taken += physics::slide(normal, s.plane.height, p, w);
  const bool has_friction = has<With, Effects::friction> && s.friction > 0;
  if (has_friction)
    physics::rub(s.friction, g.friction_response, g.dt_exact, taken * g.rate, s.pressing, p, w);
  const Point next = p + g.dt_exact * w, slipped = next - s.reference;
  const bool leaves = dot(slipped, slipped) > s.plane.limit * s.plane.limit;
  // position at which the next plane is searched
  if (leaves)
    s.reference = next;
  const Point further = next + double(g.lead) * w, gone = further - s.reference;
  const bool asks = g.lead > 0 && !leaves && dot(gone, gone) > s.plane.limit * s.plane.limit;
  // only the thread of this node sets the state to nothing_ahead
  GlidingSearch& search = g.gliding_searches[index];
  if (asks && search.state == nothing_ahead)
    search.ahead = further;
  const Point moved = now.outwards(p) - rest, v = now.turned(w) + motion.surface_velocity;
  if (has_friction && g.friction_work != nullptr)
    g.friction_work[g.rubbing_count + index] +=
        lost_to_friction(g, at, now.turned(normal), motion.surface_velocity, free, v);
  n = { { static_cast<float>(moved.x), static_cast<float>(moved.y), static_cast<float>(moved.z) },
        { static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z) },
        leaves,
        asks };
}

/// Gives new planes to nodes that left theirs in a step. Whole warps call it. `contact`: index into
/// StepArguments::sliding, or -1 minus an index into gliding.
template <int Warps, Effects With>
__device__ __noinline__ void find_others(const StepArguments& g, bool leaves, std::int32_t contact, const float (&u)[3],
                                         float (&v)[3])
{
  using Point = SurfaceContact::Point;
  const bool slides = contact >= 0;
  const std::int32_t gliding = -1 - contact;
  SurfaceContact* on = nullptr;
  Point next{ 0, 0, 0 }, at{ 0, 0, 0 };
  if (leaves && slides)
  {
    const float before = time_before(g, v, g.contact_planes[contact].reference.w);
    const Point velocity{ v[0], v[1], v[2] };
    on = &g.sliding[contact].contact;
    next = place_of(g.sliding[contact], u) + g.dt_exact * velocity;
    at = next + double(before) * velocity;
  }
  else if (leaves)
  {
    on = &g.gliding_searches[gliding].contact;
    next = at = g.gliding[gliding].reference;
  }
  const ContactPlane plane = find_before<Warps>(leaves, on, next, at);
  if (leaves && slides)
    put_on<With>(g, contact, plane, at, v);
  else if (leaves)
    g.gliding[gliding].plane = plane;
}

}  // namespace cuda
}  // namespace frontalis
