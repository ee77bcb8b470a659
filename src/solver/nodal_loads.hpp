#pragma once

#include "frontalis/model/model.hpp"

#include <array>
#include <vector>

namespace frontalis
{

/// Tractions and follower pressures on bound surfaces as nodal forces, through the transposed binding. Forces are added
/// in a fixed order.
class NodalLoads
{
public:
  explicit NodalLoads(const Model& model);

  bool empty() const { return nodes_.empty(); }
  const std::vector<std::int32_t>& nodes() const { return nodes_; }             ///< loaded nodes, ascending
  const std::vector<std::array<double, 3>>& forces() const { return forces_; }  ///< [N], one a loaded node

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
  std::vector<std::array<double, 3>> forces_;
  std::vector<Surface> surfaces_;
};

}  // namespace frontalis
