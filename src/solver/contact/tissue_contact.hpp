#pragma once

#include "frontalis/physics/contact.hpp"
#include "frontalis/physics/trilinear.hpp"
#include "solver/contact/bound_node_way.hpp"
#include "solver/contact/touching_surface.hpp"
#include "solver/contact/triangle_grid.hpp"
#include "solver/stepping/node_part.hpp"

#include <array>
#include <vector>

namespace frontalis
{

/// Contact of the tissue's surfaces with each other and with themselves. Each vertex of a surface is pushed out of the
/// triangles of others, and the corners of the triangle in the opposite direction. Each side has half of the stiffness,
/// because both are pushed out of the other.
///
/// A vertex holds on to at most `most_tracks` triangles that face it and follows the surface from one to the next.
/// Which they are is found with a grid, in two steps: in the first all triangles are sorted into cells, in the second
/// each vertex looks at those near it. This is renewed when nodes have moved by so much that a vertex and a triangle
/// that were farther apart than the search reaches could touch. Between two renewals a vertex that is `d` from its
/// triangles is not looked at before vertices have moved by that much.
///
/// Threads first place the vertices: prepare_step(). Each then finds the forces of its part of them: before_step(), and
/// adds those on nodes of its planes in the order of the vertices: add_forces().
template <class Real>
class TissueContact : public NodePart<Real>
{
public:
  TissueContact(const Model& model, const Discretisation& discretisation);

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

private:
  using Vector = physics::Vec3<double>;
  using Placed = TouchingSurface::Placed;
  using Foot = physics::SurfaceFoot<double>;

  static constexpr std::int32_t most_tracks = 2, chunk_size = 64;

  // A triangle that a vertex holds on to, and what friction knows of the two.
  enum class Touching : std::int32_t
  {
    no,
    yes,
    let_go  // in this step
  };
  struct Track
  {
    std::int32_t triangle = -1;  // -1: none
    Touching touches = Touching::no;
    double stiffness = 0;           // when it touched last [N/m]
    double pressed = 0, along = 0;  // physics::Grip
    Vector stretch{ 0, 0, 0 };      // along the surface, of the stiffness that makes it stick [m]
  };
  struct PairForce
  {
    Vector point{ 0, 0, 0 };         // [N]
    std::array<Vector, 3> corner{};  // [N]
    std::array<Vector, 3> turn{};    // of the corners' normals [N m]
    double stored = 0, lost = 0;     // [J]
  };
  struct Chunk
  {
    double due = 0;            // the earliest of its vertices
    std::int64_t touches = 0;  // whether one does, or let go in this step
  };
  enum class Stage : std::int32_t
  {
    sort,    // triangles, in the next step
    search,  // among them, in the step after that
    hold
  };
  struct Clock
  {
    double way = 0;       // by which a vertex and a triangle can have come closer to each other [m]
    double earliest = 0;  // due of all chunks
    double renewal = 0;   // way at which the search is repeated
    double dt = 0;        // of the latest step [s]; 0: there was none
    Stage stage = Stage::sort;
    std::int32_t unused = 0;
  };

  struct VertexForces
  {
    std::vector<Vector> force, turn;  // of vertices that touch [N], [N m]
    std::vector<std::uint8_t> touches;
    std::vector<std::int32_t> touching;
  };

  std::pair<std::size_t, std::size_t> chunks_of(const NodeShare& share) const
  {
    return { chunks_.size() * share.thread / share.threads, chunks_.size() * (share.thread + 1) / share.threads };
  }
  std::size_t end_of(std::size_t chunk) const { return std::min((chunk + 1) * chunk_size, surface_.vertices.size()); }
  double way_now() const;
  bool rests() const { return clock_[0].stage == Stage::hold && way_now() < clock_[0].earliest; }
  void sort_triangles();
  void search(std::size_t p);
  bool meets(std::size_t p, std::int32_t t, double& gap) const;
  Foot follow(std::int32_t& t, const Vector& x, const std::vector<Placed>& placed) const;
  double stiffness(std::size_t p, std::int32_t t, const Foot& foot, const std::vector<Placed>& placed) const;
  PairForce touch(std::size_t p, Track& track, const std::vector<Placed>& placed, double response, double& gap) const;
  void voxel_readings(std::size_t p, double way, double response);
  void mark_live();
  void find_overlap_at_rest();
  void add_vertex_forces(VertexForces& sum, const NodeShare& share, std::int32_t begin, std::int32_t end);
  /// Calls push(node, force) for the forces on nodes in a share that belong to a vertex's force and to the turn of its
  /// normal.
  template <class Push>
  void push(std::size_t p, const Vector& force, const Vector& turn, const Placed& placed, const NodeShare& share,
            const Push& push) const
  {
    const auto& vertex = surface_.vertices[p];
    const auto& nodes = model_.voxel_nodes[vertex.voxel];
    double weight[8];
    physics::trilinear_weights<double>(vertex.coordinates[0], vertex.coordinates[1], vertex.coordinates[2], weight);
    const double first = dot(turn, placed.dual[0]), second = dot(turn, placed.dual[1]);
    const std::int32_t plane = model_.voxels[vertex.voxel][2];
    for (int b = 0; b < 8; ++b)
      if (plane + (b >> 2) >= share.first_plane && plane + (b >> 2) < share.end_plane)
        push(nodes[b], weight[b] * force -
                           (first * double(vertex.along[0][b]) + second * double(vertex.along[1][b])) * placed.normal);
  }

  const Model& model_;
  TouchingSurface surface_;
  bool runs_ = true;
  double reach_;                            // how far from a triangle a vertex finds it [m]
  std::vector<float> stiffness_;            // of each vertex [N/m]
  std::vector<float> per_area_;             // the same over its area [N/m3]
  std::vector<float> overlap_;              // of each vertex at rest, from which its depth counts; not positive [m]
  std::vector<std::int32_t> plane_points_;  // first vertex in each plane of voxels, twice more their number
  BoundNodeWay nodes_;
  // of the step under way
  std::vector<PairForce> pairs_;      // of tracks that touch
  std::vector<VertexForces> forces_;  // one per thread
  Clock next_;

  // state
  std::vector<Placed> placed_;      // vertices at the start of the latest step in which they were needed
  std::vector<std::uint8_t> live_;  // whether a vertex is near one that it may touch
  std::vector<Track> tracks_;       // `most_tracks` of each vertex
  std::vector<double> due_;         // Clock::way at which a vertex is looked at again
  std::vector<Chunk> chunks_;
  std::vector<Clock> clock_;      // one entry
  std::vector<double> node_way_;  // longest way of a bound node in the latest step, one per plane of nodes [m]
  std::vector<double> lost_;      // to friction, one per plane of voxels [J]
  std::vector<double> opened_;    // what that came to when the account was opened; one entry
  TriangleGrid grid_;
};

}  // namespace frontalis
