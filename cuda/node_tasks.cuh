#pragma once

#include "step_kernel.hpp"

namespace frontalis
{
namespace cuda
{

// a node that has slid farther than this from its latest exact closest point gets a new one [m]
constexpr double slip_until_renewal = 15e-6;

struct NodeState
{
  float u[3];
  float v[3];
};

__device__ __forceinline__ double ramped(double time, double ramp) { return ramp > 0 ? fmin(time / ramp, 1.0) : 1.0; }

__device__ __noinline__ void renew_contact(const StepArguments& g, std::int32_t index, const float* u, bool first)
{
  SlidingContact& s = g.sliding[index];
  const SurfaceSearch::Point p{ s.rest[0] + u[0], s.rest[1] + u[1], s.rest[2] + u[2] };
  const SurfaceSearch::Point foot{ s.foot[0], s.foot[1], s.foot[2] };
  const double reach = first ? 1e3 : norm(p - foot) * (1 + 1e-9) + 1e-12;
  const SurfaceSearch::Closest c = g.surfaces[s.surface].closest(p, reach);
  if (c.triangle < 0)
    return;
  const SurfaceSearch::Point n = SurfaceSearch::offset_normal(c, p, s.distance, s.turned);
  s.foot[0] = c.point.x;
  s.foot[1] = c.point.y;
  s.foot[2] = c.point.z;
  const SurfaceSearch::Point rest{ s.rest[0], s.rest[1], s.rest[2] };
  g.contact_planes[index] = { make_float4(n.x, n.y, n.z, dot(n, rest - c.point) - s.distance),
                              make_float4(u[0], u[1], u[2], 0) };
}

__device__ __forceinline__ float slip_squared(const float4& reference, const float* u)
{
  const float x = u[0] - reference.x, y = u[1] - reference.y, z = u[2] - reference.z;
  return x * x + y * y + z * z;
}

__device__ __forceinline__ void slide(const StepArguments& g, std::int32_t index, NodeState& n)
{
  ContactPlane plane = g.contact_planes[index];
  const bool first = plane.reference.w != 0;
  if (first || slip_squared(plane.reference, n.u) > float(slip_until_renewal * slip_until_renewal))
  {
    renew_contact(g, index, n.u, first);
    plane = g.contact_planes[index];
  }
  const float normal[3] = { plane.normal_offset.x, plane.normal_offset.y, plane.normal_offset.z };
  const float error = normal[0] * n.u[0] + normal[1] * n.u[1] + normal[2] * n.u[2] + plane.normal_offset.w;
  const float speed = normal[0] * n.v[0] + normal[1] * n.v[1] + normal[2] * n.v[2];
#pragma unroll
  for (int i = 0; i < 3; ++i)
  {
    n.u[i] -= error * normal[i];
    n.v[i] -= speed * normal[i];
  }
}

/// Loads, then sliding, prescribed and rigid motion of one node, after its update.
__device__ __forceinline__ void run_task(const StepArguments& g, const NodeTask& task, const float4* u, float4* next,
                                         int step)
{
  const float4 before = u[task.node];
  float4 now = next[task.node];
  const float old[3] = { before.x, before.y, before.z };
  NodeState n{ { now.x, now.y, now.z }, { g.v[0][task.node], g.v[1][task.node], g.v[2][task.node] } };
  if (task.load >= 0)
  {
    double force[3] = { 0, 0, 0 };
    for (auto l = g.load_begin[task.load]; l < g.load_begin[task.load + 1]; ++l)
    {
      const LoadPart part = g.load_parts[l];
      const double share = part.weight * ramped(g.time + step * g.dt_exact, g.load_ramp[part.load]);
      for (int i = 0; i < 3; ++i)
        force[i] += share * g.vertex_force[3 * part.vertex + i];
    }
    for (int i = 0; i < 3; ++i)
    {
      const float change = g.gain * now.w * static_cast<float>(force[i]);
      n.v[i] += change;
      n.u[i] += g.dt * change;
    }
  }
  if (task.sliding >= 0)
    slide(g, task.sliding, n);
  if (task.prescribed >= 0)
  {
    const PrescribedMotion& motion = g.prescribed[task.prescribed];
    for (int i = 0; i < 3; ++i)
      if (motion.fixed[i])
      {
        n.u[i] = static_cast<float>(motion.value[i] * ramped(g.time + (step + 1) * g.dt_exact, motion.ramp[i]));
        n.v[i] = (n.u[i] - old[i]) / g.dt;
      }
  }
  if (task.rigid >= 0)
  {
    const RigidMotion& motion = g.rigid[task.rigid];
    const double* pose = g.poses + 12 * (static_cast<std::size_t>(step) * g.bones + motion.bone);
    for (int i = 0; i < 3; ++i)
    {
      double x = pose[9 + i] - motion.rest[i];
      for (int j = 0; j < 3; ++j)
        x += pose[3 * i + j] * motion.rest[j];
      n.u[i] = static_cast<float>(x);
      n.v[i] = (n.u[i] - old[i]) / g.dt;
    }
  }
  for (int i = 0; i < 3; ++i)
    g.v[i][task.node] = n.v[i];
  next[task.node] = make_float4(n.u[0], n.u[1], n.u[2], now.w);
}

}  // namespace cuda
}  // namespace frontalis
