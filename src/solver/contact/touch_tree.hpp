#pragma once

#include "frontalis/physics/surface_foot.hpp"
#include "solver/contact/touch_search.hpp"
#include "solver/cpu/touch_kernel.hpp"
#include "solver/stepping/array_list.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace frontalis
{

/// A tree of balls that finds the triangles near a vertex in SIMD lanes, and how far vertices and triangles have
/// approached each other since. A block has `touch_width` triangles with the balls around them, and a block of the next
/// level the balls around as many blocks. Which triangles form a block is chosen at rest and stays: they are neighbours
/// that face the same way, so that their ball is small however the tissue moves.
template <class Real>
class TouchTree
{
public:
  using Vector = physics::Vec3<double>;
  using Corners = std::array<std::int32_t, 3>;
  struct Triangle
  {
    physics::SurfaceTriangle<double> at;  // corners [m] and normals at them
    bool rim;                             // whether an edge has no neighbour, so that vertices beyond it may touch
  };

  /// Chooses the blocks. `corners`: vertices of each triangle. `span`: distance [m] that separates triangles as much as
  /// normals with a difference of length 1.
  void make(const std::vector<Triangle>& at_rest, const std::vector<Corners>& corners, double span);
  void list_arrays(ArrayList& list, Effect effect);
  void reset();
  /// Sets the present triangles; of(t) returns triangle t. `reach`: distance [m] up to which a vertex is near.
  template <class Of>
  void place(double reach, const Of& of)
  {
    placed_[0] = { reach, reach };
    for (std::size_t n = 0; n < order_.size(); ++n)
      place_triangle(n, of(order_[n]));
    place_blocks();
  }
  /// Largest distance [m] from the centre of a triangle at which a vertex is near.
  double largest() const { return placed_[0].largest; }
  /// Calls visit(t) at least for all triangles that a vertex at p may touch: it is near, its foot is in the triangle or
  /// beyond a rim, and the two normals do not point the same way. Positions and normals of the vertex and the triangles
  /// may have changed a little since place(). The order of the calls depends on the blocks alone.
  template <class Visit>
  void near(const TouchKernels<Real>& kernels, const Vector& p, const Vector& normal, const Visit& visit) const
  {
    const Real point[3] = { Real(p.x), Real(p.y), Real(p.z) };
    const Real direction[3] = { Real(normal.x), Real(normal.y), Real(normal.z) };
    if (!levels_.empty())
      descend(kernels, levels_.size() - 1, 0, point, direction, visit);
  }
  /// Returns an upper bound of how far vertices and triangles that are within `reach` of each other have approached
  /// each other, counting only the way within the reach [m]. place_of(v) and way_of(v) return the present position of
  /// vertex v and its displacement. The bound is closer if it would be above `enough`: then it compares triangles, not
  /// only blocks.
  template <class Place, class Way>
  double approach(const TouchKernels<Real>& kernels, double reach, double enough, const Place& place_of,
                  const Way& way_of)
  {
    for (std::size_t b = 0; b + 1 < begin_.size(); ++b)
    {
      set_boxes(blocks_[b / touch_width], b % touch_width, vertices_.data() + begin_[b],
                vertices_.data() + begin_[b + 1], place_of, way_of);
      boxed_[b] = 0;
    }
    const auto boxes = [&](std::size_t b) -> const GroupBoxes<Real>&
    {
      for (std::size_t n = touch_width * b; boxed_[b] == 0 && n < std::min(touch_width * (b + 1), corners_.size()); ++n)
        set_boxes(triangles_[b], n % touch_width, corners_[n].data(), corners_[n].data() + 3, place_of, way_of);
      boxed_[b] = 1;
      return triangles_[b];
    };
    return compare(kernels, static_cast<Real>(reach), static_cast<Real>(enough), boxes);
  }

private:
  struct Placed
  {
    double largest = 1, reach = 0;  // [m]
  };

  template <class Visit>
  void descend(const TouchKernels<Real>& kernels, std::size_t level, std::size_t block, const Real* point,
               const Real* direction, const Visit& visit) const
  {
    const FacetBlock<Real>* const facets = level == 0 ? &facets_[block] : nullptr;
    std::uint32_t bits = kernels.near(balls_[levels_[level] + block], facets, point, direction);
    for (; bits != 0; bits &= bits - 1)
    {
      const std::size_t below = block * touch_width + static_cast<std::size_t>(__builtin_ctz(bits));
      if (level == 0)
        visit(order_[below]);
      else
        descend(kernels, level - 1, below, point, direction, visit);
    }
  }
  void place_triangle(std::size_t n, const Triangle& triangle);
  void set_ball(std::size_t ball, const Vector& centre, double farthest, const Vector& normal);
  void place_blocks();
  // Sets the boxes in a lane to those around vertices.
  template <class Place, class Way>
  static void set_boxes(GroupBoxes<Real>& boxes, std::size_t lane, const std::int32_t* first, const std::int32_t* last,
                        const Place& place_of, const Way& way_of)
  {
    const auto set = [&](auto& box, const auto& of)
    {
      std::array<Real, 3> least = of(*first), most = least;
      for (const std::int32_t* v = first + 1; v != last; ++v)
      {
        const std::array<Real, 3> at = of(*v);
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
          least[axis] = std::min(least[axis], at[axis]);
          most[axis] = std::max(most[axis], at[axis]);
        }
      }
      for (std::size_t axis = 0; axis < 3; ++axis)
      {
        box.least[axis][lane] = least[axis];
        box.most[axis][lane] = most[axis];
      }
    };
    set(boxes.place, place_of);
    set(boxes.way, way_of);
  }
  // Compares blocks, and triangles of blocks that have approached each other by more than `enough`, until two triangles
  // have done so, too; boxes(b) returns the boxes of the triangles of block b.
  template <class Boxes>
  double compare(const TouchKernels<Real>& kernels, Real reach, Real enough, const Boxes& boxes) const
  {
    Real largest[touch_width] = {};
    const auto most = [&] { return *std::max_element(largest, largest + touch_width); };
    for (std::size_t a = 0; a + 1 < begin_.size(); ++a)
      for (std::size_t of = a / touch_width; of < blocks_.size(); ++of)
      {
        std::uint32_t bits = kernels.approach(blocks_[a / touch_width], static_cast<int>(a % touch_width), blocks_[of],
                                              reach, enough, largest);
        for (; bits != 0; bits &= bits - 1)
        {
          const GroupBoxes<Real>&one = boxes(a), &other = boxes(of * touch_width + __builtin_ctz(bits));
          for (int lane = 0; lane < touch_width; ++lane)
            kernels.approach(one, lane, other, reach, reach, largest);
          if (most() > enough)
            return double(most());
        }
      }
    return double(most());
  }

  std::vector<std::int32_t> order_;     // triangles in the order of the lanes
  std::vector<std::size_t> levels_;     // first block of each level; the last level has one block
  std::vector<std::int32_t> vertices_;  // of each block of triangles, without repetition
  std::vector<std::size_t> begin_;      // first vertex of each block
  std::vector<Corners> corners_;        // of triangles in the order of the lanes
  // For approach():
  std::vector<GroupBoxes<Real>> blocks_, triangles_;  // one lane per block, and per triangle
  std::vector<std::uint8_t> boxed_;                   // whether the boxes of a block's triangles are those of the call

  // State of the motion:
  std::vector<BallBlock<Real>> balls_;    // of all levels
  std::vector<FacetBlock<Real>> facets_;  // of the triangles
  std::vector<Placed> placed_;            // the vector has one entry
};

}  // namespace frontalis
