#include "frontalis/error.hpp"
#include "frontalis/model/model.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>

namespace frontalis
{
namespace
{

void check_order(const Model& model)
{
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    const auto& v = model.voxels[e];
    for (int a = 0; a < 3; ++a)
    {
      if (v[a] < 0 || v[a] >= model.size[a])
        throw Error(fmt::format("voxels: voxel {} lies at {}, outside of the grid of {}", e, v, model.size));
    }
    if (e > 0)
    {
      const auto& u = model.voxels[e - 1];
      const bool ordered = u[2] != v[2] ? u[2] < v[2] : (u[1] != v[1] ? u[1] < v[1] : u[0] < v[0]);
      if (!ordered)
        throw Error(fmt::format(
            "voxels: voxel {} at {} follows {}; voxels must be unique and ordered by k, then j, then i", e, v, u));
    }
  }
}

/// Node numbers of one plane of the grid, -1 if there is none.
struct Plane
{
  std::vector<std::int32_t> number;
  std::int32_t lowest_row = 0;
  std::int32_t end_row = 0;

  void clear(std::ptrdiff_t row_length)
  {
    std::fill(number.begin() + lowest_row * row_length, number.begin() + end_row * row_length, -1);
    lowest_row = end_row = 0;
  }

  void mark(std::int32_t i, std::int32_t j, std::ptrdiff_t row_length)
  {
    if (lowest_row == end_row)
    {
      lowest_row = j;
      end_row = j + 2;
    }
    lowest_row = std::min(lowest_row, j);
    end_row = std::max(end_row, j + 2);
    for (int b = 0; b < 4; ++b)
      number[static_cast<std::size_t>((j + (b >> 1)) * row_length + i + (b & 1))] = 0;
  }
};

}  // namespace

void build_nodes(Model& model)
{
  check_order(model);
  const std::ptrdiff_t row_length = static_cast<std::ptrdiff_t>(model.size[0]) + 1;
  const std::size_t plane_size = static_cast<std::size_t>(row_length) * (static_cast<std::size_t>(model.size[1]) + 1);
  const std::size_t voxel_count = model.voxels.size();
  model.nodes.clear();
  model.voxel_nodes.assign(voxel_count, {});

  Plane lower, upper;
  lower.number.assign(plane_size, -1);
  upper.number.assign(plane_size, -1);

  // the nodes of plane k are corners of the voxels of layers k - 1 and k: mark both, then number the plane
  std::size_t before = 0, here = 0;
  for (std::int32_t k = 0; k <= model.size[2]; ++k)
  {
    std::size_t end = here;
    while (end < voxel_count && model.voxels[end][2] == k)
      ++end;
    upper.clear(row_length);
    for (std::size_t e = before; e < end; ++e)
      upper.mark(model.voxels[e][0], model.voxels[e][1], row_length);
    for (std::int32_t j = upper.lowest_row; j < upper.end_row; ++j)
    {
      for (std::int32_t i = 0; i < row_length; ++i)
      {
        std::int32_t& number = upper.number[static_cast<std::size_t>(j * row_length + i)];
        if (number < 0)
          continue;
        number = static_cast<std::int32_t>(model.nodes.size());
        model.nodes.push_back({ i, j, k });
      }
    }
    for (std::size_t e = before; e < end; ++e)
    {
      const int half = e < here ? 4 : 0;
      for (int b = 0; b < 4; ++b)
      {
        const auto at = (model.voxels[e][1] + (b >> 1)) * row_length + model.voxels[e][0] + (b & 1);
        model.voxel_nodes[e][static_cast<std::size_t>(half + b)] = upper.number[static_cast<std::size_t>(at)];
      }
    }
    std::swap(lower, upper);
    before = here;
    here = end;
  }
}

}  // namespace frontalis
