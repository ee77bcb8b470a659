#pragma once

#include "bone_pose.cuh"
#include "built_effects.hpp"
#include "frontalis/physics/ramp.hpp"
#include "frontalis/physics/sliding.hpp"

namespace frontalis
{
namespace cuda
{

struct NodeState
{
  float u[3];
  float v[3];
};

/// The plane of a node at displacement u, found with its contact or with what searches in its place.
static __device__ __noinline__ TangentPlane contact_plane(const SlidingContact& s, SurfaceContact& contact,
                                                          const float* u, float& serves)
{
  using Point = SurfaceContact::Point;
  const Point rest{ s.rest[0], s.rest[1], s.rest[2] };
  const ContactPlane plane = contact.renew<true>(rest + Point{ u[0], u[1], u[2] });
  serves = plane.slip * plane.slip;
  const Point& n = plane.normal;
  return { make_float4(n.x, n.y, n.z, dot(n, rest) - plane.height),
           make_float4(u[0], u[1], u[2], plane.limit * plane.limit) };
}

/// A node's velocity turns with its plane.
__device__ __forceinline__ void turn(const float4& from, const float4& to, float* v)
{
  using Point = SurfaceContact::Point;
  const Point turned = physics::turned_with_normal(Point{ from.x, from.y, from.z }, Point{ to.x, to.y, to.z },
                                                   Point{ v[0], v[1], v[2] });
  v[0] = static_cast<float>(turned.x);
  v[1] = static_cast<float>(turned.y);
  v[2] = static_cast<float>(turned.z);
}

/// Finds the plane of a node anew and turns its velocity with it.
static __device__ __noinline__ void renew_contact(const StepArguments& g, std::int32_t index, const float* u, float* v)
{
  SlidingContact& s = g.sliding[index];
  if (g.contact_planes[index].reference.w < 0)
    s.contact.forget();
  const TangentPlane plane = contact_plane(s, s.contact, u, s.serves);
  turn(g.contact_planes[index].normal_offset, plane.normal_offset, v);
  g.contact_planes[index] = plane;
  s.renewed = true;
}

__device__ __forceinline__ float slip_squared(const float4& reference, const float* u)
{
  const float x = u[0] - reference.x, y = u[1] - reference.y, z = u[2] - reference.z;
  return x * x + y * y + z * z;
}

/// `plane`: as it was read before the step.
__device__ __forceinline__ void slide(const StepArguments& g, std::int32_t index, TangentPlane plane, NodeState& n)
{
  if (slip_squared(plane.reference, n.u) > plane.reference.w)
  {
    renew_contact(g, index, n.u, n.v);
    plane = g.contact_planes[index];
  }
  physics::Vec3<float> u{ n.u[0], n.u[1], n.u[2] }, v{ n.v[0], n.v[1], n.v[2] };
  const float4& p = plane.normal_offset;
  physics::slide(physics::Vec3<float>{ p.x, p.y, p.z }, -p.w, u, v);
  n = { { u.x, u.y, u.z }, { v.x, v.y, v.z } };
}

/// Velocities for the account of work, where one is kept.
__device__ __forceinline__ void keep_velocity(float* const to[3], std::uint32_t node, const float* v)
{
  if (to[0] != nullptr)
    for (int i = 0; i < 3; ++i)
      to[i][node] = v[i];
}

/// A node in a step: displacement before it and inverse mass.
struct NodeStep
{
  float4 before;
  std::uint32_t node;
  int step;
};

static __device__ __noinline__ void add_load(const StepArguments& g, std::int32_t index, const NodeStep& at,
                                             NodeState& n)
{
  double force[3] = { 0, 0, 0 };
  for (auto l = g.load_begin[index]; l < g.load_begin[index + 1]; ++l)
  {
    const LoadPart part = g.load_parts[l];
    const double share = part.weight * physics::ramped(g.time + at.step * g.dt_exact, g.load_ramp[part.load]);
    for (int i = 0; i < 3; ++i)
      force[i] += share * g.vertex_force[3 * part.vertex + i];
  }
  for (int i = 0; i < 3; ++i)
  {
    if (g.load_relief != nullptr)
      force[i] += g.load_relief[3 * index + i];
    const float change = g.gain * at.before.w * static_cast<float>(force[i]);
    n.v[i] += change;
    n.u[i] += g.dt * change;
  }
  keep_velocity(g.velocity_free, at.node, n.v);
}

static __device__ __noinline__ void keep_distance(const StepArguments& g, std::int32_t index, const NodeStep&,
                                                  NodeState& n)
{
  slide(g, index, g.contact_planes[index], n);
}

static __device__ __noinline__ void renew_gliding(const StepArguments& g, std::int32_t index,
                                                  const SurfaceContact::Point& p)
{
  g.gliding[index].plane = g.gliding_searches[index].contact.renew<true>(p);
  g.gliding[index].reference = p;
  g.gliding_searches[index].renewed = true;
}

// a variable, which code for the device can use too
constexpr bool rubs = built_with(Effect::friction);

/// Sliding on a surface that follows a bone or has friction, in double (see gliding_nodes.cpp).
template <class Frame>
static __device__ __forceinline__ void glide_on(const StepArguments& g, std::int32_t index, const Frame& now,
                                                const Frame& before, const NodeStep& at, NodeState& n)
{
  using Point = SurfaceContact::Point;
  GlidingContact& s = g.gliding[index];
  const Point rest{ s.rest[0], s.rest[1], s.rest[2] }, free{ n.v[0], n.v[1], n.v[2] };
  Point p = now.inwards(rest + Point{ n.u[0], n.u[1], n.u[2] });
  const Point surface_velocity = g.rate * (now.outwards(p) - before.outwards(p));
  Point w = now.turned_back(free - surface_velocity);
  const Point slipped = p - s.reference;
  if (dot(slipped, slipped) > s.plane.limit * s.plane.limit)
    renew_gliding(g, index, p);
  const Point& normal = s.plane.normal;
  double taken = 0;
  if (normal.x != s.turned_to.x || normal.y != s.turned_to.y || normal.z != s.turned_to.z)
  {
    // what turns it is a part of the reaction
    taken = dot(normal, w);
    w = physics::turned_with_normal(s.turned_to, normal, w);
    taken -= dot(normal, w);
    s.turned_to = normal;
  }
  taken += physics::slide(normal, s.plane.height, p, w);
  if (rubs && s.friction > 0)
  {
    const double pressing = s.pressing + g.friction_response * (taken * g.rate - s.pressing);
    s.pressing = pressing;
    const Point lost = physics::friction_loss(s.friction, g.dt_exact * pressing, norm(w)) * w;
    w = w - lost;
    p = p - g.dt_exact * lost;
  }
  const Point moved = now.outwards(p) - rest, v = now.turned(w) + surface_velocity;
  if (rubs && g.friction_work != nullptr && s.friction > 0)
  {
    const Point out = now.turned(normal), change = v - free;
    const Point along = change - dot(change, out) * out;
    const Point old{ g.velocity_before[0][at.node], g.velocity_before[1][at.node], g.velocity_before[2][at.node] };
    g.friction_work[index] -= dot(along, 0.5 * (old + v) - surface_velocity) / double(at.before.w);
  }
  n = { { static_cast<float>(moved.x), static_cast<float>(moved.y), static_cast<float>(moved.z) },
        { static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z) } };
}

static __device__ __noinline__ void glide_on_bone(const StepArguments& g, std::int32_t index, const NodeStep& at,
                                                  NodeState& n)
{
  const std::int32_t bone = g.gliding[index].bone;
  glide_on(g, index, pose_at(g, at.step + 1, bone), pose_at(g, at.step, bone), at, n);
}

static __device__ __noinline__ void glide(const StepArguments& g, std::int32_t index, const NodeStep& at, NodeState& n)
{
  if (g.gliding[index].bone >= 0)
    glide_on_bone(g, index, at, n);
  else
    glide_on(g, index, Still(), Still(), at, n);
}

static __device__ __noinline__ void follow_path(const StepArguments& g, std::int32_t index, const NodeStep& at,
                                                NodeState& n)
{
  const PrescribedMotion& motion = g.prescribed[index];
  const float old[3] = { at.before.x, at.before.y, at.before.z };
  for (int i = 0; i < 3; ++i)
    if (motion.fixed[i])
    {
      n.u[i] =
          static_cast<float>(motion.value[i] * physics::ramped(g.time + (at.step + 1) * g.dt_exact, motion.ramp[i]));
      n.v[i] = (n.u[i] - old[i]) / g.dt;
    }
}

static __device__ __noinline__ void follow_bone(const StepArguments& g, std::int32_t index, const NodeStep& at,
                                                NodeState& n)
{
  using Point = SurfaceContact::Point;
  const RigidMotion& motion = g.rigid[index];
  const Point rest{ motion.rest[0], motion.rest[1], motion.rest[2] };
  const Point moved = pose_at(g, at.step + 1, motion.bone).outwards(rest) - rest;
  const double to[3] = { moved.x, moved.y, moved.z };
  const float old[3] = { at.before.x, at.before.y, at.before.z };
  for (int i = 0; i < 3; ++i)
  {
    n.u[i] = static_cast<float>(to[i]);
    n.v[i] = (n.u[i] - old[i]) / g.dt;
  }
}

/// By NodeEffect. Called through this table, an effect that no node has is no part of the kernels' own code. `Slides`:
/// with those that slide or glide.
using NodeFunction = void (*)(const StepArguments& g, std::int32_t index, const NodeStep& at, NodeState& n);
template <bool Slides>
static __device__ const NodeFunction node_functions[node_effects] = {
  built_with(Effect::surface_loads) ? add_load : nullptr,
  built_with(Effect::sliding) && Slides ? keep_distance : nullptr,
  built_with(Effect::sliding) && Slides ? glide : nullptr,
  built_with(Effect::prescribed_displacement) ? follow_path : nullptr,
  built_with(Effect::rigid_nodes) ? follow_bone : nullptr,
};

/// What one node has, after its update.
template <bool Slides>
static __device__ __noinline__ void apply_task(const StepArguments& g, const NodeTask& task, const float4& before,
                                               int step, NodeState& n)
{
  const NodeStep at{ before, task.node, step };
#pragma unroll 1
  for (int effect = 0; effect < node_effects; ++effect)
    if (task.of[effect] >= 0)
      node_functions<Slides>[effect](g, task.of[effect], at, n);
}

/// What a node has that has been written already.
template <bool Slides>
__device__ __forceinline__ void run_task(const StepArguments& g, const NodeTask& task, const float4* u, float4* next,
                                         int step)
{
  const float4 before = u[task.node];
  const float4 now = next[task.node];
  NodeState n{ { now.x, now.y, now.z }, { g.v[0][task.node], g.v[1][task.node], g.v[2][task.node] } };
  // the inverse mass of what is written: a buffer that was never stepped holds none
  apply_task<Slides>(g, task, make_float4(before.x, before.y, before.z, now.w), step, n);
  for (int i = 0; i < 3; ++i)
    g.v[i][task.node] = n.v[i];
  next[task.node] = make_float4(n.u[0], n.u[1], n.u[2], now.w);
}

/// What the update of a node needs, fetched before the stress is computed.
struct NodeFetch
{
  float4 own;
  float v[3];
};

__device__ __forceinline__ NodeFetch fetch_node(const StepArguments& g, const float4* u, std::uint32_t word)
{
  // without a condition, so that nothing waits for it; nodes that are not stepped here are there to be read too
  const std::uint32_t node = word & StripSlot::node_mask;
  return { u[node], { g.v[0][node], g.v[1][node], g.v[2][node] } };
}

/// Damped central difference.
__device__ __forceinline__ NodeState updated(const StepArguments& g, std::uint32_t node, const NodeFetch& fetch,
                                             const float* force)
{
  const float share = g.gain * fetch.own.w;
  NodeState n;
#pragma unroll
  for (int i = 0; i < 3; ++i)
    // two multiply-adds, with gravity or without
    n.v[i] = (g.keep * fetch.v[i] + g.impulse[i]) - share * force[i];
  n.u[0] = fetch.own.x + g.dt * n.v[0];
  n.u[1] = fetch.own.y + g.dt * n.v[1];
  n.u[2] = fetch.own.z + g.dt * n.v[2];
  keep_velocity(g.velocity_before, node, fetch.v);
  keep_velocity(g.velocity_free, node, n.v);
  return n;
}

}  // namespace cuda
}  // namespace frontalis
