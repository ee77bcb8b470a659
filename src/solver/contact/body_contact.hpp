#pragma once

#include "frontalis/physics/contact.hpp"
#include "frontalis/physics/distance_field.hpp"
#include "frontalis/physics/pose.hpp"
#include "frontalis/physics/trilinear.hpp"
#include "solver/contact/pushed_body.hpp"
#include "solver/stepping/node_part.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace frontalis
{

/// Contact of bound surfaces with rigid bodies. In each step threads first share the points: before_step() finds their
/// forces. After a barrier each thread adds those on nodes of its planes: add_forces(), which also adds up the
/// reactions of points in voxels of these planes. At the end of the step, after_step() notes how far the nodes have
/// come. Points are sorted by voxel, so that each node's forces are added in the same order for any number of threads.
///
/// A point that is `d` from a body is not looked at again before nodes and body together have moved by that much.
template <class Real>
class BodyContact : public NodePart<Real>
{
public:
  BodyContact(const Model& model, const Discretisation& discretisation);

  void run(EffectSet running) override;
  void reset() override;
  void list_arrays(ArrayList& list) override;
  bool idle() const override { return !runs_ || points_.empty(); }
  bool pushes() const override { return true; }
  void before_step(const NodeShare& share, const Real* const u[3], const ConstraintStep& step) override;
  void add_forces(const NodeShare& share, const ForceSink<Real>& sink) override;
  void after_step(const NodeShare& share, const Real* const before[3], const Real* const after[3]) override;
  void add_energies(const Real* const u[3], const std::vector<RigidTransform>& bones, bool open,
                    std::vector<std::array<double, 3>>& forces, EnergyLedger& ledger) override;
  std::vector<Reaction> reactions() const override;
  std::vector<RigidTransform> bodies(const std::vector<RigidTransform>& bones) const override;
  std::int64_t lost_points() const override { return std::count(touches_.begin(), touches_.end(), Touching::lost); }

private:
  using Vector = physics::Vec3<double>;

  struct Point
  {
    std::int32_t voxel, body;
    std::array<float, 3> coordinates;
    float stiffness;  // [N/m]
    Vector rest;
  };
  struct PointForce
  {
    Vector force, arm;  // on the point [N]; from the origin of the body's frame [m]
    double lost;        // to friction in this step [J]
  };
  enum class Touching : std::uint8_t
  {
    no,
    yes,
    let_go,  // in this step
    lost     // deeper in the body than its field has samples
  };
  struct Energy
  {
    double stored = 0;  // now [J]
    double work = 0;    // done by the motion of bodies [J]
    double lost = 0;    // to friction [J]
  };
  // of a body in a plane of voxels
  struct PlaneSum
  {
    Reaction reaction;
    double work, lost;
  };
  // Points are looked at in chunks of this many.
  static constexpr std::int32_t chunk_size = 64;
  struct Chunk
  {
    double due = 0;            // the earliest of its points
    std::int64_t touches = 0;  // whether one does
  };
  // nodes [first, last), among which bound ones are not far apart
  struct Run
  {
    std::int32_t first, last;
  };
  /// Calls visit(p) for the points in [first, last) that touch.
  template <class Visit>
  void each_touching(std::int32_t first, std::int32_t last, const Visit& visit) const
  {
    for (auto p = first; p < last; ++p)
      if (chunks_[p / chunk_size].touches == 0)
        p |= chunk_size - 1;
      else if (touches_[p] != Touching::no)
        visit(p);
  }
  template <class Push>
  void push_point(const Point& point, const Vector& force, std::int32_t first, std::int32_t last,
                  const Push& push) const
  {
    const auto& nodes = model_.voxel_nodes[point.voxel];
    const auto& c = point.coordinates;
    double weight[8];
    physics::trilinear_weights<double>(c[0], c[1], c[2], weight);
    const std::int32_t plane = model_.voxels[point.voxel][2];
    for (int b = 0; b < 8; ++b)
      if (plane + (b >> 2) >= first && plane + (b >> 2) < last)
        push(nodes[b], weight[b] * force);
  }
  Vector place(const Point& point, const Real* const u[3]) const;
  /// Energies up to the present displacements.
  Energy energy_now(const Real* const u[3], const std::vector<RigidTransform>& bones,
                    std::vector<std::array<double, 3>>& forces) const;
  std::vector<BodyState> next(const ConstraintStep& step) const;
  void look_at(std::size_t p, const Real* const u[3], const BodyState& body, double response);
  physics::Grip<double> grip_at(std::size_t p, const Vector& x) const
  {
    const auto& grip = grips_[p];
    return touches_[p] == Touching::yes ? grip : physics::Grip<double>{ x, grip.normal, 0 };
  }
  double slack(const Contact& contact, const Vector& x) const;
  void add_up(int thread, std::int32_t first, std::int32_t last);

  const Model& model_;
  bool runs_ = true, any_pushed_ = false;
  double spread_ = 1;                       // by which factor a point may move more than the nodes of its voxel
  std::vector<Point> points_;               // sorted by voxel
  std::vector<std::int32_t> plane_points_;  // first point in each plane of voxels, twice more their number
  std::vector<Run> runs_of_nodes_;          // that hold all bound nodes, ascending
  std::vector<std::int32_t> plane_runs_;    // first of them in each plane of nodes, and their number
  std::vector<physics::DistanceField> fields_;
  // of the step under way
  std::vector<PointForce> forces_;  // of points that touch
  std::vector<BodyState> next_;
  std::vector<BodyMotion> motion_;  // since the step before

  // state
  std::vector<physics::Grip<double>> grips_;  // of points that touch or did lately
  std::vector<double> due_;                   // BodyState::way at which a point is looked at again
  std::vector<Touching> touches_;
  std::vector<Chunk> chunks_;
  std::vector<BodyState> bodies_;  // at the start of the latest step
  std::vector<double> node_way_;   // longest way of a bound node in the latest step, one per plane of nodes [m]
  std::vector<PlaneSum> sums_;     // one per plane of voxels and body
  std::vector<Energy> opened_;     // what they came to when the account was opened; one entry
};

}  // namespace frontalis
