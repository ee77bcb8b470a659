// The scene reader, the bake and doc/scene.md agree on the parts of the generated forehead.

#include "cli/program.hpp"

#include "frontalis/bake/forehead_shape.hpp"
#include "frontalis/scene/read_scene.hpp"

#include <gtest/gtest.h>

#include <cstdio>

namespace frontalis
{
namespace
{

std::string scene_with(const std::string& surfaces)
{
  return "unit: mm\nsurfaces:\n" + surfaces +
         "volumes:\n  tissue: {inside: skin, material: flesh, tissue: true}\n"
         "materials:\n  flesh: {young: 30 kPa, poisson: 0.45, density: 1000}\nskin: {surface: skin}\n";
}

TEST(ForeheadShape, every_part_of_the_bake_may_stand_in_a_scene)
{
  std::string surfaces;
  for (const std::string& part : forehead_parts())
    surfaces += "  " + part + ": {shape: forehead, part: " + part + "}\n";
  const TemporaryFolder folder;
  std::ofstream(folder / "scene.yaml") << scene_with(surfaces);
  const Scene scene = read_scene(folder / "scene.yaml");
  ASSERT_EQ(scene.surfaces.size(), forehead_parts().size());
  for (const Surface& surface : scene.surfaces)
    EXPECT_FALSE(make_forehead(*surface.shape).triangles.empty()) << surface.name;
}

TEST(ForeheadShape, a_part_of_the_scene_that_the_bake_lacks_would_be_found)
{
  // the reader's message lists exactly the parts that the bake can generate
  const TemporaryFolder folder;
  std::ofstream(folder / "scene.yaml") << scene_with("  skin: {shape: forehead, part: chin_and_jaw}\n");
  std::string allowed;
  for (const std::string& part : forehead_parts())
    allowed += (allowed.empty() ? "" : ", ") + part;
  expect_contains(run_program({ "run", folder / "scene.yaml" }).errors, "allowed are " + allowed + "\n");
}

TEST(ForeheadShape, every_dimension_is_documented_with_its_default)
{
  const std::string document = text_of(std::string(FRONTALIS_SOURCE_DIRECTORY) + "/doc/scene.md");
  EXPECT_GE(forehead_dimension_names().size(), 10U);
  for (const std::string& name : forehead_dimension_names())
    expect_contains(document, "| `" + name + "` | ");
  const ForeheadDimensions dimensions;
  for (const auto& [name, value] : { std::pair<const char*, double>("height", dimensions.height),
                                     { "brow_thickness", dimensions.brow_thickness },
                                     { "profile_radius", dimensions.profile_radius },
                                     { "galea_thickness", dimensions.galea_thickness } })
  {
    char row[64];
    std::snprintf(row, sizeof row, "| `%s` | %g mm |", name, value * 1e3);
    expect_contains(document, row);
  }
}

}  // namespace
}  // namespace frontalis
