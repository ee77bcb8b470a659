#pragma once

#include "solver/cpu/slide_kernel.hpp"
#include "solver/stepping/node_part.hpp"

#include <memory>
#include <vector>

namespace frontalis
{

/// The parts of all effects on nodes, in the order in which their forces are added.
template <class Real>
std::vector<std::unique_ptr<NodePart<Real>>> node_parts(const Model& model, const Discretisation& discretisation,
                                                        SlideKernel<Real> slide);

/// Terms of the energy ledger that only some effect has.
std::vector<EnergyTerm> energy_terms_of_effects();

/// What the effects of a model add to the stiffness of its voxels, whose bounds do not include it yet.
std::vector<std::shared_ptr<AddedStiffness>> added_stiffness(const Model& model,
                                                                   const Discretisation& discretisation);

}  // namespace frontalis
