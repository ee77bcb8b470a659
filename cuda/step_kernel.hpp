#pragma once

#include "surface_search.hpp"
#include "voxel_strips.hpp"

#include <cuda_runtime_api.h>
#include <vector_types.h>

#include <cstddef>

namespace frontalis
{

/// What holds or moves one node besides the forces of its voxels; indices below 0: not there.
struct NodeTask
{
  std::uint32_t node;       ///< device node
  std::int32_t load;        ///< into StepArguments::load_begin
  std::int32_t sliding;     ///< into StepArguments::sliding
  std::int32_t prescribed;  ///< into StepArguments::prescribed
  std::int32_t rigid;       ///< into StepArguments::rigid
};

/// Part of a vertex's force that a node takes.
struct LoadPart
{
  std::int32_t vertex;  ///< into StepArguments::vertex_force
  std::int32_t load;    ///< whose ramp it follows
  float weight;
};

struct PrescribedMotion
{
  double value[3];  ///< [m]
  double ramp[3];   ///< [s]
  bool fixed[3];
};

struct RigidMotion
{
  double rest[3];  ///< [m]
  std::int32_t bone;
};

/// A node on a surface: what an exact closest point needs.
struct SlidingContact
{
  double rest[3];   ///< [m]
  double distance;  ///< [m]
  double foot[3];   ///< the latest exact closest point [m]
  std::uint32_t node;
  std::int32_t surface;
  bool turned;  ///< has gone round the rim of an open surface
};

/// What a step needs of it: the tangent plane of the offset surface at the latest exact closest point. A displacement u
/// keeps its distance where normal . u + offset = 0.
struct ContactPlane
{
  float4 normal_offset;
  float4 reference;  ///< displacement there; w: 1 where there is no closest point yet
};

/// A law beyond neo-Hookean that a voxel has in part.
struct LawEntry
{
  std::int32_t law;
  float weight;          ///< proportion times tissue volume [m3]
  float inertia;         ///< frequency squared a tangent stiffness: 8 / (density h^2) times proportion
  float at_rest;         ///< tangent stiffness at rest [Pa]
  float parameters[11];  ///< order: Law
};

/// Steps of equal length, or the internal forces alone. Pointers are to device memory.
struct StepArguments
{
  // what is where
  const Strip* strips;
  const uint2* slots;  ///< StripSlot: node and palette entry
  std::uint32_t strip_count;
  float4* u[2];  ///< displacement [m] and inverse mass [1/kg]; u[first] holds the present ones
  float* v[3];   ///< velocity [m/s]
  std::int32_t first;

  // what voxels are made of: shear and bulk modulus times tissue volume [N m], hourglass stiffness [N/m], frequency
  // bound squared at rest [1/s2]; entry 0 is nothing
  const float4* palette;
  const float4* stabilisation;     ///< bending, coupling, torsion, warping [N m]; null: scalar hourglass control
  const std::uint32_t* law_begin;  ///< laws beyond neo-Hookean of each palette entry; null: none in the model
  const LawEntry* laws;
  const std::uint32_t* fibre_words;
  const float4* fibres;               ///< direction, and weight times tissue volume times stress reference [N m]
  const std::uint32_t* fibre_muscle;  ///< muscle, bit 31: passive part, bit 30: tension-length relation
  std::int32_t muscles;
  const float* activation_begin;
  const float* activation_end;

  // restricted and loaded nodes
  const NodeTask* tasks;
  const LoadPart* load_parts;
  const std::int32_t* load_begin;
  const double* vertex_force;  ///< three a vertex, at full ramp [N]
  const double* load_ramp;     ///< one a load [s]
  SlidingContact* sliding;
  ContactPlane* contact_planes;
  std::uint32_t sliding_count;
  const SurfaceSearch* surfaces;
  const PrescribedMotion* prescribed;
  const RigidMotion* rigid;
  const double* poses;  ///< [step][bone][12]: rotation row by row, translation
  std::int32_t bones;

  float scale[3];             ///< 1 / (4 h)
  float stretch_weight[3];    ///< 1/h^2 over the sum of the three
  float hourglass_weight[3];  ///< 1 / (4 sqrt(3) h)
  float dt, keep, gain;       ///< v = keep v - gain f / m + impulse
  float impulse[3];
  double time, dt_exact;
  std::int32_t step_begin, step_end, steps;  ///< of the plan; a launch may do a part of it
  std::uint32_t* look;                       ///< bits of the largest frequency bound squared at the plan's last step
  bool forces_only;                          ///< internal forces into u[1 - first], nothing updated
  std::uint32_t* barrier;
  std::uint32_t barrier_base;
};

/// Threads of a block; a warp walks one strip at a time.
constexpr int step_block = 128;

/// Planes of slots that a warp fetches past the end of its strip.
constexpr std::uint32_t planes_ahead = 2;

/// Most shared memory for a warp's slots [bytes].
constexpr std::size_t most_slot_bytes = 12 * 1024;

/// Most muscles that a model may have on the GPU: their activations lie in shared memory.
constexpr int most_muscles = 512;

/// Kernels by what voxels need, so that those of a plain model hold no registers for more.
enum class Effects : std::uint8_t
{
  none,    ///< neo-Hookean with scalar hourglass control
  fibres,  ///< muscles too
  all      ///< laws beyond neo-Hookean and assumed-strain hourglass control too; strips of two rows only
};

/// How the step kernel is launched for a model.
struct StepLaunch
{
  int rows;  ///< of a strip: 1, 2 or 4
  Effects effects;
  std::size_t slot_bytes;  ///< shared memory for a warp's slots; 0: they are read from device memory at each step
  int blocks;
};

/// Blocks of the step kernel that a device holds at once; 0 where it has no code for the device.
int resident_blocks(const StepLaunch& launch);

/// Launches steps [step_begin, step_end) of the plan. Several of them need all blocks resident at once.
cudaError_t launch_steps(const StepArguments& arguments, const StepLaunch& launch, cudaStream_t stream);

/// Exact closest points for the sliding nodes for which a step of the plan would else have to find them itself.
cudaError_t launch_renewals(const StepArguments& arguments, cudaStream_t stream);

}  // namespace frontalis
