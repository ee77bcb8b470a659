#pragma once

#include "frontalis/physics/element/node_motion.hpp"
#include "frontalis/physics/ramp.hpp"
#include "cuda/kernels/acting_load.cuh"
#include "cuda/kernels/sliding_nodes.cuh"

namespace frontalis
{
namespace cuda
{

/// Stores a velocity for the account of work, if one is kept.
__device__ __forceinline__ void keep_velocity(float* const to[3], std::uint32_t node, const float* v)
{
  if (to[0] != nullptr)
    for (int i = 0; i < 3; ++i)
      to[i][node] = v[i];
}

static __device__ __noinline__ void add_load(const StepArguments& g, std::int32_t index, const NodeStep& at,
                                             NodeState& n)
{
  double force[3];
  surface_load(g, index, at.step, force);
  for (int i = 0; i < 3; ++i)
  {
    if (g.load_relief != nullptr)
      force[i] += g.load_relief[3 * index + i];
    physics::add_load(g.gain * at.before.w, g.dt, static_cast<float>(force[i]), n.u[i], n.v[i]);
  }
  keep_velocity(g.velocity_free, at.node, n.v);
}

static __device__ __noinline__ void follow_path(const StepArguments& g, std::int32_t index, const NodeStep& at,
                                                NodeState& n)
{
  const PrescribedMotion& motion = g.prescribed[index];
  const float old[3] = { at.before.x, at.before.y, at.before.z };
  for (int i = 0; i < 3; ++i)
    if (motion.fixed[i])
      physics::move_to(motion.value[i] * physics::ramped(g.time + (at.step + 1) * g.dt_exact, motion.ramp[i]), old[i],
                       g.dt, n.u[i], n.v[i]);
}

__device__ __forceinline__ void move_with_bone(const StepArguments& g, std::int32_t index, const NodeStep& at,
                                               NodeState& n)
{
  const float4 rest = g.rigid[index];
  const physics::Vec3<float> to = bone_motion_at(g, at.step + 1, static_cast<std::int32_t>(__float_as_uint(rest.w)))
                                      .displacement_of({ rest.x, rest.y, rest.z });
  physics::move_to(to.x, at.before.x, g.dt, n.u[0], n.v[0]);
  physics::move_to(to.y, at.before.y, g.dt, n.u[1], n.v[1]);
  physics::move_to(to.z, at.before.z, g.dt, n.u[2], n.v[2]);
}

static __device__ __noinline__ void follow_bone(const StepArguments& g, std::int32_t index, const NodeStep& at,
                                                NodeState& n)
{
  move_with_bone(g, index, at, n);
}

/// One function per NodeEffect. They are called through a table instead of being inlined, so that the code of all
/// effects together does not raise the number of registers of a kernel. `With`: effects of nodes.
using NodeFunction = void (*)(const StepArguments& g, std::int32_t index, const NodeStep& at, NodeState& n);
template <Effects With>
static __device__ const NodeFunction node_functions[node_effects] = {
  add_load,
  has<With, Effects::sliding> ? keep_distance<With> : nullptr,
  has<With, Effects::sliding> ? glide<With> : nullptr,
  follow_path,
  follow_bone,
};

/// Applies the effects of a node after its update.
template <Effects With>
static __device__ __noinline__ void apply_task(const StepArguments& g, const NodeTask& task, const float4& before,
                                               int step, NodeState& n)
{
  const NodeStep at{ before, task.node, step };
#pragma unroll 1
  for (int effect = 0; effect < node_effects; ++effect)
    if (task.of[effect] >= 0)
      node_functions<With>[effect](g, task.of[effect], at, n);
}

/// Applies the effects of a node in a patch whose entry of patch_tasks is below patch_task::none.
template <Effects With>
static __device__ __noinline__ void apply_patch_task(const StepArguments& g, std::int32_t task, const NodeStep& at,
                                                     NodeState& n)
{
  const std::int32_t index = patch_task::index_of(task);
  const patch_task::Kind kind = patch_task::kind_of(task);
  if (kind == patch_task::other)
    return apply_task<With>(g, g.tasks[index], at.before, at.step, n);
  node_functions<With>[kind == patch_task::glides ? node_gliding : node_rigid](g, index, at, n);
}

/// Data for the update of a node, loaded before the stress is computed.
struct NodeFetch
{
  float4 own;
  float v[3];
};

__device__ __forceinline__ NodeFetch fetch_node(const StepArguments& g, const float4* u, std::uint32_t word)
{
  // Loads do not wait for the node's flags. Data loaded for nodes of other strips is not used.
  const std::uint32_t node = word & StripSlot::node_mask;
  return { u[node], { g.v[0][node], g.v[1][node], g.v[2][node] } };
}

/// Returns the state of a node after one step of the damped central difference scheme.
__device__ __forceinline__ NodeState updated(const StepArguments& g, std::uint32_t node, const NodeFetch& fetch,
                                             const float* force)
{
  const float share = g.gain * fetch.own.w;
  NodeState n;
#pragma unroll
  for (int i = 0; i < 3; ++i)
    n.v[i] = physics::kicked(g, i, fetch.v[i], share, force[i]);
  n.u[0] = fetch.own.x + g.dt * n.v[0];
  n.u[1] = fetch.own.y + g.dt * n.v[1];
  n.u[2] = fetch.own.z + g.dt * n.v[2];
  keep_velocity(g.velocity_before, node, fetch.v);
  keep_velocity(g.velocity_free, node, n.v);
  return n;
}

}  // namespace cuda
}  // namespace frontalis
