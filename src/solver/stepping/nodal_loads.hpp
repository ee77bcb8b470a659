#pragma once

#include "solver/stepping/discretisation.hpp"

#include <array>
#include <vector>

namespace frontalis
{

/// Nodes with selectively scaled mass, whose weight would be too large.
std::vector<std::int32_t> relieved_nodes(const Model& model, const Discretisation& discretisation);
/// Force that corrects gravity on such a node [N].
std::array<double, 3> gravity_relief(const Model& model, const Discretisation& discretisation, std::int32_t node);

/// Tractions and follower pressures on bound surfaces as nodal forces, through the transposed binding and summed in a
/// fixed order; and the correction of gravity for selective mass scaling.
class NodalLoads : public EffectPart
{
public:
  NodalLoads(const Model& model, const Discretisation& discretisation);

  /// Switches loads and the correction of gravity on or off with their effects.
  void run(EffectSet running) override;
  void reset() override {}
  void list_arrays(ArrayList& list) override;
  bool idle() const
  {
    const bool loaded = runs_ && !surfaces_.empty();
    return !loaded && !(relieves_ && !relief_.empty());
  }
  const std::vector<std::int32_t>& nodes() const { return nodes_; }             ///< loaded nodes, ascending
  const std::vector<std::array<double, 3>>& forces() const { return forces_; }  ///< [N], one per loaded node

  /// The forces without the correction of gravity.
  const std::vector<std::array<double, 3>>& surface_forces() const { return surface_forces_; }

  /// Computes the forces at a time from the present nodal displacements.
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
    std::vector<std::int32_t> begin;  // start of each loaded node's contributions
    std::vector<Contribution> contributions;
    std::vector<std::array<double, 3>> vertex_force;
    std::vector<std::array<double, 3>> vertices;
  };

  const Model& model_;
  std::vector<std::int32_t> nodes_;
  std::vector<std::array<double, 3>> surface_forces_, forces_;
  std::vector<std::array<double, 3>> relief_;  // one per loaded node; empty without scaled mass
  std::vector<Surface> surfaces_;
  bool runs_ = true, relieves_ = true;
};

}  // namespace frontalis
