#pragma once

#include "solver/cpu/attach_kernel.hpp"

namespace frontalis
{

/// Loops over the lanes of a block, which the compiler vectorises. The architecture is part of every type, so that code
/// for different instruction sets shares no template instantiation.
template <class Architecture, class Real>
struct AttachKernelBody
{
  using Arguments = AttachArguments<Real>;
  using Planes = LevelPlanes<Real>;
  static constexpr int width = attach_width;
  using Row = Real[width];
  using Vectors = Real[3][width];

  static void gather(const std::int32_t (&node)[width], Real* const (&from)[3], Vectors& to)
  {
    for (int l = 0; l < width; ++l)
      for (int axis = 0; axis < 3; ++axis)
        to[axis][l] = from[axis][node[l]];
  }
  static void scatter(const std::int32_t (&node)[width], const Vectors& from, Real* const (&to)[3])
  {
    for (int l = 0; l < width; ++l)
      for (int axis = 0; axis < 3; ++axis)
        to[axis][node[l]] = from[axis][l];
  }
  static void along(const Planes& planes, const Vectors& vector, Row& to)
  {
    for (int l = 0; l < width; ++l)
      to[l] = planes.gradient[0][l] * vector[0][l] + planes.gradient[1][l] * vector[1][l] +
              planes.gradient[2][l] * vector[2][l];
  }

  static void renew(const Arguments& g, Planes& planes, const std::int32_t (&node)[width], const Vectors& u)
  {
    std::int32_t beyond[width], any = 0;
    for (int l = 0; l < width; ++l)
    {
      const Real x = u[0][l] - planes.reference[0][l], y = u[1][l] - planes.reference[1][l],
                 z = u[2][l] - planes.reference[2][l];
      beyond[l] = x * x + y * y + z * z > planes.slip_squared[l] ? 1 : 0;
    }
    for (int l = 0; l < width; ++l)
      any |= beyond[l];
    for (int l = 0; l < width && any != 0; ++l)
      if (beyond[l] != 0 && planes.surface[l] >= 0)
      {
        const Real at[3] = { u[0][l], u[1][l], u[2][l] };
        g.renew(g.context, planes, l, node[l], at);
      }
  }

  static void add_held(const Arguments& g, const HeldRow<Real>& row, Vectors& held)
  {
    Vectors v;
    gather(row.node, g.v, v);
    for (int axis = 0; axis < 3; ++axis)
      for (int l = 0; l < width; ++l)
        held[axis][l] += row.weight[l] * v[axis][l];
  }

  static void add_level(const Arguments& g, LevelRow<Real>& row, Row& momentum, Row& inertia)
  {
    gather(row.node, g.u, row.u);
    gather(row.node, g.v, row.v);
    renew(g, row.planes, row.node, row.u);
    Row speed;
    along(row.planes, row.v, speed);
    for (int l = 0; l < width; ++l)
    {
      const Real weight = row.weight[l] * row.planes.flat[l];
      momentum[l] += weight * speed[l];
      inertia[l] += weight * row.ratio[l];
    }
  }

  static void move_held(const Arguments& g, const HeldRow<Real>& row, const Vectors& u, const Vectors& v)
  {
    Vectors moved, velocity;
    for (int axis = 0; axis < 3; ++axis)
      for (int l = 0; l < width; ++l)
      {
        moved[axis][l] = row.ratio[l] * u[axis][l];
        velocity[axis][l] = row.ratio[l] * v[axis][l];
      }
    scatter(row.node, moved, g.u);
    scatter(row.node, velocity, g.v);
  }

  static void move_level(const Arguments& g, LevelRow<Real>& row, const Row& master_level, const Row& master_speed)
  {
    Row speed, level;
    along(row.planes, row.v, speed);
    along(row.planes, row.u, level);
    for (int l = 0; l < width; ++l)
    {
      // An error of the level is removed gradually, as for other sliding nodes (physics/sliding.hpp).
      const Real change = row.ratio[l] * master_speed[l] - speed[l];
      const Real apart =
          level[l] + row.planes.level[l] + g.dt * change - row.ratio[l] * master_level[l] - row.offset[l];
      const Real half = Real(0.5) * apart, most = half < g.error_left ? half : g.error_left;
      const Real left = most > -g.error_left ? most : -g.error_left;
      speed[l] = row.planes.flat[l] * change;
      level[l] = row.planes.flat[l] * (g.dt * change - (apart - left));
    }
    Vectors moved, velocity;
    for (int axis = 0; axis < 3; ++axis)
      for (int l = 0; l < width; ++l)
      {
        velocity[axis][l] = row.v[axis][l] + speed[l] * row.planes.gradient[axis][l];
        moved[axis][l] = row.u[axis][l] + level[l] * row.planes.gradient[axis][l];
      }
    scatter(row.node, moved, g.u);
    scatter(row.node, velocity, g.v);
  }

  // Finds the velocities that satisfy the constraints and are nearest to the unconstrained velocities in the
  // mass-weighted norm. Let m be the mass of a master and of the nodes that it holds, H the momentum of these nodes
  // less m times the master's velocity v, a and q the inertia and momentum of the nodes that slide with the master, and
  // g the gradient of its level. Then v changes by the solution of (m + a g g^T) change = H + (q - a g . v) g.
  static void process(const Arguments& g, MasterBlock<Real>& b)
  {
    Planes& planes = b.planes;
    Vectors u, v, held = {};
    Row speed = {}, level = {};
    gather(b.node, g.u, u);
    gather(b.node, g.v, v);
    for (auto row = b.held_begin; row < b.held_end; ++row)
      add_held(g, g.held[row], held);
    for (int axis = 0; axis < 3; ++axis)
      for (int l = 0; l < width; ++l)
        held[axis][l] -= b.held_mass[l] * v[axis][l];
    if (b.level_begin < b.level_end)
    {
      renew(g, planes, b.node, u);
      Row momentum = {}, inertia = {}, push, steepness;
      for (auto row = b.level_begin; row < b.level_end; ++row)
        add_level(g, g.levels[row], momentum, inertia);
      along(planes, v, speed);
      along(planes, held, push);
      along(planes, planes.gradient, steepness);
      for (int l = 0; l < width; ++l)
      {
        speed[l] +=
            (push[l] + (momentum[l] - inertia[l] * speed[l]) * steepness[l]) / (b.mass[l] + inertia[l] * steepness[l]);
        momentum[l] -= inertia[l] * speed[l];
      }
      for (int axis = 0; axis < 3; ++axis)
        for (int l = 0; l < width; ++l)
          held[axis][l] += momentum[l] * planes.gradient[axis][l];
    }
    for (int axis = 0; axis < 3; ++axis)
      for (int l = 0; l < width; ++l)
      {
        const Real change = held[axis][l] / b.mass[l];
        v[axis][l] += change;
        u[axis][l] += g.dt * change;
      }
    along(planes, u, level);
    for (int l = 0; l < width; ++l)
      level[l] += planes.level[l];
    scatter(b.node, u, g.u);
    scatter(b.node, v, g.v);
    for (auto row = b.held_begin; row < b.held_end; ++row)
      move_held(g, g.held[row], u, v);
    for (auto row = b.level_begin; row < b.level_end; ++row)
      move_level(g, g.levels[row], level, speed);
  }

  static void run(const Arguments& g, std::int32_t first, std::int32_t last)
  {
    for (auto block = first; block < last; ++block)
      process(g, g.masters[block]);
  }
};

}  // namespace frontalis
