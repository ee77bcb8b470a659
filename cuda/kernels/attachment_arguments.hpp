#pragma once

#include "frontalis/physics/attachment.hpp"

#include <cstdint>

namespace frontalis
{

/// Bit of AttachedGroup::fixed: bones hold a node of the group or move a surface that one slides on.
constexpr std::uint32_t on_bones = 8;

/// A master and the range of the nodes that follow it.
struct alignas(16) AttachedGroup
{
  float rest[3];             ///< rest position of the master [m]
  float mass;                ///< of the master [kg]
  std::uint32_t master;      ///< device node
  std::int32_t first, last;  ///< range of AttachedArguments::ties
  std::uint32_t fixed;       ///< bit per axis along which the master has a prescribed path, and on_bones
};

/// A node that follows a master.
struct alignas(16) AttachedTie
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

/// First group, tie and plane of a patch. Those of a patch are successive.
struct PatchGroups
{
  std::uint32_t group;
  std::int32_t tie, plane;
};

/// Number of words of 16 bytes that the groups of a patch take, with their ties and planes. `next`: the entry of the
/// next patch.
FRONTALIS_LAW std::uint32_t group_words(const PatchGroups& patch, const PatchGroups& next)
{
  const std::size_t bytes = sizeof(AttachedGroup) * (next.group - patch.group) +
                            sizeof(AttachedTie) * static_cast<std::size_t>(next.tie - patch.tie) +
                            sizeof(physics::KeptLevel<float>) * static_cast<std::size_t>(next.plane - patch.plane);
  return static_cast<std::uint32_t>(bytes / 16);
}

/// Attached nodes and joints in device memory.
struct AttachedArguments
{
  const AttachedGroup* groups;
  std::uint32_t count;  ///< number of groups
  const AttachedTie* ties;
  const AttachedPlace* places;        ///< one per plane
  physics::KeptLevel<float>* planes;  ///< found at displacements relative to the surface
  // null in strips:
  const PatchGroups* patches;    ///< of each patch, and the numbers of all groups, ties and planes
  const std::uint32_t* grouped;  ///< a bit per device node: whether it is in a group
};

}  // namespace frontalis
