// What a scene with a generated head places by coordinates goes with the head when its dimensions are changed.

#include "bake/shapes/head/follow_head.hpp"
#include "bake/shapes/head/head.hpp"

#include "frontalis/scene/read_scene.hpp"

#include "bake/scene_pieces.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace
{

using namespace frontalis;

Scene shipped_scene() { return read_scene(FRONTALIS_SOURCE_DIRECTORY "/config/head.yaml"); }

std::shared_ptr<const HeadTemplate> shipped()
{
  static const auto head = read_head_template(FRONTALIS_SOURCE_DIRECTORY "/config/head/head.yaml");
  return head;
}

/// Gives the scene's head a longer face and a wider mouth. Returns this head.
std::unique_ptr<const Head> lengthen_face(Scene& scene)
{
  const std::map<std::string, double> dimensions{ { "sn_gn", 0.079 }, { "n_sn", 0.06 }, { "ch_ch", 0.058 } };
  for (Surface& surface : scene.surfaces)
    if (surface.shape && surface.shape->head)
      surface.shape->dimensions = dimensions;
  return std::make_unique<const Head>(shipped(), dimensions);
}

TEST(FollowHead, MovesThePlacesOfTheShippedScene)
{
  Scene scene = shipped_scene();
  EXPECT_EQ(following_head(scene).constraints[0].crop.lower, scene.constraints[0].crop.lower);
  const auto named = [](const auto& list, const std::string& name) -> const auto&
  {
    const auto found = std::find_if(list.begin(), list.end(), [&](const auto& entry) { return entry.name == name; });
    if (found == list.end())
      throw std::runtime_error("the scene has no " + name);
    return *found;
  };
  SceneConstraint below = named(scene.constraints, "face");
  below.name = "below";
  below.crop = Region();
  below.crop.upper[2] = named(scene.constraints, "face").crop.lower[2];
  scene.constraints.push_back(below);
  const auto changed = lengthen_face(scene);
  const Head& head = *changed;
  const Scene moved = following_head(scene);
  // the origin of the face frame stays at the sellion
  EXPECT_LT((to_vector(moved.frame.origin) - head.landmark("n")).norm(), 2e-3);
  EXPECT_GT(moved.frame.origin[2], 5e-3);
  EXPECT_LT((to_vector(named(moved.landmarks, "mouth_corner_left").position) - head.landmark("ch")).norm(), 2e-3);
  const Region &before = named(scene.constraints, "lateral_orbit_left").crop,
               &crop = named(moved.constraints, "lateral_orbit_left").crop;
  const Vector3d middle = (to_vector(before.lower) + to_vector(before.upper)) / 2;
  EXPECT_LT(((to_vector(crop.lower) + to_vector(crop.upper)) / 2 - head.moved(middle)).norm(), 1e-9);
  // each side of a region without end goes along with the face beside it: the fornix of the vestibule as the upper jaw,
  // although the middle of what lies above it is in the forehead, and of what lies below it in the chin
  const auto fornix = [&](const Scene& of, const char* name, bool lower)
  { return lower ? named(of.constraints, name).crop.lower[2] : named(of.constraints, name).crop.upper[2]; };
  const double way = head.moved({ 0, 0, -57.5e-3 })[2] + 57.5e-3;
  ASSERT_GT(std::abs(way - (head.landmark("gn") - Head(shipped(), {}).landmark("gn"))[2]), 4e-3);
  EXPECT_NEAR(fornix(moved, "face", true) - fornix(scene, "face", true), way, 2e-3);
  EXPECT_NEAR(fornix(moved, "below", false) - fornix(scene, "below", false), way, 2e-3);
  EXPECT_EQ(named(moved.volumes, "tissue").depth_max, named(scene.volumes, "tissue").depth_max);
  // below more tissue it follows the bone inwards
  for (Surface& surface : scene.surfaces)
    if (surface.shape && surface.shape->head)
      surface.shape->tissue = 1.2;
  const Scene full = following_head(scene);
  EXPECT_NEAR(named(full.volumes, "tissue").depth_max, 1.2 * named(scene.volumes, "tissue").depth_max, 1e-12);
  const Region deeper = named(full.constraints, "lateral_orbit_left").crop;
  EXPECT_NEAR(crop.lower[1] - deeper.lower[1], 1.9e-3, 0.8e-3);
  // the fissure of the mouth and the planes of the grid keep their heights, and there is room below the longer chin
  EXPECT_NEAR(head.landmark("sto")[2], Head(shipped(), {}).landmark("sto")[2], 1e-9);
  const Region &tissue = named(moved.volumes, "tissue").crop, &shipped_tissue = named(scene.volumes, "tissue").crop;
  EXPECT_NEAR(std::remainder(tissue.lower[2] - shipped_tissue.lower[2], 6e-3), 0, 1e-9);
  EXPECT_LT(tissue.lower[2], head.landmark("gn")[2] - 8e-3);
  EXPECT_EQ(tissue.lower[2], moved.skin.crop.lower[2]);
  const Shape& cut = *named(moved.surfaces, "cut").shape;
  EXPECT_NEAR(cut.centre[2] - cut.size[2] / 2, tissue.lower[2], 1e-12);
}

TEST(FollowHead, MovesPointsOfMusclesAndShapesAndTheFilm)
{
  Scene scene = shipped_scene();
  const auto head = lengthen_face(scene);
  const Vector3 chin{ 8e-3, 0, -104.5e-3 }, to = to_array(head->moved(to_vector(chin)));
  ASSERT_LT(to[2], chin[2] - 5e-3);
  SceneMuscle& muscle = scene.muscles[0];
  muscle.origin.points = muscle.insertion.points = { { 0, 0, 0 }, chin };
  muscle.net = ControlNet{ { 2, 2, 2 }, false, { { 0, 0, 0 }, chin }, {} };
  Surface ball = sphere_surface("ball", chin, 1e-3), sheet = ball;
  sheet.shape->kind = Shape::Kind::muscle;
  sheet.shape->curves = { { { 0, 0, 0 }, chin } };
  sheet.shape->depths = { { chin, 1e-3 } };
  scene.surfaces.push_back(ball);
  scene.surfaces.push_back(sheet);
  scene.films.emplace_back();
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    scene.films[0].crop.lower[axis] = chin[axis] - 7e-3;
    scene.films[0].crop.upper[axis] = chin[axis] + 7e-3;
  }
  const Scene moved = following_head(scene);
  EXPECT_EQ(moved.muscles[0].origin.points[1], to);
  EXPECT_EQ(moved.muscles[0].insertion.points[1], to);
  EXPECT_EQ(moved.muscles[0].net->points[1], to);
  EXPECT_EQ(moved.surfaces.rbegin()[1].shape->centre, to);
  EXPECT_EQ(moved.surfaces.back().shape->curves[0][1], to);
  EXPECT_EQ(moved.surfaces.back().shape->depths[0].at, to);
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    EXPECT_NEAR(moved.films[0].crop.lower[axis], to[axis] - 7e-3, 1e-12);
    EXPECT_NEAR(moved.films[0].crop.upper[axis], to[axis] + 7e-3, 1e-12);
  }
}

TEST(FollowHead, KeepsTheSizeOfSmallBoxes)
{
  Scene scene = shipped_scene();
  const auto head = lengthen_face(scene);
  const std::size_t first = scene.surfaces.size();
  constexpr double height = 12e-3;
  for (double z = -120e-3; z < 60e-3; z += 1e-3)
    scene.surfaces.push_back(box_surface("box", { 0, 0, z }, { 40e-3, 40e-3, height }));
  const Scene moved = following_head(scene);
  double farthest = 0;
  int sides_apart = 0;  // boxes whose sides would go different ways, each by itself
  for (std::size_t b = first; b < scene.surfaces.size(); ++b)
  {
    const Shape &box = *scene.surfaces[b].shape, &now = *moved.surfaces[b].shape;
    EXPECT_NEAR(now.size[2], height, 1e-12);
    const double way = now.centre[2] - box.centre[2];
    EXPECT_NEAR(std::remainder(way, 6e-3), 0, 1e-12);
    const auto steps = [&](double z) { return std::round((head->moved({ 0, 0, z })[2] - z) / 6e-3); };
    sides_apart += steps(box.centre[2] - height / 2) != steps(box.centre[2] + height / 2) ? 1 : 0;
    farthest = std::max(farthest, std::abs(way));
  }
  EXPECT_GE(farthest, 6e-3 - 1e-12);
  EXPECT_GT(sides_apart, 0);
}

}  // namespace
