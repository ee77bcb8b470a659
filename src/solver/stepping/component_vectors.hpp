#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace frontalis
{

/// Vectors of the first nodes, kept as three arrays, one after the other.
template <class Real>
void interleave(const std::array<std::vector<Real>, 3>& in, std::size_t nodes, std::vector<std::array<double, 3>>& out)
{
  out.resize(nodes);
  for (std::size_t n = 0; n < nodes; ++n)
    out[n] = { { double(in[0][n]), double(in[1][n]), double(in[2][n]) } };
}

/// Vectors of the first nodes to three arrays, which have room for them.
template <class Real>
void separate(const std::vector<std::array<double, 3>>& in, std::array<std::vector<Real>, 3>& out)
{
  for (std::size_t n = 0; n < in.size(); ++n)
    for (std::size_t axis = 0; axis < 3; ++axis)
      out[axis][n] = static_cast<Real>(in[n][axis]);
}

}  // namespace frontalis
