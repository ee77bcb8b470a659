#pragma once

#include "frontalis/model/contact.hpp"
#include "model/model_archive.hpp"

#include <string>

namespace frontalis
{

template <class Archive, class Mesh>
void exchange_mesh(Archive& archive, const std::string& path, Mesh& mesh);
template <class Archive, class Field>
void exchange_field(Archive& archive, const std::string& path, Field& field);
template <class Archive, class Bound>
void exchange_binding(Archive& archive, const std::string& path, Bound& binding);

/// The contacts of a model in its file, for both directions. A model without any stores nothing.
template <class Archive, class Contacts>
void exchange_contacts(Archive& archive, const std::string& path, Contacts& contacts)
{
  if (!archive.group_if(!contacts.empty(), path))
    return;
  archive.table(path, contacts, Column{ "name", &Contact::name }, Column{ "bone", &Contact::bone },
                Column{ "friction", &Contact::friction }, Column{ "reach", &Contact::reach },
                Column{ "centre", &Contact::centre }, Column{ "mass", &Contact::mass },
                Column{ "force", &Contact::force }, Column{ "spring", &Contact::spring },
                Column{ "damping", &Contact::damping });
  for (std::size_t c = 0; c < contacts.size(); ++c)
  {
    const std::string own = path + "/" + std::to_string(c);
    exchange_field(archive, own, contacts[c].field);
    exchange_mesh(archive, own, contacts[c].shape);
    archive(own + "/points", contacts[c].points);
    archive(own + "/area", contacts[c].area);
    exchange_binding(archive, own, contacts[c].binding);
  }
}

}  // namespace frontalis
