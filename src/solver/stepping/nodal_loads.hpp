#pragma once

#include "frontalis/physics/ramp.hpp"
#include "solver/stepping/node_part.hpp"

#include <array>
#include <vector>

namespace frontalis
{

/// Nodes to which selective mass scaling has added mass, so that gravity on them would be too large without a
/// correction.
std::vector<std::int32_t> relieved_nodes(const Model& model, const Discretisation& discretisation);
/// The force [N] on a node of relieved_nodes() that cancels the weight of the added mass.
std::array<double, 3> gravity_relief(const Model& model, const Discretisation& discretisation, std::int32_t node);

/// Steps of a plan for which the forces of surface loads are kept in a model with a follower pressure. A surface turns
/// little in them, and a GPU makes them in one launch.
constexpr int steps_per_pressure = 4;

/// Fraction of a load that acts at a time [s]: that of its ramp, or its activation.
inline double acting_share(const Load& load, double time, const std::vector<float>& activation)
{
  return load.activation < 0 ? physics::ramped(time, load.ramp) : double(activation[load.activation]);
}

/// Converts tractions and follower pressures on bound surfaces to nodal forces, by the transposed binding and in a
/// fixed order of summation. Also cancels the weight of mass that selective mass scaling has added.
template <class Real>
class NodalLoads : public NodePart<Real>
{
public:
  NodalLoads(const Model& model, const Discretisation& discretisation);

  /// Switches the surface loads and the correction of gravity on or off with their effects.
  void run(EffectSet running) override;
  void reset() override {}
  void list_arrays(ArrayList& list) override;
  bool pushes() const override { return true; }
  void before_step(const NodeShare& share, const Real* const u[3], const ConstraintStep& step) override
  {
    if (share.thread == 0 && (!presses_ || step.index % steps_per_pressure == 0))
      update(step.time_before, step.activation, u);
  }
  void add_forces(const NodeShare& share, const ForceSink<Real>& sink) override;
  void account(const NodeShare& share, EnergyAccount<Real>& account, const Real* const v[3], double kick) override;
  bool idle() const override
  {
    const bool loaded = runs_ && !surfaces_.empty();
    return !loaded && !(relieves_ && !relief_.empty());
  }
  const std::vector<std::int32_t>& nodes() const { return nodes_; }             ///< loaded nodes, ascending
  const std::vector<std::array<double, 3>>& forces() const { return forces_; }  ///< [N], one per loaded node

  /// The forces without the correction of gravity.
  const std::vector<std::array<double, 3>>& surface_forces() const { return surface_forces_; }

  /// Computes the forces at a time from the present nodal displacements and the activation of each muscle.
  void update(double time, const std::vector<float>& activation, const Real* const u[3]);

private:
  struct Contribution
  {
    std::int32_t vertex;
    float weight;
  };
  struct Surface
  {
    const Load* load;
    std::vector<std::int32_t> begin;  // first contribution of each loaded node
    std::vector<Contribution> contributions;
    std::vector<std::array<double, 3>> vertex_force;
    std::vector<std::array<double, 3>> vertices;
  };

  /// Calls visit(l) for each loaded node l of a share.
  template <class Visit>
  void each(const NodeShare& share, const Visit& visit) const;

  const Model& model_;
  std::vector<std::int32_t> nodes_;
  std::vector<std::array<double, 3>> surface_forces_, forces_;
  std::vector<std::array<double, 3>> relief_;  // correction of gravity, one per loaded node; empty without scaled mass
  std::vector<Surface> surfaces_;
  bool runs_ = true, relieves_ = true;
  bool presses_ = false;  // whether the model has follower pressures
};

}  // namespace frontalis
