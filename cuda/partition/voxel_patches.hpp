#pragma once

#include "frontalis/model/model.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace frontalis
{

/// Distribution of the nodes: each of `blocks` thread blocks processes `turns` patches one after the other.
struct PatchSettings
{
  int blocks = 132;
  int turns = 1;
};

/// What points that are bound to voxels ask of patches, for each voxel of the model; empty: nothing.
struct BoundWork
{
  std::vector<float> cost;  ///< of its points, relative to a voxel without effects
  /// Other voxels whose nodes a patch that has the voxel needs as well. The relation is symmetric, so that patches that
  /// read each other's nodes wait for each other.
  std::vector<std::vector<std::int32_t>> beside;
};

/// A compact part of the model that a block keeps in shared memory: the nodes that it owns, all their voxels, and the
/// halo, which is the other nodes of those voxels and those that BoundWork asks for.
struct Patch
{
  std::uint32_t first_node;   ///< device node; own nodes are contiguous
  std::uint32_t nodes;        ///< number of own nodes
  std::uint32_t border;       ///< number of leading own nodes that lie in halos of other patches
  std::uint32_t voxel_begin;  ///< first index into VoxelPatches::voxel
  std::uint32_t voxels;
  std::uint32_t special;     ///< number of leading voxels that have fibres or viscosity
  std::uint32_t halo_begin;  ///< first index into VoxelPatches::halo
  std::uint32_t halo;
};

/// The patches of a model. Patch p belongs to block p % blocks. Device nodes are numbered patch by patch from 1; node 0
/// is a placeholder. The shared memory of a block has the halo of the present patch first, at indices 0 .. most_halo -
/// 1, then the nodes of all its patches in order.
struct VoxelPatches
{
  VoxelPatches(const Model& model, const PatchSettings& settings, const BoundWork& bound = {});

  /// Index in shared memory of a device node that the patch has.
  std::uint32_t place_of(std::size_t patch, std::uint32_t node) const;

  std::vector<Patch> patches;
  std::vector<std::uint32_t> voxel;  ///< model voxel; in each patch viscous ones first, then by number of fibres
  std::vector<std::array<std::uint16_t, 8>> corner;  ///< indices of its corners in shared memory
  std::vector<std::uint32_t> halo;                   ///< device nodes
  /// For each device node, the voxels of its patch of which it is corner 0 .. 7; most_voxels if there is none.
  std::vector<std::array<std::uint16_t, 8>> node_voxel;
  std::vector<std::uint32_t> device_node;  ///< number of each model node on the device
  std::vector<std::uint32_t> first_place;  ///< index of the first own node of each patch in shared memory

  std::uint32_t blocks;
  std::uint32_t most_voxels = 0, most_halo = 0;  ///< per patch
  std::uint32_t most_nodes = 0;                  ///< per block, over all its patches
  bool fits_indices = true;                      ///< whether indices of 16 bits suffice

private:
  void number_nodes(std::size_t count, const std::vector<std::vector<std::uint32_t>>& nodes_of);
  void add_patch(const Model& model, std::size_t index, const std::vector<std::uint32_t>& voxels);
};

}  // namespace frontalis
