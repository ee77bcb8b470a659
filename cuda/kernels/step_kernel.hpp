#pragma once

#include "frontalis/physics/distance_field.hpp"
#include "frontalis/physics/element/node_motion.hpp"
#include "cuda/kernels/attachment_arguments.hpp"
#include "cuda/kernels/contact_arguments.hpp"
#include "cuda/kernels/shell_arguments.hpp"
#include "cuda/kernels/tissue_contact_arguments.hpp"
#include "cuda/partition/voxel_patches.hpp"
#include "cuda/partition/voxel_strips.hpp"

#include <cuda_runtime_api.h>
#include <vector_types.h>

#include <cstddef>

namespace frontalis
{

/// Effects on nodes other than the forces of their voxels, in the order in which they are applied.
enum NodeEffect : std::uint8_t
{
  node_load,        ///< index into StepArguments::load_begin
  node_sliding,     ///< on a surface that stands still; index into StepArguments::sliding
  node_gliding,     ///< on a surface that moves with a bone; index into StepArguments::sliding
  node_prescribed,  ///< index into StepArguments::prescribed
  node_rigid,       ///< index into StepArguments::rigid
  node_effects      ///< number of effects
};

/// The effects of one node.
struct NodeTask
{
  std::uint32_t node;             ///< device node
  std::int32_t of[node_effects];  ///< index of each NodeEffect; negative if the node does not have it
};

/// Whether the node has this effect and no other.
__host__ __device__ inline bool has_only(const NodeTask& task, NodeEffect effect)
{
  for (int other = 0; other < node_effects; ++other)
    if ((task.of[other] >= 0) != (other == effect))
      return false;
  return true;
}

/// The part of a force on a loaded surface that acts on a node.
struct LoadPart
{
  std::int32_t force;  ///< index into StepArguments::surface_force
  std::int32_t load;   ///< index into StepArguments::load_growth
  float weight;
};

/// How a load grows.
struct LoadGrowth
{
  double ramp;              ///< [s]
  std::int32_t activation;  ///< index of the activation that it is multiplied by instead; -1: none
};

struct PrescribedMotion
{
  double value[3];  ///< [m]
  double ramp[3];   ///< [s]
  bool fixed[3];
};

/// Data that a sliding node needs when it enters another cell of its field.
struct SlidingNodeField
{
  std::int32_t surface;  ///< index into StepArguments::fields
  std::int32_t cell[3];  ///< cell of the node's rest position
  float level;           ///< value of the field at which the node stays [m]
};

/// A sliding node's copy of the field near its position, in words of 16 bytes at a stride of `sliding_count`: the
/// samples of a cell minus the level [m], and 1 over their spacing [1/m]. On a sphere the inverse spacing is 0, and the
/// first entry is the distance at rest minus the level [m]. Points of contact have such copies as well, with their
/// number as the stride and the code of the cell as the last entry.
constexpr int sample_words = 7;

/// Code of the cell of a node's samples: 10 bits per axis, counted from `middle_cell`, which is the cell of the rest
/// position. A node outside of that range is past its field's rim. no_cell: no samples are stored yet.
constexpr std::int32_t middle_cell = 512;
constexpr std::uint32_t no_cell = 0xffffffffu;

/// A law other than neo-Hookean that a voxel's tissue contains.
struct LawEntry
{
  std::int32_t law;
  float weight;                                ///< fraction of the voxel's tissue, times tissue volume [m3]
  float per_tangent;                           ///< LawPart::per_tangent [m]
  float at_rest;                               ///< tangent stiffness at rest [Pa]
  float parameters[physics::parameter_slots];  ///< ordered as in physics/materials/description.hpp
};

/// A voxel in strips whose AddedStress is computed before the step. Its palette entry is its index plus one.
struct AddedVoxel
{
  std::uint32_t node[8];  ///< device nodes
  std::uint32_t fibre_word;
};

/// What an added voxel adds to the neo-Hookean stress, times tissue volume.
struct alignas(16) AddedStress
{
  float4 xx_to_yx, yy_to_zy;  ///< first Piola-Kirchhoff stress by rows, but for the last component [N m]
  float zz;                   ///< that component [N m]
  float stiffening;           ///< the laws' part of the stiffness bound [N/m]
};

/// Arguments of a launch that makes steps of equal length or computes internal forces. Pointers are to device memory.
struct StepArguments : physics::Kick<float>
{
  // The partition into patches or strips:
  const Patch* patches;
  std::uint32_t patch_count;
  const uint4* patch_corners;       ///< VoxelPatches::corner
  const uint2* patch_properties;    ///< per voxel of a patch: palette entry and fibre word
  const std::uint32_t* halo;        ///< VoxelPatches::halo
  const uint4* node_voxels;         ///< VoxelPatches::node_voxel
  const std::int32_t* patch_tasks;  ///< per device node: see patch_task
  const Strip* strips;
  const uint2* slots;  ///< per StripSlot: node and palette entry
  std::uint32_t strip_count;
  /// displacement [m] and inverse mass [1/kg], 0 for nodes that never move; u[first] has the present values
  float4* u[2];
  float* v[3];  ///< velocity [m/s]
  /// inverse mass for the frequency bound, or less (StepBackend::measure_growth) [1/kg], 0 for held nodes; null: the
  /// inverse mass in u
  const float* mobility;
  std::int32_t first;

  // Palette of materials of voxels. Each entry has shear and bulk modulus times tissue volume [N m], hourglass
  // stiffness [N/m], and the stiffening of the neo-Hookean law. Entry 0 has no stiffness.
  const float4* palette;
  const float* stiffness_bounds;   ///< per palette entry: VoxelProperties::stiffness [N/m]
  const float4* stabilisation;     ///< bending, coupling, torsion, warping [N m]; null: scalar hourglass control
  const float4* centres;           ///< physics::TissueCentre of each palette entry; null if all voxels are whole
  const float4* corner_stiffness;  ///< two per palette entry: Discretisation::corner_stiffness; null with `centres`
  const std::uint32_t* law_begin;  ///< first law other than neo-Hookean of each palette entry; null if there are none
  const LawEntry* laws;
  // In strips, a kernel before each step may compute the stress of fibres and of laws other than neo-Hookean. In the
  // step kernel a warp spends as long on one voxel that has them as on 32, so that it computes fibres itself only where
  // they fill more than 0.4 of the lanes (VoxelCut::stress_apart), and laws only with selective reduced integration.
  const AddedVoxel* added_voxels;
  AddedStress* added_stress;
  std::uint32_t added_count;  ///< number of added voxels
  bool selective_reduced;     ///< whether the isochoric stress is taken at eight Gauss points
  /// 1 + index of the viscous voxel, 0 for other voxels, in the order of slots or patch_properties; null: no viscous
  /// voxels
  const std::uint32_t* viscous_words;
  /// relaxed stress times tissue volume [N m] as [term][component][viscous voxel]; two terms are followed by their sum
  float* relaxed;
  const float4* viscous_properties;  ///< of each viscous voxel: fractions of its two terms, then their rates [1/s]
  std::uint32_t viscous_count;
  std::int32_t viscous_terms;
  /// per step, time by which viscous stresses relax before the step [s]; null: they do not relax
  const float* relaxation;
  const std::uint32_t* fibre_words;
  const float4* fibres;  ///< direction, and weight times tissue volume times stress reference [N m]
  /// index of the muscle; bit 31: has a passive part; bit 30: has the tension-length relation
  const std::uint32_t* fibre_muscle;
  std::int32_t muscles;
  const float* activation_begin;
  const float* activation_end;

  // Restricted and loaded nodes:
  const NodeTask* tasks;
  std::uint32_t task_count;
  const LoadPart* load_parts;
  const std::int32_t* load_begin;  ///< null: no load acts
  const double* surface_force;     ///< three per vertex of tractions, then per triangle under pressure [N]
  const LoadGrowth* load_growth;   ///< one per load
  const double* load_force;   ///< three per loaded node: forces of surface loads [N]; null: each node adds its parts
  const double* load_relief;  ///< three per loaded node: correction of gravity for scaled mass [N]; or null
  // Sliding nodes, on surfaces that stand still and on moving ones; those with friction come first. Samples depend on a
  // node's position only; planes and `pressing` are state.
  const physics::DistanceField* fields;
  const SlidingNodeField* sliding;
  std::uint32_t sliding_count;
  /// offset of the rest position in its cell, or from a sphere's centre [m]; bits of the cell's code
  float4* sliding_at;
  float4* samples;  ///< see sample_words
  /// tangent planes of the latest step, normal . u = offset: normal and offset; a zero normal: none yet
  float4* planes;
  const float* friction;  ///< Coulomb's coefficient of the first `rubbing_count` nodes
  float* pressing;        ///< reaction per mass of these nodes, with the delay of friction [m/s2]
  std::uint32_t rubbing_count;
  /// of each sliding node: rest position [m], bits of the bone, -1 on a surface that stands still; null if none moves
  const float4* gliding;
  const PrescribedMotion* prescribed;
  const float4* rigid;  ///< of nodes that move with a bone: rest position [m], bits of the bone
  /// [step][bone][6], before the first step and then after each step: rows of BoneMotion::less, each with a component
  /// of `shift`, then rows of `spin`, each with one of `drift`
  const float4* bone_motions;
  std::int32_t bones;

  float scale[3];             ///< 1 / (4 h)
  float stretch_weight[3];    ///< 1/h^2 divided by the sum over the three axes
  float stretch_half_sum;     ///< half of that sum over the axes [1/m2]
  float hourglass_weight[3];  ///< 1 / (4 sqrt(3) h)
  float dt;
  double time, dt_exact;
  double rate, friction_response;            ///< 1 / dt_exact; physics::friction_response
  double kick;                               ///< time over which forces change velocities in each of these steps [s]
  std::int32_t step_begin, step_end, steps;  ///< this launch makes steps [step_begin, step_end) of the plan
  std::uint32_t* frequency_bound;            ///< bits of the squared frequency bound at the plan's last step
  bool bound_every_step;                     ///< whether the bound is computed in all steps of the plan
  bool forces_only;            ///< whether the launch only writes internal forces to u[1 - first] and updates nothing
  float* velocity_before[3];   ///< velocities before the update; null without an account of work
  float* velocity_free[3];     ///< velocities after the update and the loads, before constraints
  double* friction_work;       ///< energy dissipated at nodes with friction [J]; or null
  std::uint32_t steps_before;  ///< number of steps in earlier launches of this solver
  ContactArguments contact;    ///< contact with bodies
  ShellArguments shell;
  TissueContactArguments touch;  ///< contact of tissue with itself, in patches
  AttachedArguments attached;
};

/// Threads per block of the strip kernel. Each warp processes one strip.
constexpr int step_block = 128;

/// Number of planes of slots that a warp loads beyond the end of its strip.
constexpr std::uint32_t planes_ahead = 2;

/// Largest number of threads per block of the patch kernel.
constexpr std::uint32_t most_patch_threads = 512;
/// Largest number of patches that a block processes in turn.
constexpr int most_turns = 8;

/// Largest number of muscles of a model on the GPU. It is limited, because activations are stored in shared memory.
constexpr int most_muscles = 512;

/// Entries of patch_tasks. An entry of at least 0 is an index into StepArguments::sliding: the node slides on a surface
/// that stands still and has no other effect. `none`: the node has no effect. `still`: the node never moves. Other
/// entries are coded(kind, index): the node only moves with a bone (index into StepArguments::rigid), it only slides on
/// a surface that moves (index into StepArguments::sliding), or its effects are those of a NodeTask (index of that).
namespace patch_task
{
constexpr std::int32_t none = -1;
constexpr std::int32_t still = -0x7fffffff;
enum Kind : std::int32_t
{
  moves_with_bone,
  glides,
  other,
  kinds  ///< number of kinds
};

__host__ __device__ inline std::int32_t coded(Kind kind, std::int32_t index) { return none - 1 - kinds * index - kind; }
__host__ __device__ inline Kind kind_of(std::int32_t task) { return static_cast<Kind>((none - 1 - task) % kinds); }
/// Whether an entry is coded, with this kind.
__host__ __device__ inline bool is(Kind kind, std::int32_t task)
{
  return task < none && task != still && kind_of(task) == kind;
}
__host__ __device__ inline std::int32_t index_of(std::int32_t task) { return (none - 1 - task) / kinds; }
}  // namespace patch_task

/// Effects that a kernel computes. There is one kernel per set of effects, so that an effect that a model lacks takes
/// neither registers nor instructions. Effects of few nodes are called through a table (node_tasks.cuh).
enum class Effects : std::uint16_t
{
  none = 0,  ///< neo-Hookean with scalar hourglass control
  fibres = 1,
  viscosity = 2,
  general_element = 4,  ///< laws, hourglass controls and integrations other than those of `none`
  sliding = 8,          ///< nodes that slide on surfaces
  tasks = 16,           ///< effects in node_tasks.cuh; in kernels of patches always set together with sliding
  friction = 32,        ///< friction of sliding nodes
  contact = 64,         ///< contact with bodies, in patches; always set together with all effects of nodes
  shell = 128,          ///< layers that are shells, in patches; always set together with all effects of nodes
  added = 256,          ///< in strips, instead of fibres: AddedStress
  touch = 512,          ///< contact of tissue with itself, in patches; always set together with all effects of nodes
  cut = 1024,           ///< voxels that are partly filled
  groups = 2048         ///< attached nodes and joints, in patches; always set together with `cut` and effects of nodes
};
constexpr int voxel_sets = 8;  ///< number of sets of voxel effects, which are the first three bits
constexpr Effects operator|(Effects a, Effects b) { return static_cast<Effects>(int(a) | int(b)); }
constexpr Effects operator&(Effects a, Effects b) { return static_cast<Effects>(int(a) & int(b)); }
// Sets are template variables, because device code cannot call the constexpr functions above.
template <Effects Set, Effects Part>
inline constexpr bool has = (Set & Part) == Part;
template <Effects Set, Effects Of>
inline constexpr Effects part = Set& Of;
inline constexpr Effects of_nodes = Effects::sliding | Effects::tasks | Effects::friction;
/// A set without the effects that few voxels have: laws other than neo-Hookean; these, fibres and viscosity.
template <Effects Set>
inline constexpr Effects lawless_part = static_cast<Effects>(int(Set) & ~int(Effects::general_element));
template <Effects Set>
inline constexpr Effects plain_part = Set&(of_nodes | Effects::contact | Effects::shell | Effects::touch |
                                           Effects::cut | Effects::groups);
constexpr Effects voxel_part(Effects set)
{
  return set & (Effects::fibres | Effects::viscosity | Effects::general_element);
}

/// Shared memory that a patch needs for effects with points that are bound to voxels, and for groups.
struct PatchRoom
{
  std::uint32_t contact_points;
  std::uint32_t touch_vertices;  ///< vertices that may touch other tissue; 0: patches do not find these forces
  std::uint32_t shell_threads;   ///< threads that find forces of shells while the others compute voxels
  // The following members count words of 16 bytes.
  std::uint32_t shell_words;  ///< displacements of vertices, and forces of triangles
  std::uint32_t table_words;  ///< tables of shells, of all patches of a block
  std::uint32_t group_words;  ///< tables of groups, of all patches of a block; 0: they stay in global memory
  bool keeps_triangles;       ///< whether the tables of shells include the triangles
};

/// How the step kernel is launched for a model.
struct StepLaunch
{
  bool patches;  ///< true: one block per patch and many steps per launch; false: one warp per strip
  Effects effects;
  int blocks, threads;
  std::uint32_t most_voxels, most_halo, most_nodes;  ///< as in VoxelPatches
  std::size_t shared_bytes;                          ///< per block
  PatchRoom room;                                    ///< as in patch_bytes()
};

/// Rows of voxels in a strip, and blocks of the strip kernel per multiprocessor. More rows share more nodes but take
/// more registers: a multiprocessor holds 16 warps with three rows but only 12 with four. Effects other than
/// neo-Hookean elasticity leave registers for two rows only.
constexpr int strip_rows(Effects effects)
{
  return voxel_part(effects) == Effects::none && (effects & (Effects::added | Effects::cut)) == Effects::none ? 3 : 2;
}
constexpr int strip_blocks(Effects effects)
{
  return (effects & (Effects::viscosity | Effects::general_element)) == Effects::none ? 4 : 3;
}

/// Shared memory of a block [bytes]. It holds displacements of halo and own nodes, velocities of own nodes, forces on
/// the corners of voxels and their stiffness bounds, points and vertices of contact, shells, and groups.
constexpr std::size_t patch_bytes(std::size_t most_voxels, std::size_t most_halo, std::size_t most_nodes,
                                  const PatchRoom& room = {})
{
  const bool any = room.contact_points > 0 || room.shell_words > 0 || room.touch_vertices > 0;
  const std::size_t words = 2 * room.contact_points + room.shell_words + room.table_words;
  return sizeof(float4) *
             (most_halo + most_nodes + room.group_words + (any ? words + touch_room * room.touch_vertices + 1 : 0)) +
         3 * sizeof(float) * most_nodes + 25 * sizeof(float) * (most_voxels + 1);
}

/// Number of blocks of the patch kernel that the device runs at the same time; 0 if the build has no code for the
/// device.
int resident_blocks(const StepLaunch& launch);

/// Launches steps [step_begin, step_end) of the plan. Only patches can run several steps per launch. In strips with
/// Effects::added, launch_added_stress() must come first.
cudaError_t launch_steps(const StepArguments& arguments, const StepLaunch& launch, cudaStream_t stream);
cudaError_t launch_patches(const StepArguments& arguments, const StepLaunch& launch, cudaStream_t stream);
/// Whether the step of a launch finds the bound of the squared frequency.
inline bool finds_bound(const StepArguments& g)
{
  return g.frequency_bound != nullptr && (g.bound_every_step || g.step_begin + 1 == g.steps);
}
/// In strips with Effects::added, before a step: finds the stress of all added voxels, and the forces on points of
/// contact if ContactArguments::blocks_beside says so.
cudaError_t launch_added_stress(const StepArguments& arguments, cudaStream_t stream);
/// In strips: applies the constraints of all groups after the tasks of a step. The groups have no nodes in common.
cudaError_t launch_attached(const StepArguments& arguments, cudaStream_t stream);

/// Takes the masses of groups and ties from the inverse masses in `u`, where these are not 0.
cudaError_t launch_take_masses(const float4* u, AttachedGroup* groups, std::uint32_t group_count, AttachedTie* ties,
                               std::uint32_t tie_count, cudaStream_t stream);
/// In strips: applies the tasks of all nodes after their update. `effects`: those of nodes.
cudaError_t launch_tasks(const StepArguments& arguments, Effects effects, cudaStream_t stream);

}  // namespace frontalis
