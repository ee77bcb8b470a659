#include "solver/contact/archive_contacts.hpp"
#include "cuda/backend/device_archive.hpp"
#include "cuda/backend/device_model.hpp"
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
  // kernels keep pointers to these arrays, so their addresses and sizes must not change
  const auto same_count_to_host = [&archive](auto& array, const char* what)
  {
    const std::size_t count = array.size();
    to_host(array, archive);
    if (array.size() != count)
      throw Error("a motion with " + std::to_string(array.size()) + " " + what + ": allowed are " +
                  std::to_string(count));
  };
  contacts_to_host(sliding, std::vector<SlidingContact>());
  same_count_to_host(planes, "tangent planes");
  same_count_to_host(ahead, "tangent planes ahead");
  same_count_to_host(rubbing, "nodes with friction");
  same_count_to_host(gliding, "nodes on moving surfaces");
  contacts_to_host(gliding_searches, std::vector<GlidingSearch>());
  same_count_to_host(searching, "searches of planes ahead");
}

void DeviceModel::save(Contacts& to, cudaStream_t stream) const
{
  to.sliding.assign(sliding_, stream);
  to.planes.assign(contact_planes_, stream);
  to.ahead.assign(planes_ahead_, stream);
  to.rubbing.assign(rubbing_, stream);
  to.gliding.assign(gliding_, stream);
  to.gliding_searches.assign(gliding_searches_, stream);
  to.searching.assign(searching_, stream);
}

void DeviceModel::restore(const Contacts& from, cudaStream_t stream)
{
  sliding_.assign(from.sliding, stream);
  contact_planes_.assign(from.planes, stream);
  planes_ahead_.assign(from.ahead, stream);
  rubbing_.assign(from.rubbing, stream);
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
  std::vector<RubbingContact> rubbing;
  rubbing_.download(rubbing);
  for (auto& contact : rubbing)
    contact.pressing = contact.turning = 0;
  rubbing_.upload(rubbing.data(), rubbing.size());
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
