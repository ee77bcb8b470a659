#pragma once

#include "solver/stepping/discretisation.hpp"

#include <array>
#include <vector>

namespace frontalis
{

/// Nodes whose mass is scaled while others' is not: gravity on them is too large.
std::vector<std::int32_t> relieved_nodes(const Model& model, const Discretisation& discretisation);
/// Force that corrects gravity on such a node [N].
std::array<double, 3> gravity_relief(const Model& model, const Discretisation& discretisation, std::int32_t node);

/// Tractions and follower pressures on bound surfaces as nodal forces, through the transposed binding, added in a fixed
/// order; and the correction of gravity where selective mass scaling has made nodes heavier.
class NodalLoads
{
public:
  NodalLoads(const Model& model, const Discretisation& discretisation);

  /// Loads and the correction of gravity act only while their effects run.
  void run(EffectSet running);
  void list_allocations(AllocationList& list) const;
  bool idle() const
  {
    const bool loaded = runs_ && !surfaces_.empty();
    return !loaded && !(relieves_ && !relief_.empty());
  }
  const std::vector<std::int32_t>& nodes() const { return nodes_; }             ///< loaded nodes, ascending
  const std::vector<std::array<double, 3>>& forces() const { return forces_; }  ///< [N], one per loaded node

  /// The same without the correction of gravity.
  const std::vector<std::array<double, 3>>& surface_forces() const { return surface_forces_; }

  /// Forces at a time, from the present nodal displacements.
  template <class Real>
  void update(double time, const Real* const u[3]);

private:
  struct Contribution
  {
    std::int32_t vertex;
    float weight;
  };
  struct Surface
  {
    const Load* load;
    std::vector<std::int32_t> begin;  // of each loaded node's contributions
    std::vector<Contribution> contributions;
    std::vector<std::array<double, 3>> vertex_force;
    std::vector<std::array<double, 3>> vertices;
  };

  const Model& model_;
  std::vector<std::int32_t> nodes_;
  std::vector<std::array<double, 3>> surface_forces_, forces_;
  std::vector<std::array<double, 3>> relief_;  // one per loaded node; empty where nothing is too heavy
  std::vector<Surface> surfaces_;
  bool runs_ = true, relieves_ = true;
};

}  // namespace frontalis
