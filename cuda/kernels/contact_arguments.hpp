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
  float inverse_spacing;  ///< 1 over the spacing of the field's samples [1/m]; 0: a sphere
  float reach;            ///< Contact::reach [m]
  float friction;
  std::int32_t bone;  ///< bone with which the body moves; -1: none
  double middle[3];   ///< middle of the points that may touch the body, at rest [m]
};

/// A point of the tissue that may touch a body.
struct alignas(16) ContactPoint
{
  float coordinates[3];  ///< coordinates in its voxel
  float stiffness;       ///< [N/m]
  /// offset of its rest position from the sample of its cell in the body's field [m]; see physics::FieldPoint
  float offset[3];
  std::int32_t body;  ///< index into ContactArguments::bodies
  float arm[3];       ///< vector from ContactBody::middle to its rest position [m]
  float distance;     ///< distance from a spherical body at rest [m]
  std::int32_t cell[3];
  float spring;  ///< stiffness that counts in the search for the time step [N/m]
};

/// The part of a point's contact state that is not in ContactArguments::grips.
struct alignas(8) ContactHold
{
  float along;  ///< physics::Grip::along
  std::int32_t touching;
};

/// The points of contact of a patch, as ranges of arrays.
struct alignas(16) PatchContact
{
  std::uint32_t point_begin, points;  ///< range of the arrays of points
  std::uint32_t voxel_begin, voxels;  ///< range of ContactArguments::voxels
  std::uint32_t node_begin, nodes;    ///< range of ContactArguments::watched
};

/// Contact with bodies in device memory. Points are sorted by voxel. In patches every copy of a voxel has copies of its
/// points, each with a state of its own; because their displacements are equal, the copies stay equal without any
/// exchange.
struct ContactArguments
{
  const ContactBody* bodies;
  const ContactPoint* points;
  const BoundVoxel* voxels;     ///< in patches, the voxels that have points
  const PatchContact* patches;  ///< per patch; null: contact is not computed
  const uint4* corners;         ///< corners of the voxel of each point in a patch, like StepArguments::patch_corners
  /// nodes of these voxels: displacement when the points were last evaluated [m]; index of the node in shared memory
  float4* watched;
  float inverse_spread;  ///< a point moves at most by the largest motion of its voxel's nodes divided by this
  BoundPoints bound;     ///< used by strips
  std::uint32_t point_count, body_count;

  // Motion of the bodies in the steps of a plan:
  /// [step][body][3], at the start of the step: rows of the inverse rotation minus the identity, and of the translation
  /// [m]. Poses of bodies that are pushed are completed when the step begins (PushedBodies).
  float4* poses;
  const float* ways;  ///< [step]: upper bound of any body's motion relative to the tissue since the plan began [m]

  // State. Positions are relative to the rest position, in the frame of the body.
  float4* grips;  ///< physics::Grip: anchor [m], normal force [N]
  ContactHold* holds;
  /// per point, written in the last step of a launch if the point touched: force [N], energy lost to friction [J]
  float4* forces;
  float4* arms;  ///< from the origin of the body's frame to the points where these forces act [m]
  // The following arrays depend on positions only, not on the history.
  float4* samples;     ///< see sample_words
  float4* clearances;  ///< position, and distance [m] within which a point need not be evaluated again

  /// In strips: number of blocks of find_added_stress() that find the forces on points; 0: a kernel of their own does.
  std::uint32_t blocks_beside;

  /// Whether the forces are those of points that all touch and stick, as in ContactStiffness.
  bool spring;
};

}  // namespace frontalis
