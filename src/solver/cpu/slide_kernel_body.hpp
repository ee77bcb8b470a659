#pragma once

#include "frontalis/physics/element/sliding_node.hpp"
#include "solver/cpu/field_lanes.hpp"
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

  static std::uint32_t waits(const Block& b, float* const u[3])
  {
    std::uint32_t bits = 0;
    for (int l = 0; l < Block::width; l += lanes)
    {
      const Vector slip =
          load(u[0] + l, u[1] + l, u[2] + l) - load(b.reference[0] + l, b.reference[1] + l, b.reference[2] + l);
      const Batch excess = dot(slip, slip) - load(b.slip_squared + l);
      if (xsimd::any(excess > Batch(0.0f)))
        bits |= RecordLanes<Architecture>::positive(excess) << l;
    }
    return bits;
  }

  static void slide(const Block& b, float* const u[3], float* const v[3])
  {
    for (int l = 0; l < Block::width; l += lanes)
    {
      Vector at = load(u[0] + l, u[1] + l, u[2] + l);
      Vector velocity = load(v[0] + l, v[1] + l, v[2] + l);
      const Vector normal = load(b.normal[0] + l, b.normal[1] + l, b.normal[2] + l);
      physics::slide(normal, load(b.offset + l), at, velocity);
      velocity = velocity + load(b.speed + l) * normal;
      store(at, u[0] + l, u[1] + l, u[2] + l);
      store(velocity, v[0] + l, v[1] + l, v[2] + l);
    }
  }

  static void store(const Vector& v, float* x, float* y, float* z)
  {
    v.x.store_unaligned(x);
    v.y.store_unaligned(y);
    v.z.store_unaligned(z);
  }

  static void glide(const SlideArguments<float>& g, std::int32_t block, float* const u[3], float* const v[3])
  {
    const Block& b = g.blocks[block];
    RoughBlock<float>& r = g.rough[block];
    for (int l = 0; l < Block::width; l += lanes)
    {
      const physics::CurvedLevel<Batch> level{ load(b.normal[0] + l, b.normal[1] + l, b.normal[2] + l),
                                               load(b.offset + l),
                                               load(b.reference[0] + l, b.reference[1] + l, b.reference[2] + l),
                                               { load(r.bend[0] + l), load(r.bend[1] + l), load(r.bend[2] + l),
                                                 load(r.bend[3] + l), load(r.bend[4] + l), load(r.bend[5] + l) },
                                               load(r.surface_velocity[0] + l, r.surface_velocity[1] + l,
                                                    r.surface_velocity[2] + l) };
      Vector outward = load(r.outward[0] + l, r.outward[1] + l, r.outward[2] + l);
      Vector at = load(u[0] + l, u[1] + l, u[2] + l), velocity = load(v[0] + l, v[1] + l, v[2] + l);
      Batch pressing = load(r.pressing + l);
      physics::glide(level, Batch(g.rubbing) * load(r.coefficient + l), Batch(g.response), Batch(g.dt), outward,
                     pressing, at, velocity);
      store(outward, r.outward[0] + l, r.outward[1] + l, r.outward[2] + l);
      pressing.store_unaligned(r.pressing + l);
      store(at, u[0] + l, u[1] + l, u[2] + l);
      store(velocity, v[0] + l, v[1] + l, v[2] + l);
    }
  }

  static std::int32_t run(const SlideArguments<float>& g, std::int32_t first, std::int32_t last)
  {
    std::int32_t waiting = 0;
    for (auto block = first; block < last; ++block)
    {
      const std::int32_t node = g.node[block], count = g.count[block];
      float* const u[3] = { g.u[0] + node, g.u[1] + node, g.u[2] + node };
      float* const v[3] = { g.v[0] + node, g.v[1] + node, g.v[2] + node };
      const bool whole = count == Block::width;
      // The nodes beyond the block belong to another thread, so that the loops work on a padded copy.
      float copy[6][Block::width];
      float* const u_copy[3] = { copy[0], copy[1], copy[2] };
      float* const v_copy[3] = { copy[3], copy[4], copy[5] };
      for (int axis = 0; axis < 3 && !whole; ++axis)
        for (std::int32_t l = 0; l < Block::width; ++l)
        {
          u_copy[axis][l] = l < count ? u[axis][l] : 0;
          v_copy[axis][l] = l < count ? v[axis][l] : 0;
        }
      if (const auto bits = g.waiting == nullptr ? 0 : waits(g.blocks[block], whole ? u : u_copy); bits != 0)
      {
        g.waiting[waiting++] = { block, bits };
        continue;
      }
      if (g.rough != nullptr)
        glide(g, block, whole ? u : u_copy, whole ? v : v_copy);
      else
        slide(g.blocks[block], whole ? u : u_copy, whole ? v : v_copy);
      for (int axis = 0; axis < 3 && !whole; ++axis)
        for (std::int32_t l = 0; l < count; ++l)
        {
          u[axis][l] = u_copy[axis][l];
          v[axis][l] = v_copy[axis][l];
        }
    }
    return waiting;
  }

  static void planes(PlaneBatch& b)
  {
    using Field = FieldLanes<Architecture>;
    for (int l = 0; l < PlaneBatch::width; l += lanes)
    {
      const auto value = physics::spline(Field::samples(b.first + l), load(b.inverse_spacing + l),
                                         load(b.place[0] + l, b.place[1] + l, b.place[2] + l));
      const Batch slope = norm(value.gradient);
      const auto plane = physics::level_plane(value, load(b.level + l), slope);
      store(plane.normal, b.normal[0] + l, b.normal[1] + l, b.normal[2] + l);
      const Batch bend[6] = {
        plane.bend.xx, plane.bend.yy, plane.bend.zz, plane.bend.xy, plane.bend.xz, plane.bend.yz
      };
      for (int i = 0; i < 6; ++i)
        bend[i].store_unaligned(b.bend[i] + l);
      plane.distance.store_unaligned(b.distance + l);
      plane.slip.store_unaligned(b.slip + l);
      slope.store_unaligned(b.slope + l);
    }
  }

  static SlideKernels<float> kernels() { return { run, planes }; }
};

}  // namespace frontalis
