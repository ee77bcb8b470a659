#pragma once

#include "step_kernel.hpp"

namespace frontalis
{
namespace cuda
{

// a node that has slid farther than this from its latest exact closest point gets a new one [m]; as on the host
constexpr double slip_until_renewal = 15e-6;

struct NodeState
{
  double u[3];
  double v[3];
};

__device__ __forceinline__ double ramped(double time, double ramp) { return ramp > 0 ? fmin(time / ramp, 1.0) : 1.0; }

__device__ __noinline__ void renew_contact(const StepArguments& g, SlidingContact& s, const SurfaceSearch::Point& p)
{
  const SurfaceSearch::Point foot{ s.foot[0], s.foot[1], s.foot[2] };
  const double reach = s.stale ? 1e3 : norm(p - foot) * (1 + 1e-9) + 1e-12;
  const SurfaceSearch::Closest c = g.surfaces[s.surface].closest(p, reach);
  if (c.triangle < 0)
    return;
  const SurfaceSearch::Point away = p - c.point;
  const double distance = sqrt(c.squared_distance);
  // sign by the pseudonormal, and the pseudonormal itself where the point lies on the surface
  const SurfaceSearch::Point normal =
      distance < 1e-7 ? c.normal : (dot(away, c.normal) < 0 ? -1 / distance : 1 / distance) * away;
  const double found[9] = { normal.x, normal.y, normal.z, c.point.x, c.point.y, c.point.z, p.x, p.y, p.z };
  for (int i = 0; i < 3; ++i)
  {
    s.normal[i] = found[i];
    s.foot[i] = found[3 + i];
    s.reference[i] = found[6 + i];
  }
  s.stale = 0;
}

__device__ __forceinline__ void slide(const StepArguments& g, SlidingContact& s, NodeState& n)
{
  double moved = 0;
  double p[3];
  for (int i = 0; i < 3; ++i)
  {
    p[i] = s.rest[i] + static_cast<float>(n.u[i]);
    moved += (p[i] - s.reference[i]) * (p[i] - s.reference[i]);
  }
  if (s.stale || moved > slip_until_renewal * slip_until_renewal)
    renew_contact(g, s, { p[0], p[1], p[2] });
  double error = -s.distance, normal_velocity = 0;
  for (int i = 0; i < 3; ++i)
  {
    error += s.normal[i] * (p[i] - s.foot[i]);
    normal_velocity += s.normal[i] * n.v[i];
  }
  for (int i = 0; i < 3; ++i)
  {
    n.u[i] = static_cast<float>(p[i] - error * s.normal[i] - s.rest[i]);
    n.v[i] -= normal_velocity * s.normal[i];
  }
}

/// Loads, then sliding, prescribed and rigid motion of one node, after its update.
__device__ __forceinline__ void run_task(const StepArguments& g, const NodeTask& task, const float4* u, float4* next,
                                         int step)
{
  const float4 before = u[task.node];
  float4 now = next[task.node];
  const double old[3] = { before.x, before.y, before.z };
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
      n.v[i] = static_cast<float>(n.v[i]) + change;
      n.u[i] = static_cast<float>(n.u[i]) + g.dt * change;
    }
  }
  if (task.sliding >= 0)
    slide(g, g.sliding[task.sliding], n);
  if (task.prescribed >= 0)
  {
    const PrescribedMotion& motion = g.prescribed[task.prescribed];
    for (int i = 0; i < 3; ++i)
      if (motion.fixed[i])
      {
        n.u[i] = static_cast<float>(motion.value[i] * ramped(g.time + (step + 1) * g.dt_exact, motion.ramp[i]));
        n.v[i] = (static_cast<float>(n.u[i]) - static_cast<float>(old[i])) / g.dt;
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
      n.v[i] = (static_cast<float>(x) - static_cast<float>(old[i])) / g.dt;
    }
  }
  for (int i = 0; i < 3; ++i)
    g.v[i][task.node] = static_cast<float>(n.v[i]);
  next[task.node] = make_float4(n.u[0], n.u[1], n.u[2], now.w);
}

}  // namespace cuda
}  // namespace frontalis
