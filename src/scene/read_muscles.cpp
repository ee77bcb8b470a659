#include "sections.hpp"

#include "suggestion.hpp"

namespace frontalis
{

void read_muscles(const Node& node, Scene& scene, SceneNames& names)
{
  for (const auto& [name, entry] : node.named_pairs())
  {
    SceneMuscle muscle;
    muscle.name = name;
    muscle.line = entry.line();
    names.muscles.names.push_back(name);
    {
      Mapping mapping(entry);
      const Node volume = mapping.optional("volume");
      muscle.volume = volume.given() ? volume.reference(names.volumes) : name;
      if (!volume.given() && entry.is_mapping() && names.volumes.complete && !names.volumes.has(name))
        volume.fault("missing, and no volume is called '" + name + "'; the volumes are " +
                     list_with_suggestion(name, names.volumes.names));
      muscle.fibre = mapping.required("fibre", "a direction [x, y, z]").direction(muscle.fibre);
      muscle.stress_reference =
          mapping.optional("stress_reference").number(Dimension::pressure, positive, muscle.stress_reference);
      muscle.rise_time = mapping.optional("rise_time").number(Dimension::time, not_negative, 0);
      muscle.fall_time = mapping.optional("fall_time").number(Dimension::time, not_negative, 0);
      muscle.passive = mapping.optional("passive").boolean(muscle.passive);
      muscle.tension_length = mapping.optional("tension_length").boolean(muscle.tension_length);
    }
    scene.muscles.push_back(muscle);
  }
  names.muscles.complete = !node.given() || node.is_mapping();
}

void read_expressions(const Node& node, Scene& scene, SceneNames& names)
{
  for (const auto& [name, entry] : node.named_pairs())
  {
    if (name == "relax")
    {
      entry.fault("'relax' is there in every scene, with all muscles at 0; choose another name");
      continue;
    }
    names.expressions.names.push_back(name);
    std::map<std::string, double>& activation = scene.expressions[name];
    for (const auto& [muscle, value] : entry.pairs())
    {
      if (names.muscles.complete && !names.muscles.has(muscle))
        value.fault("no muscle is called '" + muscle + "'; the muscles are " +
                    list_with_suggestion(muscle, names.muscles.names));
      if (value.is_null())
        value.fault("found nothing; must be an activation from 0 to 1");
      else
        activation[muscle] = value.number(Dimension::number, proportion, 0);
    }
  }
  names.expressions.complete = !node.given() || node.is_mapping();
}

void read_demo(const Node& node, Scene& scene, const SceneNames& names)
{
  for (const Node& entry : node.entries())
  {
    DemoPhase phase;
    Mapping mapping(entry);
    phase.expression = mapping.required("expression", "the name of an expression").reference(names.expressions);
    const Node ramp = mapping.optional("ramp");
    phase.ramp = ramp.number(Dimension::time, not_negative, phase.ramp);
    phase.seconds = mapping.optional("seconds").number(Dimension::time, positive, phase.seconds);
    if (phase.ramp > phase.seconds)
    {
      if (ramp.given())
        ramp.fault(ramp.found() + "; must be at most 'seconds', which holds the ramp");
      else
        phase.ramp = phase.seconds;
    }
    scene.demo.push_back(phase);
  }
}

}  // namespace frontalis
