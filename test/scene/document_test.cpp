// The example of doc/scene.md is a valid scene.

#include "frontalis/scene/read_scene.hpp"
#include "files.hpp"

#include <gtest/gtest.h>

#include <string>

namespace frontalis
{
namespace
{

TEST(Document, its_example_is_a_good_scene)
{
  const std::string document = text_of(std::string(FRONTALIS_SOURCE_DIRECTORY) + "/doc/scene.md");
  const std::string fence = "```yaml\n";
  ASSERT_NE(document.find(fence), std::string::npos);
  const std::size_t begin = document.find(fence) + fence.size();
  const std::size_t end = document.find("```", begin);
  const TemporaryFolder folder;
  const Scene scene = read_scene(folder.write("example.yaml", document.substr(begin, end - begin)));
  EXPECT_EQ(scene.surfaces.size(), 2U);
  EXPECT_EQ(scene.muscles.at(0).volume, "bar");
  for (const double edge : scene.accuracy.voxel)
    EXPECT_NEAR(edge, 0.0025, 1e-15);
}

}  // namespace
}  // namespace frontalis
