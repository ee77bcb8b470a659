#pragma once

#include "solver/stepping/discretisation.hpp"

#include <array>
#include <vector>

namespace frontalis
{

/// Work on the nodes since the account was opened [J].
struct Work
{
  double muscle = 0;      ///< done by fibres, active and passive
  double load = 0;        ///< done by surface loads
  double constraint = 0;  ///< done by rigid, prescribed and sliding nodes, friction included
  double friction = 0;    ///< lost to friction, not negative; included in `constraint`
  double damping = 0;     ///< lost to mass-proportional damping, not negative
  double viscous = 0;     ///< absorbed by viscous stresses
};

/// Records the work of each step's impulses on the nodes. An impulse acts along the mean of the velocities before and
/// after the step, so that all works add up to the change of kinetic energy exactly. Each plane has its own sums, in
/// double precision, so that the result does not depend on which thread processes a plane. Real is the backend's number
/// type.
template <class Real>
class EnergyAccount
{
public:
  EnergyAccount(const Model& model, const Discretisation& discretisation);

  void open();
  /// Stores the velocities before the update of nodes [first, last).
  void before(std::int32_t first, std::int32_t last, const Real* const v[3]) { copy(first, last, v, before_); }
  /// Stores the velocities after the update and the loads, before constraints.
  void unconstrained(std::int32_t first, std::int32_t last, const Real* const v[3]) { copy(first, last, v, free_); }
  /// Adds the step's work in planes [first, last). damping [1/s], dt [s]; kick: time over which forces changed
  /// velocities [s]; u_before, u: displacements before and after the step [m]. Constraints may have moved a node by d
  /// in addition to dt v. The mean of the other forces in this step and the next then does work along d too, which the
  /// constraints absorb.
  void after(std::int32_t first, std::int32_t last, const Real* const u_before[3], const Real* const u[3],
             const Real* const v[3], double damping, double dt, double kick);
  /// Adds the friction work in plane k. `restricted`: a RestrictedNodes<Real>.
  template <class Restricted>
  void friction(std::int32_t k, const Restricted& restricted, const Real* const v[3])
  {
    const Real* const old[3] = { before_[0].data(), before_[1].data(), before_[2].data() };
    const Real* const free[3] = { free_[0].data(), free_[1].data(), free_[2].data() };
    planes_[k].friction += restricted.friction_loss(plane_nodes_[k], plane_nodes_[k + 1], mass_, old, free, v);
  }
  /// Adds the work that a force [N] does on a node of a plane in the step. Call load() after after(), with the same
  /// `kick`.
  void load(std::int32_t plane, std::int32_t node, const std::array<double, 3>& force, const Real* const v[3],
            double kick);
  Work work() const;

  void list_arrays(ArrayList& list);

  std::vector<double> muscle;   ///< work of fibres, one per plane, filled by the backend [J]
  std::vector<double> viscous;  ///< two per plane: change of H : E, and present H : E (physics/viscosity.hpp)

private:
  using Field = std::array<std::vector<Real>, 3>;
  static void copy(std::int32_t first, std::int32_t last, const Real* const v[3], Field& to);

  const std::vector<double>& mass_;
  std::vector<std::int32_t> plane_nodes_;
  std::vector<Work> planes_;
  std::array<std::vector<double>, 3> beside_;  // displacement by constraints in the latest step in addition to dt v [m]
  Field before_, free_;
};

}  // namespace frontalis
