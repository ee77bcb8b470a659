// config/head.yaml can be baked with random dimensions of the head, whose parts fit together. FRONTALIS_HEADS: number
// of heads, 5 by default.

#include "bake/mesh/surface.hpp"
#include "bake/shapes/head/head.hpp"
#include "bake/shapes/muscle_net.hpp"
#include "frontalis/bake/bake.hpp"
#include "frontalis/error.hpp"
#include "frontalis/scene/read_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
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

/// The parts of a head, with edges of 2 mm (skin) and 3 mm.
struct Parts
{
  explicit Parts(const Head& head) : skin("skin", head.part("skin", 2e-3))
  {
    for (const char* name : { "skull", "mandible", "teeth_upper", "teeth_lower" })
      bones.push_back(std::make_unique<PreparedSurface>(name, head.part(name, edge)));
  }
  bool in_bone(const Vector3d& p) const
  {
    return std::any_of(bones.begin(), bones.end(),
                       [&](const auto& bone) { return bone->signed_distance(p, bone->tree().closest(p)) < 0; });
  }

  static constexpr double edge = 3e-3;
  PreparedSurface skin;
  PreparedSurfaces bones;
};

/// The depths of the bone below the skin are 2.9 mm and more, so that no tissue may be thinner than 1 mm.
void expect_tissue_between_skin_and_bone(const Head& head, const Parts& parts)
{
  double thinnest = 1;
  Vector3 place{};
  std::string below;
  for (const Vector3& v : head.part("face", Parts::edge).vertices)
    for (const auto& bone : parts.bones)
    {
      const double thickness = bone->signed_distance(to_vector(v), bone->tree().closest(to_vector(v)));
      if (thickness >= thinnest)
        continue;
      thinnest = thickness;
      place = v;
      below = bone->name();
    }
  std::printf("tissue at least %.2f mm thick, at (%.1f, %.1f, %.1f) mm over %s\n", 1e3 * thinnest, 1e3 * place[0],
              1e3 * place[1], 1e3 * place[2], below.c_str());
  EXPECT_GE(thinnest, 1e-3);
}

/// At most 5 % of a muscle lie in bone or outside of the skin, and the right muscle is the image of the left one.
void expect_muscles_between_skin_and_bone(const HeadTemplate& data, const Head& head, const Parts& parts)
{
  double most_in_bone = 0, most_outside = 0, asymmetry = 0;
  for (const auto& muscle : data.muscles)
  {
    const ControlNet net = *head.net(muscle.name + (muscle.sided ? "_left" : ""));
    if (muscle.sided)
    {
      const ControlNet image = *head.net(muscle.name + "_right");
      for (std::size_t i = 0; i < net.points.size(); ++i)
      {
        const Vector3& p = image.points[i];
        asymmetry = std::max(asymmetry, (to_vector(net.points[i]) - Vector3d(p[0], -p[1], p[2])).norm());
      }
    }
    const NurbsVolume volume = volume_of(net);
    int count = 0, in_bone = 0, outside = 0;
    for (double u = 0.05; u < 1; u += 0.1)
      for (double v = 0.05; v < 1; v += 0.1)
        for (const double w : { 0.1, 0.5, 0.9 })
        {
          const Vector3d p = volume.at({ u, v, w }).position;
          ++count;
          in_bone += parts.in_bone(p) ? 1 : 0;
          outside += parts.skin.signed_distance(p, parts.skin.tree().closest(p)) > 0 ? 1 : 0;
        }
    EXPECT_LE(in_bone, 0.05 * count) << muscle.name << ": samples in bone, of " << count;
    EXPECT_LE(outside, 0.05 * count) << muscle.name << ": samples outside the skin, of " << count;
    most_in_bone = std::max(most_in_bone, static_cast<double>(in_bone) / count);
    most_outside = std::max(most_outside, static_cast<double>(outside) / count);
  }
  std::printf("muscles at most %.1f %% in bone, %.1f %% outside the skin, sides differ by %.2g m\n", 100 * most_in_bone,
              100 * most_outside, asymmetry);
  EXPECT_LE(asymmetry, 1e-9);
}

int number_of_heads()
{
  const char* wanted = std::getenv("FRONTALIS_HEADS");
  return wanted != nullptr ? std::atoi(wanted) : 5;
}

std::shared_ptr<const HeadTemplate> shipped()
{
  static const auto head = read_head_template(FRONTALIS_SOURCE_DIRECTORY "/config/head/head.yaml");
  return head;
}

TEST(RandomHeads, HavePartsThatFitTogether)
{
  std::mt19937 random(1);
  for (int n = 0; n < number_of_heads(); ++n)
  {
    SCOPED_TRACE(n);
    const Head head(shipped(), random_dimensions(*shipped(), random));
    const Parts parts(head);
    expect_tissue_between_skin_and_bone(head, parts);
    expect_muscles_between_skin_and_bone(*shipped(), head, parts);
  }
}

TEST(RandomHeads, CanBeBaked)
{
  Scene scene = read_scene(FRONTALIS_SOURCE_DIRECTORY "/config/head.yaml");
  const std::size_t muscles = scene.muscles.size();
  std::mt19937 random(1);
  for (int n = 0; n < number_of_heads(); ++n)
  {
    SCOPED_TRACE(n);
    const std::map<std::string, double> dimensions = random_dimensions(*shipped(), random);
    for (Surface& surface : scene.surfaces)
      if (surface.shape && surface.shape->head)
      {
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
      std::printf("head %d: %zu voxels\n", n, model.voxels.size());
      std::fflush(stdout);
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
