#pragma once

#include "frontalis/model/model.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace frontalis
{

/// Distribution of the nodes: each of `blocks` thread blocks processes `turns` patches in turn.
struct PatchSettings
{
  int blocks = 132;
  int turns = 1;
};

/// What points that are bound to voxels require of the partition, one entry per voxel of the model. Empty lists:
/// nothing.
struct BoundWork
{
  std::vector<float> cost;  ///< cost of the voxel's points, relative to a voxel without effects
  /// Other voxels whose nodes a patch with this voxel needs as well. The relation is symmetric, so that patches that
  /// read each other's nodes wait for each other.
  std::vector<std::vector<std::int32_t>> beside;
};

/// A compact part of the model that a block keeps in shared memory: the nodes that it owns, all their voxels, and the
/// halo. The halo consists of the other nodes of these voxels and of the nodes that BoundWork requires.
struct Patch
{
  std::uint32_t first_node;   ///< device node; own nodes are contiguous
  std::uint32_t nodes;        ///< number of own nodes
  std::uint32_t border;       ///< number of own nodes that lie in halos of other patches; they come first
  std::uint32_t voxel_begin;  ///< index of the first voxel in VoxelPatches::voxel
  std::uint32_t voxels;
  std::uint32_t laws;        ///< number of voxels with laws other than neo-Hookean; they come first
  std::uint32_t special;     ///< number of voxels that have such laws, fibres or viscosity; they come first
  std::uint32_t halo_begin;  ///< index of the first halo node in VoxelPatches::halo
  std::uint32_t halo;
};

/// The patches of a model. Patch p belongs to block p % blocks. Device nodes are numbered patch by patch from 1; node 0
/// is a placeholder. In the shared memory of a block, the halo of the present patch has the indices 0 to most_halo - 1;
/// the nodes of all its patches follow in order.
struct VoxelPatches
{
  VoxelPatches(const Model& model, const PatchSettings& settings, const BoundWork& bound = {});

  /// Index of the patch that owns a device node.
  std::size_t patch_of(std::uint32_t node) const;
  /// Index in shared memory of a device node of the patch.
  std::uint32_t place_of(std::size_t patch, std::uint32_t node) const;
  /// Largest sum over the voxels of a patch, of numbers given for each voxel of the model.
  std::uint32_t most_in_patch(const std::vector<std::uint32_t>& in_voxel) const;

  std::vector<Patch> patches;
  /// model voxels; in each patch those with laws other than neo-Hookean come first, then viscous ones, then the others
  /// by number of fibres
  std::vector<std::uint32_t> voxel;
  std::vector<std::array<std::uint16_t, 8>> corner;  ///< indices of its corners in shared memory
  std::vector<std::uint32_t> halo;                   ///< device nodes
  /// For each device node, the voxels of its patch whose corner 0 .. 7 the node is; most_voxels if there is none.
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
