#pragma once

#include "frontalis/physics/contact.hpp"
#include "frontalis/physics/distance_field.hpp"

#include <vector_types.h>

namespace frontalis
{

/// A body that tissue may touch.
struct ContactBody
{
  physics::DistanceField field;
  float inverse_spacing;  ///< of its samples [1/m]
  float reach;            ///< Contact::reach [m]
  float friction;
};

/// A point of the tissue that may touch a body.
struct alignas(16) ContactPoint
{
  float coordinates[3];  ///< in its voxel
  float stiffness;       ///< [N/m]
  float offset[3];       ///< of its rest position in its cell of the body's field [m]; see physics::FieldPoint
  std::int32_t body;     ///< into ContactArguments::bodies
  std::int32_t cell[3];
  std::int32_t bone;  ///< that the body is; -1: it stands still
  double rest[3];     ///< [m]
};

/// State of a point besides that of its friction.
struct alignas(8) ContactHold
{
  float along;  ///< physics::Grip::along
  std::int32_t touching;
};

/// Points [first, end) of a voxel. In a patch they count from the patch's first.
struct ContactVoxel
{
  std::uint32_t column;  ///< the voxel's number in its patch
  std::uint32_t first, end;
};

/// What a patch has of contact.
struct PatchContact
{
  std::uint32_t point_begin, points;  ///< into the arrays of points
  std::uint32_t voxel_begin, voxels;  ///< into ContactArguments::voxels
};

/// Contact with bodies in device memory. Points are sorted by voxel. In patches every copy of a voxel has copies of its
/// points with states of their own: equal displacements keep the copies equal without any exchange.
struct ContactArguments
{
  const ContactBody* bodies;
  const ContactPoint* points;
  const ContactVoxel* voxels;
  const PatchContact* patches;  ///< per patch
  const uint4* corners;         ///< of the voxel of each point in a patch, as StepArguments::patch_corners
  // in strips
  const uint4* nodes;               ///< two per point: device nodes of its voxel
  const std::uint32_t* bound;       ///< device nodes of voxels with points
  const std::int32_t* node_voxels;  ///< per bound node, the voxels of which it is corner 0 .. 7; negative: none
  float4* pushes;                   ///< force on each point in this step [N]
  std::uint32_t point_count, bound_count;

  // state. Places are relative to that at rest, in the frame of the body.
  float4* grips;  ///< physics::Grip: anchor [m], normal force [N]
  ContactHold* holds;
  float4* forces;      ///< in the latest step: on each point [N]; lost to friction [J]
  float4* arms;        ///< of these forces, from the origin of the body's frame [m]
  float4* clearances;  ///< place and distance [m]: within this distance of that place the point is not looked at

  /// Forces are those of points that all touch and stick, as ContactStiffness::add_forces() has them.
  bool spring;
};

}  // namespace frontalis
