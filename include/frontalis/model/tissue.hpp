#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace frontalis
{

/// Isochoric law of a material, and the order of its parameters (physics/ has the laws). The second parameter of every
/// law is the bulk modulus kappa [Pa] of the volumetric part.
enum class Law : std::uint8_t
{
  neo_hookean,    ///< shear modulus mu [Pa], kappa
  mooney_rivlin,  ///< c1 [Pa], kappa, c2 [Pa]
  ogden,          ///< mu1 [Pa], kappa, alpha1, mu2 [Pa], alpha2
  fung,           ///< mu [Pa], kappa, b
  holzapfel,      ///< mu [Pa], kappa, k1 [Pa], k2, dispersion, two family directions (local axes, length 1)
  guccione        ///< c [Pa], kappa, bf, bt, bfs, fibre direction (local axes, length 1)
};

/// Where the directions of a directed law (holzapfel, guccione) stand among its parameters.
constexpr int first_direction = 5;

struct Material
{
  std::string name;
  Law law = Law::neo_hookean;
  std::array<double, 11> parameters{};
  double density = 0;  ///< [kg/m3]
  /// Viscosity of the isochoric part as a Prony series of up to two terms: the share of the instantaneous stress that
  /// relaxes (their sum below 1), and its time constant [s]. Share 0: no such term. The moduli are the instantaneous.
  std::array<double, 2> viscous_share{};
  std::array<double, 2> viscous_time{};
};

struct Muscle
{
  std::string name;
  double stress_reference = 0.3e6;  ///< sigma_max [Pa]
  bool passive = false;
  bool tension_length = true;
  double rise_time = 0;  ///< activation follows what is asked for with this time constant when it grows [s]; 0: at once
  double fall_time = 0;  ///< the same when it falls [s]
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
  std::vector<std::int32_t> materials;  ///< selective: voxels with one of these; empty: all
  double time_step = 0;                 ///< selective: that is wanted [s]; 0: until they no longer rule it
};

/// What gives stiffness to the modes that one-point quadrature leaves without.
enum class HourglassControl : std::uint8_t
{
  scalar,         ///< one stiffness a voxel, tied to Young's modulus: cheap
  assumed_strain  ///< a stiffness an axis, Poisson coupling and torsion, turned with the element: accurate
};

/// Where the isochoric stress of a voxel is integrated. The volumetric part, fibres and viscosity are taken at its
/// centre.
enum class Integration : std::uint8_t
{
  one_point,         ///< at the centre, with hourglass control: cheap
  selective_reduced  ///< at eight Gauss points, no hourglass control: dear
};

/// Numbers of the state: displacements, velocities and the forces on them.
enum class Precision : std::uint8_t
{
  single,       ///< float
  compensated,  ///< float, displacements summed with their rounding errors carried along (Kahan)
  double_precision
};

/// How the critical time step is found.
enum class TimeStepEstimate : std::uint8_t
{
  element,   ///< bounded at nodes from the stiffness of their voxels: always safe
  assembled  ///< from the assembled model by power iteration, renewed as it stiffens: longer where few voxels are stiff
};

}  // namespace frontalis
