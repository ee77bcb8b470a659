#include "frontalis/model/self_contact.hpp"

#include "model/effect_description.hpp"
#include "model/model_checks.hpp"
#include "model/model_layout.hpp"

namespace frontalis
{
namespace
{

EffectPresence found(const Model& model)
{
  std::size_t points = 0;
  for (const SelfContact& contact : model.self_contacts)
    points += contact.surface.vertices.size();
  return { points > 0,
           points > 0 ? fmt::format("{} point{} of tissue", points, points == 1 ? "" : "s") : "no surface that touches",
           0, points };
}

void check(const Model& model)
{
  using namespace checks;
  for (const SelfContact& contact : model.self_contacts)
  {
    const std::string name = "self_contacts '" + contact.name + "'";
    check_not_negative(name, "friction", contact.friction);
    check_mesh(name, contact.surface);
    check_binding(name + ".binding", contact.binding, contact.surface.vertices.size(), model.voxels.size());
  }
}

// Writes or reads the self-contacts of a model file. The file of a model without them has no arrays for them.
template <class Archive, class Contacts>
void exchange(Archive& archive, Contacts& contacts)
{
  const std::string path = "self_contacts";
  if (!archive.group_if(!contacts.empty(), path))
    return;
  archive.table(path, contacts, Column{ "name", &SelfContact::name }, Column{ "friction", &SelfContact::friction });
  for (std::size_t c = 0; c < contacts.size(); ++c)
  {
    const std::string own = path + "/" + std::to_string(c);
    exchange_mesh(archive, own, contacts[c].surface);
    exchange_binding(archive, own, contacts[c].binding);
  }
}

}  // namespace

EffectDescription self_contact_description()
{
  return { Effect::self_contact,
           found,
           [](Model& model, EffectSet) { model.self_contacts.clear(); },
           check,
           [](ModelWriter& archive, const Model& model) { exchange(archive, model.self_contacts); },
           [](ModelReader& archive, Model& model) { exchange(archive, model.self_contacts); } };
}

}  // namespace frontalis
