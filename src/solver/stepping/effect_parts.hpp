#pragma once

#include "solver/cpu/part_kernels.hpp"
#include "solver/stepping/node_part.hpp"

#include <memory>
#include <vector>

namespace frontalis
{

/// The parts of all effects on nodes, in the order in which their forces are added.
template <class Real>
std::vector<std::unique_ptr<NodePart<Real>>> node_parts(const Model& model, const Discretisation& discretisation,
                                                        const PartKernels<Real>& kernels);

/// Terms of the energy ledger that exist because of an effect.
std::vector<EnergyTerm> energy_terms_of_effects();

/// Stiffness that effects of a model add to its voxels. The voxels' bounds must not include this stiffness yet.
std::vector<std::shared_ptr<AddedStiffness>> added_stiffness(const Model& model, const Discretisation& discretisation);

}  // namespace frontalis
