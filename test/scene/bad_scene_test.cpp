// Each scene of test/scene/bad has one fault. The message in its first line must be reported, and no other.

#include "frontalis/error.hpp"
#include "frontalis/scene/read_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace frontalis
{
namespace
{

const std::string folder = std::string(FRONTALIS_SOURCE_DIRECTORY) + "/test/scene";

std::vector<std::string> bad_scenes()
{
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder + "/bad"))
    if (entry.path().extension() == ".yaml")
      names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string first_line(const std::string& path)
{
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

std::string message_of(const std::string& path, const SceneOptions& options = {})
{
  try
  {
    read_scene(path, options);
  }
  catch (const Error& error)
  {
    return error.what();
  }
  return {};
}

std::size_t line_count(const std::string& text)
{
  return text.empty() ? 0 : 1 + static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

class BadScene : public testing::TestWithParam<std::string>
{
};

TEST_P(BadScene, is_refused_for_its_one_fault)
{
  const std::string path = folder + "/bad/" + GetParam() + ".yaml";
  const std::string line = first_line(path);
  const std::string message = message_of(path);
  const std::string expect = "# expect: ";
  const std::string expect_bake = "# expect-bake: ";
  if (line.compare(0, expect_bake.size(), expect_bake) == 0)
  {
    EXPECT_EQ(message, "") << "the fault is one that only the bake can find";
    return;
  }
  ASSERT_EQ(line.compare(0, expect.size(), expect), 0) << "the first line says what is expected";
  const std::string expected = path + line.substr(expect.size());
  EXPECT_EQ(message.compare(0, expected.size(), expected), 0) << "expected " << expected << "\nfound    " << message;
  EXPECT_EQ(line_count(message), 1U) << message;
}

INSTANTIATE_TEST_SUITE_P(scenes, BadScene, testing::ValuesIn(bad_scenes()),
                         [](const auto& scene) { return scene.param; });

TEST(BadScenes, are_many) { EXPECT_GE(bad_scenes().size(), 60U); }

TEST(Faults, all_of_a_file_are_reported_at_once_in_order)
{
  const std::string message = message_of(folder + "/five_faults.yaml");
  EXPECT_EQ(line_count(message), 5U) << message;
  std::size_t place = 0;
  for (const char* fault : { ":9: materials.flesh.young: ", ":11: layers[0].thickness: ", ":13: muscles.strand.fibre: ",
                             ":16: skin.surface: ", ":24: expressions.pull.strand: " })
  {
    place = message.find(fault, place);
    EXPECT_NE(place, std::string::npos) << fault << " is not in its place in\n" << message;
  }
}

TEST(Faults, missing_scene_and_folder_are_told)
{
  EXPECT_NE(message_of(folder + "/absent.yaml").find("absent.yaml: no such file"), std::string::npos);
  EXPECT_NE(message_of(folder).find("cannot be read"), std::string::npos);
}

TEST(Options, wrong_ones_are_told_with_what_exists)
{
  const std::string path = folder + "/bad/empty_volume.yaml";
  SceneOptions options;
  options.accuracy = "fnie";
  EXPECT_NE(message_of(path, options).find("'fnie'; the profiles are draft, fine (did you mean 'fine'?)"),
            std::string::npos);
  for (const char* edge : { "-1", "0 mm", "1 kg", "wide" })
  {
    options = {};
    options.voxel_quantity = edge;
    EXPECT_NE(message_of(path, options).find("voxel edge asked for: "), std::string::npos) << edge;
  }
}

TEST(Options, files_of_similar_names_are_suggested)
{
  std::ifstream scene(folder + "/bad/missing_file.yaml");
  const std::string text{ std::istreambuf_iterator<char>(scene), {} }, path = testing::TempDir() + "similar_file.yaml";
  SceneOptions options;
  options.mesh_directory = folder;
  for (const auto& [file, expected] :
       { std::pair{ "meshes/Triangle.OBJ", "Triangle.OBJ' (did you mean 'triangle.obj'?); must be" },
         std::pair{ "meshes\\triangle.obj", "triangle.obj' (write / between folders); must be" } })
  {
    std::string changed = text;
    changed.replace(changed.find("absent.obj"), 10, file);
    std::ofstream(path) << changed;
    EXPECT_NE(message_of(path, options).find(expected), std::string::npos) << message_of(path, options);
  }
}

}  // namespace
}  // namespace frontalis
