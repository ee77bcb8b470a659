#pragma once

#include "solver/stepping/restricted_nodes.hpp"
#include "solver/stepping/step_backend.hpp"

#include <tuple>

namespace frontalis
{

/// State of a backend in host memory: copies of its arrays, contacts and work. Real is its number type.
template <class Real, class... Arrays>
struct HostState : BackendState
{
  std::tuple<Arrays...> arrays;
  typename RestrictedNodes<Real>::Contacts contacts;
  WorkBook book;

  void archive(ByteArchive& archive) override
  {
    std::apply([&](auto&... array) { (archive(array), ...); }, arrays);
    contacts.archive(archive);
    book.archive(archive);
  }
};

/// Vectors of the first nodes from three arrays.
template <class Real>
void interleave(const std::array<std::vector<Real>, 3>& in, std::size_t nodes, NodalVectors& out)
{
  out.resize(nodes);
  for (std::size_t n = 0; n < nodes; ++n)
    out[n] = { { double(in[0][n]), double(in[1][n]), double(in[2][n]) } };
}

/// The same back to three arrays, which may be longer.
template <class Real>
void separate(const NodalVectors& in, std::array<std::vector<Real>, 3>& out)
{
  for (std::size_t n = 0; n < in.size(); ++n)
    for (std::size_t axis = 0; axis < 3; ++axis)
      out[axis][n] = static_cast<Real>(in[n][axis]);
}

}  // namespace frontalis
