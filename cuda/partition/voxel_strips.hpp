#pragma once

#include "frontalis/model/model.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace frontalis
{

/// Settings for cutting the voxels of a model into strips. A strip is a bundle of 32 columns of nodes, `rows` deep in
/// y, through which a warp walks along z: lanes are neighbours in x, and each lane holds its rows in registers. The
/// lanes of a strip may belong to several pieces of the model, so that thin curved shells fill them.
struct StripSettings
{
  int rows = 4;     ///< rows of nodes that a strip owns
  int planes = 64;  ///< largest number of planes of nodes that a strip owns
};

/// One entry of a strip: a node, and the voxel of which it is the lower corner.
struct StripSlot
{
  static constexpr std::uint32_t owned = 0x80000000u;    ///< this strip computes the node's force
  static constexpr std::uint32_t updated = 0x40000000u;  ///< this strip also updates the node
  static constexpr std::uint32_t node_mask = 0x3fffffffu;

  std::uint32_t node;   ///< device node with flags; 0: none
  std::uint32_t voxel;  ///< 1 + index of the model voxel, or a number that the caller puts in its place; 0: none
};

struct Strip
{
  static constexpr std::uint32_t none = 0xffffffffu;

  std::uint32_t slot_begin;  ///< layout of slots: [plane][row 0 .. rows + 1][lane]
  std::uint32_t planes;
  std::uint32_t fibre_begin;  ///< layout of words: [plane][row 0 .. rows][lane]; no words without fibres
};

/// Index of a voxel's first fibre entry * 16 + number of entries; 0: no fibres. Throws Error if there are more than 15
/// entries.
std::uint32_t fibre_word(const Model& model, std::uint32_t voxel);

/// The strips of a model. Device nodes are numbered from 1 in the order of the strips; node 0 is a fixed placeholder.
struct VoxelStrips
{
  VoxelStrips(const Model& model, const StripSettings& settings);

  int rows = 0;
  std::vector<Strip> strips;  ///< in descending order of cost
  std::vector<StripSlot> slots;
  std::vector<std::uint32_t> fibre_words;  ///< fibre_word() of each entry; 0: none
  std::vector<std::uint32_t> device_node;  ///< number of each model node on the device

  /// Fraction of the entries that have a voxel, among the rows with at least one voxel.
  double filled() const;
  /// Fraction of the entries that have fibres, among the rows with at least one such entry; 0 without fibres.
  double filled_by_fibres() const;
};

}  // namespace frontalis
