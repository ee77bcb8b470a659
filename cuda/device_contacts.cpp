#include "archive_contacts.hpp"
#include "device_archive.hpp"
#include "device_model.hpp"
#include "frontalis/error.hpp"

#include <string>

namespace frontalis
{
namespace cuda
{

void DeviceModel::Contacts::archive(ByteArchive& archive)
{
  const auto contacts_to_host = [&archive](auto& contacts, auto entries)
  {
    contacts.download(entries);
    archive_contacts(entries, archive);
    contacts.upload(entries.data(), entries.size());
  };
  contacts_to_host(sliding, std::vector<SlidingContact>());
  to_host(planes, archive);
  to_host(ahead, archive);
  to_host(gliding, archive);
  contacts_to_host(gliding_searches, std::vector<GlidingSearch>());
  const std::size_t searches = searching.size();
  to_host(searching, archive);
  if (searching.size() != searches)
    throw Error("a motion with " + std::to_string(searching.size()) + " searches of planes ahead: allowed are " +
                std::to_string(searches));
}

void DeviceModel::save(Contacts& to, cudaStream_t stream) const
{
  to.sliding.assign(sliding_, stream);
  to.planes.assign(contact_planes_, stream);
  to.ahead.assign(planes_ahead_, stream);
  to.gliding.assign(gliding_, stream);
  to.gliding_searches.assign(gliding_searches_, stream);
  to.searching.assign(searching_, stream);
}

void DeviceModel::restore(const Contacts& from, cudaStream_t stream)
{
  sliding_.assign(from.sliding, stream);
  contact_planes_.assign(from.planes, stream);
  planes_ahead_.assign(from.ahead, stream);
  gliding_.assign(from.gliding, stream);
  gliding_searches_.assign(from.gliding_searches, stream);
  searching_.assign(from.searching, stream);
}

void DeviceModel::reset_contacts()
{
  const std::vector<TangentPlane> unknown(contact_planes_.size(), TangentPlane{ { 0, 0, 0, 0 }, { 0, 0, 0, -1 } });
  static_assert(nothing_ahead == -1, "a plane that is not known is none ahead either");
  contact_planes_.upload(unknown.data(), unknown.size());
  planes_ahead_.upload(unknown.data(), unknown.size());
  std::vector<GlidingContact> gliding;
  gliding_.download(gliding);
  for (auto& contact : gliding)
  {
    contact.pressing = 0;
    contact.plane = {};
    contact.plane.slip = contact.plane.limit = -1;
    contact.turned_to = { 0, 0, 0 };
  }
  gliding_.upload(gliding.data(), gliding.size());
  std::vector<GlidingSearch> searches;
  gliding_searches_.download(searches);
  for (auto& search : searches)
  {
    search.contact.forget();
    search.state = nothing_ahead;
  }
  gliding_searches_.upload(searches.data(), searches.size());
}

}  // namespace cuda
}  // namespace frontalis
