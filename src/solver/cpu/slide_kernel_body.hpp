#pragma once

#include "frontalis/physics/sliding.hpp"
#include "solver/cpu/simd_number.hpp"
#include "solver/cpu/slide_kernel.hpp"

namespace frontalis
{

// The architecture is part of every type, so that code for different instruction sets shares no template instantiation.
template <class Architecture>
struct SlideKernelBody
{
  using Block = SlidingBlock<float>;
  using Batch = xsimd::batch<float, Architecture>;
  using Vector = physics::Vec3<Batch>;
  static constexpr int lanes = static_cast<int>(Batch::size);
  static_assert(Block::width % lanes == 0, "a block is a whole number of batches");

  static FRONTALIS_LAW Batch load(const float* p) { return Batch::load_unaligned(p); }
  static FRONTALIS_LAW Vector load(const float* x, const float* y, const float* z)
  {
    return { load(x), load(y), load(z) };
  }

  static void renew(const SlideArguments<float>& g, std::int32_t block, int offset, float* const u[3],
                    float* const v[3], const Batch& excess)
  {
    float lane[lanes];
    excess.store_unaligned(lane);
    for (int l = 0; l < lanes; ++l)
      if (lane[l] > 0)
      {
        const float at[3] = { u[0][offset + l], u[1][offset + l], u[2][offset + l] };
        float with[3] = { v[0][offset + l], v[1][offset + l], v[2][offset + l] };
        g.renew(g.context, block, offset + l, at, with);
        for (int axis = 0; axis < 3; ++axis)
          v[axis][offset + l] = with[axis];
      }
  }

  static void slide(const SlideArguments<float>& g, std::int32_t block, float* const u[3], float* const v[3])
  {
    Block& b = g.blocks[block];
    for (int l = 0; l < Block::width; l += lanes)
    {
      Vector at = load(u[0] + l, u[1] + l, u[2] + l);
      const Vector slip = at - load(b.reference[0] + l, b.reference[1] + l, b.reference[2] + l);
      const Batch excess = dot(slip, slip) - load(b.slip_squared + l);
      if (xsimd::any(excess > Batch(0.0f)))
        renew(g, block, l, u, v, excess);
      Vector velocity = load(v[0] + l, v[1] + l, v[2] + l);
      const Vector normal = load(b.normal[0] + l, b.normal[1] + l, b.normal[2] + l);
      physics::slide(normal, load(b.offset + l), at, velocity);
      velocity = velocity + load(b.speed + l) * normal;
      at.x.store_unaligned(u[0] + l);
      at.y.store_unaligned(u[1] + l);
      at.z.store_unaligned(u[2] + l);
      velocity.x.store_unaligned(v[0] + l);
      velocity.y.store_unaligned(v[1] + l);
      velocity.z.store_unaligned(v[2] + l);
    }
  }

  static void run(const SlideArguments<float>& g, std::int32_t first, std::int32_t last)
  {
    for (auto block = first; block < last; ++block)
    {
      const std::int32_t node = g.node[block], count = g.count[block];
      float* const u[3] = { g.u[0] + node, g.u[1] + node, g.u[2] + node };
      float* const v[3] = { g.v[0] + node, g.v[1] + node, g.v[2] + node };
      if (count == Block::width)
      {
        slide(g, block, u, v);
        continue;
      }
      // The nodes beyond the block belong to another thread, so that the loop works on a padded copy.
      float copy[6][Block::width] = {};
      float* const u_copy[3] = { copy[0], copy[1], copy[2] };
      float* const v_copy[3] = { copy[3], copy[4], copy[5] };
      for (int axis = 0; axis < 3; ++axis)
        for (std::int32_t l = 0; l < count; ++l)
        {
          u_copy[axis][l] = u[axis][l];
          v_copy[axis][l] = v[axis][l];
        }
      slide(g, block, u_copy, v_copy);
      for (int axis = 0; axis < 3; ++axis)
        for (std::int32_t l = 0; l < count; ++l)
        {
          u[axis][l] = u_copy[axis][l];
          v[axis][l] = v_copy[axis][l];
        }
    }
  }
};

}  // namespace frontalis
