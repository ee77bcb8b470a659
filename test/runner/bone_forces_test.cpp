// Newton's third law: the force of a body on tissue acts on the bone that holds the tissue.

#include "cli/bar_model.hpp"

#include "frontalis/model/sample_field.hpp"
#include "frontalis/runner/face_frame.hpp"
#include "frontalis/runner/named_controls.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace frontalis
{
namespace
{

// The bar of bar_model.hpp on the bone `base`, with a slanted finger at its free end.
Model held_bar()
{
  Model model = bar_model();
  model.bones = { "base", "finger" };
  for (RigidNode& node : model.rigid)
    node.bone = 0;
  Contact contact;
  contact.name = "touch";
  contact.bone = 1;
  contact.friction = 0.3;
  contact.field = sphere_field({ { 16.2e-3 + 0.9, 0.3, 0.2 } }, 0.9 + 0.07);
  set_points(contact, model.skin, model.skin_binding);
  model.contacts = { contact };
  return model;
}

class BoneForces : public testing::TestWithParam<std::string>
{
};

TEST_P(BoneForces, balance_those_on_a_finger)
{
  const auto model = std::make_shared<const Model>(held_bar());
  const auto solver = make_solver(model, { GetParam(), 1 });
  Controls controls = rest_controls(*model);
  controls.activation = { 0.5 };
  // the bone moves too, so that its moment is about another point than at rest
  set_bone_motion(*model, "base", { { 1, 0, 0, 0, 1, 0, 0, 0, 1 }, { 0, 0, 1.5e-3 } }, controls.bone);
  solver->advance(0.2, controls);
  const Equilibrium found = solver->settle(controls, 1e-7, 5);
  ASSERT_LT(found.residual, 1e-5);

  const std::vector<BodyFrame> bones = bones_in_face_frame(*solver, *model, true);
  ASSERT_EQ(bones.size(), 2U);
  const auto &on_base = bones[0].reaction, &on_finger = bones[1].reaction;
  const double size = std::hypot(on_finger.force[0], on_finger.force[1], on_finger.force[2]);
  EXPECT_GT(size, 1e-3);
  // the moment on a bone is about the face frame's origin as the bone carries it; the base has shifted this point
  const auto& shift = bones[0].pose.translation;
  const std::array<double, 3> carried{ { shift[1] * on_base.force[2] - shift[2] * on_base.force[1],
                                         shift[2] * on_base.force[0] - shift[0] * on_base.force[2],
                                         shift[0] * on_base.force[1] - shift[1] * on_base.force[0] } };
  constexpr double distance = 0.6;  // approximate distance of the forces from the origin of the face frame [m]
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    EXPECT_NEAR(on_base.force[axis] + on_finger.force[axis], 0, 1e-3 * size) << axis;
    EXPECT_NEAR(on_base.moment[axis] + carried[axis] + on_finger.moment[axis], 0, 1e-3 * distance * size) << axis;
  }

  const std::vector<BodyFrame> unasked = bones_in_face_frame(*solver, *model, false);
  EXPECT_EQ(unasked[0].reaction.force, (std::array<double, 3>{}));
  EXPECT_NEAR(unasked[0].pose.translation[2], 1.5e-3, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Backends, BoneForces, testing::Values("reference", "cpu"),
                         [](const auto& backend) { return backend.param; });

}  // namespace
}  // namespace frontalis
