#pragma once

#include "frontalis/physics/materials/description.hpp"
#include "frontalis/physics/materials/fung.hpp"
#include "frontalis/physics/materials/guccione.hpp"
#include "frontalis/physics/materials/holzapfel.hpp"
#include "frontalis/physics/materials/mooney_rivlin.hpp"
#include "frontalis/physics/materials/neo_hookean.hpp"
#include "frontalis/physics/materials/ogden.hpp"

#include <cstddef>
#include <type_traits>
#include <utility>

namespace frontalis
{
namespace physics
{

template <template <class> class... Solids>
struct MaterialList
{
  using Places = std::make_index_sequence<sizeof...(Solids)>;
};

/// The table of materials: every solid that a scene can use. A solid is a struct of its parameters with a `description`
/// and the functions add_stress, energy, tangent_stiffness and shear_modulus. If the solid has fibres, the first three
/// take a pointer to the fibre directions after the kinematics. New solids go to the end, because model files store
/// indices into the table.
using Materials = MaterialList<NeoHookean, MooneyRivlin, Ogden, FungExponential, HolzapfelGasserOgden, Guccione>;

/// The solid with a material's numbers; description.hpp defines their order.
template <template <class> class Solid, class T, std::size_t... I>
FRONTALIS_LAW Solid<T> solid_of(const T* numbers, std::index_sequence<I...>)
{
  // NeoHookean is the only solid that includes the volumetric part.
  if constexpr (std::is_same_v<Solid<T>, NeoHookean<T>>)
    return { numbers[0], numbers[bulk_modulus_slot], numbers[slot_of(1)] };
  else
    return { numbers[slot_of(static_cast<int>(I))]... };
}

/// Calls visit(solid), or visit(solid, directions) if the solid has fibres.
template <template <class> class Solid, class T, class Visit>
FRONTALIS_LAW void visit_solid(const T* numbers, Visit&& visit)
{
  constexpr int parameters = Solid<T>::description.count(), directions = Solid<T>::description.directions;
  const Solid<T> solid = solid_of<Solid>(numbers, std::make_index_sequence<parameters>());
  if constexpr (directions == 0)
    visit(solid);
  else
  {
    Vec3<T> along[directions];
    for (int d = 0; d < directions; ++d)
    {
      const T* const a = numbers + first_direction + 3 * d;
      along[d] = { a[0], a[1], a[2] };
    }
    visit(solid, along);
  }
}

/// Calls visit with the law's solid. Laws with an index below `First` are skipped.
template <int First, class T, class Visit, template <class> class... Solids, std::size_t... I>
FRONTALIS_LAW void visit_listed(Law law, const T* numbers, Visit&& visit, MaterialList<Solids...>,
                                std::index_sequence<I...>)
{
  (void)((static_cast<int>(I) >= First && law == static_cast<Law>(I) && (visit_solid<Solids>(numbers, visit), true)) ||
         ...);
}

/// Calls visit with the law's solid from the whole table, or from the table's index `First` onwards.
template <int First = 0, class T, class Visit>
FRONTALIS_LAW void visit_table(Law law, const T* numbers, Visit&& visit)
{
  visit_listed<First>(law, numbers, visit, Materials{}, Materials::Places{});
}

template <template <class> class Solid, template <class> class... Solids>
constexpr Law find_law(MaterialList<Solids...>)
{
  int place = 0;
  (void)((std::is_same_v<Solid<double>, Solids<double>> || (++place, false)) || ...);
  return static_cast<Law>(place);
}

}  // namespace physics

/// The law of a solid, for instance law_of<physics::Guccione>.
template <template <class> class Solid>
constexpr Law law_of = physics::find_law<Solid>(physics::Materials{});
static_assert(law_of<physics::NeoHookean> == Law::neo_hookean, "kernels have code of their own for the first law");

}  // namespace frontalis
