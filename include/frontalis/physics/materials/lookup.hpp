#pragma once

#include "frontalis/physics/materials/all.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

namespace frontalis::physics
{

template <template <class> class... Solids>
constexpr std::array<MaterialDescription, sizeof...(Solids)> descriptions_of(MaterialList<Solids...>)
{
  return { { Solids<double>::description... } };
}

/// The description of each law, by its index in the table.
inline constexpr auto material_table = descriptions_of(Materials{});

template <std::size_t... I>
constexpr std::array<Law, sizeof...(I)> laws_at(std::index_sequence<I...>)
{
  return { { static_cast<Law>(I)... } };
}

/// All laws, in the order of the table.
inline constexpr auto every_law = laws_at(Materials::Places{});

constexpr const MaterialDescription& description_of(Law law) { return material_table[static_cast<std::size_t>(law)]; }

/// The law with this name in scenes, if there is one.
inline std::optional<Law> law_named(std::string_view name)
{
  for (const Law law : every_law)
    if (name == description_of(law).name)
      return law;
  return std::nullopt;
}

/// The numbers of a material as models store them; description.hpp defines their order.
using MaterialNumbers = std::array<double, parameter_slots>;

/// Shear modulus at rest [Pa].
inline double shear_modulus_of(Law law, const MaterialNumbers& numbers)
{
  double modulus = 0;
  visit_table(law, numbers.data(), [&](const auto& solid, const auto&...) { modulus = shear_modulus(solid); });
  return modulus;
}

/// The numbers of a material from the parameters of a scene, in SI units and in the order of the law's description.
/// Directions stay zero. The bulk modulus is that of linear elasticity.
inline MaterialNumbers numbers_of(Law law, const std::array<double, law_parameters_max>& given, double poisson)
{
  MaterialNumbers numbers{};
  const MaterialDescription& description = description_of(law);
  for (int p = 0; p < description.count(); ++p)
  {
    const bool by_young = description.parameters[p].measure == Measure::young_modulus;
    numbers[slot_of(p)] = by_young ? given[p] / (2 * (1 + poisson)) : given[p];
  }
  numbers[bulk_modulus_slot] = 2 * shear_modulus_of(law, numbers) * (1 + poisson) / (3 * (1 - 2 * poisson));
  return numbers;
}

/// Bulk modulus [Pa] of a material with the shear modulus `shear` in a model whose bulk moduli are limited to `limit`:
/// no limit goes below that of Poisson's ratio 0.4. Tissue is nearly incompressible, so that a bulk modulus stands only
/// for one that is far larger. It has to be large against the stresses that act, and a larger one shortens the step.
inline double limited_bulk_modulus(double bulk, double shear, double limit)
{
  constexpr double of_least_ratio = 2 * (1 + 0.4) / (3 * (1 - 2 * 0.4));
  return std::min(bulk, std::max(limit, of_least_ratio * shear));
}

/// The numbers of the description's example, including directions, for tests and studies of every law.
inline MaterialNumbers example_of(Law law, double poisson = 0.49)
{
  std::array<double, law_parameters_max> given{};
  const MaterialDescription& description = description_of(law);
  for (int p = 0; p < description.count(); ++p)
    given[p] = description.parameters[p].example;
  MaterialNumbers numbers = numbers_of(law, given, poisson);
  for (int d = 0; d < description.directions; ++d)
    for (int axis = 0; axis < 3; ++axis)
      numbers[first_direction + 3 * d + axis] = example_directions[d][axis];
  return numbers;
}

}  // namespace frontalis::physics
