#pragma once

#include "frontalis/physics/contact.hpp"
#include "frontalis/physics/distance_field.hpp"
#include "frontalis/physics/pose.hpp"
#include "frontalis/physics/trilinear.hpp"
#include "solver/contact/bound_node_way.hpp"
#include "solver/contact/contact_blocks.hpp"
#include "solver/contact/pushed_contact.hpp"
#include "solver/stepping/node_part.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace frontalis
{

/// Contact of bound surfaces with rigid bodies. In each step, before_step() finds the forces on the points; each thread
/// processes a part of them. After a barrier, add_forces() adds the forces on the nodes of the thread's planes, and
/// sums the reactions of points in voxels of these planes. after_step() records how far the nodes have moved. Points
/// are sorted by voxel, so that each node's forces are added in the same order for any number of threads.
///
/// A point at some distance from all bodies is evaluated again only when nodes and body together can have brought it
/// nearer by that much. A point outside of its voxel moves farther than the voxel's nodes (spread_at()).
template <class Real>
class BodyContact : public NodePart<Real>
{
public:
  /// `kernel`: finds the places of sixteen points at a time; null: each point is evaluated alone.
  BodyContact(const Model& model, const Discretisation& discretisation, PointKernel<Real> kernel = nullptr);

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
  double body_energy() const override
  {
    double sum = 0;
    for (std::size_t b = 0; b < bodies_.size(); ++b)
      sum += energy_of(model_.contacts[b], bodies_[b]);
    return sum;
  }
  std::int64_t lost_points() const override { return std::count(touches_.begin(), touches_.end(), Touching::lost); }

  // The following types and functions are for a backend that keeps the points in its own memory and finds their forces
  // there. follow() then sums these forces.

  using Vector = physics::Vec3<double>;
  using PushedMotion = physics::PushedMotion<double>;
  struct Point
  {
    std::int32_t voxel, body;
    std::array<float, 3> coordinates;
    float stiffness;  ///< [N/m]
    Vector rest;
  };
  struct PointForce
  {
    Vector force, arm;  ///< force on the point [N]; arm from the origin of the body's frame [m]
    double lost;        ///< dissipated by friction in this step [J]
  };
  /// Result of a step for a point.
  struct Found
  {
    PointForce force;
    physics::Grip<double> grip;
    physics::Touching touching;
  };
  const std::vector<Point>& points() const { return points_; }
  /// Largest ratio of a point's displacement to the largest displacement of a node of its voxel.
  double spread() const { return nodes_.spread(); }
  /// Takes the results of a step, one entry per point, and adds up the reactions and energies. `pushed`: motion of each
  /// body at the start of the step, used if the body is pushed; if empty, the motions are computed here.
  void follow(const std::vector<Found>& found, const ConstraintStep& step,
              const std::vector<PushedMotion>& pushed = {});

private:
  using Touching = physics::Touching;
  struct Energy
  {
    double stored = 0;  // energy in the stiffness of contact at present [J]
    double work = 0;    // done by the motion of bodies [J]
    double lost = 0;    // dissipated by friction [J]
  };
  // Sums for one body in one plane of voxels.
  struct PlaneSum
  {
    Reaction reaction;
    double work, lost;
  };
  // Number of points that are skipped together.
  static constexpr std::int32_t chunk_size = 16;
  struct Chunk
  {
    double due = 0;            // value of BodyState::way at which the first of the chunk's points must be evaluated
    std::int64_t touches = 0;  // not 0: a point of the chunk touches a body
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
  /// Energies at the present displacements. Also adds the present forces [N] on nodes to `forces`, unless it is empty.
  Energy energy_now(const Real* const u[3], const std::vector<RigidTransform>& bones,
                    std::vector<std::array<double, 3>>& forces) const;
  std::vector<BodyState> next(const ConstraintStep& step) const;
  /// Whether the kernel's places suffice for the forces of a body. Displacements from the anchors of friction need
  /// double precision.
  bool touches_in_lanes(std::int32_t body) const
  {
    return model_.contacts[body].friction == 0 && fields_[body].radius == 0;
  }
  /// Value of BodyState::way up to which a point at a distance [m] from its body need not be evaluated again.
  double due_after(std::size_t p, double way, double distance) const;
  /// Finds the force on a point. `places`: those of its chunk, or null.
  void find_force(std::size_t p, const Real* const u[3], const BodyState& body, double response,
                  const PointPlaces<Real>* places);
  physics::Grip<double> grip_at(std::size_t p, const Vector& x) const
  {
    const auto& grip = grips_[p];
    return touches_[p] == Touching::yes ? grip : physics::Grip<double>{ x, grip.normal, 0 };
  }
  void go_on_to(const std::vector<BodyState>& now);
  void add_up(int thread, std::int32_t first, std::int32_t last);

  const Model& model_;
  bool runs_ = true, any_pushed_ = false;
  std::vector<Point> points_;  // sorted by voxel
  // first point in each plane of voxels; the last two entries are the number of points
  std::vector<std::int32_t> plane_points_;
  ContactBlocks<Real> blocks_;
  BoundNodeWay nodes_;
  std::vector<double> spread_;  // spread_at() each point
  std::vector<physics::DistanceField> fields_;
  // Values of the present step:
  std::vector<PointForce> forces_;  // one per point
  std::vector<BodyState> next_;
  std::vector<BodyMotion> motion_;  // motion of each body since the previous step

  // State of the motion:
  std::vector<physics::Grip<double>> grips_;  // one per point
  std::vector<double> due_;                   // value of BodyState::way at which a point must be evaluated again
  std::vector<Touching> touches_;
  std::vector<Chunk> chunks_;
  std::vector<BodyState> bodies_;  // at the start of the latest step
  std::vector<double> node_way_;  // longest displacement of a bound node in the latest step, one per plane of nodes [m]
  std::vector<PlaneSum> sums_;    // one per plane of voxels and body
  std::vector<Energy> opened_;    // energies when the account was opened; the vector has one entry
};

}  // namespace frontalis
