#pragma once

#include "frontalis/byte_archive.hpp"

namespace frontalis
{

/// Writes or reads entries that have a SurfaceContact `contact`. Addresses of surfaces are not restored: contacts keep
/// the surfaces that they have. Throws Error if the number of entries differs.
template <class T>
void archive_contacts(std::vector<T>& entries, ByteArchive& archive)
{
  const std::vector<T> present = entries;
  archive(entries);
  if (entries.size() != present.size())
    throw Error("a motion with " + std::to_string(entries.size()) + " sliding nodes: allowed are " +
                std::to_string(present.size()));
  for (std::size_t e = 0; e < entries.size(); ++e)
    entries[e].contact.stay_on(present[e].contact);
}

}  // namespace frontalis
