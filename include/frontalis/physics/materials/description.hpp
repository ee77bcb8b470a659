#pragma once

#include "frontalis/physics/number.hpp"

#include <cstdint>
#include <limits>

namespace frontalis
{

/// The law of a material: its index in the table of materials (physics/materials/all.hpp), which model files store.
enum class Law : std::uint8_t
{
  neo_hookean = 0  ///< the law that every kernel computes for all voxels, without a lookup in the table
};

namespace physics
{

/// What a model stores of a material: at most four parameters of its law, the bulk modulus, at most two directions.
constexpr int law_parameters_max = 4;
constexpr int bulk_modulus_slot = 1;
constexpr int first_direction = 5;
constexpr int parameter_slots = first_direction + 2 * 3;

/// Index of a law's parameter among a material's numbers: parameters stand in order and leave out the slot of the bulk
/// modulus.
FRONTALIS_LAW constexpr int slot_of(int parameter) { return parameter < bulk_modulus_slot ? parameter : parameter + 1; }

/// The quantity and unit of a parameter.
enum class Measure : std::uint8_t
{
  number,        ///< [-]
  pressure,      ///< [Pa]
  young_modulus  ///< [Pa]; converted to the shear modulus with Poisson's ratio
};

struct Range
{
  double lower = 0, upper = 0;
  bool lower_allowed = true, upper_allowed = true, zero_allowed = true;
};
constexpr double unbounded = std::numeric_limits<double>::infinity();
constexpr Range any_value{ -unbounded, unbounded, true, true };
constexpr Range not_zero{ -unbounded, unbounded, true, true, false };
constexpr Range above_zero{ 0, unbounded, false, true };
constexpr Range from_zero{ 0, unbounded, true, true };

/// One parameter of a law, as a scene specifies it.
struct Parameter
{
  const char* key = nullptr;      ///< in the scene
  const char* meaning = nullptr;  ///< for error texts: "shear modulus of the matrix"
  Measure measure = Measure::number;
  Range range{};
  double example = 0;     ///< value for a soft tissue, in SI units
  bool optional = false;  ///< whether a scene may leave it out, which means 0
};

/// What scenes, models and tests need to know of a law, as plain data: the member `description` of its struct.
struct MaterialDescription
{
  const char* name;           ///< value of `law` in a scene
  const char* title;          ///< for display
  const char* shear_modulus;  ///< formula of the shear modulus at rest, with the parameters' keys
  /// Whether materials of this law in one voxel are replaced by one material with their mean parameters.
  bool averaged;
  int directions;  ///< number of fibre directions that a scene gives: 0, 1 or 2
  /// Parameters in the order of the law's members; unused entries have no key.
  Parameter parameters[law_parameters_max];

  FRONTALIS_LAW constexpr int count() const
  {
    int n = 0;
    while (n < law_parameters_max && parameters[n].key != nullptr)
      ++n;
    return n;
  }
  constexpr const Parameter* begin() const { return parameters; }
  constexpr const Parameter* end() const { return parameters + count(); }
};

/// Directions for the examples of laws with fibres.
constexpr double example_directions[2][3] = { { 0.8, 0.6, 0 }, { 0.8, -0.6, 0 } };

}  // namespace physics
}  // namespace frontalis
