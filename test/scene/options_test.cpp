// Options that are given when a scene is read.

#include "frontalis/error.hpp"
#include "frontalis/scene/read_scene.hpp"
#include "files.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

namespace frontalis
{
namespace
{

const std::string source = FRONTALIS_SOURCE_DIRECTORY;

void expect_vector(const Vector3& found, const Vector3& expected)
{
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(found[i], expected[i], 1e-15) << "component " << i;
}

TEST(Options, a_file_may_hold_the_profile)
{
  const std::string path = source + "/test/scene/every_key.yaml";
  const TemporaryFolder folder;
  SceneOptions options;
  options.accuracy =
      folder.write("chosen.yaml",
                   "chosen: {voxel: 1.25 mm, mass_scaling: {selective: [fat]}, measured: {error: 0.2 mm, cost: 3}}\n");
  const Scene scene = read_scene(path, options);
  EXPECT_EQ(scene.accuracy.name, "chosen");
  expect_vector(scene.accuracy.voxel, { 1.25e-3, 1.25e-3, 1.25e-3 });
  EXPECT_EQ(scene.profiles.back().measured.cost, 3);
  EXPECT_NE(content_of(scene), content_of(read_scene(path)));
  options.voxel_quantity = "2 mm";
  EXPECT_EQ(read_scene(path, options).accuracy.measured.cost, 0) << "another voxel edge was not measured";
  EXPECT_EQ(read_scene(path, options).profiles.back().measured.cost, 0);

  // a profile from a file replaces the scene's profile of the same name
  options.voxel_quantity.clear();
  folder.write("chosen.yaml", "draft: {voxel: 1.25 mm, measured: {error: 0.1 mm, cost: 9}}\n");
  const Scene replaced = read_scene(path, options);
  EXPECT_EQ(replaced.profiles.size(), read_scene(path).profiles.size());
  EXPECT_EQ(replaced.profiles.back().name, "draft");
  EXPECT_EQ(replaced.profiles.back().measured.cost, 9);

  for (const auto& [text, fault] :
       { std::pair<const char*, const char*>("a: {voxel: 1 mm}\nb: {}\n", "found 2 profiles"),
         { "a: {voxl: 1 mm}\n", ":1: a.voxl" },
         { "a: {measured: {error: 1}}\n", "cost" },
         { "- a\n", "found a list" } })
  {
    folder.write("chosen.yaml", text);
    try
    {
      read_scene(path, options);
      ADD_FAILURE() << text;
    }
    catch (const Error& error)
    {
      EXPECT_NE(std::string(error.what()).find(fault), std::string::npos) << error.what();
    }
  }
  std::filesystem::remove(options.accuracy);
  EXPECT_THROW(read_scene(path, options), Error);
}

TEST(Options, choose_profile_voxel_and_mesh_folder)
{
  const std::string path = source + "/test/scene/every_key.yaml";
  SceneOptions options;
  options.accuracy = "draft";
  EXPECT_EQ(read_scene(path, options).accuracy.name, "draft");
  options.voxel_quantity = "1.5";
  expect_vector(read_scene(path, options).accuracy.voxel, { 0.015, 0.015, 0.015 });
  options.voxel_quantity = "1.5 mm";
  expect_vector(read_scene(path, options).accuracy.voxel, { 0.0015, 0.0015, 0.0015 });
  options.voxel_quantity.clear();
  options.voxel = 0.002;
  expect_vector(read_scene(path, options).accuracy.voxel, { 0.002, 0.002, 0.002 });

  const TemporaryFolder folder;
  folder.write("triangle.obj", "v 0 0 0\n");
  options.mesh_directory = folder.path();
  EXPECT_EQ(read_scene(path, options).surfaces[0].file, folder.path() + "/triangle.obj");
}
}  // namespace
}  // namespace frontalis
