#pragma once

#include "frontalis/byte_archive.hpp"

namespace frontalis
{

/// Entries with a SurfaceContact `contact`, but for the address of its surface: read back, contacts stay on the
/// surfaces of those that are there. Throws Error where these are not as many.
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
