#pragma once

#include "frontalis/physics/surface_foot.hpp"
#include "solver/contact/bound_node_way.hpp"
#include "solver/contact/touching_surface.hpp"
#include "solver/contact/touch_tree.hpp"
#include "solver/cpu/touch_kernel.hpp"
#include "solver/stepping/node_part.hpp"

#include <array>
#include <vector>

namespace frontalis
{

/// Contact of the tissue's surfaces with each other and with themselves. Each vertex is pushed out of triangles that
/// face it, on other surfaces or on other parts of its own, and the corners of such a triangle are pushed in the
/// opposite direction (physics/surface_touch.hpp). Each side has half of the stiffness, because the vertices of either
/// side are pushed out of the other side.
///
/// A vertex forms pairs with at most `most_pairs` triangles that face it, and follows the surface from one triangle to
/// the next. A tree of balls finds the pairs within three steps: the first places the triangles in it, the second
/// searches near each vertex, the third puts the pairs into blocks. The search is repeated when a vertex could touch a
/// triangle outside of its reach: the motion of nodes bounds that of vertices, and where the bound is reached, the
/// first step measures how far vertices have approached each other and goes on without a search if that is much less. A
/// block whose pairs have gaps of at least `d` is skipped until vertices have moved by `d`, and the positions of
/// vertices far from all pairs are not computed.
///
/// In prepare_step() the threads compute the positions of the vertices. In before_step() each thread finds the forces
/// of its part of the pairs, and in add_forces() it adds the forces on the nodes of its planes in the order of the
/// pairs.
template <class Real>
class TissueContact : public NodePart<Real>
{
public:
  TissueContact(const Model& model, const Discretisation& discretisation, const TouchKernels<Real>& kernels);

  void run(EffectSet running) override;
  void reset() override;
  void list_arrays(ArrayList& list) override;
  bool idle() const override { return !runs_ || surface_.vertices.empty(); }
  bool pushes() const override { return true; }
  bool prepares() const override { return true; }
  void prepare_step(const NodeShare& share, const Real* const u[3]) override;
  void before_step(const NodeShare& share, const Real* const u[3], const ConstraintStep& step) override;
  void add_forces(const NodeShare& share, const ForceSink<Real>& sink) override;
  void after_step(const NodeShare& share, const Real* const before[3], const Real* const after[3]) override;
  void add_energies(const Real* const u[3], const std::vector<RigidTransform>& bones, bool open,
                    std::vector<std::array<double, 3>>& forces, EnergyLedger& ledger) override;

  const TouchingSurface& surface() const { return surface_; }
  // One value per vertex of the surface:
  const std::vector<float>& stiffness() const { return stiffness_; }  ///< [N/m]
  const std::vector<float>& per_area() const { return per_area_; }    ///< the same per area of the vertex [N/m3]
  const std::vector<float>& overlap() const { return overlap_; }      ///< gap at rest, not positive [m]
  std::int64_t searches() const { return clock_[0].searches; }        ///< number of searches since reset()

private:
  using Vector = physics::Vec3<double>;
  using Moved = MovedVertices<Real>;

  static constexpr std::size_t most_pairs = touch_search::most_pairs;
  struct View;

  enum class Stage : std::int32_t
  {
    check,    // if vertices have approached each other so far that a search is due, go on as in `place`
    place,    // place triangles in the tree
    search,   // search the tree, in the next step
    collect,  // collect the pairs that were found at the start of the step after `search`
    hold
  };
  struct Clock
  {
    double way = 0;       // upper bound of the distance by which a vertex and a triangle have approached each other [m]
    double earliest = 0;  // smallest due_ of all blocks
    double renewal = 0;   // value of `way` at which the search is repeated
    double dt = 0;        // length of the latest step [s]; 0: no step has been made
    Stage stage = Stage::place;
    std::int32_t blocks = 0;    // number of blocks of pairs
    std::int64_t searches = 0;  // number of searches since the start
  };
  struct Found
  {
    std::array<std::int32_t, most_pairs> triangle{ { -1, -1 } };  // -1: no triangle
    std::array<double, most_pairs> away{};                        // distance from each triangle [m]
  };
  // A pair of a vertex and a triangle, with its state of friction.
  struct Pair
  {
    std::int32_t vertex, triangle;
    Real held, pressed, along, stretch[3];
  };
  // The arrays that touch() reads and changes.
  struct Arena
  {
    std::vector<PairVertices>& pair_vertices;
    std::vector<PairBlock<Real>>& pairs;
    std::vector<PairForceBlock<Real>>& forces;
    std::vector<double>& due;
    std::vector<std::uint32_t>& touches;
    Moved moved;
    const TissueContact* contact;
    std::int32_t blocks;
  };

  std::size_t stride() const { return vertex_blocks_.size() * touch_width; }
  Moved moved_in(std::vector<Real>& components) const;
  Arena arena(std::int32_t blocks)
  {
    return { pair_vertices_, pairs_, forces_, due_, touches_, moved_in(moved_), this, blocks };
  }
  double way_now() const;
  double approached(double enough);
  void choose_stage(Stage stage, double way);
  bool rests() const { return clock_[0].stage == Stage::hold && way_now() < clock_[0].earliest; }
  Vector place(std::size_t v, const Moved& moved) const;
  Vector normal(std::size_t v, const Moved& moved) const;
  void make_vertex_blocks();
  void touch(Arena& arena, double way, double dt, std::int32_t first, std::int32_t last) const;
  void make_tree();
  void place_triangles();
  Found search(std::size_t p);
  static void go_on(void* arena, std::int32_t block, int lane);
  void set_lane(PairVertices& vertices, PairBlock<Real>& block, int lane, const Pair& pair) const;
  void collect_pairs();
  void mark_live();
  void find_overlap_at_rest();
  void add_up(const Arena& arena, const NodeShare& share, std::vector<Real>& sums, std::vector<std::uint8_t>& summed,
              std::vector<double>& lost) const;
  template <class Sink>
  void push(const NodeShare& share, const Moved& moved, std::vector<Real>& sums, std::vector<std::uint8_t>& summed,
            std::vector<Real>& node_forces, const Sink& sink) const;

  const Model& model_;
  TouchKernels<Real> kernels_;
  TouchingSurface surface_;
  bool runs_ = true, rubs_ = false;
  double reach_;              // distance from a triangle within which a vertex forms a pair with it [m]
  std::vector<Vector> rest_;  // positions of the vertices at rest, which TouchingSurface keeps farther apart
  std::vector<float> stiffness_, per_area_;
  std::vector<float> overlap_;  // gap at rest, not positive, from which the depth of contact is measured [m]
  std::vector<VertexBlock<Real>> vertex_blocks_;
  std::vector<std::int32_t> bound_nodes_;  // ascending
  // first vertex in each plane of voxels; the last two entries are the number of vertices
  std::vector<std::int32_t> plane_points_;
  BoundNodeWay nodes_;
  // Values of the present step:
  std::vector<PairForceBlock<Real>> forces_;
  std::vector<std::uint32_t> touches_;             // PairArguments::touches
  std::vector<std::vector<Real>> sums_;            // forces on vertices and on their normals, one list per thread
  std::vector<std::vector<std::uint8_t>> summed_;  // whether a block of vertices has forces, one list per thread
  std::vector<Real> node_forces_;                  // on bound nodes, four numbers each [N]
  Clock next_;

  // State of the motion:
  std::vector<Real> moved_;         // MovedVertices at the start of the latest step in which they were needed
  std::vector<std::uint8_t> live_;  // whether a block has a vertex close to a triangle that it may touch
  std::vector<PairVertices> pair_vertices_;
  std::vector<PairBlock<Real>> pairs_;
  std::vector<double> due_;  // value of Clock::way at which a block of pairs is evaluated again
  std::vector<Found> found_;
  std::vector<Real> searched_;    // displacements of vertices at the latest search, three numbers each [m]
  std::vector<Clock> clock_;      // the vector has one entry
  std::vector<double> node_way_;  // BoundNodeWay::in_plane() of the latest step, one per plane of nodes [m]
  std::vector<double> lost_;      // energy lost to friction, one per plane of voxels [J]
  std::vector<double> opened_;    // sum of lost_ when the account was opened; the vector has one entry
  TouchTree<Real> tree_;
};

}  // namespace frontalis
