#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace frontalis
{

/// Isochoric law of a material, and the order of its parameters (physics/ has the laws). The second parameter of every law
/// is the bulk modulus kappa [Pa] of the volumetric part.
enum class Law : std::uint8_t
{
  neo_hookean,    ///< shear modulus mu [Pa], kappa
  mooney_rivlin,  ///< c1 [Pa], kappa, c2 [Pa]
  ogden,          ///< mu1 [Pa], kappa, alpha1, mu2 [Pa], alpha2
  fung,           ///< mu [Pa], kappa, b
  holzapfel       ///< mu [Pa], kappa, k1 [Pa], k2, dispersion, two family directions (local axes, length 1)
};

struct Material
{
  std::string name;
  Law law = Law::neo_hookean;
  std::array<double, 11> parameters{};
  double density = 0;  ///< [kg/m3]
};

struct Muscle
{
  std::string name;
  double stress_reference = 0.3e6;  ///< sigma_max [Pa]
  bool passive = false;
  bool tension_length = true;
};

/// Triangulated surface in local coordinates [m].
struct TriangleMesh
{
  std::vector<std::array<double, 3>> vertices;
  std::vector<std::array<std::int32_t, 3>> triangles;
};

struct ConstraintSurface
{
  std::string name;
  TriangleMesh mesh;
};

/// Points tied to voxels: they follow by trilinear interpolation (or extrapolation) of the voxel's eight nodes.
struct Binding
{
  std::vector<std::int32_t> voxel;                 ///< index into Model::voxels
  std::vector<std::array<float, 3>> coordinates;   ///< in the voxel, 0..1 inside, along x, y, z
};

struct RigidNode
{
  std::int32_t node = 0;
  std::int32_t bone = -1;  ///< index into Model::bones; -1: still
};

struct SlidingNode
{
  std::int32_t node = 0;
  std::int32_t surface = 0;  ///< index into Model::constraint_surfaces
  double distance = 0;       ///< kept from the surface [m], positive on the side of its outward normals
};

struct PrescribedNode
{
  std::int32_t node = 0;
  std::int32_t load = 0;  ///< index into Model::loads
};

/// Load on a bound surface (traction, pressure) or prescribed motion of nodes (displacement).
struct Load
{
  enum class Kind : std::uint8_t
  {
    traction,
    pressure,
    displacement
  };
  std::string name;
  Kind kind = Kind::traction;
  std::array<double, 3> value{};                     ///< local axes; [Pa] (pressure: first component) or [m]
  std::array<bool, 3> fixed{ { true, true, true } };  ///< displacement: which components are prescribed, local axes
  double ramp = 0;                                   ///< [s]
  TriangleMesh mesh;                                 ///< traction and pressure: the surface, at rest
  Binding binding;                                   ///< of the mesh's vertices
};

/// Mass given to voxels so that they do not rule the time step.
struct MassScalingSettings
{
  enum class Kind : std::uint8_t
  {
    none,
    uniform,
    selective
  };
  Kind kind = Kind::none;
  double factor = 1;
  std::vector<std::int32_t> materials;
};

/// What gives stiffness to the modes that one-point quadrature leaves without.
enum class HourglassControl : std::uint8_t
{
  scalar,         ///< one stiffness a voxel, tied to Young's modulus: cheap
  assumed_strain  ///< a stiffness an axis, Poisson coupling and torsion, turned with the element: accurate
};

/// Rigid map from local coordinates to another frame: p = rotation * local + translation; rotation row by row.
struct RigidTransform
{
  std::array<double, 9> rotation{ { 1, 0, 0, 0, 1, 0, 0, 0, 1 } };
  std::array<double, 3> translation{ { 0, 0, 0 } };  ///< [m]
};

/// Everything that the solver needs, constant while it runs. Plain arrays in SI units, in a local frame whose origin lies
/// within the model (float keeps its precision) and whose x axis is the one with the longest rows of voxels: an even
/// permutation of the scene's axes, so that no handedness changes.
struct Model
{
  // grid: node (i,j,k) rests at (i,j,k) * spacing from the local origin
  std::array<double, 3> spacing{ { 1e-3, 1e-3, 1e-3 } };  ///< voxel edges [m]
  std::array<std::int32_t, 3> size{ { 0, 0, 0 } };        ///< voxels of the bounding grid along x, y, z

  // voxels, ordered by k, then j, then i; lower corner at node (i,j,k)
  std::vector<std::array<std::int32_t, 3>> voxels;
  std::vector<float> fill;  ///< proportion of the voxel that is tissue, 0..1: scales stiffness and mass

  // mixture of voxel e: entries mixture_begin[e] .. mixture_begin[e + 1]; proportions add up to 1
  std::vector<Material> materials;
  std::vector<std::int32_t> mixture_begin;
  std::vector<std::int16_t> mixture_material;
  std::vector<float> mixture_proportion;

  // muscles of voxel e: entries fibre_begin[e] .. fibre_begin[e + 1]; directions have length 1
  std::vector<Muscle> muscles;
  std::vector<std::int32_t> fibre_begin;
  std::vector<std::int16_t> fibre_muscle;
  std::vector<float> fibre_weight;  ///< proportion of the tissue in the voxel that is this muscle, 0..1
  std::vector<std::array<float, 3>> fibre_direction;

  // nodes, ordered by k, then j, then i: the corners of the voxels (derived: see build_nodes)
  std::vector<std::array<std::int32_t, 3>> nodes;
  std::vector<std::array<std::int32_t, 8>> voxel_nodes;  ///< corner b = i + 2j + 4k

  // constraints
  std::vector<std::string> bones;
  std::vector<ConstraintSurface> constraint_surfaces;
  std::vector<RigidNode> rigid;
  std::vector<SlidingNode> sliding;

  // loads
  std::array<double, 3> gravity{ { 0, 0, 0 } };  ///< local axes [m/s2]
  std::vector<Load> loads;
  std::vector<PrescribedNode> prescribed;

  // published skin and landmarks
  TriangleMesh skin;
  Binding skin_binding;
  std::vector<std::string> landmarks;
  std::vector<std::array<double, 3>> landmark_positions;  ///< at rest, local [m]
  Binding landmark_binding;

  // frames
  RigidTransform to_scene;
  RigidTransform to_face;
  std::string face_frame = "face";

  // time
  double damping = 0;          ///< mass-proportional damping coefficient [1/s]
  double time_scaling = 1;
  double frame_rate = 30;      ///< [1/s] of wall time
  double time_step_share = 0.9;
  MassScalingSettings mass_scaling;
  HourglassControl hourglass = HourglassControl::scalar;

  // presets by name: activations by muscle index
  struct Expression
  {
    std::string name;
    std::vector<std::pair<std::int32_t, float>> activation;
  };
  std::vector<Expression> expressions;
  struct DemoPhase
  {
    std::int32_t expression = -1;  ///< index into expressions; -1: relax
    double ramp = 0.3;             ///< [s] simulated
    double seconds = 1;            ///< [s] simulated
  };
  std::vector<DemoPhase> demo;

  std::string scene_hash;  ///< of the scene's content; empty for models made by programs
};

/// Fills nodes and voxel_nodes from voxels. Voxels must be sorted by k, j, i and unique; throws Error otherwise.
void build_nodes(Model& model);

/// Checks that indices are in range, arrays have matching lengths and numbers are finite; throws Error naming the array.
void check_model(const Model& model);

}  // namespace frontalis
