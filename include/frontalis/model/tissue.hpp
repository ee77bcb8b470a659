#pragma once

#include "frontalis/physics/materials/description.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace frontalis
{

struct Material
{
  std::string name;
  Law law = Law::neo_hookean;
  /// Parameters of the law in the law's own order, with the bulk modulus [Pa] between the first and the second, then
  /// the fibre directions (local axes, length 1) from `physics::first_direction` on.
  std::array<double, physics::parameter_slots> parameters{};
  double density = 0;  ///< [kg/m3]
  /// Viscosity of the isochoric part as a Prony series of up to two terms: the share of the instantaneous stress that
  /// relaxes (their sum below 1), and its time constant [s]. Share 0: no such term. The moduli are instantaneous.
  std::array<double, 2> viscous_share{};
  std::array<double, 2> viscous_time{};
};

struct Muscle
{
  std::string name;
  double stress_reference = 0.3e6;  ///< active stress at full activation and optimal length [Pa]
  bool passive = false;
  bool tension_length = true;
  double rise_time = 0;  ///< time constant with which activation rises to the commanded value [s]; 0: at once
  double fall_time = 0;  ///< time constant with which activation falls to the commanded value [s]; 0: at once
  double tone = 0;       ///< activation at rest, 0..1
};

/// Mass added to voxels so that they do not limit the time step.
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
  std::vector<std::int32_t> materials;  ///< selective: voxels that contain one of these; empty: all
  double time_step = 0;                 ///< selective: critical time step to reach [s]; 0: that of the other voxels
  double in_motion = 0;                 ///< uniform: time step that distorted voxels do not shorten [s]; 0: they do
};

/// How the hourglass modes, which one-point quadrature leaves without stiffness, are stiffened.
enum class HourglassControl : std::uint8_t
{
  scalar,         ///< one stiffness per voxel, proportional to Young's modulus: cheap
  assumed_strain  ///< one stiffness per axis, Poisson coupling and torsion, turned with the element: accurate
};

/// Where the isochoric stress of a voxel is integrated. The volumetric part, fibres and viscosity are taken at its
/// centre.
enum class Integration : std::uint8_t
{
  one_point,         ///< at the centre, with hourglass control: cheap
  selective_reduced  ///< at eight Gauss points, no hourglass control: expensive
};

/// Number type of the state: displacements, velocities and forces.
enum class Precision : std::uint8_t
{
  single,       ///< float
  compensated,  ///< float, with the rounding errors of the displacements carried along (Kahan summation)
  double_precision
};

/// How the critical time step is found.
enum class TimeStepEstimate : std::uint8_t
{
  element,   ///< bounded at nodes from the stiffness of their voxels: always safe
  assembled  ///< by Lanczos iteration on the assembled model, renewed as it stiffens; longer
};

}  // namespace frontalis
