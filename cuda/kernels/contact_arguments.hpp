#pragma once

#include "cuda/kernels/bound_points.hpp"
#include "frontalis/physics/contact.hpp"
#include "frontalis/physics/distance_field.hpp"

#include <vector_types.h>

namespace frontalis
{

/// A body that tissue may touch.
struct ContactBody
{
  physics::DistanceField field;
  float inverse_spacing;  ///< of its samples [1/m]; 0: a sphere
  float reach;            ///< Contact::reach [m]
  float friction;
  std::int32_t bone;  ///< that the body is; -1: it stands still
  double middle[3];   ///< of the points that may touch it, at rest [m]
};

/// A point of the tissue that may touch a body.
struct alignas(16) ContactPoint
{
  float coordinates[3];  ///< in its voxel
  float stiffness;       ///< [N/m]
  float offset[3];       ///< of its rest position in its cell of the body's field [m]; see physics::FieldPoint
  std::int32_t body;     ///< into ContactArguments::bodies
  float arm[3];          ///< from ContactBody::middle to its rest position [m]
  float distance;        ///< from a sphere, at rest [m]
  std::int32_t cell[3];
  std::int32_t unused;
};

/// State of a point besides that of its friction.
struct alignas(8) ContactHold
{
  float along;  ///< physics::Grip::along
  std::int32_t touching;
};

/// What a patch has of contact.
struct alignas(16) PatchContact
{
  std::uint32_t point_begin, points;  ///< into the arrays of points
  std::uint32_t voxel_begin, voxels;  ///< into ContactArguments::voxels
  std::uint32_t node_begin, nodes;    ///< into ContactArguments::watched
};

/// Contact with bodies in device memory. Points are sorted by voxel. In patches every copy of a voxel has copies of its
/// points with states of their own: equal displacements keep the copies equal without any exchange.
struct ContactArguments
{
  const ContactBody* bodies;
  const ContactPoint* points;
  const BoundVoxel* voxels;     ///< in patches, those with points
  const PatchContact* patches;  ///< per patch; null: contact is not computed
  const uint4* corners;         ///< of the voxel of each point in a patch, as StepArguments::patch_corners
  float4* watched;              ///< nodes of these voxels: displacement when the points were looked at [m], place
  float inverse_spread;         ///< a point moves at most by the largest way of its voxel's nodes over this
  BoundPoints bound;            ///< in strips
  std::uint32_t point_count, body_count;

  // motion of the bodies in the steps of a plan
  const float4* poses;  ///< [step][body][3], at its start: rows of the inverse rotation minus 1, and of the shift [m]
  const float* ways;    ///< [step]: at most the way [m] of any body against the tissue since the plan began

  // State. Places are relative to that at rest, in the frame of the body.
  float4* grips;  ///< physics::Grip: anchor [m], normal force [N]
  ContactHold* holds;
  float4* forces;  ///< of points that touched in the latest step of a launch: on each [N]; lost to friction [J]
  float4* arms;    ///< of these forces, from the origin of the body's frame [m]
  // These depend on places alone, not on time.
  float4* samples;     ///< see sample_words
  float4* clearances;  ///< place and distance [m]: within this distance of that place the point is not looked at

  /// Forces are those of points that all touch and stick, as ContactStiffness::add_forces() has them.
  bool spring;
};

}  // namespace frontalis
