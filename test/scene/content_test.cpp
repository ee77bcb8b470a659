// The data that determine a scene's content hash.

#include "frontalis/error.hpp"
#include "frontalis/content_hash.hpp"
#include "frontalis/scene/read_scene.hpp"
#include "files.hpp"

#include <gtest/gtest.h>

#include <regex>
#include <string>

namespace frontalis
{
namespace
{

const std::string source = FRONTALIS_SOURCE_DIRECTORY;

TEST(Content, hash_is_fnv_1a_of_64_bits)
{
  // test vectors of Fowler, Noll and Vo
  EXPECT_EQ(content_hash(""), "cbf29ce484222325");
  EXPECT_EQ(content_hash("a"), "af63dc4c8601ec8c");
  EXPECT_EQ(content_hash("foobar"), "85944171f73967e8");
}

TEST(Content, depends_on_what_decides_the_bake_alone)
{
  const std::string text = text_of(source + "/test/scene/every_key.yaml");
  const TemporaryFolder folder;
  const std::string mesh = folder.write("a/meshes/triangle.obj", "v 0 0 0\n");
  const std::string content = read_scene(folder.write("a/scene.yaml", text)).content;

  // folder, comments and profiles that are not chosen do not change the hash
  folder.write("b/meshes/triangle.obj", "v 0 0 0\n");
  std::string changed = "# a comment\n" + text;
  changed.replace(changed.find("draft: {voxel: 3 mm"), 19, "draft: {voxel: 4 mm");
  EXPECT_EQ(read_scene(folder.write("b/scene.yaml", changed)).content, content);

  // the same length in another unit does not change the hash
  changed = text;
  changed.replace(changed.find("minor_radius: 1,"), 16, "minor_radius: 10 mm,");
  EXPECT_EQ(read_scene(folder.write("a/scene.yaml", changed)).content, content);

  // a number, the chosen profile and each byte of a mesh change the hash
  changed = text;
  changed.replace(changed.find("poisson: 0.49"), 13, "poisson: 0.48");
  EXPECT_NE(read_scene(folder.write("a/scene.yaml", changed)).content, content);
  SceneOptions options;
  options.accuracy = "draft";
  EXPECT_NE(read_scene(folder.write("a/scene.yaml", text), options).content, content);
  folder.write("a/meshes/triangle.obj", "v 0 0 1\n");
  EXPECT_NE(read_scene(folder.path() + "/a/scene.yaml").content, content);
}

// Every number of the file, except in profiles not chosen, changes the hash: otherwise caches return wrong models.
TEST(Content, depends_on_every_number)
{
  const std::string text = text_of(source + "/test/scene/every_key.yaml");
  const TemporaryFolder folder;
  folder.write("meshes/triangle.obj", "v 0 0 0\n");
  const std::string content = read_scene(folder.write("scene.yaml", text)).content;
  const std::regex number(R"([\[:,{ ](-?[0-9]+(\.[0-9]+)?)(?=[\], }\n]))");
  int changed = 0;
  for (auto it = std::sregex_iterator(text.begin(), text.end(), number); it != std::sregex_iterator(); ++it)
  {
    const std::size_t at = static_cast<std::size_t>(it->position(1)), line = text.rfind('\n', at) + 1;
    const std::string before = text.substr(line, at - line);
    const std::string list = before.substr(before.rfind('[') == std::string::npos ? 0 : before.rfind('['));
    const std::string key = before.substr(0, before.size() - list.size());
    const bool direction =
        list.find(']') == std::string::npos && std::regex_search(key, std::regex("(forward|up|axis|fibre): $"));
    if (direction || (before.find("  draft:") == 0 && before.find("measured") == std::string::npos))
      continue;
    std::string other = text;
    const std::string digits = it->str(1);
    other.replace(at, digits.size(),
                  digits.find('.') != std::string::npos ? digits + "1" : std::to_string(std::stoi(digits) + 1));
    std::string got;
    try
    {
      got = read_scene(folder.write("scene.yaml", other)).content;
    }
    catch (const Error&)
    {
      continue;  // the changed number is outside its range
    }
    ++changed;
    EXPECT_NE(got, content) << digits << " of " << text.substr(line, text.find('\n', line) - line);
  }
  EXPECT_GT(changed, 100);
}

}  // namespace
}  // namespace frontalis
