// The frame after a step or a reset of a runner has the fine lines of its own skin, because the face may stand still
// afterwards.

#include "frontalis/runner/runner.hpp"

#include "block_model.hpp"
#include "film_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace frontalis;

namespace
{

// a slab, fixed at x = 0, with a muscle along x; on one side is a skin with a film that folds when the muscle pulls
Model slab_with_film()
{
  constexpr double edge = 4e-3;
  test::BlockSettings s;
  s.voxels = { { 6, 6, 1 } };
  s.spacing = { { edge, edge, edge } };
  s.damping = 500;
  Model model = test::block_model(s);
  Muscle muscle;
  muscle.name = "puller";
  test::add_muscle(model, { { 1, 0, 0 } }, muscle);
  test::hold_plane(model, 0, 0);
  model.bones = { "jaw" };
  const Model sheet = test::film_model(100);
  model.film = sheet.film;
  model.skin = sheet.skin;
  for (const auto& p : model.skin.vertices)
  {
    const double x = std::floor(p[0] / edge), y = std::floor(p[1] / edge);
    model.skin_binding.voxel.push_back(static_cast<std::int32_t>(6 * y + x));
    model.skin_binding.coordinates.push_back(
        { { static_cast<float>(p[0] / edge - x), static_cast<float>(p[1] / edge - y), 0 } });
  }
  return model;
}

}  // namespace

TEST(RunnerFineLines, FramesOfStepsAndResetsHaveTheFineLinesOfTheirSkin)
{
  const auto highest = [](const std::vector<float>& height)
  { return height.empty() ? -1 : *std::max_element(height.begin(), height.end()); };
  Model model = slab_with_film();
  for (const Pace pace : { Pace::lock_step, Pace::real_time })
  {
    RunnerSettings wanted{ { "cpu", 1, 0 }, pace, 100 };
    wanted.wanted_field = [] { return SkinField::lines; };
    float latest = 0;  // written by the runner's thread, before step() and reset() return
    Runner runner(std::make_shared<const Model>(model), wanted,
                  [&](const Frame& frame) { latest = highest(frame.skin.line_height); });
    runner.pause(true);
    runner.set_activation({ { "puller", 0.8 } });
    const Frame frame = runner.step(0.1);
    EXPECT_GT(highest(frame.skin.line_height), 0.2 * test::film_thickness);
    EXPECT_EQ(frame.field, frame.skin.line_height);
    runner.reset();
    EXPECT_EQ(latest, 0);
  }
  model.film = SkinFilm();
  Runner plain(std::make_shared<const Model>(model), { { "cpu", 1, 0 }, Pace::lock_step, 100 }, {});
  EXPECT_TRUE(plain.step(0.01).skin.line_height.empty());
}
