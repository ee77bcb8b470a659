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
};

struct Muscle
{
  std::string name;
  double stress_reference = 0.3e6;  ///< sigma_max [Pa]
  bool passive = false;
  bool tension_length = true;
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

}  // namespace frontalis
