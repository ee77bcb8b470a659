// config/head.yaml can be baked with random dimensions of the head. FRONTALIS_HEADS: number of heads, 5 by default.

#include "bake/shapes/head/head.hpp"
#include "frontalis/bake/bake.hpp"
#include "frontalis/error.hpp"
#include "frontalis/scene/read_scene.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

namespace
{

using namespace frontalis;

/// Independent dimensions within two standard deviations of the means. All share a random size of the head, which gives
/// two of them a correlation of 0.36, about as in people.
std::map<std::string, double> random_dimensions(const HeadTemplate& head, std::mt19937& random)
{
  std::normal_distribution<double> normal;
  const double size = normal(random);
  std::map<std::string, double> dimensions;
  for (const auto& d : head.dimensions)
  {
    const double deviations = std::min(2.0, std::max(-2.0, 0.6 * size + 0.8 * normal(random)));
    if (d.derived_from.empty())
      dimensions[d.name] = d.mean + deviations * d.deviation;
  }
  return dimensions;
}

TEST(RandomHeads, CanBeBaked)
{
  const char* wanted = std::getenv("FRONTALIS_HEADS");
  const int count = wanted != nullptr ? std::atoi(wanted) : 5;
  Scene scene = read_scene(FRONTALIS_SOURCE_DIRECTORY "/config/head.yaml");
  const std::size_t muscles = scene.muscles.size();
  std::mt19937 random(1);
  for (int n = 0; n < count; ++n)
  {
    SCOPED_TRACE(n);
    std::map<std::string, double> dimensions;
    for (Surface& surface : scene.surfaces)
      if (surface.shape && surface.shape->head)
      {
        if (dimensions.empty())
          dimensions = random_dimensions(*surface.shape->head, random);
        surface.shape->dimensions = dimensions;
        surface.shape->edge = 3.5e-3;  // coarse, because a few surfaces take most of the time
      }
    for (SceneLandmark& landmark : scene.landmarks)
      if (landmark.head)
        landmark.head->dimensions = dimensions;
    for (SceneJoint& joint : scene.joints)
      if (joint.head)
        joint.head->dimensions = dimensions;
    try
    {
      const Model model = bake(scene);
      EXPECT_EQ(model.muscles.size(), muscles);
      EXPECT_GT(model.voxels.size(), 15000u);
      EXPECT_GT(model.landmarks.size(), 10u);
    }
    catch (const Error& error)
    {
      ADD_FAILURE() << error.what();
    }
  }
}

}  // namespace
