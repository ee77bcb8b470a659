#pragma once

#include "frontalis/physics/shell.hpp"
#include "solver/cpu/shell_kernel.hpp"

namespace frontalis
{

/// The kernel, for lanes of a kind that loads, gathers and stores them. The kind is part of every type, so that
/// instruction sets share no template instantiation.
template <class Lanes>
struct ShellKernelBody
{
  using Real = typename Lanes::Real;
  using Batch = typename Lanes::Batch;
  using Block = ShellBlock<Real>;
  using Vector = physics::Vec3<Batch>;
  static_assert(Block::width % Lanes::count == 0, "a block is a whole number of batches");

  static FRONTALIS_LAW physics::ShellTriangle<Batch> load(const Block& b, int lane)
  {
    physics::ShellTriangle<Batch> t;
    FRONTALIS_UNROLL
    for (int i = 0; i < 5; ++i)
      t.from_corner[i] = { Lanes::load(b.from_corner[i][0] + lane), Lanes::load(b.from_corner[i][1] + lane),
                           Lanes::load(b.from_corner[i][2] + lane) };
    FRONTALIS_UNROLL
    for (int i = 0; i < 3; ++i)
    {
      t.metric[i] = Lanes::load(b.metric[i] + lane);
      t.height[i] = Lanes::load(b.height[i] + lane);
    }
    t.area_twice = Lanes::load(b.area_twice + lane);
    t.shear = Lanes::load(b.shear + lane);
    t.dilatation = Lanes::load(b.dilatation + lane);
    FRONTALIS_UNROLL
    for (int i = 0; i < 6; ++i)
      t.bending[i] = Lanes::load(b.bending[i] + lane);
    return t;
  }

  static void run(const ShellArguments<Real>& g, std::int32_t first, std::int32_t last)
  {
    for (auto block = first; block < last; ++block)
      for (int lane = 0; lane < Block::width; lane += Lanes::count)
      {
        const Block& b = g.blocks[block];
        Vector u[6];
        FRONTALIS_UNROLL
        for (int i = 0; i < 6; ++i)
          u[i] = { Lanes::gather(g.u[0], b.vertex[i] + lane), Lanes::gather(g.u[1], b.vertex[i] + lane),
                   Lanes::gather(g.u[2], b.vertex[i] + lane) };
        const auto out = physics::shell_forces(load(b, lane), u);
        Real* const force = g.forces + std::ptrdiff_t{ block } * 18 * Block::width + lane;
        FRONTALIS_UNROLL
        for (int i = 0; i < 6; ++i)
        {
          Lanes::store(out.force[i].x, force + (3 * i) * Block::width);
          Lanes::store(out.force[i].y, force + (3 * i + 1) * Block::width);
          Lanes::store(out.force[i].z, force + (3 * i + 2) * Block::width);
        }
      }
  }
};

}  // namespace frontalis
