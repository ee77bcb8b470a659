#pragma once

#include "cuda/backend/device_memory.hpp"
#include "cuda/backend/tissue_contact_tables.hpp"
#include "cuda/partition/voxel_patches.hpp"

#include <vector_types.h>

namespace frontalis
{
namespace cuda
{

/// The constant arrays of TouchPatches, on the host.
struct TouchPatchTables
{
  TouchPatchTables(const TouchTables& tables, const VoxelPatches& patches);

  std::vector<TouchPatch> patches;
  std::vector<uint4> corners;
  std::vector<std::uint32_t> vertex_of;
  std::vector<BoundVoxel> voxels;
  std::vector<std::uint16_t> copy_of;
  std::vector<std::uint32_t> near_begin;
  std::vector<std::uint16_t> near;
  std::vector<std::uint32_t> watch_begin;
  std::vector<std::uint16_t> watched;
  float slide, per_newton;
  std::size_t vertices;
  std::size_t most_entries = 0;  ///< number of entries that all lists together can have

private:
  void add_vertices(const TouchTables& tables, const VoxelPatches& cut);
  void add_near(const TouchTables& tables);
};

/// TouchPatches in device memory.
class DeviceTouchPatches
{
public:
  explicit DeviceTouchPatches(const TouchPatchTables& tables);
  TouchPatches view() const;
  std::size_t bytes() const;

private:
  float slide_, per_newton_;
  DeviceArray<TouchPatch> patches_;
  DeviceArray<uint4> corners_;
  DeviceArray<std::uint32_t> vertex_of_, near_begin_, watch_begin_, counts_, lists_, entry_vertex_;
  DeviceArray<BoundVoxel> voxels_;
  DeviceArray<std::uint16_t> copy_of_, near_, watched_;
  DeviceArray<TouchEntry> entries_;
  DeviceArray<float4> before_, words_[2], ended_[2];
};

}  // namespace cuda
}  // namespace frontalis
