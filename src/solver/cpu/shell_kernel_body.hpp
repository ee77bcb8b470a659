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
  static_assert(Block::width % Lanes::count == 0 && WeightedSums<Real>::width % Lanes::count == 0,
                "a block is a whole number of batches");

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

  static void forces(const Block* blocks, const ConstComponents<Real>& from, Real* out, std::int32_t first,
                     std::int32_t last)
  {
    for (auto block = first; block < last; ++block)
      for (int lane = 0; lane < Block::width; lane += Lanes::count)
      {
        const Block& b = blocks[block];
        Vector u[6];
        FRONTALIS_UNROLL
        for (int i = 0; i < 6; ++i)
          u[i] = gathered(from, b.vertex[i] + lane);
        const auto reaction = physics::shell_forces(load(b, lane), u);
        Real* const force = out + std::ptrdiff_t{ block } * 18 * Block::width + lane;
        FRONTALIS_UNROLL
        for (int i = 0; i < 6; ++i)
          store(reaction.force[i], { force + (3 * i) * Block::width, force + (3 * i + 1) * Block::width,
                                     force + (3 * i + 2) * Block::width });
      }
  }

  static void sum(const WeightedSums<Real>& sums, const ConstComponents<Real>& in, const Components<Real>& out,
                  std::int32_t first, std::int32_t last)
  {
    constexpr int width = WeightedSums<Real>::width;
    for (auto block = first; block < last; ++block)
      for (int lane = 0; lane < width; lane += Lanes::count)
      {
        const Batch none = physics::Number<Batch>::of(0);
        Vector sum{ none, none, none };
        for (auto r = sums.begin[block]; r < sums.begin[block + 1]; ++r)
          sum = sum + Lanes::load(sums.rows[r].weight + lane) * gathered(in, sums.rows[r].index + lane);
        const std::ptrdiff_t at = std::ptrdiff_t{ block } * width + lane;
        store(sum, { out[0] + at, out[1] + at, out[2] + at });
      }
  }

private:
  static FRONTALIS_LAW Vector gathered(const ConstComponents<Real>& from, const std::int32_t* index)
  {
    return { Lanes::gather(from[0], index), Lanes::gather(from[1], index), Lanes::gather(from[2], index) };
  }
  static FRONTALIS_LAW void store(const Vector& v, const Components<Real>& out)
  {
    Lanes::store(v.x, out[0]);
    Lanes::store(v.y, out[1]);
    Lanes::store(v.z, out[2]);
  }
};

}  // namespace frontalis
