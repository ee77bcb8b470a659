#include "bake/checks.hpp"

#include "bake/messages.hpp"
#include "frontalis/physics/materials/lookup.hpp"

#include <set>

namespace frontalis
{

void check_magnitudes(const Scene& scene, const Model& model, BakeMonitor& monitor)
{
  const auto check =
      [&](const std::string& place, const char* what, double value, double least, double most, const char* unit)
  {
    if (value < least || value > most)
      monitor.warn("{}: {} is {:.3g} {}, expected {:g} to {:g}; a number without a unit is in {}", place, what, value,
                   unit, least, most, unit);
  };
  for (std::size_t m = 0; m < scene.materials.size(); ++m)
  {
    const std::string place = place_in_scene(scene, "material", scene.materials[m]);
    check(place, "density", scene.materials[m].density, 100, 20e3, "kg/m3");
    check(place, "shear modulus at rest",
          physics::shear_modulus_of(model.materials[m].law, model.materials[m].parameters), 50, 100e9, "Pa");
  }
  for (const SceneMuscle& muscle : scene.muscles)
  {
    const std::string place = place_in_scene(scene, "muscle", muscle);
    check(place, "stress_reference", muscle.stress_reference, 1e3, 100e6, "Pa");
    check(place, "cross_section", muscle.cross_section, 0, 0.01, "m2");
  }
  check(scene.file, "gravity", to_vector(scene.gravity).norm(), 0, 100, "m/s2");
  constexpr double thinnest = 5e-6, thickest = 0.01;
  for (const Layer& layer : scene.layers)
    if (layer.thickness < thinnest || layer.thickness > thickest)
      monitor.warn("{} is {} thick, expected {} to {}; check its unit", place_in_scene(scene, "layer", layer),
                   length_text(layer.thickness, scene.unit), length_text(thinnest, scene.unit),
                   length_text(thickest, scene.unit));
}

void check_bone_centres(const Scene& scene, BakeMonitor& monitor)
{
  std::set<std::string> told;
  const auto check = [&](const std::string& what, const std::vector<BonePose>& bones)
  {
    for (const BonePose& bone : bones)
      if (to_vector(bone.turn).norm() > 0 && scene.bone_centres.count(bone.bone) == 0 && told.insert(bone.bone).second)
        monitor.warn(
            "{}: {} turns bone '{}' about the origin of the face frame, because the bone has no centre; give it one, "
            "as in 'bones: {{{}: {{centre: [x, y, z]}}}}'",
            scene.file, what, bone.bone, bone.bone);
  };
  for (const auto* poses : { &scene.expressions, &scene.action_units })
    for (const auto& [name, pose] : *poses)
      check("'" + name + "'", pose.bones);
  for (const DemoPhase& phase : scene.demo)
    check("the demo", phase.bones);
}

}  // namespace frontalis
