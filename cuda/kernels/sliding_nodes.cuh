#pragma once

#include "cuda/kernels/bone_pose.cuh"
#include "frontalis/physics/element/sliding_node.hpp"

namespace frontalis
{
namespace cuda
{

// Nodes that slide on surfaces. In each step a node uses the tangent plane of its field's level set at its position.
// The samples around it are read from a copy per node, in loads that the threads of a warp share. In most steps a node
// stays in its cell and the copy is valid.

struct NodeState
{
  float u[3];
  float v[3];
};

/// A node in a step. `before`: displacement before the step, and inverse mass.
struct NodeStep
{
  float4 before;
  std::uint32_t node;
  int step;
};

/// Data of a sliding node, read before the step. Its samples would take too many registers and are read when needed.
struct SlidingFetch
{
  float4 at, plane;
  float inverse_spacing;
  float friction = 0, pressing = 0;
};

__device__ __forceinline__ physics::Vec3<float> normal_of(const float4& plane) { return { plane.x, plane.y, plane.z }; }

/// Whether a sliding node has friction.
__device__ __forceinline__ bool rubs(const StepArguments& g, std::int32_t index)
{
  return static_cast<std::uint32_t>(index) < g.rubbing_count;
}

/// The n-th of the 28 numbers of a node's samples (see sample_words).
__device__ __forceinline__ float& sample_of(const StepArguments& g, std::int32_t index, int n)
{
  return reinterpret_cast<float*>(g.samples + n / 4 * g.sliding_count + index)[n % 4];
}

template <Effects With>
__device__ __forceinline__ void fetch_sliding(const StepArguments& g, std::int32_t index, SlidingFetch& fetch)
{
  fetch.at = g.sliding_at[index];
  fetch.plane = g.planes[index];
  fetch.inverse_spacing = sample_of(g, index, 27);
  if (has<With, Effects::friction> && rubs(g, index))
  {
    fetch.friction = g.friction[index];
    fetch.pressing = g.pressing[index];
  }
}

/// Copies the samples of another cell to a node. Returns false, and copies nothing, if none are stored there.
static __device__ __noinline__ bool enter_cell(const StepArguments& g, std::int32_t index, std::uint32_t code)
{
  const SlidingNodeField node = g.sliding[index];
  std::int32_t cell[3];
  for (int axis = 0; axis < 3; ++axis)
    cell[axis] = node.cell[axis] + static_cast<std::int32_t>(code >> 10 * axis & 1023u) - middle_cell;
  const physics::DistanceField& field = g.fields[node.surface];
  const float* const first = field.around(cell);
  if (first == nullptr)
    return false;
  const physics::FieldSamples samples = physics::gather(first);
  for (int n = 0; n < 27; ++n)
    sample_of(g, index, n) = samples.value[n] - node.level;
  g.sliding_at[index].w = __uint_as_float(code);
  return true;
}

/// Hides the address of a rarely called function from the compiler, which would otherwise allocate the registers of the
/// function and its caller together and spill.
template <class Function>
__device__ __forceinline__ Function* aside(Function* function)
{
  auto address = reinterpret_cast<std::uint64_t>(function);
  asm volatile("" : "+l"(address));
  return reinterpret_cast<Function*>(address);
}

/// A node's field minus its level at displacement `u`. Returns false if no samples are stored there.
__device__ __forceinline__ bool field_at(const StepArguments& g, std::int32_t index, const SlidingFetch& fetch,
                                         const physics::Vec3<float>& u, physics::FieldValue<float>& value)
{
  const physics::Vec3<float> offset = physics::Vec3<float>{ fetch.at.x, fetch.at.y, fetch.at.z } + u;
  if (fetch.inverse_spacing == 0)
  {
    value = physics::sphere_value(sample_of(g, index, 0), offset);
    return true;
  }
  std::int32_t cell[3] = { middle_cell, middle_cell, middle_cell };
  const physics::Vec3<float> place = physics::enter_cell(fetch.inverse_spacing, offset, cell);
  if (((cell[0] | cell[1] | cell[2]) & ~1023) != 0)
    return false;
  const std::uint32_t code = cell[0] | cell[1] << 10 | cell[2] << 20;
  if (code != __float_as_uint(fetch.at.w) && !aside(enter_cell)(g, index, code))
    return false;
  physics::FieldSamples samples;
  FRONTALIS_UNROLL
  for (int w = 0; w < sample_words; ++w)
  {
    const float4 word = g.samples[w * g.sliding_count + index];
    const float of[4] = { word.x, word.y, word.z, word.w };
    FRONTALIS_UNROLL
    for (int n = 4 * w; n < 4 * w + 4 && n < 27; ++n)
      samples.value[n] = of[n - 4 * w];
  }
  value = physics::spline(samples, fetch.inverse_spacing, place);
  return true;
}

/// The plane on which a node at displacement `u` slides in this step; without samples there, that of the latest step.
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

/// Slides a node with position p and velocity v relative to its surface on a plane in the surface's frame. Returns
/// whether it has friction. T: number type of the step.
template <Effects With, class T>
__device__ __forceinline__ bool slide_on(const StepArguments& g, std::int32_t index, const SlidingFetch& fetch,
                                         const physics::LevelPlane<float>& plane, physics::Vec3<T>& p,
                                         physics::Vec3<T>& v)
{
  const auto of = [](const physics::Vec3<float>& a) { return physics::Vec3<T>{ a.x, a.y, a.z }; };
  const physics::Vec3<T> normal = of(plane.normal);
  T taken = physics::turn_with_plane(of(normal_of(fetch.plane)), normal, v);
  physics::Vec3<T> push{ 0, 0, 0 };
  taken = taken + physics::slide(normal, -T(plane.distance), push, v);
  p = p + push;
  if (!has<With, Effects::friction> || !rubs(g, index))
    return false;
  T pressing = fetch.pressing;
  physics::rub(T(fetch.friction), T(g.friction_response), T(g.dt_exact), taken * T(g.rate), pressing, p, v);
  g.pressing[index] = static_cast<float>(pressing);
  return true;
}

/// Adds the energy dissipated by friction at a node [J]; see physics::friction_work().
static __device__ __forceinline__ void account_friction(const StepArguments& g, std::int32_t index, const NodeStep& at,
                                                        const physics::Vec3<double>& normal,
                                                        const physics::Vec3<double>& surface_velocity,
                                                        const physics::Vec3<double>& free,
                                                        const physics::Vec3<double>& v)
{
  const physics::Vec3<double> old{ g.velocity_before[0][at.node], g.velocity_before[1][at.node],
                                   g.velocity_before[2][at.node] };
  g.friction_work[index] += physics::friction_work(normal, surface_velocity, old, free, v) / double(at.before.w);
}

/// Step of a node that slides on a still surface.
template <Effects With>
__device__ __forceinline__ void slide(const StepArguments& g, std::int32_t index, const NodeStep& at,
                                      const SlidingFetch& fetch, NodeState& n)
{
  physics::Vec3<float> u{ n.u[0], n.u[1], n.u[2] }, v{ n.v[0], n.v[1], n.v[2] };
  const physics::LevelPlane<float> plane = plane_at(g, index, fetch, u);
  if (slide_on<With>(g, index, fetch, plane, u, v) && g.friction_work != nullptr)
    account_friction(g, index, at, { plane.normal.x, plane.normal.y, plane.normal.z }, { 0, 0, 0 },
                     { n.v[0], n.v[1], n.v[2] }, { v.x, v.y, v.z });
  n = { { u.x, u.y, u.z }, { v.x, v.y, v.z } };
}

template <Effects With>
static __device__ __noinline__ void keep_distance(const StepArguments& g, std::int32_t index, const NodeStep& at,
                                                  NodeState& n)
{
  SlidingFetch fetch;
  fetch_sliding<With>(g, index, fetch);
  slide<With>(g, index, at, fetch, n);
}

/// Step of a node that slides on a surface moving with a bone. Only the plane is in single precision, so that
/// conversions between the frames do not move a node at rest.
template <Effects With>
static __device__ __noinline__ void glide(const StepArguments& g, std::int32_t index, const NodeStep& at, NodeState& n)
{
  using Point = physics::Vec3<double>;
  const GlidingNode node = g.gliding[index];
  SlidingFetch fetch;
  fetch_sliding<With>(g, node.sliding, fetch);
  const Pose now = pose_at(g, at.step + 1, node.bone), before = pose_at(g, at.step, node.bone);
  const Point rest{ node.rest[0], node.rest[1], node.rest[2] }, free{ n.v[0], n.v[1], n.v[2] };
  physics::RelativeMotion motion =
      physics::relative_to(now, before, g.rate, rest + Point{ n.u[0], n.u[1], n.u[2] }, free);
  const Point gone = motion.place - rest;
  const physics::LevelPlane<float> plane = plane_at(
      g, node.sliding, fetch, { static_cast<float>(gone.x), static_cast<float>(gone.y), static_cast<float>(gone.z) });
  const bool rubbed = slide_on<With>(g, node.sliding, fetch, plane, motion.place, motion.velocity);
  const Point u = now.outwards(motion.place) - rest, v = now.turned(motion.velocity) + motion.surface_velocity;
  if (rubbed && g.friction_work != nullptr)
    account_friction(g, node.sliding, at, now.turned({ plane.normal.x, plane.normal.y, plane.normal.z }),
                     motion.surface_velocity, free, v);
  n = { { static_cast<float>(u.x), static_cast<float>(u.y), static_cast<float>(u.z) },
        { static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z) } };
}

}  // namespace cuda
}  // namespace frontalis
