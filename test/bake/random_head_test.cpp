// config/head.yaml can be baked for random people, and the parts of their heads fit together. FRONTALIS_HEADS: number
// of heads, 3 by default; FRONTALIS_FIRST_HEAD: number of the first of them that is made, 0 by default.

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
#include <numeric>
#include <random>
#include <set>

namespace
{

using namespace frontalis;

/// A person: independent dimensions within two standard deviations of the means of a sex and an age, and an amount of
/// tissue. All dimensions share a random size of the head, which gives two of them a correlation of 0.36, about as in
/// people.
struct Person
{
  Person(const HeadTemplate& head, std::mt19937& random)
  {
    const auto any_of = [&](const auto& presets) { return *std::next(presets.begin(), random() % presets.size()); };
    const bool man = random() % 2 == 0;
    const auto age = any_of(head.ages);
    const auto amount = any_of(head.tissues);
    tissue = amount.second;
    description = std::string(man ? "man" : "woman") + ", " + age.first + ", " + amount.first;
    std::normal_distribution<double> normal;
    const double size = normal(random);
    for (const auto& d : head.dimensions)
    {
      const double deviations = std::min(2.0, std::max(-2.0, 0.6 * size + 0.8 * normal(random)));
      const auto change = age.second.find(d.name);
      if (d.derived_from.empty())
        dimensions[d.name] =
            (man ? d.men : d.women) + (change == age.second.end() ? 0 : change->second) + deviations * d.deviation;
    }
  }

  std::map<std::string, double> dimensions;
  double tissue = 1;
  std::string description;
};

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

int setting(const char* name, int usual)
{
  const char* wanted = std::getenv(name);
  return wanted != nullptr ? std::atoi(wanted) : usual;
}
int number_of_heads() { return setting("FRONTALIS_HEADS", 3); }
int first_head() { return setting("FRONTALIS_FIRST_HEAD", 0); }

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
    const Person person(*shipped(), random);
    if (n < first_head())
      continue;
    std::printf("head %d (%s): ", n, person.description.c_str());
    const Head head(shipped(), person.dimensions, person.tissue);
    const Parts parts(head);
    expect_tissue_between_skin_and_bone(head, parts);
    expect_muscles_between_skin_and_bone(*shipped(), head, parts);
  }
}

/// Whether tissue joins the lips within two voxels of the fissure and at most `half` [m] beside the middle of the face.
bool lips_are_joined(const Model& model, double half)
{
  const double fissure = -74.1e-3, voxel = model.spacing[0];
  std::vector<std::size_t> part(model.nodes.size());
  std::iota(part.begin(), part.end(), std::size_t{ 0 });
  const auto root = [&](std::size_t n)
  {
    while (part[n] != n)
      n = part[n] = part[part[n]];
    return n;
  };
  for (const Model::Joint& joint : model.joints)
    part[root(static_cast<std::size_t>(joint.node))] = root(static_cast<std::size_t>(joint.master));
  std::vector<std::pair<std::size_t, double>> voxels;  // a node of each voxel at the lips, and the height of its centre
  for (const auto& nodes : model.voxel_nodes)
  {
    Vector3d centre = Vector3d::Zero();
    for (const std::int32_t n : nodes)
      centre += to_vector(model.to_scene(rest_position(model, static_cast<std::size_t>(n)))) / 8;
    const bool at_lips = std::abs(centre[2] - fissure) < 2.5 * voxel && std::abs(centre[1]) < half;
    if (!at_lips || centre[0] < -5e-3)
      continue;
    for (const std::int32_t n : nodes)
      part[root(static_cast<std::size_t>(n))] = root(static_cast<std::size_t>(nodes[0]));
    voxels.emplace_back(static_cast<std::size_t>(nodes[0]), centre[2]);
  }
  std::set<std::size_t> upper;
  for (const auto& [node, height] : voxels)
    if (height > fissure + 1.5 * voxel)
      upper.insert(root(node));
  return std::any_of(voxels.begin(), voxels.end(),
                     [&](const auto& v) { return v.second < fissure - 1.5 * voxel && upper.count(root(v.first)) > 0; });
}

bool bounds(const Volume& volume, const std::string& surface)
{
  std::vector<std::string> names{ volume.within };
  for (const auto* list : { &volume.closed_by, &volume.inside, &volume.outside, &volume.without, &volume.slits })
    names.insert(names.end(), list->begin(), list->end());
  return std::find(names.begin(), names.end(), surface) != names.end();
}

// They come together within half a voxel of the corners, in nodes of the voxels before that.
TEST(ShippedHead, HasItsLipsApartUpToTheCornersOfTheMouth)
{
  Scene scene = read_scene(FRONTALIS_SOURCE_DIRECTORY "/config/head.yaml");
  // Only the tissue and its slits matter here, and the rest takes most of the time.
  scene.volumes.resize(1);
  const auto is_left_out = [&](const Surface& surface)
  { return surface.name != scene.skin.surface && !bounds(scene.volumes[0], surface.name); };
  scene.surfaces.erase(std::remove_if(scene.surfaces.begin(), scene.surfaces.end(), is_left_out), scene.surfaces.end());
  scene.layers = {};
  scene.muscles = {};
  scene.constraints = {};
  scene.loads = {};
  scene.films = {};
  scene.landmarks = {};
  scene.expressions = scene.action_units = {};
  scene.demo = {};
  const double corner = Head(shipped(), {}).landmark("ch")[1];
  EXPECT_FALSE(lips_are_joined(bake(scene), corner - 3e-3));
  scene.volumes[0].slits.clear();
  EXPECT_TRUE(lips_are_joined(bake(scene), corner - 15e-3)) << "without a slit they are one";
}

TEST(RandomHeads, CanBeBaked)
{
  Scene scene = read_scene(FRONTALIS_SOURCE_DIRECTORY "/config/head.yaml");
  const std::size_t muscles = scene.muscles.size() + scene.loads.size();  // each load has an activation
  std::mt19937 random(1);
  for (int n = 0; n < number_of_heads(); ++n)
  {
    SCOPED_TRACE(n);
    const Person person(*shipped(), random);
    if (n < first_head())
      continue;
    const auto is_of = [&](Shape& shape)
    {
      shape.dimensions = person.dimensions;
      shape.tissue = person.tissue;
    };
    for (Surface& surface : scene.surfaces)
      if (surface.shape && surface.shape->head)
      {
        is_of(*surface.shape);
        surface.shape->edge = 3.5e-3;  // coarse, because a few surfaces take most of the time
      }
    for (SceneLandmark& landmark : scene.landmarks)
      if (landmark.head)
        is_of(*landmark.head);
    for (SceneJoint& joint : scene.joints)
      if (joint.head)
        is_of(*joint.head);
    try
    {
      const Model model = bake(scene);
      std::printf("head %d (%s): %zu voxels\n", n, person.description.c_str(), model.voxels.size());
      std::fflush(stdout);
      EXPECT_EQ(model.muscles.size(), muscles);
      EXPECT_GT(model.voxels.size(), 15000u);
      EXPECT_GT(model.landmarks.size(), 10u);
      const Head head(shipped(), person.dimensions, person.tissue);
      EXPECT_FALSE(lips_are_joined(model, head.landmark("ch")[1] - 4e-3));
    }
    catch (const Error& error)
    {
      ADD_FAILURE() << person.description << ": " << error.what();
    }
  }
}

}  // namespace
