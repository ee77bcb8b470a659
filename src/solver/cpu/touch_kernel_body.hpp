#pragma once

#include "frontalis/physics/surface_touch.hpp"
#include "frontalis/physics/surface_vertex.hpp"
#include "solver/cpu/prefetch.hpp"
#include "solver/cpu/touch_kernel.hpp"

#include <algorithm>

namespace frontalis
{

/// The kernels of contact between surfaces. `Lanes` loads, gathers and stores batches; it is part of every type, so
/// that code for different instruction sets shares no template instantiation.
template <class Lanes>
struct TouchKernelBody
{
  using Real = typename Lanes::Real;
  using Batch = typename Lanes::Batch;
  using Number = physics::Number<Batch>;
  using Vector = physics::Vec3<Batch>;
  using Moved = MovedVertices<Real>;
  static_assert(touch_width % Lanes::count == 0, "a block is a whole number of batches");

  template <class Pointers>
  static FRONTALIS_LAW Vector load(const Pointers& p, std::ptrdiff_t lane)
  {
    return { Lanes::load(p[0] + lane), Lanes::load(p[1] + lane), Lanes::load(p[2] + lane) };
  }
  template <class Pointers>
  static FRONTALIS_LAW void store(const Vector& v, Pointers&& p, std::ptrdiff_t lane)
  {
    Lanes::store(v.x, p[0] + lane);
    Lanes::store(v.y, p[1] + lane);
    Lanes::store(v.z, p[2] + lane);
  }

  // Components of the dual vectors of tangent t, for the vertices that begin at index `at`.
  static FRONTALIS_LAW std::array<Real*, 3> dual(const Moved& vertices, std::ptrdiff_t at, int t)
  {
    Real* const first = vertices.dual + (6 * (at / touch_width) + 3 * t) * touch_width + at % touch_width;
    return { first, first + touch_width, first + 2 * touch_width };
  }

  // Loads vectors from consecutive records.
  static FRONTALIS_LAW Vector consecutive(const Real* p, std::ptrdiff_t stride)
  {
    std::int32_t index[Lanes::count];
    for (int l = 0; l < Lanes::count; ++l)
      index[l] = l;
    return Lanes::gather_records(p, stride, index);
  }
  static FRONTALIS_LAW void store_as_records(const Vector& v, Real* p, std::ptrdiff_t stride)
  {
    alignas(64) Real records[4 * Lanes::count];
    Lanes::store_records(v, records);
    for (int l = 0; l < Lanes::count; ++l)
      Lanes::copy_record(records + Lanes::record(l), p + l * stride);
  }
  static FRONTALIS_LAW physics::SideWeights<Batch> weights(const VertexBlock<Real>& b, int lane)
  {
    return { Lanes::load(b.coordinates[0] + lane), Lanes::load(b.coordinates[1] + lane),
             Lanes::load(b.coordinates[2] + lane) };
  }
  static FRONTALIS_LAW Vector inverse_spacing(const VertexBlock<Real>& b)
  {
    return { Batch(b.inverse_spacing[0]), Batch(b.inverse_spacing[1]), Batch(b.inverse_spacing[2]) };
  }

  static void place(const VertexBlock<Real>* blocks, const Moved& vertices, const std::array<const Real*, 3>& u,
                    std::int32_t first, std::int32_t last)
  {
    for (auto block = first; block < last; ++block)
    {
      // Meanwhile voxels have displaced the blocks from the cache of a core.
      prefetch(blocks + block + 1);
      for (int lane = 0; lane < touch_width; lane += Lanes::count)
        place(blocks[block], vertices, u, lane, std::ptrdiff_t{ block } * touch_width + lane);
    }
  }

  static FRONTALIS_LAW void place(const VertexBlock<Real>& b, const Moved& vertices,
                                  const std::array<const Real*, 3>& u, int lane, std::ptrdiff_t at)
  {
    const Vector tangent[2] = { load(b.tangent[0], lane), load(b.tangent[1], lane) };
    const auto vertex = physics::surface_vertex(weights(b, lane), tangent, inverse_spacing(b),
                                                [&](int two, Vector& low, Vector& high)
                                                {
                                                  const std::int32_t* const node = b.node[two] + lane;
                                                  Lanes::gather_two(u[0], node, low.x, high.x);
                                                  Lanes::gather_two(u[1], node, low.y, high.y);
                                                  Lanes::gather_two(u[2], node, low.z, high.z);
                                                });
    for (int t = 0; t < 2; ++t)
      store(vertex.dual[t], dual(vertices, at, t), 0);
    if (vertices.change != nullptr)
      store_as_records(vertex.displacement - consecutive(vertices.record + at * Moved::stride, Moved::stride),
                       vertices.change + 4 * at, 4);
    store_as_records(vertex.displacement, vertices.record + at * Moved::stride, Moved::stride);
    store_as_records(vertex.normal, vertices.record + at * Moved::stride + 4, Moved::stride);
  }

  static FRONTALIS_LAW Vector moved(const Moved& vertices, const std::int32_t* index)
  {
    return Lanes::gather_records(vertices.record, Moved::stride, index);
  }
  static FRONTALIS_LAW Vector normal(const Moved& vertices, const std::int32_t* index)
  {
    return Lanes::gather_records(vertices.record + 4, Moved::stride, index);
  }

  // The triangle, and the pair's vertex, relative to the triangle's corner 0. Differences of positions are then exact.
  static FRONTALIS_LAW physics::SurfaceTriangle<Batch> triangle(const PairVertices& at, const PairBlock<Real>& b,
                                                                const Moved& vertices, int lane, Vector& point)
  {
    const Batch none = Number::of(0);
    physics::SurfaceTriangle<Batch> out;
    const Vector origin = moved(vertices, at.vertex[1] + lane);
    out.corner[0] = { none, none, none };
    point = load(b.rest[0], lane) + (moved(vertices, at.vertex[0] + lane) - origin);
    for (int i = 1; i < 3; ++i)
      out.corner[i] = load(b.rest[i], lane) + (moved(vertices, at.vertex[i + 1] + lane) - origin);
    for (int i = 0; i < 3; ++i)
      out.normal[i] = normal(vertices, at.vertex[i + 1] + lane);
    return out;
  }

  // Moves pairs whose foot is beyond an edge by more than `edge_error` to the next triangle. Returns whether a pair
  // moved.
  static bool go_on(const PairArguments<Real>& g, std::int32_t block, int lane, const Batch (&weight)[3])
  {
    PairBlock<Real>& b = g.pairs[block];
    Batch beyond = Number::of(0);
    for (int i = 0; i < 3; ++i)
      beyond = Number::max(beyond, Lanes::load(b.inner[i] + lane) * (Number::of(-edge_error) - weight[i]));
    if (!Lanes::any_positive(beyond))
      return false;
    alignas(64) Real excess[Lanes::count];
    Lanes::store(beyond, excess);
    for (int l = 0; l < Lanes::count; ++l)
      if (excess[l] > 0 && g.pair_vertices[block].triangle[lane + l] >= 0)
        g.go_on(g.context, block, lane + l);
    return true;
  }

  static FRONTALIS_LAW Vector change(const Moved& vertices, const std::int32_t* index)
  {
    return Lanes::gather_records(vertices.change, 4, index);
  }

  struct Result
  {
    Batch wait;             // motion after which the pairs must be checked again [m]
    std::uint32_t touches;  // bits of the lanes that touch
    bool loses;             // whether friction dissipates energy
  };

  template <bool rubs>
  static FRONTALIS_LAW Result touch(const PairArguments<Real>& g, std::int32_t block, int lane)
  {
    const PairVertices& at = g.pair_vertices[block];
    PairBlock<Real>& b = g.pairs[block];
    PairForceBlock<Real>& out = g.forces[block];
    const Batch none = Number::of(0);
    Vector point;
    auto corners = triangle(at, b, g.vertices, lane, point);
    auto foot = physics::surface_foot(corners, point);
    if (go_on(g, block, lane, foot.weight))
    {
      corners = triangle(at, b, g.vertices, lane, point);
      foot = physics::surface_foot(corners, point);
    }
    physics::TouchingPair<Batch> pair{
      Lanes::load(b.stiffness + lane), {}, {}, Lanes::load(b.overlap + lane), Lanes::load(b.friction + lane)
    };
    for (int i = 0; i < 3; ++i)
    {
      pair.softer[i] = Lanes::load(b.softer[i] + lane);
      pair.inner[i] = Lanes::load(b.inner[i] + lane);
    }
    const Batch gap = foot.gap - pair.overlap;
    const Batch whole = pair_stiffness(pair, foot, normal(g.vertices, at.vertex[0] + lane));
    const Batch stiffness =
        Number::select(gap < none, Number::select(gap > Number::of(-double(g.deepest)), whole, none), none);
    physics::PairGrip<Batch> grip{ Lanes::load(b.held + lane), none, none, { none, none, none } };
    Vector slip{ none, none, none };
    if constexpr (rubs)
    {
      grip.pressed = Lanes::load(b.pressed + lane);
      grip.along = Lanes::load(b.along + lane);
      grip.stretch = load(b.stretch, lane);
      slip = change(g.vertices, at.vertex[0] + lane);
      for (int i = 0; i < 3; ++i)
        slip = slip - carried(foot, i, change(g.vertices, at.vertex[i + 1] + lane));
    }
    const auto force =
        physics::touch_pair<rubs>(pair, corners, foot, gap, stiffness, slip, Number::of(double(g.response)), grip);
    const Batch open = Number::select(gap > none, Number::of(0.5) * gap, Number::of(double(g.patience)));
    const Batch wait = Number::select(stiffness > none, none, Number::select(grip.pressed > none, none, open));
    Lanes::store(grip.stiffness, b.held + lane);
    if constexpr (rubs)
    {
      Lanes::store(grip.pressed, b.pressed + lane);
      Lanes::store(grip.along, b.along + lane);
      store(grip.stretch, b.stretch, lane);
    }
    Lanes::store(force.stored, out.stored + lane);
    for (int i = 0; i < 3; ++i)
    {
      Lanes::store_records(force.corner[i], out.corner[i] + 4 * lane);
      Lanes::store_records(force.turn[i], out.turn[i] + 4 * lane);
    }
    bool loses = false;
    if constexpr (rubs)
    {
      Lanes::store(force.lost, out.lost + lane);
      loses = Lanes::any_positive(force.lost * force.lost);
    }
    return { wait, Lanes::positive(stiffness), loses };
  }

  static void touch(const PairArguments<Real>& g, std::int32_t first, std::int32_t last)
  {
    for (auto block = first; block < last; ++block)
    {
      if (g.due[block] > g.way)
        continue;
      // Meanwhile voxels have displaced the blocks from the cache of a core.
      prefetch(g.pair_vertices + block + 1);
      prefetch(g.pairs + block + 1);
      prefetch<true>(g.forces + block + 1);
      Batch all = Number::of(1e30);
      std::uint32_t touches = 0;
      for (int lane = 0; lane < touch_width; lane += Lanes::count)
      {
        const Result result = g.rubs ? touch<true>(g, block, lane) : touch<false>(g, block, lane);
        all = Number::min(all, result.wait);
        touches |= result.touches << lane | (result.loses ? 1U << touch_width : 0U);
      }
      alignas(64) Real wait[Lanes::count];
      Lanes::store(all, wait);
      Real least = touches != 0 ? 0 : wait[0];
      for (int l = 1; l < Lanes::count && touches == 0; ++l)
        least = least < wait[l] ? least : wait[l];
      g.due[block] = g.way + double(least);
      g.touches[block] = touches;
    }
  }

  static void spread(const VertexBlock<Real>* blocks, const Moved& vertices, Real* sums, Real* node_forces,
                     std::int32_t block, std::int32_t first_plane, std::int32_t end_plane)
  {
    const VertexBlock<Real>& b = blocks[block];
    const std::ptrdiff_t first = std::ptrdiff_t{ block } * touch_width;
    const Batch none = Number::of(0);
    alignas(64) Real part[8][4 * Lanes::count];
    for (int lane = 0; lane < touch_width; lane += Lanes::count)
    {
      const std::ptrdiff_t at = first + lane;
      const Vector force = consecutive(sums + 8 * at, 8), turn = consecutive(sums + 8 * at + 4, 8);
      const Vector direction = consecutive(vertices.record + Moved::stride * at + 4, Moved::stride);
      for (int row = 0; row < 8; ++row)
        Lanes::store(none, sums + 8 * at + row * Lanes::count);
      const Vector tangent[2] = { load(b.tangent[0], lane), load(b.tangent[1], lane) };
      const Vector along = physics::normal_forces(turn, load(dual(vertices, at, 0), 0), load(dual(vertices, at, 1), 0),
                                                  tangent, inverse_spacing(b));
      const auto w = weights(b, lane);
      for (int corner = 0; corner < 8; ++corner)
        Lanes::store_records(physics::surface_node_force(w, corner, force, along, direction), part[corner]);
      for (int l = 0; l < Lanes::count; ++l)
      {
        const std::int32_t plane = b.plane[lane + l];
        const auto add = [&](int two)
        {
          Real* const to = node_forces + 4 * std::ptrdiff_t{ b.bound[two][lane + l] };
          Lanes::add_record(part[2 * two] + Lanes::record(l), to);
          Lanes::add_record(part[2 * two + 1] + Lanes::record(l), to + 4);
        };
        if (plane >= first_plane && plane < end_plane)  // the nodes are in the lower plane of the voxel
        {
          add(0);
          add(1);
        }
        if (plane + 1 >= first_plane && plane + 1 < end_plane)
        {
          add(2);
          add(3);
        }
      }
    }
  }

  static std::uint32_t near(const BallBlock<Real>& balls, const FacetBlock<Real>* facets, const Real* point,
                            const Real* normal)
  {
    const Vector p{ Batch(point[0]), Batch(point[1]), Batch(point[2]) };
    const Vector n{ Batch(normal[0]), Batch(normal[1]), Batch(normal[2]) };
    const Batch none = Number::of(0), whole = Number::of(1);
    std::uint32_t bits = 0;
    for (int lane = 0; lane < touch_width; lane += Lanes::count)
    {
      const Vector way = p - load(balls.centre, lane);
      std::uint32_t near = Lanes::positive(Lanes::load(balls.farthest + lane) - dot(way, way)) &
                           Lanes::positive(whole - dot(load(balls.away, lane), n));
      if (near != 0 && facets != nullptr)
      {
        const Batch above = dot(way, load(facets->normal, lane)), height = Number::max(above, none - above);
        const Batch one = dot(way, load(facets->slope[0], lane)), two = dot(way, load(facets->slope[1], lane));
        const auto lean = [&](int i) { return Lanes::load(facets->lean[i] + lane) * height; };
        const Batch least = Number::min(lean(0) - one - two, Number::min(lean(1) + one, lean(2) + two));
        near &= Lanes::positive(least + Number::of(1.0 / 3) + Lanes::load(facets->beyond + lane)) &
                Lanes::positive(Lanes::load(facets->highest + lane) - above);
      }
      bits |= near << lane;
    }
    return bits;
  }

  // Squared length of the vector of lower bounds of the distance between a box and those of a block or, with
  // `farthest`, of upper bounds.
  template <bool farthest>
  static FRONTALIS_LAW Batch between(const typename GroupBoxes<Real>::Boxes& one, int at,
                                     const typename GroupBoxes<Real>::Boxes& others, int lane)
  {
    const Batch none = Number::of(0);
    Batch squared = none;
    for (int axis = 0; axis < 3; ++axis)
    {
      const Batch above = farthest ? Lanes::load(others.most[axis] + lane) - Batch(one.least[axis][at])
                                   : Lanes::load(others.least[axis] + lane) - Batch(one.most[axis][at]);
      const Batch below = farthest ? Batch(one.most[axis][at]) - Lanes::load(others.least[axis] + lane)
                                   : Batch(one.least[axis][at]) - Lanes::load(others.most[axis] + lane);
      const Batch longer = Number::max(none, Number::max(above, below));
      squared = squared + longer * longer;
    }
    return squared;
  }

  static std::uint32_t approach(const GroupBoxes<Real>& one, int at, const GroupBoxes<Real>& others, Real reach,
                                Real enough, Real (&largest)[touch_width])
  {
    std::uint32_t bits = 0;
    for (int lane = 0; lane < touch_width; lane += Lanes::count)
    {
      const Batch apart = Number::sqrt(between<false>(one.place, at, others.place, lane));
      const Batch way = Number::sqrt(between<true>(one.way, at, others.way, lane));
      const Batch value = Number::min(way, Batch(reach) - apart);
      bits |= Lanes::positive(value - Batch(enough)) << lane;
      const Batch most = Lanes::load(largest + lane);
      Lanes::store(Number::select(value > Batch(enough), most, Number::max(most, value)), largest + lane);
    }
    return bits;
  }

  static TouchKernels<Real> kernels()
  {
    TouchKernels<Real> kernels{ place, touch, spread, near, approach, {} };
    for (int l = 0; l < touch_width; ++l)
      kernels.record[l] = 4 * (l / Lanes::count * Lanes::count) + Lanes::record(l % Lanes::count);
    return kernels;
  }

private:
  // Tolerance in barycentric coordinates. It is above the rounding errors of a foot, so that a point on an edge does
  // not change triangles in every step.
  static constexpr double edge_error = 3e-5;
};

}  // namespace frontalis
