#include "scene/sections.hpp"

#include "frontalis/error.hpp"

#include <algorithm>

namespace frontalis
{

void read_effects(const Node& node, Scene& scene)
{
  if (!node.given())
    return;
  Mapping mapping(node);
  EffectSet present = EffectSet::all();
  const bool rubs = std::any_of(scene.constraints.begin(), scene.constraints.end(),
                                [](const SceneConstraint& constraint) {
                                  return constraint.kind == SceneConstraint::Kind::sliding && constraint.friction > 0;
                                });
  present = present.with(Effect::friction, rubs);
  for (const Effect effect : every_effect())
    if (const Node entry = mapping.optional(name_of(effect)); entry.given())
      scene.switched_off = scene.switched_off.with(effect, entry.choice({ "on", "off" }) == "off");
  try
  {
    check_switched_off(scene.switched_off, present);
  }
  catch (const Error& error)
  {
    node.fault(error.what());
  }
}

}  // namespace frontalis
