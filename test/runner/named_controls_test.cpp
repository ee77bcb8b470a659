// Expressions and action units as activations of muscles and motions of bones.

#include "frontalis/runner/named_controls.hpp"

#include "frontalis/error.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace frontalis
{
namespace
{

constexpr double pi = 3.14159265358979323846;

Model face()
{
  Model model;
  for (const char* name : { "zygomaticus_left", "zygomaticus_right", "procerus", "levator" })
    model.muscles.push_back({ name });
  model.muscles[3].tone = 0.5;
  model.bones = { "mandible", "finger" };
  model.to_face.rotation = { { 0, 1, 0, 0, 0, 1, 1, 0, 0 } };
  model.to_face.translation = { { 0, 0, 0.1 } };
  const Model::BonePose opened{ 0, { { 0, 0, -2e-3 } }, { { 0, pi / 6, 0 } }, { { -80e-3, 0, -50e-3 } } };
  model.expressions = { { "smile", { { 0, 0.75f }, { 1, 0.75f }, { 2, 0.5f } }, {} }, { "gape", {}, { opened } } };
  model.action_units = { { "AU12", { { 0, 1 }, { 1, 1 } }, {} },
                         { "AU43", { { 3, -1 } }, {} },
                         { "AU5", { { 3, 1 } }, {} },
                         { "AU26", {}, { opened } } };
  return model;
}

TEST(NamedControls, tones_are_kept_raised_and_lowered)
{
  const Model model = face();
  EXPECT_EQ(rest_controls(model).activation, (std::vector<float>{ 0, 0, 0, 0.5f }));
  EXPECT_EQ(expression_controls(model, "relax").activation, (std::vector<float>{ 0, 0, 0, 0.5f }));
  EXPECT_EQ(expression_controls(model, "smile").activation, (std::vector<float>{ 0.75f, 0.75f, 0.5f, 0.5f }));
  EXPECT_EQ(action_unit_controls(model, { { "AU43", 0.25 } }).activation[3], 0.25f);
  EXPECT_EQ(action_unit_controls(model, { { "AU43", 1 } }).activation[3], 0);
  EXPECT_EQ(action_unit_controls(model, { { "AU5", 1 } }).activation[3], 1);
}

TEST(NamedControls, one_side_moves_alone_with_half_of_the_middle)
{
  const Model model = face();
  EXPECT_EQ(expression_controls(model, "smile_left").activation, (std::vector<float>{ 0.75f, 0, 0.25f, 0.5f }));
  EXPECT_EQ(expression_controls(model, "smile_right").activation, (std::vector<float>{ 0, 0.75f, 0.25f, 0.5f }));
  EXPECT_EQ(action_unit_controls(model, { { "AU12C_left", 1 } }).activation,
            action_unit_controls(model, { { "AU12_left", 0.6 } }).activation);
  EXPECT_EQ(action_unit_controls(model, { { "AU5E", 0.5 } }).activation[3],
            action_unit_controls(model, { { "AU5", 0.5 } }).activation[3]);
  EXPECT_THROW(action_unit_controls(model, { { "AU12F", 1 } }), Error);
  EXPECT_EQ(action_unit_controls(model, { { "AU12_left", 0.5 } }).activation, (std::vector<float>{ 0.5f, 0, 0, 0.5f }));
  EXPECT_EQ(action_unit_controls(model, { { "AU12_left", 0.5 }, { "AU12", 0.25 } }).activation,
            (std::vector<float>{ 0.75f, 0.25f, 0, 0.5f }));
}

TEST(NamedControls, bones_turn_about_their_centres)
{
  const Model model = face();
  for (const double share : { 0.5, 1.0 })
  {
    const RigidTransform motion = motion_in_face(model, action_unit_controls(model, { { "AU26", share } }).bone[0]);
    const auto centre = motion(std::array<double, 3>{ { -80e-3, 0, -50e-3 } });
    EXPECT_NEAR(centre[0], -80e-3, 1e-12);
    EXPECT_NEAR(centre[2], -50e-3 - share * 2e-3, 1e-12);
    // a point 100 mm in front of the centre goes down
    const auto chin = motion(std::array<double, 3>{ { 20e-3, 0, -50e-3 } });
    EXPECT_NEAR(chin[0], -80e-3 + 0.1 * std::cos(share * pi / 6), 1e-12);
    EXPECT_NEAR(chin[2], -50e-3 - share * 2e-3 - 0.1 * std::sin(share * pi / 6), 1e-12);
  }
}

TEST(NamedControls, an_expression_leaves_bones_alone_that_none_moves)
{
  const Model model = face();
  Controls controls = rest_controls(model);
  RigidTransform moved;
  moved.translation = { { 1e-3, 0, 0 } };
  set_bone_motion(model, "finger", moved, controls.bone);
  take_pose(model, expression_controls(model, "gape"), controls);
  EXPECT_NE(controls.bone[0].rotation, RigidTransform().rotation);
  EXPECT_NE(controls.bone[1].translation, RigidTransform().translation);
  take_pose(model, expression_controls(model, "smile"), controls);
  EXPECT_EQ(controls.bone[0].rotation, RigidTransform().rotation);
  EXPECT_NE(controls.bone[1].translation, RigidTransform().translation);
}

TEST(NamedControls, wrong_ones_are_told_with_those_that_exist)
{
  const Model model = face();
  const auto told = [](const auto& call) -> std::string
  {
    try
    {
      call();
    }
    catch (const Error& error)
    {
      return error.what();
    }
    return {};
  };
  EXPECT_NE(told([&] { expression_controls(model, "grin"); }).find("'grin'; there is relax, smile, gape"),
            std::string::npos);
  EXPECT_NE(told(
                [&] {
                  action_unit_controls(model, { { "AU99", 1 } });
                })
                .find("AU12, AU43, AU5, AU26"),
            std::string::npos);
  EXPECT_NE(told(
                [&] {
                  action_unit_controls(model, { { "AU12", 1.5 } });
                })
                .find("must be from 0 to 1"),
            std::string::npos);
  EXPECT_EQ(told(
                [&] {
                  action_unit_controls(model, { { "AU13", 1 } });
                })
                .find("did you mean"),
            std::string::npos)
      << "units that differ by a digit have nothing in common";
  EXPECT_NE(told([&] { expression_controls(model, "relaxx"); }).find("(did you mean 'relax'?)"), std::string::npos);
  std::vector<RigidTransform> bones = rest_controls(model).bone;
  EXPECT_NE(told([&] { set_bone_motion(model, "Finger", {}, bones); }).find("(did you mean 'finger'?)"),
            std::string::npos);
  EXPECT_NE(told([&] { expression_controls(model, "Smile"); }).find("(did you mean 'smile'?)"), std::string::npos);
  std::vector<float> activation = rest_controls(model).activation;
  EXPECT_NE(told(
                [&] {
                  set_activations(model, { { "zygomaticus", 1 } }, activation);
                })
                .find("(did you mean 'zygomaticus_left' or 'zygomaticus_right'?)"),
            std::string::npos);
}

}  // namespace
}  // namespace frontalis
