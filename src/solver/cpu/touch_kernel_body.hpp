#pragma once

#include "frontalis/physics/surface_touch.hpp"
#include "solver/cpu/touch_kernel.hpp"

namespace frontalis
{

/// The kernels, for lanes of a kind that loads, gathers and stores them. The kind is part of every type, so that
/// instruction sets share no template instantiation.
template <class Lanes>
struct TouchKernelBody
{
  using Real = typename Lanes::Real;
  using Batch = typename Lanes::Batch;
  using Number = physics::Number<Batch>;
  using Vector = physics::Vec3<Batch>;
  using Row = Real[touch_width];
  static_assert(touch_width % Lanes::count == 0, "a block is a whole number of batches");

  template <class Pointers>
  static FRONTALIS_LAW Vector load(const Pointers& p, int lane)
  {
    return { Lanes::load(p[0] + lane), Lanes::load(p[1] + lane), Lanes::load(p[2] + lane) };
  }
  template <class Pointers>
  static FRONTALIS_LAW Vector gather(const Pointers& p, const std::int32_t* index)
  {
    return { Lanes::gather(p[0], index), Lanes::gather(p[1], index), Lanes::gather(p[2], index) };
  }
  template <class Pointers>
  static FRONTALIS_LAW void store(const Vector& v, Pointers& p, std::ptrdiff_t lane)
  {
    Lanes::store(v.x, p[0] + lane);
    Lanes::store(v.y, p[1] + lane);
    Lanes::store(v.z, p[2] + lane);
  }

  static void place(const VertexBlock<Real>* blocks, const MovedVertices<Real>& vertices,
                    const std::array<const Real*, 3>& u, std::int32_t first, std::int32_t last)
  {
    const Batch none = Number::of(0);
    for (auto block = first; block < last; ++block)
      for (int lane = 0; lane < touch_width; lane += Lanes::count)
      {
        const VertexBlock<Real>& b = blocks[block];
        const std::ptrdiff_t at = std::ptrdiff_t{ block } * touch_width + lane;
        // displacement, and the tangents
        Vector sum{ none, none, none }, tangent[2] = { load(b.tangent[0], lane), load(b.tangent[1], lane) };
        for (int corner = 0; corner < 8; ++corner)
        {
          const Vector moved = gather(u, b.node[corner] + lane);
          sum = sum + Lanes::load(b.weight[corner] + lane) * moved;
          for (int k = 0; k < 2; ++k)
            tangent[k] = tangent[k] + Lanes::load(b.along[k][corner] + lane) * moved;
        }
        const Vector area = cross(tangent[0], tangent[1]);
        const Batch scale = Number::of(1) / Number::max(norm(area), Number::of(1e-12));
        const Vector normal = scale * area;
        store(load(vertices.u, static_cast<int>(at)), vertices.before, at);
        store(sum, vertices.u, at);
        store(normal, vertices.normal, at);
        store(scale * cross(tangent[1], normal), vertices.dual[0], at);
        store(scale * cross(normal, tangent[0]), vertices.dual[1], at);
      }
  }

  // The triangle relative to its corner 0, which makes differences of places exact.
  static FRONTALIS_LAW physics::SurfaceTriangle<Batch> triangle(const PairBlock<Real>& b,
                                                                const MovedVertices<Real>& vertices, int lane,
                                                                Vector& point)
  {
    const Batch none = Number::of(0);
    physics::SurfaceTriangle<Batch> out;
    const Vector origin = gather(vertices.u, b.vertex[1] + lane);
    out.corner[0] = { none, none, none };
    point = load(b.rest[0], lane) + (gather(vertices.u, b.vertex[0] + lane) - origin);
    for (int i = 1; i < 3; ++i)
      out.corner[i] = load(b.rest[i], lane) + (gather(vertices.u, b.vertex[i + 1] + lane) - origin);
    for (int i = 0; i < 3; ++i)
      out.normal[i] = gather(vertices.normal, b.vertex[i + 1] + lane);
    return out;
  }

  // Lets pairs go on whose foot is farther beyond an edge than rounding errors. Returns whether one did.
  static bool go_on(const PairArguments<Real>& g, std::int32_t block, int lane, const Batch (&weight)[3])
  {
    PairBlock<Real>& b = g.pairs[block];
    Batch beyond = Number::of(0);
    for (int i = 0; i < 3; ++i)
      beyond = Number::max(beyond, Lanes::load(b.inner[i] + lane) * (Number::of(-edge_error) - weight[i]));
    alignas(64) Real excess[Lanes::count];
    Lanes::store(beyond, excess);
    Real any = 0;
    for (int l = 0; l < Lanes::count; ++l)
      any = any > excess[l] ? any : excess[l];
    for (int l = 0; l < Lanes::count && any > 0; ++l)
      if (excess[l] > 0 && b.triangle[lane + l] >= 0)
        g.go_on(g.context, block, lane + l);
    return any > 0;
  }

  static FRONTALIS_LAW Vector change(const MovedVertices<Real>& vertices, const std::int32_t* index)
  {
    return gather(vertices.u, index) - gather(vertices.before, index);
  }

  // Returns the way [m] after which the pairs are to be looked at again, in the lanes of `wait`.
  template <bool rubs>
  static FRONTALIS_LAW void touch(const PairArguments<Real>& g, std::int32_t block, int lane, Real* wait)
  {
    PairBlock<Real>& b = g.pairs[block];
    PairForceBlock<Real>& out = g.forces[block];
    const Batch none = Number::of(0);
    Vector point;
    auto corners = triangle(b, g.vertices, lane, point);
    auto foot = physics::surface_foot(corners, point);
    if (go_on(g, block, lane, foot.weight))
    {
      corners = triangle(b, g.vertices, lane, point);
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
    const Batch whole = pair_stiffness(pair, foot, gather(g.vertices.normal, b.vertex[0] + lane));
    const Batch stiffness =
        Number::select(gap < none, Number::select(gap > Number::of(-double(g.deepest)), whole, none), none);
    physics::PairGrip<Batch> grip{ Lanes::load(b.held + lane), none, none, { none, none, none } };
    Vector slip{ none, none, none };
    if constexpr (rubs)
    {
      grip.pressed = Lanes::load(b.pressed + lane);
      grip.along = Lanes::load(b.along + lane);
      grip.stretch = load(b.stretch, lane);
      slip = change(g.vertices, b.vertex[0] + lane);
      for (int i = 0; i < 3; ++i)
        slip = slip - carried(foot, i, change(g.vertices, b.vertex[i + 1] + lane));
    }
    const auto force =
        physics::touch_pair<rubs>(pair, corners, foot, gap, stiffness, slip, Number::of(double(g.response)), grip);
    const Batch open = Number::select(gap > none, Number::of(0.5) * gap, Number::of(double(g.patience)));
    Lanes::store(Number::select(stiffness > none, none, Number::select(grip.pressed > none, none, open)), wait + lane);
    Lanes::store(grip.stiffness, b.held + lane);
    if constexpr (rubs)
    {
      Lanes::store(grip.pressed, b.pressed + lane);
      Lanes::store(grip.along, b.along + lane);
      store(grip.stretch, b.stretch, lane);
    }
    Lanes::store(force.stored, out.stored + lane);
    Lanes::store(force.lost, out.lost + lane);
    store(force.point, out.point, lane);
    for (int i = 0; i < 3; ++i)
    {
      store(force.corner[i], out.corner[i], lane);
      store(force.turn[i], out.turn[i], lane);
    }
  }

  static void touch(const PairArguments<Real>& g, std::int32_t first, std::int32_t last)
  {
    for (auto block = first; block < last; ++block)
    {
      if (g.due[block] > g.way)
        continue;
      alignas(64) Row wait;
      for (int lane = 0; lane < touch_width; lane += Lanes::count)
        if (g.rubs)
          touch<true>(g, block, lane, wait);
        else
          touch<false>(g, block, lane, wait);
      Real least = wait[0], touches = 0;
      for (int l = 0; l < touch_width; ++l)
      {
        least = least < wait[l] ? least : wait[l];
        touches += g.pairs[block].held[l] + g.forces[block].lost[l];
      }
      g.due[block] = g.way + double(least);
      g.touches[block] = touches != 0 ? 1 : 0;
    }
  }

  static void spread(const VertexBlock<Real>& b, const MovedVertices<Real>& vertices, const VertexSums<Real>& sums,
                     std::int32_t first_vertex, Real* node_forces, std::int32_t first_plane, std::int32_t end_plane)
  {
    const Batch none = Number::of(0);
    alignas(64) Real part[8][3][touch_width];
    for (int lane = 0; lane < touch_width; lane += Lanes::count)
    {
      const int at = first_vertex + lane;
      const Vector force = load(sums.force, at), turn = load(sums.turn, at), normal = load(vertices.normal, at);
      const Vector of_first = dot(turn, load(vertices.dual[0], at)) * normal;
      const Vector of_second = dot(turn, load(vertices.dual[1], at)) * normal;
      store({ none, none, none }, sums.force, at);
      store({ none, none, none }, sums.turn, at);
      for (int corner = 0; corner < 8; ++corner)
        store(Lanes::load(b.weight[corner] + lane) * force - Lanes::load(b.along[0][corner] + lane) * of_first -
                  Lanes::load(b.along[1][corner] + lane) * of_second,
              part[corner], lane);
    }
    for (int l = 0; l < touch_width; ++l)
    {
      // nodes in the lower plane of the voxel, then in the upper one
      const bool lower = b.plane[l] >= first_plane && b.plane[l] < end_plane;
      const bool upper = b.plane[l] + 1 >= first_plane && b.plane[l] + 1 < end_plane;
      for (int corner = lower ? 0 : 4; corner < (upper ? 8 : 4); ++corner)
        for (int axis = 0; axis < 3; ++axis)
          node_forces[4 * b.bound[corner][l] + axis] += part[corner][axis][l];
    }
  }

private:
  // In barycentric coordinates; more than the rounding errors of a foot, so that points on an edge do not go to and
  // fro.
  static constexpr double edge_error = 3e-5;
};

}  // namespace frontalis
