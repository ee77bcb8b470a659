#pragma once

#include "frontalis/physics/attachment.hpp"

#include <cstdint>

namespace frontalis
{

/// A master and the range of the nodes that follow it.
struct AttachedGroup
{
  float rest[3];             ///< rest position of the master [m]
  float mass;                ///< of the master [kg]
  std::uint32_t master;      ///< device node
  std::int32_t first, last;  ///< range of AttachedArguments::ties
  std::uint32_t fixed;       ///< bit per axis along which the master has a prescribed path
};

/// A node that follows a master.
struct AttachedTie
{
  float rest[3];              ///< rest position of the node [m]
  float ratio, mass;          ///< AttachedNode::ratio; mass of the node [kg]
  float offset;               ///< level_offset() of a sliding node [m]
  std::uint32_t node;         ///< device node
  std::int32_t bone;          ///< that holds the node or moves its surface; -1: none
  std::int32_t plane;         ///< index into AttachedArguments::planes; -1: the node is held
  std::int32_t master_plane;  ///< plane of the master on the same surface
};

/// Rest position of a node in the field of a surface.
struct AttachedPlace
{
  float offset[3];  ///< from the sample of its cell, or from a sphere's centre [m]
  float distance;   ///< from a sphere's surface [m]
  std::int32_t cell[3];
  std::int32_t surface;  ///< index into StepArguments::fields
};

/// Attached nodes and joints in device memory.
struct AttachedArguments
{
  const AttachedGroup* groups;
  std::uint32_t count;  ///< number of groups
  const AttachedTie* ties;
  const AttachedPlace* places;        ///< one per plane
  physics::KeptLevel<float>* planes;  ///< found at displacements relative to the surface
  /// first group of each patch, and the number of all groups; null in strips
  const std::uint32_t* patch_groups;
};

}  // namespace frontalis
