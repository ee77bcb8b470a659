#include "solver/stepping/effect_parts.hpp"

#include "solver/contact/body_contact.hpp"
#include "solver/contact/contact_stiffness.hpp"
#include "solver/contact/tissue_contact.hpp"
#include "solver/shell/shell_forces.hpp"
#include "solver/shell/shell_stiffness.hpp"
#include "solver/stepping/attached_nodes.hpp"
#include "solver/stepping/nodal_loads.hpp"
#include "solver/stepping/restricted_nodes.hpp"

namespace frontalis
{

template <class Real>
std::vector<std::unique_ptr<NodePart<Real>>> node_parts(const Model& model, const Discretisation& discretisation,
                                                        const PartKernels<Real>& kernels)
{
  std::vector<std::unique_ptr<NodePart<Real>>> parts;
  parts.push_back(std::make_unique<RestrictedNodes<Real>>(model, kernels.slide));
  parts.push_back(std::make_unique<AttachedNodes<Real>>(model, discretisation.node_mass, kernels.attach));
  parts.push_back(std::make_unique<NodalLoads<Real>>(model, discretisation));
  parts.push_back(std::make_unique<ShellForces<Real>>(model, kernels.shell));
  parts.push_back(std::make_unique<BodyContact<Real>>(model, discretisation, kernels.point));
  parts.push_back(std::make_unique<TissueContact<Real>>(model, discretisation, kernels.touch));
  return parts;
}

template std::vector<std::unique_ptr<NodePart<float>>> node_parts(const Model&, const Discretisation&,
                                                                  const PartKernels<float>&);
template std::vector<std::unique_ptr<NodePart<double>>> node_parts(const Model&, const Discretisation&,
                                                                   const PartKernels<double>&);

std::vector<EnergyTerm> energy_terms_of_effects()
{
  using Kind = EnergyTerm::Kind;
  return {
    { "contact", Kind::work },           // work of the motion of bodies that tissue touches
    { "contact_stored", Kind::stored },  // energy in the stiffness of contact
    { "shell", Kind::stored },           // energy of layers that are shells
  };
}

std::vector<std::shared_ptr<AddedStiffness>> added_stiffness(const Model& model, const Discretisation& discretisation)
{
  std::vector<std::shared_ptr<AddedStiffness>> added;
  if (!model.contacts.empty() || !model.self_contacts.empty())
    added.push_back(std::make_shared<ContactStiffness>(model, discretisation));
  if (!model.shells.empty())
    added.push_back(std::make_shared<ShellStiffness>(model, discretisation));
  return added;
}

}  // namespace frontalis
