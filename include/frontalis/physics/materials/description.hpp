#pragma once

#include "frontalis/physics/number.hpp"

#include <cstdint>
#include <limits>

namespace frontalis
{

/// The law of a material: its place in the table of materials (physics/materials/all.hpp), which model files store.
enum class Law : std::uint8_t
{
  neo_hookean = 0  ///< the part of the stress that every voxel's kernel computes without asking for a law
};

namespace physics
{

/// The numbers of a material in a model: at most four parameters of its law, the bulk modulus, at most two directions.
constexpr int law_parameters_max = 4;
constexpr int bulk_modulus_slot = 1;
constexpr int first_direction = 5;
constexpr int parameter_slots = first_direction + 2 * 3;

/// Where a law's parameter stands among a material's numbers: in order, but for the slot of the bulk modulus.
FRONTALIS_LAW constexpr int slot_of(int parameter) { return parameter < bulk_modulus_slot ? parameter : parameter + 1; }

/// What a parameter measures.
enum class Measure : std::uint8_t
{
  number,        ///< [-]
  pressure,      ///< [Pa]
  young_modulus  ///< [Pa]; the law gets the shear modulus that follows from it and Poisson's ratio
};

/// Where a parameter may lie.
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

/// One parameter as a scene gives it.
struct Parameter
{
  const char* key = nullptr;      ///< in the scene
  const char* meaning = nullptr;  ///< for error texts: "shear modulus of the matrix"
  Measure measure = Measure::number;
  Range range{};
  double example = 0;  ///< of a soft tissue, in SI units
};

/// What scenes, models and tests need to know of a law: plain data beside its formulas, as its member `description`.
struct MaterialDescription
{
  const char* name;           ///< as `law` in a scene
  const char* title;          ///< in texts
  const char* shear_modulus;  ///< formula of the shear modulus at rest, by the parameters' keys
  /// Whether materials of this law that share a voxel are replaced by one with their mean parameters.
  bool averaged;
  int directions;  ///< of fibres that a scene gives: 0, 1 or 2
  /// In the order of the law's members; those behind the last have no key.
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

/// Directions of the examples of laws that have some.
constexpr double example_directions[2][3] = { { 0.8, 0.6, 0 }, { 0.8, -0.6, 0 } };

}  // namespace physics
}  // namespace frontalis
