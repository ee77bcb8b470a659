#pragma once

#include "frontalis/model/model.hpp"

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace frontalis
{

/// Sparse grid that finds the voxels at (i, j, k). Only blocks of 8^3 cells that hold a voxel are stored.
class VoxelIndex
{
public:
  /// Indexes the voxels by the places where they rest. Several voxels may rest at one place.
  explicit VoxelIndex(const Model& model) : VoxelIndex(model.voxels, model.size)
  {
    if (model.flaps.empty())
      return;
    std::vector<std::array<std::int32_t, 3>> places;
    places.reserve(model.voxels.size());
    for (const auto& voxel : model.voxels)
      places.push_back(rest_place(model, voxel));
    *this = VoxelIndex(places, model.size);
  }
  VoxelIndex(const std::vector<std::array<std::int32_t, 3>>& voxels, const std::array<std::int32_t, 3>& size)
      : size_(size)
  {
    for (int a = 0; a < 3; ++a)
      blocks_[a] = (size[a] + 7) / 8;
    first_.assign(std::size_t{ 1 } * blocks_[0] * blocks_[1] * blocks_[2], -1);
    for (std::size_t e = 0; e < voxels.size(); ++e)
    {
      std::int32_t& first = first_[block(voxels[e])];
      if (first < 0)
      {
        first = static_cast<std::int32_t>(number_.size() / 512);
        number_.resize(number_.size() + 512, -1);
      }
      std::int32_t& at = number_[std::size_t{ 512 } * first + within(voxels[e])];
      if (at >= 0)
        before_[static_cast<std::int32_t>(e)] = at;
      at = static_cast<std::int32_t>(e);
    }
  }

  /// Index of a voxel at `place`, the last one if there are several; -1 if there is none.
  std::int32_t find(const std::array<std::int32_t, 3>& place) const
  {
    for (int a = 0; a < 3; ++a)
      if (place[a] < 0 || place[a] >= size_[a])
        return -1;
    const std::int32_t first = first_[block(place)];
    return first < 0 ? -1 : number_[std::size_t{ 512 } * first + within(place)];
  }

  /// Index of another voxel at the place of a voxel that was found; -1 if there is no further one.
  std::int32_t another(std::int32_t voxel) const
  {
    const auto found = before_.find(voxel);
    return found == before_.end() ? -1 : found->second;
  }

private:
  std::size_t block(const std::array<std::int32_t, 3>& p) const
  {
    return (std::size_t{ 1 } * (p[2] / 8) * blocks_[1] + p[1] / 8) * blocks_[0] + p[0] / 8;
  }
  static std::size_t within(const std::array<std::int32_t, 3>& p) { return (p[2] % 8 * 8 + p[1] % 8) * 8 + p[0] % 8; }

  std::array<std::int32_t, 3> size_;
  std::array<std::int32_t, 3> blocks_{};
  std::vector<std::int32_t> first_;
  std::vector<std::int32_t> number_;
  std::unordered_map<std::int32_t, std::int32_t> before_;
};

}  // namespace frontalis
