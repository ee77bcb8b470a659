// Finds the triangles that a vertex may touch.

#include "solver/contact/tissue_contact.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

using Vector = physics::Vec3<double>;

// Around the triangle of a pair, the corners of this many rings of triangles also get positions in each step.
constexpr int rings = 3;

// Blocks of the tree are chosen as if triangles whose normals differ by a length of 1 were this far apart, in voxel
// edges, so that no block has triangles of both lips of a mouth.
constexpr double block_span = 2;

// The search is repeated when less than this share is left of the way by which vertices may approach triangles.
constexpr double least_left = 0.2;

template <class Real>
Vector record(const Real* records, std::size_t v)
{
  const Real* const r = records + v * MovedVertices<Real>::stride;
  return { double(r[0]), double(r[1]), double(r[2]) };
}

}  // namespace

template <class Real>
physics::Vec3<double> TissueContact<Real>::place(std::size_t v, const Moved& moved) const
{
  return rest_[v] + record(moved.record, v);
}

template <class Real>
physics::Vec3<double> TissueContact<Real>::normal(std::size_t v, const Moved& moved) const
{
  return record(moved.record + 4, v);
}

// The surfaces at their present positions, for the functions of touch_search.hpp.
template <class Real>
struct TissueContact<Real>::View
{
  using Number = double;
  static constexpr double edge_error = 1e-9;

  Vector apart(std::int32_t v, std::int32_t w) const { return contact.place(v, moved) - contact.place(w, moved); }
  Vector rest_apart(std::int32_t v, std::int32_t w) const { return contact.rest_[v] - contact.rest_[w]; }
  Vector normal(std::int32_t v) const { return contact.normal(v, moved); }
  double overlap(std::int32_t v) const { return double(contact.overlap_[v]); }
  std::int32_t contact_of(std::int32_t v) const { return contact.surface_.vertices[v].contact; }
  bool joined(std::int32_t v, std::int32_t w) const { return contact.surface_.joined(v, w); }
  const std::int32_t* corners(std::int32_t t) const { return contact.surface_.triangles[t].vertex.data(); }
  const std::int32_t* neighbours(std::int32_t t) const { return contact.surface_.triangles[t].neighbour.data(); }
  physics::SurfaceTriangle<double> triangle(std::int32_t t) const { return touch_search::triangle_of(*this, t); }
  bool placed(std::int32_t t) const
  {
    const auto& corners = contact.surface_.triangles[t].vertex;
    return std::all_of(corners.begin(), corners.end(),
                       [&](std::int32_t v) { return contact.live_[v / touch_width] != 0; });
  }
  double edge() const { return contact.surface_.edge; }

  const TissueContact& contact;
  Moved moved;
};

// The kernels call this function for a pair of a vertex and a triangle if the vertex's foot (physics::SurfaceFoot) is
// beyond the triangle. The pairs of a vertex are neighbours in a block; if two of them reach the same triangle, the
// second pair is removed.
template <class Real>
void TissueContact<Real>::go_on(void* arena, std::int32_t block, int lane)
{
  const Arena& in = *static_cast<const Arena*>(arena);
  const TissueContact& contact = *in.contact;
  PairVertices& at = in.pair_vertices[block];
  PairBlock<Real>& b = in.pairs[block];
  const std::int32_t p = at.vertex[0][lane];
  Pair pair{ p,
             at.triangle[lane],
             b.held[lane],
             b.pressed[lane],
             b.along[lane],
             { b.stretch[0][lane], b.stretch[1][lane], b.stretch[2][lane] } };
  physics::SurfaceTriangle<double> unused;
  touch_search::follow(View{ contact, in.moved }, p, pair.triangle, unused);
  if (pair.triangle == at.triangle[lane])
    return;
  contact.set_lane(at, b, lane, pair);
  for (const int other : { lane - 1, lane + 1 })
    if (other >= 0 && other < touch_width && at.vertex[0][other] == p && at.triangle[other] == pair.triangle)
    {
      const int second = std::max(lane, other);
      at.triangle[second] = -1;
      b.stiffness[second] = b.held[second] = b.pressed[second] = b.along[second] = 0;
    }
}

template <class Real>
void TissueContact<Real>::set_lane(PairVertices& vertices, PairBlock<Real>& block, int lane, const Pair& pair) const
{
  const auto& triangle = surface_.triangles[pair.triangle];
  const auto p = pair.vertex;
  vertices.vertex[0][lane] = p;
  vertices.triangle[lane] = pair.triangle;
  const Vector origin = rest_[triangle.vertex[0]];
  for (std::size_t i = 0; i < 3; ++i)
  {
    const auto v = triangle.vertex[i];
    vertices.vertex[i + 1][lane] = v;
    block.softer[i][lane] = static_cast<Real>(per_area_[v] / per_area_[p]);
    block.inner[i][lane] = triangle.neighbour[i] < 0 ? 0 : 1;
    const Vector way = rest_[i == 0 ? p : v] - origin;
    block.rest[i][0][lane] = static_cast<Real>(way.x);
    block.rest[i][1][lane] = static_cast<Real>(way.y);
    block.rest[i][2][lane] = static_cast<Real>(way.z);
    block.stretch[i][lane] = pair.stretch[i];
  }
  block.stiffness[lane] = stiffness_[p];
  block.overlap[lane] = overlap_[p];
  block.friction[lane] = static_cast<Real>(model_.self_contacts[surface_.vertices[p].contact].friction);
  block.held[lane] = pair.held;
  block.pressed[lane] = pair.pressed;
  block.along[lane] = pair.along;
}

template <class Real>
void TissueContact<Real>::make_tree()
{
  std::vector<typename TouchTree<Real>::Triangle> at_rest(surface_.triangles.size());
  std::vector<typename TouchTree<Real>::Corners> corners;
  for (const auto& triangle : surface_.triangles)
  {
    physics::SurfaceTriangle<double>& at = at_rest[corners.size()].at;
    for (std::size_t i = 0; i < 3; ++i)
    {
      at.corner[i] = rest_[triangle.vertex[i]];
      at.normal[i] = surface_.vertices[triangle.vertex[i]].normal;
    }
    corners.push_back(triangle.vertex);
  }
  tree_.make(at_rest, corners, block_span * surface_.edge);
}

template <class Real>
void TissueContact<Real>::place_triangles()
{
  const Moved moved = moved_in(moved_);
  tree_.place(touch_search::margin * reach_,
              [&](std::int32_t t)
              {
                const auto& [corner, neighbour] = surface_.triangles[t];
                typename TouchTree<Real>::Triangle triangle;
                for (std::size_t i = 0; i < 3; ++i)
                {
                  triangle.at.corner[i] = place(corner[i], moved);
                  triangle.at.normal[i] = normal(corner[i], moved);
                }
                triangle.rim = *std::min_element(neighbour.begin(), neighbour.end()) < 0;
                return triangle;
              });
}

// Returns an upper bound of the distance by which a vertex and a triangle that formed no pair at the latest search have
// come closer than the reach [m], or a number above `enough` if they may have done so by more. First tries the diagonal
// of the box that contains the ways of all vertices, so that a motion which they have in common does not count.
template <class Real>
double TissueContact<Real>::approached(double enough)
{
  const Moved moved = moved_in(moved_);
  const auto way_of = [&](std::size_t v)
  {
    const Real *const now = moved.record + v * Moved::stride, *const then = searched_.data() + 3 * v;
    return std::array<Real, 3>{ { now[0] - then[0], now[1] - then[1], now[2] - then[2] } };
  };
  const auto place_of = [&](std::size_t v)
  {
    const Vector at = place(v, moved);
    return std::array<Real, 3>{ { static_cast<Real>(at.x), static_cast<Real>(at.y), static_cast<Real>(at.z) } };
  };
  std::array<Real, 3> least = way_of(0), most = least;
  for (std::size_t v = 1; v < surface_.vertices.size(); ++v)
  {
    const std::array<Real, 3> way = way_of(v);
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      least[axis] = std::min(least[axis], way[axis]);
      most[axis] = std::max(most[axis], way[axis]);
    }
  }
  const Vector box{ double(most[0] - least[0]), double(most[1] - least[1]), double(most[2] - least[2]) };
  const double diagonal = norm(box);
  return diagonal < enough ? diagonal : std::min(diagonal, tree_.approach(kernels_, reach_, enough, place_of, way_of));
}

// Sets the stage of the next step, and places triangles if it is a search. `way`: Clock::way at this step.
template <class Real>
void TissueContact<Real>::choose_stage(Stage stage, double way)
{
  const double farthest = touch_search::renewal_share * reach_;
  if (stage == Stage::hold && way >= next_.renewal)
    next_.stage = Stage::check;
  if (stage == Stage::check || stage == Stage::place)
  {
    const double left = stage == Stage::check ? farthest - approached((1 - least_left) * farthest) : 0;
    next_.stage = left > least_left * farthest ? Stage::hold : Stage::search;
    next_.renewal = way + left;
    if (next_.stage == Stage::search)
      place_triangles();
  }
  if (stage == Stage::search)
  {
    next_.stage = Stage::collect;
    ++next_.searches;
    next_.renewal = way + farthest;
    const Moved moved = moved_in(moved_);
    for (std::size_t v = 0; v < surface_.vertices.size(); ++v)
      std::copy_n(moved.record + v * Moved::stride, 3, searched_.data() + 3 * v);
  }
  if (stage == Stage::collect)
    next_.stage = Stage::hold;
}

// Returns the nearest triangles that a vertex may touch, at most `most_pairs`, of which no two share a corner.
template <class Real>
typename TissueContact<Real>::Found TissueContact<Real>::search(std::size_t p)
{
  const View view{ *this, moved_in(moved_) };
  Found found;
  found.away.fill(2 * reach_);
  tree_.near(kernels_, place(p, view.moved), normal(p, view.moved),
             [&](std::int32_t t)
             {
               double gap;
               if (!touch_search::may_touch(view, static_cast<std::int32_t>(p), t, reach_, tree_.largest(), gap))
                 return;
               // If t is nearer, it replaces the triangle found so far that shares a corner with t or, if none does,
               // the farthest triangle found so far.
               std::size_t k = found.away[0] > found.away[1] ? 0 : 1;
               for (std::size_t same = 0; same < most_pairs; ++same)
                 if (found.triangle[same] >= 0 && touch_search::adjoin(view, t, found.triangle[same]))
                   k = same;
               if (std::abs(gap) >= found.away[k])
                 return;
               found.away[k] = std::abs(gap);
               found.triangle[k] = t;
             });
  return found;
}

// Forms blocks of the pairs that touch and of the pairs that the search has found.
template <class Real>
void TissueContact<Real>::collect_pairs()
{
  std::vector<Pair> held;
  for (std::int32_t b = 0; b < clock_[0].blocks; ++b)
    for (int l = 0; l < touch_width; ++l)
      if (const PairBlock<Real>& from = pairs_[b]; from.held[l] > 0 || from.pressed[l] > 0)
        held.push_back({ pair_vertices_[b].vertex[0][l],
                         pair_vertices_[b].triangle[l],
                         from.held[l],
                         from.pressed[l],
                         from.along[l],
                         { from.stretch[0][l], from.stretch[1][l], from.stretch[2][l] } });
  const View view{ *this, moved_in(moved_) };
  std::int32_t blocks = 0;
  std::size_t lanes = touch_width;  // number of lanes used in the last block
  auto next = held.begin();
  std::vector<Pair> of_vertex;
  for (std::int32_t p = 0; p < static_cast<std::int32_t>(found_.size()); ++p)
  {
    of_vertex.clear();
    while (next != held.end() && next->vertex == p)
      of_vertex.push_back(*next++);
    const Found& found = found_[p];
    const std::size_t nearest = found.away[0] <= found.away[1] ? 0 : 1;
    for (const std::size_t k : { nearest, 1 - nearest })
      if (const auto t = found.triangle[k];
          t >= 0 && of_vertex.size() < most_pairs &&
          std::none_of(of_vertex.begin(), of_vertex.end(),
                       [&](const Pair& pair) { return touch_search::adjoin(view, pair.triangle, t); }))
        of_vertex.push_back({ p, t, 0, 0, 0, {} });
    if (of_vertex.empty())
      continue;
    if (lanes + of_vertex.size() > touch_width)
    {
      // Unused lanes are copies of this pair without stiffness.
      for (int l = 0; l < touch_width; ++l)
      {
        set_lane(pair_vertices_[blocks], pairs_[blocks], l, { p, of_vertex[0].triangle, 0, 0, 0, {} });
        pairs_[blocks].stiffness[l] = 0;
        pair_vertices_[blocks].triangle[l] = -1;
      }
      lanes = 0;
      due_[blocks++] = 0;
    }
    for (const Pair& pair : of_vertex)
      set_lane(pair_vertices_[blocks - 1], pairs_[blocks - 1], static_cast<int>(lanes++), pair);
  }
  clock_[0].blocks = blocks;
  mark_live();
}

template <class Real>
void TissueContact<Real>::mark_live()
{
  std::fill(live_.begin(), live_.end(), std::uint8_t(0));
  const auto mark = [&](const auto& self, std::int32_t t, int left) -> void
  {
    for (const auto v : surface_.triangles[t].vertex)
      live_[v / touch_width] = 1;
    for (const auto across : surface_.triangles[t].neighbour)
      if (left > 0 && across >= 0)
        self(self, across, left - 1);
  };
  for (std::int32_t b = 0; b < clock_[0].blocks; ++b)
    for (int l = 0; l < touch_width; ++l)
      if (const PairVertices& pairs = pair_vertices_[b]; pairs.triangle[l] >= 0)
      {
        live_[pairs.vertex[0][l] / touch_width] = 1;
        mark(mark, pairs.triangle[l], rings);
      }
}

// Finds how far surfaces that meet at rest, such as closed lips, overlap because of errors of their triangulation.
template <class Real>
void TissueContact<Real>::find_overlap_at_rest()
{
  const std::vector<Real> still(model_.nodes.size(), 0);
  const Moved moved = moved_in(moved_);
  kernels_.place(vertex_blocks_.data(), moved, { still.data(), still.data(), still.data() }, 0,
                 static_cast<std::int32_t>(vertex_blocks_.size()));
  place_triangles();
  std::vector<float> overlap(overlap_.size(), 0);
  physics::SurfaceTriangle<double> unused;
  for (std::size_t p = 0; p < overlap.size(); ++p)
    for (auto t : search(p).triangle)
      if (t >= 0)
      {
        const auto foot = touch_search::follow(View{ *this, moved }, static_cast<std::int32_t>(p), t, unused);
        overlap[p] = std::min(overlap[p], static_cast<float>(foot.gap));
      }
  reset();
  overlap_ = overlap;
}

#define FRONTALIS_TISSUE_CONTACT_SEARCH(Real)                                            \
  template void TissueContact<Real>::go_on(void*, std::int32_t, int);                    \
  template void TissueContact<Real>::choose_stage(Stage, double);                        \
  template void TissueContact<Real>::make_tree();                                        \
  template void TissueContact<Real>::place_triangles();                                  \
  template typename TissueContact<Real>::Found TissueContact<Real>::search(std::size_t); \
  template void TissueContact<Real>::collect_pairs();                                    \
  template void TissueContact<Real>::find_overlap_at_rest();
FRONTALIS_TISSUE_CONTACT_SEARCH(float)
FRONTALIS_TISSUE_CONTACT_SEARCH(double)

}  // namespace frontalis
