#pragma once

#include "cuda/kernels/bone_pose.cuh"
#include "cuda/kernels/kept_samples.cuh"
#include "frontalis/physics/element/sliding_node.hpp"

namespace frontalis
{
namespace cuda
{

// Nodes that slide on surfaces. In each step a node uses the tangent plane of its level set at its present position.

struct NodeState
{
  float u[3];
  float v[3];
};

/// A node in a step. `before`: its displacement before the step, and its inverse mass.
struct NodeStep
{
  float4 before;
  std::uint32_t node;
  int step;
};

/// Data of a sliding node that is read before the step. The node's samples would take too many registers and are read
/// when they are needed.
struct SlidingFetch
{
  float4 at, plane;
  float inverse_spacing;
  float friction = 0, pressing = 0;
};

__device__ __forceinline__ physics::Vec3<float> normal_of(const float4& plane) { return { plane.x, plane.y, plane.z }; }

__device__ __forceinline__ bool rubs(const StepArguments& g, std::int32_t index)
{
  return static_cast<std::uint32_t>(index) < g.rubbing_count;
}

__device__ __forceinline__ KeptSamples samples_of(const StepArguments& g, std::int32_t index)
{
  return { g.samples, g.sliding_count, static_cast<std::uint32_t>(index) };
}

template <Effects With>
__device__ __forceinline__ void fetch_sliding(const StepArguments& g, std::int32_t index, SlidingFetch& fetch)
{
  fetch.at = g.sliding_at[index];
  fetch.plane = g.planes[index];
  fetch.inverse_spacing = samples_of(g, index).number(27);
  if (has<With, Effects::friction> && rubs(g, index))
  {
    fetch.friction = g.friction[index];
    fetch.pressing = g.pressing[index];
  }
}

/// Copies the samples of another cell to a node's own copy. Returns false, and copies nothing, if the cell has no
/// samples.
static __device__ __noinline__ bool enter_cell(const StepArguments& g, std::int32_t index, std::uint32_t code)
{
  const SlidingNodeField node = g.sliding[index];
  if (!samples_of(g, index).copy(g.fields[node.surface], node.cell, code, node.level))
    return false;
  g.sliding_at[index].w = __uint_as_float(code);
  return true;
}

/// Finds the field of a node's surface at the node's displacement `u`, minus the node's level. Returns false if no
/// samples are stored there.
__device__ __forceinline__ bool field_at(const StepArguments& g, std::int32_t index, const SlidingFetch& fetch,
                                         const physics::Vec3<float>& u, physics::FieldValue<float>& value)
{
  const physics::Vec3<float> at{ fetch.at.x, fetch.at.y, fetch.at.z };
  const KeptSamples kept = samples_of(g, index);
  if (fetch.inverse_spacing == 0)
  {
    value = physics::sphere_value(kept.number(0), at, u);
    return true;
  }
  return kept.value_at(fetch.inverse_spacing, at + u, __float_as_uint(fetch.at.w), value,
                       [&](std::uint32_t code) { return aside(enter_cell)(g, index, code); });
}

/// The plane on which a node at displacement `u` slides in this step. Where no samples are stored, the plane of the
/// latest step is kept.
__device__ __forceinline__ physics::LevelPlane<float> plane_at(const StepArguments& g, std::int32_t index,
                                                               const SlidingFetch& fetch, const physics::Vec3<float>& u)
{
  const physics::Vec3<float> latest = normal_of(fetch.plane);
  physics::LevelPlane<float> plane{ latest, dot(latest, u) - fetch.plane.w, 0 };
  physics::FieldValue<float> value;
  if (field_at(g, index, fetch, u, value) && physics::level_plane(value, 0.0f, plane))
    g.planes[index] =
        make_float4(plane.normal.x, plane.normal.y, plane.normal.z, dot(plane.normal, u) - plane.distance);
  return plane;
}

/// Slides a node on a plane. The plane, the node's position p and its velocity v are those relative to the surface.
/// Returns whether the node has friction.
template <Effects With>
__device__ __forceinline__ bool slide_on(const StepArguments& g, std::int32_t index, const SlidingFetch& fetch,
                                         const physics::LevelPlane<float>& plane, physics::Vec3<float>& p,
                                         physics::Vec3<float>& v)
{
  float taken = physics::turn_with_plane(normal_of(fetch.plane), plane.normal, v);
  physics::Vec3<float> push{ 0, 0, 0 };
  taken = taken + physics::slide(plane.normal, -plane.distance, push, v);
  p = p + push;
  if (!has<With, Effects::friction> || !rubs(g, index))
    return false;
  float pressing = fetch.pressing;
  physics::rub(fetch.friction, static_cast<float>(g.friction_response), g.dt, taken * static_cast<float>(g.rate),
               pressing, p, v);
  g.pressing[index] = pressing;
  return true;
}

/// Adds the energy dissipated by friction at a node [J]; see physics::friction_work().
static __device__ __forceinline__ void account_friction(const StepArguments& g, std::int32_t index, const NodeStep& at,
                                                        const physics::Vec3<float>& normal,
                                                        const physics::Vec3<float>& surface_velocity,
                                                        const physics::Vec3<float>& free, const physics::Vec3<float>& v)
{
  const auto exact = [](const physics::Vec3<float>& a) { return physics::Vec3<double>{ a.x, a.y, a.z }; };
  const physics::Vec3<double> old{ g.velocity_before[0][at.node], g.velocity_before[1][at.node],
                                   g.velocity_before[2][at.node] };
  g.friction_work[index] +=
      physics::friction_work(exact(normal), exact(surface_velocity), old, exact(free), exact(v)) / double(at.before.w);
}

/// Step of a node that slides on a surface that stands still.
template <Effects With>
__device__ __forceinline__ void slide(const StepArguments& g, std::int32_t index, const NodeStep& at,
                                      const SlidingFetch& fetch, NodeState& n)
{
  physics::Vec3<float> u{ n.u[0], n.u[1], n.u[2] }, v{ n.v[0], n.v[1], n.v[2] };
  const physics::Vec3<float> before = v;
  const physics::LevelPlane<float> plane = plane_at(g, index, fetch, u);
  if (slide_on<With>(g, index, fetch, plane, u, v) && g.friction_work != nullptr)
    account_friction(g, index, at, plane.normal, { 0, 0, 0 }, before, v);
  n = { { u.x, u.y, u.z }, { v.x, v.y, v.z } };
}

/// Step of a node on a surface that moves with a bone. It is done in the bone's frame, and its changes of displacement
/// and velocity are turned back to the scene's.
template <Effects With>
__device__ __forceinline__ void glide_here(const StepArguments& g, std::int32_t index, const NodeStep& at, NodeState& n)
{
  using Place = physics::Vec3<float>;
  const float4 on = g.gliding[index];
  SlidingFetch fetch;
  fetch_sliding<With>(g, index, fetch);
  const Place u{ n.u[0], n.u[1], n.u[2] }, v{ n.v[0], n.v[1], n.v[2] }, rest{ on.x, on.y, on.z };
  const BoneMotion bone = bone_motion_at(g, at.step + 1, static_cast<std::int32_t>(__float_as_uint(on.w)));
  const Place gone = bone.gone(rest, u), of_surface = bone.velocity_at(rest + gone),
              before = bone.turned_back(v - of_surface);
  const physics::LevelPlane<float> plane = plane_at(g, index, fetch, gone);
  Place push{ 0, 0, 0 }, relative = before;
  const bool rubbed = slide_on<With>(g, index, fetch, plane, push, relative);
  const Place moved = u + bone.turned(push), changed = v + bone.turned(relative - before);
  if (rubbed && g.friction_work != nullptr)
    account_friction(g, index, at, bone.turned(plane.normal), of_surface, v, changed);
  n = { { moved.x, moved.y, moved.z }, { changed.x, changed.y, changed.z } };
}

/// slide() and glide_here() as functions that are not inlined, for the table in node_tasks.cuh.
template <Effects With>
static __device__ __noinline__ void keep_distance(const StepArguments& g, std::int32_t index, const NodeStep& at,
                                                  NodeState& n)
{
  SlidingFetch fetch;
  fetch_sliding<With>(g, index, fetch);
  slide<With>(g, index, at, fetch, n);
}
template <Effects With>
static __device__ __noinline__ void glide(const StepArguments& g, std::int32_t index, const NodeStep& at, NodeState& n)
{
  glide_here<With>(g, index, at, n);
}

}  // namespace cuda
}  // namespace frontalis
