// Properties of muscles besides their shape: strength, origins, and the action of thin muscles on thick voxels.

#include "bake/scene_pieces.hpp"
#include "files.hpp"
#include "frontalis/error.hpp"
#include "frontalis/scene/read_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace frontalis
{
namespace
{

// A strand of 40 x 2 x 4 mm in a slab of tissue. In the half x < 0, its lower side is 1 mm above a bone.
std::string strand(const std::string& keys, const std::string& constraint, const std::string& profile)
{
  return "unit: mm\nsurfaces:\n"
         "  slab: {shape: box, centre: [0, 0, 6], size: [60, 20, 12]}\n"
         "  bone: {shape: box, centre: [-15, 0, -2], size: [30, 40, 4]}\n"
         "  strand: {shape: box, centre: [0, 1, 3], size: [40, 2, 4]}\n"
         "volumes:\n"
         "  slab: {inside: slab, material: fat, tissue: true}\n"
         "  strand: {inside: strand, material: fat}\n"
         "materials:\n  fat: {young: 4 kPa, poisson: 0.45, density: 1000}\n"
         "muscles:\n  strand: {fibre: [1, 0, 0], stress_reference: 0.4 MPa" +
         keys + "}\nconstraints:\n" + constraint + "skin: {surface: slab}\naccuracy:\n  only: {voxel: 2" + profile +
         "}\n";
}

const std::string anywhere = "  - {name: hold, rigid: bone}\n";

Model baked(const std::string& scene, BakeReport* report = nullptr)
{
  const TemporaryFolder folder;
  return bake(read_scene(folder.write("scene.yaml", scene)), report);
}

double volume(const Model& model)
{
  double sum = 0;
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
    for (std::int32_t f = model.fibre_begin[e]; f < model.fibre_begin[e + 1]; ++f)
      sum += static_cast<double>(model.fill[e] * model.fibre_weight[f]) * 8e-9;
  return sum;
}

TEST(Strength, is_that_of_the_given_cross_section)
{
  BakeReport report;
  const Model model = baked(strand(", cross_section: 4 mm2", anywhere, ""), &report);
  // the strand of 40 x 2 x 4 mm has a cross-section of 8 mm2
  ASSERT_EQ(report.forces.size(), 1U);
  EXPECT_NEAR(report.forces[0].length, 40e-3, 1e-9);
  EXPECT_NEAR(report.forces[0].cross_section, 8e-6, 0.02 * 8e-6);
  EXPECT_NEAR(report.forces[0].force, 0.4e6 * 4e-6, 1e-9);
  EXPECT_NEAR(model.muscles[0].stress_reference * report.forces[0].cross_section, 1.6, 1e-9);
}

TEST(Strength, is_that_of_the_mesh_without)
{
  BakeReport report;
  const Model model = baked(strand("", anywhere, ""), &report);
  EXPECT_EQ(model.muscles[0].stress_reference, 0.4e6);
  EXPECT_NEAR(report.forces[0].force, 0.4e6 * report.forces[0].cross_section, 1e-9);
}

TEST(Origin, holds_the_end_of_a_muscle_that_is_near_the_bone)
{
  const Model whole = baked(strand("", anywhere, ""));
  const Model end = baked(strand("", "  - {name: hold, rigid: bone, of: strand}\n", ""));
  // held nodes belong to voxels whose centres are in the first 15 % of the fibres, which begin at -20 mm
  double first = 1e9, last = -1e9;
  for (const RigidNode& rigid : end.rigid)
  {
    const auto p = rest_position(end, rigid.node);
    const double x = end.to_scene.turned(p)[0] + end.to_scene.translation[0];
    first = std::min(first, x);
    last = std::max(last, x);
  }
  EXPECT_NEAR(first, -20e-3, 1e-6);
  EXPECT_LE(last, -12e-3 + 1e-6);
  EXPECT_GE(last, -16e-3 - 1e-6);
  std::set<std::int32_t> all;
  for (const RigidNode& rigid : whole.rigid)
    all.insert(rigid.node);
  EXPECT_LT(end.rigid.size(), all.size() / 4);
  for (const RigidNode& rigid : end.rigid)
    EXPECT_EQ(all.count(rigid.node), 1U);
}

// The bone lies below the whole insertion, but ends 2 mm before the end of the origin that the scene gives.
TEST(Origin, that_the_scene_gives_is_held_although_the_other_end_is_nearer_to_the_bone)
{
  std::string text = strand("", "  - {name: hold, rigid: bone, of: strand}\n", "");
  const auto replace = [&](const std::string& old, const std::string& by)
  { text.replace(text.find(old), old.size(), by); };
  replace("centre: [-15, 0, -2], size: [30, 40, 4]", "centre: [-11, 0, -2], size: [58, 40, 4]");
  replace("fibre: [1, 0, 0]", "origin: [20, 1, 3], insertion: [-20, 1, 3]");
  const Model model = baked(text);
  ASSERT_FALSE(model.rigid.empty());
  for (const RigidNode& rigid : model.rigid)
  {
    const auto p = rest_position(model, rigid.node);
    EXPECT_GT(model.to_scene.turned(p)[0] + model.to_scene.translation[0], 0);
  }
}

TEST(Origin, that_the_scene_gives_away_from_the_bone_is_told)
{
  const std::string hold = "  - {name: hold, rigid: bone, of: strand}\n";
  for (const bool twice : { false, true })
  {
    // Each of two constraints may be meant to hold one end.
    std::string text = strand("", hold + (twice ? "  - {name: too, rigid: bone, of: strand}\n" : ""), "");
    const std::string fibre = "fibre: [1, 0, 0]";
    text.replace(text.find(fibre), fibre.size(), "origin: [20, 1, 3], insertion: [-20, 1, 3]");
    BakeReport report;
    baked(text, &report);
    const auto tells = [](const std::string& warning)
    { return warning.find("muscle 'strand' is held at its insertion") != std::string::npos; };
    EXPECT_EQ(std::count_if(report.warnings.begin(), report.warnings.end(), tells), twice ? 0 : 1);
  }
}

TEST(Origin, that_is_not_at_the_bone_is_an_error)
{
  try
  {
    baked(strand("", "  - {name: hold, rigid: bone, of: strand, within: 1, crop: {lower: [-5, null, null]}}\n", ""));
    FAIL() << "no error";
  }
  catch (const Error& error)
  {
    EXPECT_NE(std::string(error.what()).find("neither end of muscle 'strand'"), std::string::npos) << error.what();
  }
}

TEST(SpreadFibres, keep_volume_and_direction)
{
  const Model sampled = baked(strand("", anywhere, "")), spread = baked(strand("", anywhere, ", fibres: spread"));
  EXPECT_NEAR(volume(spread) / volume(sampled), 1, 0.01);
  EXPECT_GT(spread.fibre_muscle.size(), 2 * sampled.fibre_muscle.size());
  for (const auto& direction : spread.fibre_direction)
  {
    const auto scene = spread.to_scene.turned(direction);
    EXPECT_NEAR(std::abs(scene[0]), 1, 1e-6);
  }
}

TEST(Tissues, come_from_a_file_and_may_be_replaced)
{
  const TemporaryFolder folder;
  folder.write("lib.yaml",
               "fat: {young: 1 kPa, poisson: 0.45, density: 900}\n"
               "muscle: {young: 8 kPa, poisson: 0.45, density: 1050}\n"
               "bone: {young: 1 GPa, poisson: 0.3, density: 2000}\n");
  std::string text = strand("", anywhere, "");
  text.insert(text.find("materials:"), "tissues: lib.yaml\n");
  text.replace(text.find("{inside: strand, material: fat}"), 31, "{inside: strand, material: muscle}");
  const Scene scene = read_scene(folder.write("scene.yaml", text));
  ASSERT_EQ(scene.materials.size(), 2U) << "what nothing uses is left out";
  EXPECT_EQ(scene.materials[0].parameters.at("young"), 4e3) << "the scene's own";
  EXPECT_EQ(scene.materials[1].name, "muscle");
  EXPECT_EQ(scene.materials[1].density, 1050);

  folder.write("lib.yaml", "fat: {young: 1 kPa, poisson: 0.45}\n");
  try
  {
    read_scene(folder.path() + "/scene.yaml");
    FAIL() << "no error";
  }
  catch (const Error& error)
  {
    EXPECT_NE(std::string(error.what()).find("lib.yaml:1: fat.density"), std::string::npos) << error.what();
  }
}

TEST(Strength, of_a_muscle_in_a_removed_island_is_zero_and_told)
{
  std::string scene = strand("", anywhere, "");
  for (const auto& [old, changed] :
       { std::pair("  bone:", "  speck: {shape: box, centre: [60, 0, 6], size: [6, 6, 6]}\n  bone:"),
         std::pair("{inside: slab,", "{inside: [slab, speck],"),
         std::pair("centre: [0, 1, 3], size: [40, 2, 4]", "centre: [60, 0, 6], size: [4, 4, 4]") })
    scene.replace(scene.find(old), std::string(old).size(), changed);
  BakeReport report;
  const Model model = baked(scene, &report);
  EXPECT_EQ(volume(model), 0);
  ASSERT_EQ(report.forces.size(), 1u);
  EXPECT_EQ(report.forces[0].length, 0);
  EXPECT_EQ(report.forces[0].force, 0);
  EXPECT_TRUE(std::any_of(report.warnings.begin(), report.warnings.end(),
                          [](const std::string& warning)
                          { return warning.find("'strand' has no voxel in the model") != std::string::npos; }));
}

TEST(Strength, changes_as_fast_as_is_shown)
{
  const Model model = baked(strand(", rise_time: 20 ms, fall_time: 40 ms", anywhere, "") +
                            "time: {scaling: 4, activation_slew: 10 1/s}\n"
                            "loads:\n  - {name: lift, displacement: [null, null, 1], surface: slab, ramp: 0.2 s}\n");
  EXPECT_DOUBLE_EQ(model.muscles[0].rise_time, 5e-3);
  EXPECT_DOUBLE_EQ(model.muscles[0].fall_time, 10e-3);
  EXPECT_DOUBLE_EQ(model.loads[0].ramp, 0.05);
  EXPECT_DOUBLE_EQ(model.activation_slew, 40);
}

}  // namespace
}  // namespace frontalis
