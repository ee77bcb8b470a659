#pragma once

#include "solver/stepping/discretisation.hpp"
#include "frontalis/byte_archive.hpp"

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
  double friction = 0;    ///< of it, lost to friction: 0 or more
  double damping = 0;     ///< lost to mass-proportional damping: 0 or more
  double viscous = 0;     ///< taken up by viscous stresses
};

/// Work up to now, per node plane.
struct WorkBook
{
  std::vector<double> muscle;   ///< one per plane, filled by the backend
  std::vector<double> viscous;  ///< two per plane: sum of change of H : E, and of H : E now (physics/viscosity.hpp)
  std::vector<Work> planes;
  /// By how much constraints moved each node in the latest step, other than by dt times its velocity [m].
  std::array<std::vector<double>, 3> beside;

  void archive(ByteArchive& archive) { archive(muscle)(viscous)(planes)(beside); }
};

/// Keeps account of the work of each step's impulses on the nodes, along the mean of the velocities before and after
/// the step: the sum is exactly the change of kinetic energy. Each plane is summed in double precision by itself, so
/// that the result does not depend on which thread sums it. Real is the backend's number type.
template <class Real>
class EnergyAccount : public WorkBook
{
public:
  using Book = WorkBook;

  EnergyAccount(const Model& model, const Discretisation& discretisation);

  void open();
  /// Velocities before the update of nodes [first, last).
  void before(std::int32_t first, std::int32_t last, const Real* const v[3]) { copy(first, last, v, before_); }
  /// The same after the update and the loads, before constraints.
  void unconstrained(std::int32_t first, std::int32_t last, const Real* const v[3]) { copy(first, last, v, free_); }
  /// Adds the step's work in planes [first, last). damping [1/s], dt [s]; kick: for how long forces changed velocities
  /// [s]; u_before, u: displacements before and after the step [m]. Where constraints moved a node by d beside dt v,
  /// the other forces worked along d too, by the mean of this step's and the next, and the constraints took that away.
  void after(std::int32_t first, std::int32_t last, const Real* const u_before[3], const Real* const u[3],
             const Real* const v[3], double damping, double dt, double kick);
  /// Adds what friction took in plane k; restricted: RestrictedNodes<Real>.
  template <class Restricted>
  void friction(std::int32_t k, const Restricted& restricted, const Real* const v[3])
  {
    const Real* const old[3] = { before_[0].data(), before_[1].data(), before_[2].data() };
    const Real* const free[3] = { free_[0].data(), free_[1].data(), free_[2].data() };
    planes[k].friction += restricted.friction_loss(plane_nodes_[k], plane_nodes_[k + 1], mass_, old, free, v);
  }
  /// Adds the work of a force on a node of a plane over the step, after after(); kick as there.
  void load(std::int32_t plane, std::int32_t node, const std::array<double, 3>& force, const Real* const v[3],
            double kick);
  Work work() const;

  void list_allocations(AllocationList& list) const;
  /// All that is in the account between two steps.
  const Book& book() const { return *this; }
  void restore(const Book& book) { static_cast<Book&>(*this) = book; }

private:
  using Field = std::array<std::vector<Real>, 3>;
  static void copy(std::int32_t first, std::int32_t last, const Real* const v[3], Field& to);

  const std::vector<double>& mass_;
  std::vector<std::int32_t> plane_nodes_;
  Field before_, free_;
};

}  // namespace frontalis
