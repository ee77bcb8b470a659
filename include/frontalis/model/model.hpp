#pragma once

#include "frontalis/model/contact.hpp"
#include "frontalis/model/presets.hpp"
#include "frontalis/model/restriction.hpp"
#include "frontalis/model/self_contact.hpp"
#include "frontalis/model/shell.hpp"
#include "frontalis/model/skin_film.hpp"
#include "frontalis/model/surface.hpp"
#include "frontalis/model/tissue.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace frontalis
{

/// Everything that the solver needs, constant while it runs: plain arrays in SI units, in a local frame. The origin
/// lies within the model, so that single precision suffices for positions. The local axes are an even permutation of
/// the scene's axes, which keeps the handedness; local x is the axis with the longest rows of voxels.
struct Model : ModelPresets
{
  // Grid: outside of flaps, node (i,j,k) rests at (i,j,k) * spacing from the local origin; rest_place() gives the place
  // in flaps.
  std::array<double, 3> spacing{ { 1e-3, 1e-3, 1e-3 } };  ///< voxel edges [m]
  std::array<std::int32_t, 3> size{ { 0, 0, 0 } };        ///< voxels of the bounding grid along x, y, z

  // Voxels are ordered by k, then j, then i; the lower corner of voxel (i,j,k) is node (i,j,k).
  std::vector<std::array<std::int32_t, 3>> voxels;
  std::vector<float> fill;  ///< proportion of the voxel that is tissue, 0..1: scales stiffness and mass
  /// Centroid of the tissue in each voxel, from -1 to 1 along each axis: the point where the voxel's stress is
  /// computed. Empty if it is the centre of every voxel.
  std::vector<std::array<float, 3>> tissue_centre;

  // The mixture of voxel e is in the entries from mixture_begin[e] up to, but not including, mixture_begin[e + 1]. Its
  // proportions add up to 1.
  std::vector<Material> materials;
  std::vector<std::int32_t> mixture_begin;
  std::vector<std::int16_t> mixture_material;
  std::vector<float> mixture_proportion;
  /// Two directions per voxel (local axes, length 1) that replace the fibre directions of its materials; a material
  /// with one direction uses the first. A direction of zero means that the material's own direction applies. May be
  /// empty.
  std::vector<std::array<float, 6>> material_directions;

  // The muscles of voxel e are in the entries from fibre_begin[e] up to, but not including, fibre_begin[e + 1].
  // Directions have length 1. Loads with an activation of their own (Load::activation) are among the muscles; they have
  // no fibres.
  std::vector<Muscle> muscles;
  std::vector<std::int32_t> fibre_begin;
  std::vector<std::int16_t> fibre_muscle;
  std::vector<float> fibre_weight;  ///< proportion of the tissue in the voxel that is this muscle, 0..1
  std::vector<std::array<float, 3>> fibre_direction;

  // Nodes are the corners of the voxels, ordered by k, then j, then i; build_nodes() derives them.
  std::vector<std::array<std::int32_t, 3>> nodes;
  std::vector<std::array<std::int32_t, 8>> voxel_nodes;  ///< corner b = i + 2j + 4k

  /// Tissue on the second side of a gap has planes of the grid of its own, so that it shares no node with the first
  /// side: voxels and nodes with k >= first rest `shift` planes lower than their index says.
  struct Flap
  {
    std::int32_t first = 0;
    std::int32_t shift = 0;
  };
  std::vector<Flap> flaps;  ///< ascending; empty without gaps
  /// Two nodes that move as one, where a flap is connected to other tissue. Both have the same rest position.
  struct Joint
  {
    std::int32_t node = 0;
    std::int32_t master = 0;  ///< not the `node` of another joint; several joints may have the same master
  };
  std::vector<Joint> joints;

  std::vector<std::string> bones;
  std::vector<std::string> constraints;  ///< names, in the scene's order
  std::vector<ConstraintSurface> constraint_surfaces;
  std::vector<RigidNode> rigid;
  std::vector<SlidingNode> sliding;
  std::vector<AttachedNode> attached;
  std::vector<Contact> contacts;
  std::vector<SelfContact> self_contacts;
  std::vector<Shell> shells;

  std::array<double, 3> gravity{ { 0, 0, 0 } };  ///< local axes [m/s2]
  std::vector<Load> loads;
  std::vector<PrescribedNode> prescribed;

  TriangleMesh skin;
  Binding skin_binding;
  std::vector<std::string> landmarks;
  std::vector<std::array<double, 3>> landmark_positions;  ///< at rest, local [m]
  Binding landmark_binding;

  RigidTransform to_scene;
  RigidTransform to_face;
  std::string face_frame = "face";

  double damping = 0;       ///< mass-proportional damping coefficient [1/s]
  double time_scaling = 1;  ///< how many seconds of activations and frames pass per second of the solver's time
  double frame_rate = 30;   ///< [1/s] of wall time
  /// Fastest change of a muscle's activation [1/s of simulated time]; 0: no limit.
  double activation_slew = 0;
  double time_step_share = 0.9;
  MassScalingSettings mass_scaling;
  HourglassControl hourglass = HourglassControl::scalar;
  Integration integration = Integration::one_point;
  Precision precision = Precision::single;  ///< of the CPU backend
  TimeStepEstimate time_step_estimate = TimeStepEstimate::element;

  /// Names of effects that the scene switched off; no data is stored for them (model/effects.hpp).
  std::vector<std::string> switched_off;

  std::string scene_hash;  ///< of the scene's content; empty for models made by programs

  SkinFilm film;  ///< film on the skin, for its fine lines
};

/// Rest position of the voxel or node with the index `place`, in voxel edges from the origin. It equals `place` outside
/// of flaps.
inline std::array<std::int32_t, 3> rest_place(const Model& model, std::array<std::int32_t, 3> place)
{
  for (auto flap = model.flaps.rbegin(); flap != model.flaps.rend(); ++flap)
    if (place[2] >= flap->first)
      return { { place[0], place[1], place[2] - flap->shift } };
  return place;
}

/// Position of a node at rest, local [m].
inline std::array<double, 3> rest_position(const Model& model, std::size_t node)
{
  const auto n = rest_place(model, model.nodes[node]);
  return { { n[0] * model.spacing[0], n[1] * model.spacing[1], n[2] * model.spacing[2] } };
}

/// Fills nodes and voxel_nodes from voxels. Voxels must be sorted by k, j, i and unique; throws Error otherwise.
void build_nodes(Model& model);

/// Checks that indices are in range, arrays have matching lengths and numbers are finite; throws Error naming the
/// array.
void check_model(const Model& model);

}  // namespace frontalis
