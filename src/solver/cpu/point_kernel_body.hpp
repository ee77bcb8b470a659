#pragma once

#include "solver/cpu/bound_lanes.hpp"
#include "solver/cpu/record_lanes.hpp"
#include "solver/cpu/point_kernel.hpp"
#include "solver/cpu/prefetch.hpp"

#include <cmath>
#include <utility>

namespace frontalis
{

// The architecture is part of every type, so that code for different instruction sets shares no template instantiation.
template <class Architecture>
struct PointKernelBody
{
  using Lanes = RecordLanes<Architecture>;
  using Batch = typename Lanes::Batch;
  using Vector = typename Lanes::Vector;
  using Block = PointBlock<float>;
  using Body = PosedBody<float>;
  static_assert(Block::width % Lanes::count == 0, "a block is a whole number of batches");

  static FRONTALIS_LAW Vector place(const Block& b, const float* const u[3], int lane)
  {
    const Vector rest{ Lanes::load(b.rest[0] + lane), Lanes::load(b.rest[1] + lane), Lanes::load(b.rest[2] + lane) };
    return displaced<Lanes>(rest, b, u, lane);
  }

  // Position in the body's frame, relative to the origin of the body's field [spacings of its samples].
  static FRONTALIS_LAW Vector inwards(const Body& body, const Vector& place)
  {
    const float* const r = body.rotation;
    const Vector p = place - Vector{ body.translation[0], body.translation[1], body.translation[2] };
    const auto along = [&](int axis)
    { return body.inverse_spacing * (r[axis] * p.x + r[axis + 3] * p.y + r[axis + 6] * p.z - body.origin[axis]); };
    return { along(0), along(1), along(2) };
  }

  // The samples of a batch of points, in the form that physics::spline() reads. There is no loop, because the compiler
  // would make it a copy through memory.
  struct Samples
  {
    Batch value[27];
  };
  template <std::size_t... n>
  static FRONTALIS_LAW Samples samples_at(const float* first, std::index_sequence<n...>)
  {
    return { { Lanes::load(first + n * Block::width)... } };
  }

  // Copies the samples of the cells that the points of `lanes` have entered into the block.
  static void enter(Block& b, int lane, std::uint32_t lanes, const Body* bodies, const Vector& cell)
  {
    alignas(64) float at[3][Lanes::count];
    Lanes::store(cell.x, at[0]);
    Lanes::store(cell.y, at[1]);
    Lanes::store(cell.z, at[2]);
    const float* first[Lanes::count];
    for (auto rest = lanes; rest != 0; rest &= rest - 1)
    {
      const int l = __builtin_ctz(rest);
      std::int32_t whole[3];
      for (int axis = 0; axis < 3; ++axis)
      {
        b.cell[axis][lane + l] = at[axis][l];
        whole[axis] = std::abs(at[axis][l]) < 1e9f ? static_cast<std::int32_t>(at[axis][l]) : -1000000000;
      }
      const physics::DistanceField& field = *bodies[static_cast<int>(b.body[lane + l])].field;
      first[l] = field.radius > 0 ? nullptr : field.around(whole);
      prefetch_samples(first[l]);
    }
    for (auto rest = lanes; rest != 0; rest &= rest - 1)
    {
      const int l = __builtin_ctz(rest);
      for (int n = 0; n < 27; ++n)
        b.samples[n][lane + l] = first[l] == nullptr ? Block::none : physics::gather_one(first[l], n);
    }
  }

  static FRONTALIS_LAW physics::FieldValue<Batch> sample(Block& b, int lane, const Vector& x, std::uint32_t wanted,
                                                         const Body* bodies)
  {
    const Batch half(0.5f);
    const Vector cell{ xsimd::floor(x.x + half), xsimd::floor(x.y + half), xsimd::floor(x.z + half) };
    const auto kept = cell.x == Lanes::load(b.cell[0] + lane) && cell.y == Lanes::load(b.cell[1] + lane) &&
                      cell.z == Lanes::load(b.cell[2] + lane);
    if (!xsimd::all(kept))
      if (const auto entered = Lanes::positive(xsimd::select(kept, Batch(0.0f), Batch(1.0f))) & wanted >> lane;
          entered != 0)
        enter(b, lane, entered, bodies, cell);
    return physics::spline(samples_at(b.samples[0] + lane, std::make_index_sequence<27>()), Batch(1.0f), x - cell);
  }

  static FRONTALIS_LAW void store(const Vector& x, float (&to)[3][Block::width], int lane)
  {
    Lanes::store(x.x, to[0] + lane);
    Lanes::store(x.y, to[1] + lane);
    Lanes::store(x.z, to[2] + lane);
  }

  static void run(Block& b, const float* const u[3], const Body* bodies, std::uint32_t wanted,
                  PointPlaces<float>& places)
  {
    for (int lane = 0; lane < Block::width; lane += Lanes::count)
    {
      const Vector p = place(b, u, lane);
      Vector x = inwards(bodies[b.first_body], p);
      for (auto body = b.first_body + 1; body <= b.last_body; ++body)
      {
        const auto same = Lanes::load(b.body + lane) == Batch(static_cast<float>(body));
        const Vector other = inwards(bodies[body], p);
        x = { xsimd::select(same, other.x, x.x), xsimd::select(same, other.y, x.y), xsimd::select(same, other.z, x.z) };
      }
      const auto value = sample(b, lane, x, wanted, bodies);
      Lanes::store(value.value, places.distance + lane);
      store(value.gradient, places.gradient, lane);
      store(x, places.offset, lane);
    }
  }
};

}  // namespace frontalis
