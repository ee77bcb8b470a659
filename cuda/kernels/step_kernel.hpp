#pragma once

#include "solver/contact/surface_contact.hpp"
#include "cuda/partition/voxel_patches.hpp"
#include "cuda/partition/voxel_strips.hpp"

#include <cuda_runtime_api.h>
#include <vector_types.h>

#include <cstddef>

namespace frontalis
{

/// What holds or moves nodes besides the forces of their voxels, in the order in which it does.
enum NodeEffect : std::uint8_t
{
  node_load,        ///< into StepArguments::load_begin
  node_sliding,     ///< into StepArguments::sliding
  node_gliding,     ///< into StepArguments::gliding
  node_prescribed,  ///< into StepArguments::prescribed
  node_rigid,       ///< into StepArguments::rigid
  node_effects      ///< how many there are
};

/// What one node has of them.
struct NodeTask
{
  std::uint32_t node;             ///< device node
  std::int32_t of[node_effects];  ///< indices, by NodeEffect; below 0: not there
};

/// Whether the node slides on a surface that is still, and has nothing else.
__host__ __device__ inline bool slides_only(const NodeTask& task)
{
  static_assert(node_effects == 5, "each of them stands below");
  return task.of[node_sliding] >= 0 &&
         (task.of[node_load] & task.of[node_gliding] & task.of[node_prescribed] & task.of[node_rigid]) < 0;
}

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

/// In strips planes are found beside a plan's steps for so many nodes of each `search_group` that follow one another in
/// StepArguments::sliding and then ::gliding, in models of up to `small_model` such nodes for all of them: what a
/// search knows of its surface takes 296 bytes.
constexpr std::uint32_t search_group = 32, group_searches = 8, small_model = 20000;

/// A node on a still surface: what an exact closest point needs.
struct SlidingContact
{
  double rest[3];  ///< [m]
  SurfaceContact contact;
  std::uint32_t node;
  std::int32_t search;         ///< in strips, into StepArguments::searching, where a plane is found beside the steps
  float serves, serves_ahead;  ///< squares of ContactPlane::slip of its plane and of the one found ahead [m2]
};

/// What friction on a still surface needs besides.
struct RubbingContact
{
  float friction;  ///< coefficient
  float pressing;  ///< reaction over mass that friction knows of [m/s2]
  float turning;   ///< normal speed that changes of the plane took, a part of the next reaction [m/s]
};

/// A node on a surface that follows a bone: what each step needs of it, in the frame of the bone.
struct GlidingContact
{
  double rest[3];  ///< [m]
  std::int32_t bone;
  double friction;
  double pressing;  ///< reaction over mass that friction knows of [m/s2]
  ContactPlane plane;
  SurfaceContact::Point reference;  ///< where the plane was found
  SurfaceContact::Point turned_to;  ///< normal of the plane that its velocity is parallel to
};

/// What an exact closest point of it needs, and the plane that is found before it is needed.
struct GlidingSearch
{
  SurfaceContact contact;
  std::uint32_t node;
  std::int32_t search;  ///< as SlidingContact::search
  float state;          ///< nothing_ahead, wanted_ahead, or 0: found
  SurfaceContact::Point ahead;
  ContactPlane found;
};

/// What a step needs of a sliding node: the tangent plane of the offset surface at the latest exact closest point. A
/// displacement u keeps its distance where normal . u + offset = 0.
struct TangentPlane
{
  float4 normal_offset;
  float4 reference;  ///< displacement there; w: square of ContactPlane::limit [m2], below 0: there is no plane yet
};

/// In the place of TangentPlane::reference.w of planes that are found before they are needed.
constexpr float nothing_ahead = -1, wanted_ahead = -2;

/// A law beyond neo-Hookean that a voxel has in part.
struct LawEntry
{
  std::int32_t law;
  float weight;          ///< proportion times tissue volume [m3]
  float per_tangent;     ///< LawPart::per_tangent [m]
  float at_rest;         ///< tangent stiffness at rest [Pa]
  float parameters[11];  ///< order: Law
};

/// Steps of equal length, or the internal forces alone. Pointers are to device memory.
struct StepArguments
{
  // what is where: patches, or strips
  const Patch* patches;
  std::uint32_t patch_count;
  const uint4* patch_corners;       ///< VoxelPatches::corner
  const uint2* patch_makes;         ///< of each voxel of each patch: palette entry, word of its fibres
  const std::uint32_t* halo;        ///< VoxelPatches::halo
  const uint4* node_voxels;         ///< VoxelPatches::node_voxel
  const std::int32_t* patch_tasks;  ///< of each device node: see patch_task
  const Strip* strips;
  const uint2* slots;  ///< StripSlot: node and palette entry
  std::uint32_t strip_count;
  float4* u[2];  ///< displacement [m] and inverse mass [1/kg], 0 of still nodes; u[first] holds the present ones
  float* v[3];   ///< velocity [m/s]
  const float* mobility;  ///< inverse mass of nodes that are not held, 0 of those that are [1/kg]; null: that of u
  std::int32_t first;

  // what voxels are made of: shear and bulk modulus times tissue volume [N m], hourglass stiffness [N/m], bound of the
  // largest eigenvalue of the stiffness at rest [N/m]; entry 0 is nothing
  const float4* palette;
  const float4* stabilisation;     ///< bending, coupling, torsion, warping [N m]; null: scalar hourglass control
  const std::uint32_t* law_begin;  ///< laws beyond neo-Hookean of each palette entry; null: none in the model
  const LawEntry* laws;
  bool selective_reduced;  ///< isochoric stress at eight points
  const std::uint32_t*
      viscous_words;  ///< laid out as slots or patch_makes: 1 + viscous voxel, 0: none; null: no voxel is viscous
  float* relaxed;  ///< [term, then their sum where there are two][component][viscous voxel] times tissue volume [N m]
  const float4* viscous_makes;  ///< of each viscous voxel: share of two terms, rate of two terms [1/s]
  std::uint32_t viscous_count;
  std::int32_t viscous_terms;
  const float* relaxation;  ///< of each step: seconds by which viscous stresses relax before it; null: not in a launch
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
  const double* load_relief;   ///< three a loaded node: what gravity is less on scaled masses [N]; null: nowhere
  SlidingContact* sliding;
  TangentPlane* contact_planes;
  TangentPlane* planes_ahead;  ///< found before they are needed; reference.w: nothing_ahead, wanted_ahead or as above
  std::uint32_t sliding_count;
  RubbingContact* rubbing;  ///< of the first `rubbing_count` of ::sliding, which have friction
  std::uint32_t rubbing_count;
  GlidingContact* gliding;
  GlidingSearch* gliding_searches;
  std::uint32_t gliding_count;
  SurfaceContact* searching;  ///< `searches` for each search_group
  std::uint32_t searches;     ///< 0: planes are asked for within launches (plane_queue.cuh), not from plan to plan
  float lead;  ///< how long before a node leaves its plane another is asked for within a launch [s]; 0: none is
  const PrescribedMotion* prescribed;
  const RigidMotion* rigid;
  const double* poses;  ///< [step][bone][12]: rotation row by row, translation; before the first step, after each
  std::int32_t bones;

  float scale[3];             ///< 1 / (4 h)
  float stretch_weight[3];    ///< 1/h^2 over the sum of the three
  float stretch_half_sum;     ///< half of that sum [1/m2]
  float hourglass_weight[3];  ///< 1 / (4 sqrt(3) h)
  float dt, keep, gain;       ///< v = keep v - gain f / m + impulse
  float impulse[3];
  double time, dt_exact;
  double rate, friction_response;            ///< 1 / dt_exact; physics::friction_response
  double kick;                               ///< for how long forces change velocities in these steps [s]
  std::int32_t step_begin, step_end, steps;  ///< of the plan; a launch may do a part of it
  std::uint32_t* look;         ///< bits of the bound of the highest frequency squared at the plan's last step, or all
  bool look_always;            ///< at every step of the plan
  bool forces_only;            ///< internal forces into u[1 - first], nothing updated
  float* velocity_before[3];   ///< velocities before the update; null: no account of work is kept
  float* velocity_free[3];     ///< after it and the loads, before constraints
  double* friction_work;       ///< lost to friction by each that rubs, then by each that glides [J], or null
  std::uint32_t steps_before;  ///< that this solver's launches have done before this one
};

/// Threads of a block of the strip kernel; a warp walks one strip.
constexpr int step_block = 128;

/// Planes of slots that a warp fetches past the end of its strip.
constexpr std::uint32_t planes_ahead = 2;

/// Most threads of a patch. Where nodes slide, its last warp finds their planes (plane_queue.cuh).
constexpr std::uint32_t most_patch_threads = 512;
/// Of them those of the warp that finds planes.
constexpr std::uint32_t finding_threads = 32;
/// Most patches that a block takes in turn.
constexpr int most_turns = 8;

/// Most muscles that a model may have on the GPU: their activations lie in shared memory.
constexpr int most_muscles = 512;

/// Entries of patch_tasks: 0 and up: the node slides on this contact and nothing else; none: nothing holds it; still:
/// it never moves; else other - index of its NodeTask.
namespace patch_task
{
constexpr std::int32_t none = -1;
constexpr std::int32_t other = -2;
constexpr std::int32_t still = -0x7fffffff;
}  // namespace patch_task

/// What a kernel has within its loops over voxels and nodes. There is one for each set, so that what a model does not
/// have takes neither registers nor instructions. What few nodes have is called through a table (node_tasks.cuh), in
/// kernels of their own.
enum class Effects : std::uint8_t
{
  none = 0,  ///< neo-Hookean with scalar hourglass control
  fibres = 1,
  viscosity = 2,
  general_element = 4,  ///< laws beyond neo-Hookean, other hourglass controls and integrations
  sliding = 8,          ///< on surfaces
  tasks = 16,    ///< what node_tasks.cuh has; goes with sliding, whose rare search is better called than compiled in
  friction = 32  ///< of what slides
};
constexpr int voxel_sets = 8;  ///< of the first three bits
constexpr Effects operator|(Effects a, Effects b) { return static_cast<Effects>(int(a) | int(b)); }
constexpr Effects operator&(Effects a, Effects b) { return static_cast<Effects>(int(a) & int(b)); }
// variables, which device code can use too
template <Effects Set, Effects Part>
inline constexpr bool has = (Set & Part) == Part;
template <Effects Set, Effects Of>
inline constexpr Effects part = Set& Of;
/// What nodes do.
inline constexpr Effects of_nodes = Effects::sliding | Effects::tasks | Effects::friction;
/// What voxels that have neither fibres nor viscosity need of a kernel.
template <Effects Set>
inline constexpr Effects plain_part = Set&(Effects::general_element | of_nodes);
/// What voxels need of one.
constexpr Effects voxel_part(Effects set)
{
  return set & (Effects::fibres | Effects::viscosity | Effects::general_element);
}

/// How the step kernel is launched for a model.
struct StepLaunch
{
  bool patches;  ///< a block of threads a patch, many steps a launch; else a warp a strip
  Effects effects;
  int blocks, threads;
  // of patches
  std::uint32_t most_voxels, most_halo, most_nodes;  ///< see VoxelPatches
  std::size_t shared_bytes;                          ///< of a block
};

/// Rows of a strip that the strip kernel takes, and blocks of it that a multiprocessor holds. Three rows leave room for
/// 16 warps a multiprocessor where four would for 12; with fibres it is two.
constexpr int strip_rows(Effects effects) { return voxel_part(effects) == Effects::none ? 3 : 2; }
constexpr int strip_blocks(Effects effects)
{
  return (effects & (Effects::viscosity | Effects::general_element)) == Effects::none ? 4 : 3;
}

/// Shared memory [bytes] of a block: displacements of halo and nodes, velocities of nodes, forces of voxels' corners
/// and their stiffness; where nodes slide, a queue of them.
constexpr std::size_t patch_bytes(std::size_t most_voxels, std::size_t most_halo, std::size_t most_nodes, bool slides)
{
  return sizeof(float4) * (most_halo + most_nodes) + 3 * sizeof(float) * most_nodes +
         25 * sizeof(float) * (most_voxels + 1) + (slides ? sizeof(std::int32_t) * (2 + most_nodes) : 0);
}

/// Blocks of the patch kernel that a device holds at once; 0 where it has no code for the device.
int resident_blocks(const StepLaunch& launch);

/// Launches steps [step_begin, step_end) of the plan; several of them need patches.
cudaError_t launch_steps(const StepArguments& arguments, const StepLaunch& launch, cudaStream_t stream);
cudaError_t launch_patches(const StepArguments& arguments, const StepLaunch& launch, cudaStream_t stream);

/// Before a plan, in patches before the first: sliding and gliding nodes that have left their planes find new ones at
/// once. In strips they take those that were found for them first, where they need them, and who will want another
/// before the next plan ends asks for it.
cudaError_t launch_renewals(const StepArguments& arguments, cudaStream_t stream);
/// What was asked for; runs beside the plan's steps.
cudaError_t launch_renewals_ahead(const StepArguments& arguments, cudaStream_t stream);

}  // namespace frontalis
