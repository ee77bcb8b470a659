#pragma once

#include "frontalis/physics/shell.hpp"
#include "solver/cpu/bound_lanes.hpp"
#include "solver/cpu/shell_kernel.hpp"

#include <cstring>

namespace frontalis
{

/// The kernels of shells. `Lanes` loads, gathers and stores batches; it is part of every type, so that code for
/// different instruction sets shares no template instantiation.
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
    t.inverse_area = Lanes::load(b.inverse_area + lane);
    t.shear = Lanes::load(b.shear + lane);
    t.dilatation = Lanes::load(b.dilatation + lane);
    FRONTALIS_UNROLL
    for (int i = 0; i < 6; ++i)
      t.bending[i] = Lanes::load(b.bending[i] + lane);
    return t;
  }

  static void place(const ShellVertices<Real>* blocks, const Real* const u[3], ShellVector<Real>* out,
                    std::int32_t first, std::int32_t last)
  {
    const Batch none = physics::Number<Batch>::of(0);
    for (auto block = first; block < last; ++block)
      for (int lane = 0; lane < Block::width; lane += Lanes::count)
        Lanes::store_records(displaced<Lanes>(Vector{ none, none, none }, blocks[block], u, lane),
                             out[std::ptrdiff_t{ block } * Block::width + lane].x);
  }

  static void forces(const Block* blocks, const ShellVector<Real>* from, ShellVector<Real>* out, std::int32_t first,
                     std::int32_t last)
  {
    for (auto block = first; block < last; ++block)
      for (int lane = 0; lane < Block::width; lane += Lanes::count)
      {
        const Block& b = blocks[block];
        Vector u[6];
        FRONTALIS_UNROLL
        for (int i = 0; i < 6; ++i)
          u[i] = Lanes::gather_records(from->x, 4, b.vertex[i] + lane);
        const auto reaction = physics::shell_forces(load(b, lane), u);
        FRONTALIS_UNROLL
        for (int i = 0; i < 6; ++i)
          Lanes::store_records(reaction.force[i], out[(std::ptrdiff_t{ block } * 6 + i) * Block::width + lane].x);
      }
  }

  static void sum(const WeightedSums<Real>& sums, const ShellVector<Real>* in, ShellVector<Real>* out,
                  std::int32_t first, std::int32_t last)
  {
    // A vector type of the compiler, because compilers do not find by themselves that four numbers fit into a register.
    using Four [[gnu::vector_size(4 * sizeof(Real))]] = Real;
    const auto* const terms = sums.terms.data();
    const auto* const begin = sums.begin.data();
    for (auto i = first; i < last; ++i)
    {
      Four sum{};
      for (auto t = begin[i]; t < begin[i + 1]; t += 4)
      {
        Four term[4];
        FRONTALIS_UNROLL
        for (int k = 0; k < 4; ++k)
        {
          std::memcpy(&term[k], &in[terms[t + k].index], sizeof term[k]);
          term[k] *= terms[t + k].weight;
        }
        sum += (term[0] + term[1]) + (term[2] + term[3]);
      }
      std::memcpy(&out[i], &sum, sizeof sum);
    }
  }

  static int place_of_lane(int lane) { return lane - lane % Lanes::count + Lanes::record(lane % Lanes::count) / 4; }

  static ShellKernels<Real> all() { return { place, forces, sum, place_of_lane }; }
};

}  // namespace frontalis
