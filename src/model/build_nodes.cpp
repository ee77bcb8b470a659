#include "frontalis/error.hpp"
#include "frontalis/model/model.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>

namespace frontalis
{
namespace
{

constexpr std::int32_t most_along_axis = 1 << 20;
constexpr double most_in_plane = 1 << 28;

void check_order(const Model& model)
{
  for (const std::int32_t voxels : model.size)
    if (voxels < 0 || voxels > most_along_axis)
      throw Error(fmt::format("size: {} voxels; a grid has 0 to {} along each axis", model.size, most_along_axis));
  if (double(model.size[0]) * double(model.size[1]) > most_in_plane)
    throw Error(fmt::format("size: {} voxels; a plane of a grid has at most {:.0f}", model.size, most_in_plane));
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    const auto& v = model.voxels[e];
    for (int axis = 0; axis < 3; ++axis)
      if (v[axis] < 0 || v[axis] >= model.size[axis])
        throw Error(fmt::format("voxels: voxel {} lies at {}, outside of the grid of {}", e, v, model.size));
    if (e == 0)
      continue;
    const auto& u = model.voxels[e - 1];
    if (!std::lexicographical_compare(u.rbegin(), u.rend(), v.rbegin(), v.rend()))
      throw Error(fmt::format(
          "voxels: voxel {} at {} follows {}; voxels must be unique and ordered by k, then j, then i", e, v, u));
  }
}

}  // namespace

void build_nodes(Model& model)
{
  check_order(model);
  const std::ptrdiff_t row_length = static_cast<std::ptrdiff_t>(model.size[0]) + 1;
  const std::size_t voxel_count = model.voxels.size();
  model.nodes.clear();
  model.voxel_nodes.assign(voxel_count, {});

  // Numbers of the nodes in one plane of the grid; -1: no node.
  std::vector<std::int32_t> number(static_cast<std::size_t>(row_length * (model.size[1] + 1)));
  // Index within the plane of a voxel's lower corner 0 to 3 (i + 2j).
  const auto place = [&](std::size_t e, std::size_t corner)
  {
    const auto row = static_cast<std::ptrdiff_t>(model.voxels[e][1] + (corner >> 1));
    return row * row_length + model.voxels[e][0] + static_cast<std::ptrdiff_t>(corner & 1);
  };

  // The nodes of plane k are corners of the voxels in layers k - 1 and k. Mark the corners of both layers, then number
  // the plane.
  std::size_t before = 0, here = 0;
  for (std::int32_t k = 0; k <= model.size[2]; ++k)
  {
    std::size_t end = here;
    while (end < voxel_count && model.voxels[end][2] == k)
      ++end;
    std::ptrdiff_t lowest = number.size(), highest = -1;
    for (std::size_t e = before; e < end; ++e)
    {
      lowest = std::min(lowest, place(e, 0));
      highest = std::max(highest, place(e, 3));
    }
    if (lowest <= highest)
      std::fill(number.begin() + lowest, number.begin() + highest + 1, -1);
    for (std::size_t e = before; e < end; ++e)
      for (std::size_t corner = 0; corner < 4; ++corner)
        number[place(e, corner)] = 0;
    for (std::ptrdiff_t at = lowest; at <= highest; ++at)
      if (number[at] == 0)
      {
        number[at] = static_cast<std::int32_t>(model.nodes.size());
        model.nodes.push_back(
            { static_cast<std::int32_t>(at % row_length), static_cast<std::int32_t>(at / row_length), k });
      }
    for (std::size_t e = before; e < end; ++e)
      for (std::size_t corner = 0; corner < 4; ++corner)
        model.voxel_nodes[e][e < here ? 4 + corner : corner] = number[place(e, corner)];
    before = here;
    here = end;
  }
}

}  // namespace frontalis
