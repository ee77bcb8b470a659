// Muscles that are weak everywhere, or in a region.

#include "frontalis/error.hpp"

#include "bake/scene_pieces.hpp"

#include <gtest/gtest.h>

namespace frontalis
{
namespace
{

/// A muscle that fills a block of 20 x 4 x 4 mm with a corner at the origin, in voxels of 1 mm.
Scene block_of_muscle(bool passive)
{
  Scene scene = plain_scene(1e-3);
  scene.surfaces = { box_surface("block", { 10e-3, 2e-3, 2e-3 }, { 20e-3, 4e-3, 4e-3 }) };
  scene.volumes = { volume_inside("tissue", { "block" }, "muscle", true) };
  scene.skin.surface = "block";
  SceneMuscle muscle;
  muscle.name = "pull";
  muscle.volume = "tissue";
  muscle.fibre = { 1, 0, 0 };
  muscle.passive = passive;
  scene.muscles = { muscle };
  return scene;
}

TEST(Weakness, of_a_whole_muscle_leaves_its_passive_part)
{
  Scene scene = block_of_muscle(true);
  const Model healthy = bake(scene);
  ASSERT_EQ(healthy.muscles.size(), 1u);
  const double whole = muscle_volume(healthy, 0);
  scene.weakness = { { { "pull" }, 0.25 } };
  BakeReport report;
  const Model weak = bake(scene, &report);
  ASSERT_EQ(report.forces.size(), 1u);
  EXPECT_NEAR(report.forces[0].left, 0.25, 1e-6);
  ASSERT_EQ(weak.muscles.size(), 2u);
  EXPECT_EQ(weak.muscles[1].name, "pull_passive");
  EXPECT_TRUE(weak.muscles[1].passive);
  EXPECT_NEAR(muscle_volume(weak, 0), 0.25 * whole, 1e-6 * whole);
  EXPECT_NEAR(muscle_volume(weak, 1), 0.75 * whole, 1e-6 * whole);
  // a weakness of another muscle changes nothing
  scene.weakness = { { { "other" }, 0.25 } };
  const Model other = bake(scene);
  EXPECT_EQ(other.muscles.size(), 1u);
  EXPECT_EQ(other.fibre_weight, healthy.fibre_weight);
  EXPECT_EQ(other.fibre_begin, healthy.fibre_begin);
  EXPECT_EQ(other.fibre_direction, healthy.fibre_direction);
}

TEST(Weakness, of_a_place_is_accepted_without_contraction)
{
  Scene scene = block_of_muscle(false);
  scene.weakness = { { {}, 0.5, { 0, 2e-3, 2e-3 }, 8e-3, false } };
  scene.switched_off = EffectSet().with(Effect::contraction);
  EXPECT_TRUE(bake(scene).fibre_weight.empty());
}

TEST(Weakness, of_a_passive_muscle_needs_a_name_for_its_passive_part)
{
  Scene scene = block_of_muscle(true);
  scene.muscles.push_back(scene.muscles[0]);
  scene.muscles[1].name = "pull_passive";
  scene.muscles[1].passive = false;
  scene.muscles[1].volume = "other";
  scene.volumes.push_back(volume_inside("other", { "block" }, "muscle", false));
  scene.weakness = { { { "pull" }, 0.5 } };
  try
  {
    bake(scene);
    FAIL() << "two muscles have one name";
  }
  catch (const Error& error)
  {
    EXPECT_NE(std::string(error.what()).find("rename that muscle"), std::string::npos) << error.what();
  }
}

TEST(Weakness, of_a_sphere_ends_at_its_radius_and_that_of_a_dose_fades)
{
  Scene scene = block_of_muscle(false);
  scene.weakness = { { {}, 0.5, { 0, 2e-3, 2e-3 }, 8e-3, false } };
  for (const bool dose : { false, true })
  {
    scene.weakness[0].dose = dose;
    const Model model = bake(scene);
    ASSERT_EQ(model.muscles.size(), 1u);
    for (std::size_t e = 0; e < model.voxels.size(); ++e)
    {
      const auto& v = model.voxels[e];
      Vector3 p{};
      for (std::size_t axis = 0; axis < 3; ++axis)
        p[axis] = (v[axis] + 0.5) * model.spacing[axis];
      p = transformed(model.to_scene, p);
      const double squared = (p[0] * p[0] + std::pow(p[1] - 2e-3, 2) + std::pow(p[2] - 2e-3, 2)) / 64e-6;
      const double kept = dose ? 1 - 0.5 * std::exp(-squared) : squared <= 1 ? 0.5 : 1;
      EXPECT_NEAR(model.fibre_weight[model.fibre_begin[e]], kept, 1e-6) << p[0];
    }
  }
}

TEST(Weakness, of_all_muscles_leaves_the_tension_of_skin)
{
  Scene scene = block_of_muscle(false);
  scene.weakness = { { {}, 0, { 10e-3, 2e-3, 2e-3 }, 5e-3, false } };
  scene.muscles.push_back(scene.muscles[0]);
  scene.muscles[1].name = scene.muscles[1].volume = "tension";
  scene.muscles[1].of_rest = true;
  scene.volumes.push_back(volume_inside("tension", { "block" }, "muscle", false));
  const Model model = bake(scene);
  EXPECT_LT(muscle_volume(model, 0), 0.95 * muscle_volume(model, 1));
}

TEST(Weakness, without_any_strength_left_there_are_no_fibres)
{
  Scene scene = block_of_muscle(false);
  scene.weakness = { { {}, 0, { 0, 2e-3, 2e-3 }, 8.5e-3, false } };
  const Model model = bake(scene);
  EXPECT_LT(model.fibre_muscle.size(), model.voxels.size());
  EXPECT_GT(model.fibre_muscle.size(), model.voxels.size() / 2);
}

TEST(Weakness, that_weakens_nothing_is_refused)
{
  Scene scene = block_of_muscle(false);
  scene.weakness = { { {}, 0, { 0, 2e-3, 50e-3 }, 8e-3, false } };
  EXPECT_THROW(bake(scene), Error);
  scene.weakness = { { { "other" }, 0, { 0, 2e-3, 2e-3 }, 8e-3, false } };
  EXPECT_THROW(bake(scene), Error);
}

}  // namespace
}  // namespace frontalis
