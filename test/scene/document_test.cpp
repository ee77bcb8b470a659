// The example of doc/scene.md and the tension of doc/wrinkles.md are valid.

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

TEST(Document, its_example_is_a_good_scene)
{
  const std::string document = text_of(source + "/doc/scene.md");
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

// Skin of each age has a tension, which the shipped scene uses once its lines "# tension:" are no comments.
TEST(LivingForehead, has_the_tension_of_its_age)
{
  const std::string config = source + "/config/";
  const std::string text = std::regex_replace(text_of(config + "living_forehead.yaml"), std::regex("# tension: "), "");
  double younger = 53e3;
  for (const char* age : { "young", "middle", "old" })
  {
    const TemporaryFolder folder;
    const std::string tissues = std::string("skin_") + age + ".yaml";
    folder.write(tissues, text_of(config + tissues));
    const Scene scene = read_scene(
        folder.write("scene.yaml", std::regex_replace(text, std::regex("skin_middle.yaml\nmat"), tissues + "\nmat")));
    const SceneMuscle& tension = scene.muscles.back();
    EXPECT_EQ(tension.name, "skin_tension");
    EXPECT_LT(tension.stress_reference, younger);
    EXPECT_GT(tension.stress_reference, 5e3);
    EXPECT_EQ(tension.tone, 1);
    EXPECT_FALSE(tension.tension_length);
    younger = tension.stress_reference;
  }
}

}  // namespace
}  // namespace frontalis
