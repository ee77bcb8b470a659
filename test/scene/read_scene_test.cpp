// Results of reading valid scenes.

#include "frontalis/error.hpp"
#include "frontalis/physics/materials/lookup.hpp"
#include "frontalis/scene/read_scene.hpp"
#include "files.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

namespace frontalis
{
namespace
{

constexpr double infinity = std::numeric_limits<double>::infinity();
const std::string source = FRONTALIS_SOURCE_DIRECTORY;

void expect_vector(const Vector3& found, const Vector3& expected)
{
  for (std::size_t i = 0; i < 3; ++i)
    if (std::isinf(expected[i]))
      EXPECT_EQ(found[i], expected[i]);
    else
      EXPECT_NEAR(found[i], expected[i], 1e-15) << "component " << i;
}

const Scene& every_key()
{
  static const Scene scene = read_scene(source + "/test/scene/every_key.yaml");
  return scene;
}

TEST(EveryKey, surfaces)
{
  const auto& surfaces = every_key().surfaces;
  ASSERT_EQ(surfaces.size(), 10U);
  EXPECT_EQ(surfaces[0].name, "scanned");
  EXPECT_EQ(surfaces[0].file, source + "/test/scene/meshes/triangle.obj");
  EXPECT_FALSE(surfaces[0].shape);
  EXPECT_EQ(surfaces[0].unit, 1e-3);
  EXPECT_EQ(surfaces[0].line, 6);

  const Shape& box = *surfaces[1].shape;
  EXPECT_EQ(box.kind, Shape::Kind::box);
  expect_vector(box.centre, { 0.01, 0.02, 0.03 });
  expect_vector(box.size, { 0.003, 0.004, 0.005 });
  EXPECT_NEAR(box.edge, 0.001, 1e-15);
  EXPECT_TRUE(surfaces[1].file.empty());

  EXPECT_EQ(surfaces[2].shape->kind, Shape::Kind::sphere);
  EXPECT_NEAR(surfaces[2].shape->radius, 0.0508, 1e-15);
  EXPECT_EQ(surfaces[3].shape->kind, Shape::Kind::ellipsoid);
  expect_vector(surfaces[3].shape->size, { 0.01, 0.02, 0.03 });
  EXPECT_EQ(surfaces[4].shape->kind, Shape::Kind::cylinder);
  expect_vector(surfaces[4].shape->axis, { 0, 0.6, 0.8 });
  EXPECT_NEAR(surfaces[4].shape->length, 0.05, 1e-15);
  EXPECT_EQ(surfaces[5].shape->kind, Shape::Kind::torus);
  EXPECT_NEAR(surfaces[5].shape->minor_radius, 0.01, 1e-15);
  EXPECT_EQ(surfaces[6].shape->kind, Shape::Kind::forehead);
  EXPECT_EQ(surfaces[6].shape->part, "skull");
  EXPECT_NEAR(surfaces[6].shape->dimensions.at("brow_thickness"), 0.008, 1e-15);
  EXPECT_NEAR(surfaces[6].shape->dimensions.at("width"), 0.12, 1e-15);
  const Shape &strap = *surfaces[7].shape, &loop = *surfaces[8].shape, &bone = *surfaces[9].shape;
  EXPECT_EQ(strap.kind, Shape::Kind::muscle);
  ASSERT_EQ(strap.curves.size(), 2U);
  expect_vector(strap.curves[1][1], { 0.02, 0.01, 0 });
  EXPECT_NEAR(strap.thickness, 0.003, 1e-15);
  EXPECT_FALSE(strap.ring);
  EXPECT_TRUE(loop.ring);
  EXPECT_EQ(bone.kind, Shape::Kind::offset);
  EXPECT_EQ(bone.below->name, "box");
  ASSERT_EQ(bone.depths.size(), 2U);
  expect_vector(bone.depths[0].at, { 0.01, 0.02, 0.03 });
  EXPECT_NEAR(bone.depths[1].depth, 0.004, 1e-15);
}

// A scene with one material; `keys` are the parameters of its law.
std::string fault_of_material(const std::string& keys, Scene& scene)
{
  const TemporaryFolder folder;
  const std::string path =
      folder.write("material.yaml",
                   "unit: mm\nsurfaces: {bar: {shape: box, size: [30, 10, 10]}}\nskin: {surface: bar}\n"
                   "volumes: {tissue: {inside: bar, material: flesh, tissue: true}}\n"
                   "materials: {flesh: {poisson: 0.49, density: 1000, " +
                       keys + "}}\n");
  try
  {
    scene = read_scene(path);
  }
  catch (const Error& error)
  {
    return error.what();
  }
  return {};
}

TEST(EveryLaw, reads_what_its_description_asks_for)
{
  for (const auto& law : physics::material_table)
  {
    // all keys, but with the value `other` for `key`, or without `key` if `other` is empty
    const auto keys = [&](const std::string& key = {}, const std::string& other = {})
    {
      std::string text = fmt::format("law: {}", law.name);
      for (const auto& parameter : law)
        if (parameter.key != key)
          text += fmt::format(", {}: {}", parameter.key, parameter.example);
        else if (!other.empty())
          text += fmt::format(", {}: {}", key, other);
      return text + (law.directions == 1   ? ", fibre: [4, 3, 0]"
                     : law.directions == 2 ? ", families: [[4, 3, 0], [4, -3, 0]]"
                                           : "");
    };
    Scene scene;
    ASSERT_EQ(fault_of_material(keys(), scene), "");
    const SceneMaterial& material = scene.materials.at(0);
    EXPECT_EQ(material.law, law.name);
    EXPECT_EQ(material.parameters.size(), static_cast<std::size_t>(law.count()) + 1);
    for (int d = 0; d < law.directions; ++d)
      expect_vector(material.families[d], { 0.8, d == 0 ? 0.6 : -0.6, 0 });
    for (const auto& parameter : law)
    {
      const std::string place = fmt::format(":5: materials.flesh.{}: ", parameter.key);
      const auto has = [&](const std::string& fault, const std::string& text)
      { return fault.find(place) != std::string::npos && fault.find(text) != std::string::npos; };
      EXPECT_EQ(material.parameters.at(parameter.key), parameter.example);
      const std::string without = fault_of_material(keys(parameter.key), scene);
      EXPECT_TRUE(parameter.optional ? without.empty() && scene.materials.at(0).parameters.at(parameter.key) == 0
                                     : has(without, std::string("missing; must be ") + parameter.meaning));
      EXPECT_TRUE(has(fault_of_material(keys(parameter.key, "1 kg"), scene), "unit"));
      EXPECT_TRUE(parameter.range.lower != 0 ||
                  has(fault_of_material(keys(parameter.key, "-1"), scene), "found '-1'; must be "));
      EXPECT_TRUE(parameter.range.zero_allowed ||
                  has(fault_of_material(keys(parameter.key, "0"), scene), "must not be 0"));
    }
  }
}

TEST(EveryLaw, has_its_parameters)
{
  const Scene scene = read_scene(source + "/test/scene/every_law.yaml");
  ASSERT_EQ(scene.materials.size(), 5U);
  using Parameters = std::map<std::string, double>;
  EXPECT_EQ(scene.materials[0].parameters, (Parameters{ { "c1", 4e3 }, { "c2", 1e3 }, { "poisson", 0.49 } }));
  EXPECT_EQ(scene.materials[1].parameters,
            (Parameters{ { "mu1", 6e3 }, { "alpha1", 2.5 }, { "mu2", -2e3 }, { "alpha2", -2 }, { "poisson", 0.49 } }));
  EXPECT_EQ(scene.materials[2].parameters, (Parameters{ { "shear", 8e3 }, { "b", 1.5 }, { "poisson", 0.49 } }));
  EXPECT_EQ(scene.materials[3].parameters,
            (Parameters{ { "shear", 5e3 }, { "k1", 6e3 }, { "k2", 0.8 }, { "dispersion", 0.1 }, { "poisson", 0.49 } }));
  expect_vector(scene.materials[3].families[0], { 0.8, 0.6, 0 });
  expect_vector(scene.materials[3].families[1], { 0.8, -0.6, 0 });
  EXPECT_EQ(scene.materials[3].along, "bar");
  EXPECT_EQ(scene.materials[4].parameters,
            (Parameters{ { "c", 2e3 }, { "bf", 8 }, { "bt", 2 }, { "bfs", 4 }, { "poisson", 0.49 } }));
  expect_vector(scene.materials[4].families[0], { 0, 0, 1 });
}

TEST(EveryKey, volumes_materials_and_layers)
{
  const Scene& scene = every_key();
  ASSERT_EQ(scene.volumes.size(), 3U);
  const Volume& tissue = scene.volumes[0];
  EXPECT_EQ(tissue.closed_by, (std::vector<std::string>{ "box", "sphere" }));
  EXPECT_EQ(tissue.inside, (std::vector<std::string>{ "ellipsoid", "cylinder" }));
  EXPECT_EQ(tissue.outside, std::vector<std::string>{ "torus" });
  EXPECT_EQ(tissue.without, std::vector<std::string>{ "sphere" });
  expect_vector(tissue.crop.lower, { -0.01, -infinity, -infinity });
  expect_vector(tissue.crop.upper, { 0.01, 0.02, infinity });
  EXPECT_EQ(tissue.material, "dermis");
  EXPECT_TRUE(tissue.tissue);
  EXPECT_EQ(tissue.priority, 3);
  EXPECT_EQ(tissue.line, 17);
  EXPECT_EQ(scene.volumes[1].within, "box");
  EXPECT_NEAR(scene.volumes[1].depth_min, 0.002, 1e-15);
  EXPECT_NEAR(scene.volumes[1].depth_max, 0.004, 1e-15);
  EXPECT_EQ(scene.volumes[1].priority, 1);
  EXPECT_EQ(scene.volumes[2].material, "");

  ASSERT_EQ(scene.materials.size(), 3U);
  EXPECT_EQ(scene.materials[0].law, "neo_hookean");
  EXPECT_NEAR(scene.materials[0].parameters.at("young"), 81400, 1e-9);
  EXPECT_EQ(scene.materials[0].parameters.at("poisson"), 0.49);
  EXPECT_NEAR(scene.materials[0].density, 1100, 1e-9);
  EXPECT_EQ(scene.materials[1].parameters.at("young"), 2000);
  ASSERT_EQ(scene.materials[0].viscosity.size(), 2U);
  EXPECT_EQ(scene.materials[0].viscosity[0].share, 0.3);
  EXPECT_NEAR(scene.materials[0].viscosity[0].time, 0.04, 1e-12);
  EXPECT_EQ(scene.materials[0].viscosity[1].time, 1);
  EXPECT_TRUE(scene.materials[1].viscosity.empty());
  EXPECT_EQ(scene.materials[2].about + " " + scene.materials[2].along, "fibres box");
  EXPECT_NEAR(scene.materials[2].angle, 0.6283185307179586, 1e-12);
  EXPECT_EQ(scene.materials[2].tension, 8e3);

  ASSERT_EQ(scene.layers.size(), 2U);
  EXPECT_EQ(scene.layers[0].name, "outer");
  EXPECT_NEAR(scene.layers[0].thickness, 20e-6, 1e-18);
  EXPECT_NEAR(scene.layers[1].thickness, 1e-3, 1e-15);
  EXPECT_FALSE(scene.layers[0].shell);
  EXPECT_TRUE(scene.layers[1].shell);
}

TEST(EveryKey, ways_to_give_fibres)
{
  const Scene& scene = every_key();
  ASSERT_EQ(scene.muscles.size(), 6U);
  EXPECT_FALSE(scene.muscles[0].origin.given() || scene.muscles[0].ring || scene.muscles[0].net);
  const SceneMuscle& ended = scene.muscles[2];
  expect_vector(ended.fibre, { 0, 0, 0 });
  EXPECT_EQ(ended.origin.surface, "sphere");
  EXPECT_TRUE(ended.origin.points.empty());
  ASSERT_EQ(ended.insertion.points.size(), 2U);
  expect_vector(ended.insertion.points[0], { 0.01, 0.02, 0.03 });
  expect_vector(ended.insertion.points[1], { 0.04, 0.05, 0.006 });
  EXPECT_EQ(scene.muscles[3].ring, false);
  ASSERT_TRUE(scene.muscles[4].net);
  const ControlNet& net = *scene.muscles[4].net;
  EXPECT_EQ(net.size, (std::array<int, 3>{ 4, 2, 2 }));
  EXPECT_TRUE(net.ring);
  ASSERT_EQ(net.points.size(), 16U);
  expect_vector(net.points[15], { 0, -0.02, 0.01 });
  ASSERT_EQ(net.weights.size(), 16U);
  EXPECT_EQ(net.weights[15], 0.5);
  EXPECT_EQ(scene.muscles[5].stress_reference * scene.muscles[5].tone, 8e3);
  EXPECT_FALSE(scene.muscles[5].tension_length || scene.muscles[5].passive);
}

TEST(EveryKey, action_units_and_weakness)
{
  const Scene& scene = every_key();
  ASSERT_EQ(scene.action_units.size(), 3U);
  const FacePose& closed = scene.action_units.at("AU43");
  EXPECT_EQ(closed.activation.at("other"), -0.5);
  ASSERT_EQ(closed.bones.size(), 1U);
  expect_vector(closed.bones[0].turn, { 0, 0.5235987755982988, 0 });
  expect_vector(scene.bone_centres.at("finger"), { 0.01, 0.02, 0.003 });
  const FacePose& both = scene.expressions.at("both");
  EXPECT_EQ(both.activation.at("fibres"), 0.5 * 0.5 + 0.125);
  EXPECT_EQ(both.activation.at("ended"), 0.125);
  EXPECT_EQ(both.activation.at("other"), -0.25);
  ASSERT_EQ(both.bones.size(), 1U);
  expect_vector(both.bones[0].shift, { 0, 0, 0.002 });
  expect_vector(both.bones[0].turn, { 0, 0.2617993877991494, 0 });

  ASSERT_EQ(scene.weakness.size(), 4U);
  EXPECT_EQ(scene.weakness[0].muscles, std::vector<std::string>{ "other" });
  EXPECT_EQ(scene.weakness[0].keeps, 0.5);
  EXPECT_EQ(scene.weakness[0].radius, 0);
  EXPECT_EQ(scene.weakness[1].muscles.size(), 2U);
  EXPECT_EQ(scene.weakness[1].keeps, 0.25);
  EXPECT_NEAR(scene.weakness[1].radius, 0.004, 1e-15);
  EXPECT_TRUE(!scene.weakness[1].dose && scene.weakness[2].dose);
  EXPECT_TRUE(scene.weakness[3].muscles.size() == 1 && scene.weakness[3].radius == 0);
  EXPECT_TRUE(scene.weakness[2].muscles.empty());
  expect_vector(scene.weakness[2].centre, { 0, 0, 0.001 });
}

TEST(EveryKey, muscles_and_expressions)
{
  const Scene& scene = every_key();
  ASSERT_EQ(scene.muscles.size(), 6U);
  EXPECT_EQ(scene.muscles[0].volume, "fibres");
  expect_vector(scene.muscles[0].fibre, { 0, 0.6, 0.8 });
  EXPECT_EQ(scene.muscles[0].stress_reference, 5e6);
  EXPECT_TRUE(scene.muscles[0].passive);
  EXPECT_FALSE(scene.muscles[0].tension_length);
  EXPECT_NEAR(scene.muscles[0].rise_time, 0.01, 1e-12);
  EXPECT_NEAR(scene.muscles[0].fall_time, 0.05, 1e-12);
  EXPECT_EQ(scene.muscles[1].rise_time, 0);
  EXPECT_EQ(scene.muscles[1].volume, "deep");
  expect_vector(scene.muscles[1].fibre, { 1, 0, 0 });
  EXPECT_EQ(scene.muscles[1].stress_reference, 0.3e6);
  EXPECT_FALSE(scene.muscles[1].passive);
  EXPECT_TRUE(scene.muscles[1].tension_length);

  EXPECT_EQ(scene.muscles[0].tone, 0.25);
  EXPECT_EQ(scene.muscles[1].tone, 0);

  ASSERT_EQ(scene.expressions.size(), 3U);
  EXPECT_EQ(scene.expressions.at("raise_brows").activation.at("fibres"), 0.75);
  EXPECT_EQ(scene.expressions.at("frown").activation.at("other"), 0);
  ASSERT_EQ(scene.demo.size(), 3U);
  EXPECT_NEAR(scene.demo[0].ramp, 0.2, 1e-15);
  EXPECT_EQ(scene.demo[0].seconds, 2);
  EXPECT_EQ(scene.demo[1].expression, "relax");
  EXPECT_EQ(scene.demo[1].ramp, 0.1);
  EXPECT_TRUE(scene.demo[1].bones.empty());
  EXPECT_EQ(scene.demo[2].expression, "");
  ASSERT_EQ(scene.demo[2].bones.size(), 2U);
  EXPECT_EQ(scene.demo[2].bones[0].bone, "finger");
  expect_vector(scene.demo[2].bones[0].shift, { 0.01, 0, -0.002 });
  expect_vector(scene.demo[2].bones[0].turn, { 0, 1.5707963267948966, 0 });
  expect_vector(scene.demo[2].bones[1].turn, { 0.5, 0, 0 });
}

TEST(EveryKey, constraints_and_loads)
{
  const Scene& scene = every_key();
  ASSERT_EQ(scene.constraints.size(), 5U);
  EXPECT_EQ(scene.constraints[0].kind, SceneConstraint::Kind::rigid);
  EXPECT_EQ(scene.constraints[0].surfaces, std::vector<std::string>{ "torus" });
  EXPECT_NEAR(scene.constraints[0].within, 1.5e-3, 1e-15);
  expect_vector(scene.constraints[0].crop.upper, { infinity, infinity, 0.1 });
  EXPECT_EQ(scene.constraints[0].bone, "skull");
  EXPECT_EQ(scene.constraints[1].kind, SceneConstraint::Kind::sliding);
  EXPECT_LT(scene.constraints[1].within, 0);
  EXPECT_EQ(scene.constraints[1].bone, "mandible");
  EXPECT_EQ(scene.constraints[1].friction, 0.2);
  EXPECT_EQ(scene.constraints[2].kind, SceneConstraint::Kind::contact);
  EXPECT_EQ(scene.constraints[2].surfaces, std::vector<std::string>{ "sphere" });
  EXPECT_EQ(scene.constraints[2].on, "box");
  EXPECT_EQ(scene.constraints[2].bone, "finger");
  EXPECT_EQ(scene.constraints[2].friction, 0.3);
  ASSERT_TRUE(scene.constraints[2].pushed);
  const ScenePush& pushed = *scene.constraints[2].pushed;
  EXPECT_NEAR(pushed.mass, 0.02, 1e-15);
  expect_vector(pushed.force, { 0, 0, -0.5 });
  EXPECT_NEAR(pushed.spring, 2000, 1e-9);
  EXPECT_NEAR(pushed.damping, 0.5, 1e-15);
  EXPECT_EQ(scene.constraints[3].kind, SceneConstraint::Kind::self_contact);
  EXPECT_EQ(scene.constraints[3].surfaces, (std::vector<std::string>{ "box", "sphere" }));
  EXPECT_EQ(scene.constraints[3].friction, 0.4);
  // what is only shown is a body of contact within whose reach there is no tissue
  EXPECT_EQ(scene.constraints[4].kind, SceneConstraint::Kind::contact);
  EXPECT_EQ(scene.constraints[4].within, 0);
  EXPECT_EQ(scene.constraints[4].bone, "finger");
  EXPECT_EQ(scene.constraints[4].crop.lower[0], 1e-2);
  ASSERT_EQ(scene.loads.size(), 4U);
  EXPECT_TRUE(scene.loads[0].kind == SceneLoad::Kind::traction && scene.loads[0].ramp == 0.1);
  expect_vector(scene.loads[0].value, { 0, 0, 1000 });
  const SceneLoad& push = scene.loads[1];
  EXPECT_TRUE(push.kind == SceneLoad::Kind::pressure && push.value[0] == -2000);
  EXPECT_TRUE(push.clear_of == std::vector<std::string>{ "box" } && std::abs(push.clearance - 1.5e-3) < 1e-15);
  EXPECT_TRUE(scene.loads[2].activated);
  EXPECT_EQ(scene.loads[3].kind, SceneLoad::Kind::displacement);
  EXPECT_EQ(scene.loads[3].fixed, (std::array<bool, 3>{ false, true, true }));
  expect_vector(scene.loads[3].value, { 0, 0, 0.005 });
  EXPECT_NEAR(scene.loads[3].within, 0.5e-3, 1e-15);
  expect_vector(scene.gravity, { 0, 0, -9.81 });
  EXPECT_EQ(names_of(scene.switched_off), "viscosity, sliding, friction");
}

TEST(EveryKey, output_time_and_accuracy)
{
  const Scene& scene = every_key();
  EXPECT_EQ(scene.skin.surface, "box");
  expect_vector(scene.skin.crop.lower, { -infinity, -infinity, 0 });
  EXPECT_NEAR(scene.skin.extrapolation, 0.006, 1e-15);
  ASSERT_EQ(scene.films.size(), 2U);
  EXPECT_EQ(scene.films[0].material + " on " + scene.films[0].base, "dermis on fat");
  expect_vector({ scene.films[0].thickness, scene.films[1].thickness, scene.films[0].stretch }, { 1e-4, 2e-4, 0.05 });
  expect_vector(scene.films[0].crop.upper, { infinity, 0.01, infinity });
  ASSERT_EQ(scene.landmarks.size(), 2U);
  EXPECT_EQ(scene.landmarks[0].name, "brow_left");
  expect_vector(scene.landmarks[0].position, { 0.01, 0.02, 0.03 });

  EXPECT_EQ(scene.frame.id, "subject");
  expect_vector(scene.frame.origin, { 0.01, 0.02, 0.03 });
  expect_vector(scene.frame.forward, { 0, -1, 0 });
  expect_vector(scene.frame.up, { 0, 0, 1 });

  EXPECT_EQ(scene.time.damping, 20);
  EXPECT_EQ(scene.time.scaling, 2);
  EXPECT_EQ(scene.time.activation_slew, 5);
  EXPECT_EQ(scene.time.frame_rate, 60);

  ASSERT_EQ(scene.profiles.size(), 3U);
  EXPECT_EQ(scene.profiles[0].mass_scaling.kind, MassScaling::Kind::selective);
  EXPECT_NEAR(scene.profiles[0].mass_scaling.time_step, 20e-6, 1e-15);
  EXPECT_EQ(scene.profiles[0].mass_scaling.materials, std::vector<std::string>{ "fat" });
  EXPECT_EQ(scene.accuracy.name, "fine");
  expect_vector(scene.accuracy.voxel, { 0.001, 0.002, 0.003 });
  EXPECT_EQ(scene.accuracy.samples, 8);
  EXPECT_EQ(scene.accuracy.fill_min, 0.1);
  EXPECT_EQ(scene.accuracy.time_step_share, 0.5);
  EXPECT_EQ(scene.accuracy.mass_scaling.kind, MassScaling::Kind::uniform);
  expect_vector({ scene.accuracy.mass_scaling.factor, 1e6 * scene.accuracy.mass_scaling.in_motion, 0 }, { 12, 40, 0 });
  EXPECT_TRUE(scene.accuracy.assumed_strain);
  EXPECT_FALSE(scene.profiles[0].assumed_strain);
  EXPECT_EQ(scene.accuracy.integration, "selective_reduced");
  EXPECT_EQ(scene.accuracy.precision, "double");
  EXPECT_EQ(scene.accuracy.time_step, "assembled");
  EXPECT_EQ(scene.profiles[0].precision, "single");
  EXPECT_NEAR(scene.profiles[0].measured.error, 0.3e-3, 1e-15);
  EXPECT_EQ(scene.profiles[0].measured.cost, 0.8);
  EXPECT_EQ(scene.profiles[0].measured.machine, "a bench");
  EXPECT_EQ(scene.profiles[1].measured.cost, 0);
  // keys that a profile leaves out have their defaults, not the values of another profile
  expect_vector(scene.profiles[2].voxel, { 1e-3, 1e-3, 1e-3 });
  EXPECT_EQ(scene.profiles[2].samples, 4);
  EXPECT_EQ(scene.profiles[2].mass_scaling.kind, MassScaling::Kind::none);
}

}  // namespace
}  // namespace frontalis
