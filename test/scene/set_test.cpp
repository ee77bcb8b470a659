// Entries that define several things at once: sets of parts, muscles of a set, names without a side.

#include "frontalis/error.hpp"
#include "frontalis/scene/read_scene.hpp"
#include "files.hpp"

#include <gtest/gtest.h>

namespace frontalis
{
namespace
{

Scene read_with(const std::string& surfaces, const std::string& muscles, const std::string& more = "")
{
  const TemporaryFolder folder;
  return read_scene(
      folder.write("scene.yaml", "unit: mm\nsurfaces:\n" + surfaces +
                                     "volumes:\n"
                                     "  body: {inside: tissue, material: flesh, tissue: true}\n"
                                     "materials:\n"
                                     "  flesh: {young: 30 kPa, poisson: 0.45, density: 1000}\n"
                                     "  fibre: {young: 20 kPa, poisson: 0.45, density: 1000, tension: 5 kPa}\n"
                                     "muscles:\n" +
                                     muscles + "skin: {surface: skin}\n" + more));
}

std::string error_of(const std::string& surfaces, const std::string& muscles, const std::string& more = "")
{
  try
  {
    read_with(surfaces, muscles, more);
  }
  catch (const Error& error)
  {
    return error.what();
  }
  return {};
}

TEST(SetsOfSurfaces, DoNotShareNames)
{
  const std::string two = "  brow: {shape: forehead, parts: all}\n  other: {shape: forehead, parts: [skin]}\n";
  EXPECT_NE(error_of(two, "  {}\n").find("surfaces.other: its part 'skin' is a surface already"), std::string::npos)
      << error_of(two, "  {}\n");
}

const std::string all = "  brow: {shape: forehead, parts: all, dimensions: {height: 80}}\n";

template <class Item>
const Item& named(const std::vector<Item>& items, const std::string& name)
{
  for (const Item& item : items)
    if (item.name == name)
      return item;
  throw Error("nothing is called " + name);
}

TEST(Set, holds_each_part_as_a_surface_of_its_name)
{
  const Scene scene = read_with(all + "  skull: {shape: forehead, part: skull, edge: 5}\n", "  m: {each: brow}\n");
  ASSERT_EQ(scene.surfaces.size(), forehead_parts().size());
  for (const std::string& part : forehead_parts())
  {
    const Surface& surface = named(scene.surfaces, part);
    EXPECT_EQ(surface.shape->part, part);
    EXPECT_EQ(surface.shape->edge, part == "skull" ? 5e-3 : 1e-3) << "its own entry replaces a part";
    EXPECT_EQ(surface.shape->dimensions.count("height"), part == "skull" ? 0U : 1U);
  }
}

TEST(Set, has_its_muscles_with_volumes_of_their_own)
{
  const Scene scene = read_with(all,
                                "  m: {each: brow, without: corrugator, material: fibre, stress_reference: 1 MPa}\n"
                                "  procerus: {stress_reference: 2 MPa, material: flesh}\n",
                                "expressions: {up: {frontalis: 0.5, procerus: 0.25}}\n");
  ASSERT_EQ(scene.muscles.size(), 3U) << "both frontales and procerus; the galea is no muscle";
  EXPECT_EQ(named(scene.muscles, "frontalis_left").stress_reference, 1e6);
  EXPECT_EQ(named(scene.muscles, "procerus").stress_reference, 2e6);
  const Volume& volume = named(scene.volumes, named(scene.muscles, "frontalis_right").volume);
  EXPECT_EQ(volume.inside, std::vector<std::string>{ "frontalis_right" });
  EXPECT_EQ(volume.material, "fibre");
  EXPECT_EQ(volume.priority, 1);
  EXPECT_EQ(named(scene.volumes, "procerus").material, "flesh");
  const std::map<std::string, double> up{ { "frontalis_left", 0.5 }, { "frontalis_right", 0.5 }, { "procerus", 0.25 } };
  EXPECT_EQ(scene.expressions.at("up").activation, up);
}

TEST(Set, gives_way_to_a_muscle_that_stands_for_the_tension_of_a_material)
{
  const Scene scene = read_with(all,
                                "  m: {each: brow, cross_section: 90 mm2, passive: true, tone: 0.1, rise_time: 5 ms}\n"
                                "  procerus: {tension_of: fibre}\n");
  const SceneMuscle &tense = named(scene.muscles, "procerus"), &other = named(scene.muscles, "frontalis_left");
  EXPECT_EQ(tense.stress_reference, 5e3);
  EXPECT_EQ(tense.cross_section, 0);
  EXPECT_FALSE(tense.passive);
  EXPECT_FALSE(tense.tension_length);
  EXPECT_EQ(tense.tone, 1);
  EXPECT_EQ(tense.rise_time, 5e-3) << "what the tension does not determine is that of the set";
  EXPECT_NEAR(other.cross_section, 90e-6, 1e-15);
  EXPECT_TRUE(other.passive);
  EXPECT_EQ(other.tone, 0.1);
}

TEST(Set, is_the_same_as_its_entries_written_out)
{
  const std::string parts = "  brow: {shape: forehead, parts: [skin, tissue, procerus]}\n";
  const std::string written =
      "  skin: {shape: forehead, part: skin}\n  tissue: {shape: forehead, part: tissue}\n"
      "  procerus: {shape: forehead, part: procerus}\n";
  EXPECT_EQ(read_with(parts, "  m: {each: [brow], material: fibre, rise_time: 5 ms}\n").content,
            read_with(written, "  procerus: {material: fibre, rise_time: 5 ms}\n").content);
}

TEST(Set, faults_name_their_place)
{
  const auto expect = [](const std::string& message, const std::string& text)
  {
    EXPECT_NE(message.find(text), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << "one fault";
  };
  expect(error_of("  brow: {shape: forehead, part: skin, parts: all}\n", "  body: {}\n"),
         "surfaces.brow.part: stands beside");
  expect(error_of(all, "  m: {each: brwo}\n"), "muscles.m.each: no surface is called 'brwo'");
  expect(error_of(all, "  m: {each: brow, without: galea}\n"), "muscles.m.without: no muscle is called");
  expect(error_of(all, "  m: {each: brow, fibre: [1, 0, 0]}\n"), "muscles.m.fibre: unknown key");
  expect(error_of(all, "  m: {each: [brow, procerus]}\n"), "muscles.m.each: 'procerus' is in two sets");
  expect(error_of(all, "  body: {material: fibre}\n"), "'material' stands beside a volume called 'body'");
  expect(error_of(all, "  m: {each: brow}\n", "expressions: {up: {frontalis: 0.5, frontalis_left: 1}}\n"),
         "expressions.up.frontalis_left: 'frontalis_left' has an activation already");
}

TEST(Set, takes_a_head_of_a_sex_an_age_and_a_tissue)
{
  const std::string head = "  head: {shape: head, template: " FRONTALIS_SOURCE_DIRECTORY
                           "/config/head/head.yaml, parts: [skin, skull], dimensions: {sa_sba: 60}";
  const auto scene_of = [&](const std::string& presets)
  { return read_with(head + presets + "}\n  tissue: {shape: box, size: [1, 1, 1]}\n", "  body: {}\n"); };
  const Scene scene = scene_of(", sex: male, age: old, tissue: full");
  const Shape& shape = *named(scene.surfaces, "skin").shape;
  EXPECT_NEAR(shape.dimensions.at("sa_sba"), 60e-3, 1e-9) << "what is asked for goes first";
  EXPECT_NEAR(shape.dimensions.at("n_sn"), 54.8e-3 + 2.5e-3, 1e-9);
  EXPECT_NEAR(shape.dimensions.at("zy_zy"), 142.6e-3, 1e-9);
  EXPECT_EQ(shape.tissue, 1.2);
  const Scene older = scene_of(", age: old");
  const Shape& default_sex = *named(older.surfaces, "skull").shape;
  EXPECT_NEAR(default_sex.dimensions.at("n_sn"), 52.7e-3 + 2.5e-3, 1e-9);
  EXPECT_EQ(default_sex.dimensions.count("zy_zy"), 0U);
  EXPECT_EQ(default_sex.tissue, 1);
  EXPECT_THROW(scene_of(", age: ancient"), Error);
}

TEST(Set, gives_later_parts_the_size_of_its_head)
{
  const std::string shape = "{shape: head, template: " FRONTALIS_SOURCE_DIRECTORY "/config/head/head.yaml, ";
  const Scene scene = read_with("  head: " + shape + "parts: [skin], dimensions: {zy_zy: 145}, tissue: full}\n" +
                                    "  lining: " + shape + "part: skin}\n  other: " + shape +
                                    "part: skin, age: young}\n" + "  tissue: {shape: box, size: [1, 1, 1]}\n",
                                "  body: {}\n");
  EXPECT_EQ(named(scene.surfaces, "lining").shape->dimensions, named(scene.surfaces, "skin").shape->dimensions);
  EXPECT_EQ(named(scene.surfaces, "lining").shape->tissue, 1.2);
  EXPECT_TRUE(named(scene.surfaces, "other").shape->dimensions.empty());
}

}  // namespace
}  // namespace frontalis
