// Newton's third law: the force of a body on tissue also acts on the bone that carries the tissue, in whichever way the
// bone carries it.

#include "cli/bar_model.hpp"

#include "frontalis/model/sample_field.hpp"
#include "frontalis/runner/face_frame.hpp"
#include "frontalis/runner/named_controls.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>

namespace frontalis
{
namespace
{

// How the bone `base` carries the bar.
enum class Hold
{
  rigid,     // it holds the nodes of one end
  many,      // the same; nodes of the underside slide on it with friction, and a body of it touches the free end
  attached,  // it holds the same end at a boundary between nodes
  guided     // the same as `many`, but the underside is at a boundary between nodes, without friction and body
};

std::string name_of(Hold hold)
{
  return hold == Hold::rigid ? "rigid" : hold == Hold::many ? "many" : hold == Hold::attached ? "attached" : "guided";
}

// The bar of bar_model.hpp on the bone `base`, with a slanted finger at its free end.
Model held_bar(Hold hold)
{
  Model model = bar_model();
  model.bones = { "base", "finger" };
  for (RigidNode& node : model.rigid)
    node.bone = 0;
  const auto node_at = [&](std::int32_t i, std::int32_t j, std::int32_t k)
  {
    const auto found = std::find(model.nodes.begin(), model.nodes.end(), std::array<std::int32_t, 3>{ { i, j, k } });
    return static_cast<std::int32_t>(found - model.nodes.begin());
  };
  if (hold == Hold::attached)
    for (const RigidNode& node : std::exchange(model.rigid, {}))
    {
      const auto& [i, j, k] = model.nodes[static_cast<std::size_t>(node.node)];
      // the boundary is a quarter of an edge from the end
      model.attached.push_back({ node.node, node_at(i + 1, j, k), -1.0 / 3, 0, -1, -1 });
    }
  std::vector<std::int32_t> underside;
  for (std::int32_t i = 3; i < 6; ++i)
    for (std::int32_t k = 0; k < 3; ++k)
      underside.push_back(node_at(i, 0, k));
  // a floor below the middle of the bar, at the level -1 mm, or through the lowest quarter of its voxels
  const double level = hold == Hold::guided ? 0.5e-3 : -1e-3;
  const auto floor = [&](const std::array<double, 3>& p) { return SurfaceDistance(p[1] - level); };
  if (hold == Hold::many || hold == Hold::guided)
  {
    slide_on(model, "floor", floor, underside);
    model.constraint_surfaces[0].bone = 0;
  }
  if (hold == Hold::guided)
    for (const SlidingNode& node : std::exchange(model.sliding, {}))
    {
      const auto& [i, j, k] = model.nodes[static_cast<std::size_t>(node.node)];
      model.attached.push_back({ node.node, node_at(i, j + 1, k), -1.0 / 3, -1, 0, -1 });
    }
  Contact contact;
  contact.name = "touch";
  contact.bone = 1;
  contact.friction = 0.3;
  contact.field = sphere_field({ { 16.2e-3 + 0.9, 0.3, 0.2 } }, 0.9 + 0.07);
  set_points(contact, model.skin, model.skin_binding);
  model.contacts = { contact };
  if (hold == Hold::many)
  {
    model.constraint_surfaces[0].friction = 0.2;
    contact.name = "stop";
    contact.bone = 0;
    contact.field = sphere_field({ { 13.5e-3 + 0.05, 3e-3, 2e-3 } }, 0.05);
    set_points(contact, model.skin, model.skin_binding);
    model.contacts.push_back(contact);
  }
  return model;
}

class BoneForces : public testing::TestWithParam<std::tuple<std::string, Hold>>
{
};

TEST_P(BoneForces, balance_those_on_a_finger)
{
  const auto [backend, hold] = GetParam();
  const auto model = std::make_shared<const Model>(held_bar(hold));
  const auto solver = make_solver(model, { backend, 1 });
  Controls controls = rest_controls(*model);
  controls.activation = { 0.5 };
  // The bone moves too, so that the reference point of its moment is not where it was at rest.
  set_bone_motion(*model, "base", { { 1, 0, 0, 0, 1, 0, 0, 0, 1 }, { 0, 0, 1.5e-3 } }, controls.bone);
  solver->advance(0.2, controls);
  const Equilibrium found = solver->settle(controls, 1e-7, 5);
  ASSERT_LT(found.residual, 1e-5);

  const std::vector<BodyFrame> bones = bones_in_face_frame(*solver, *model, true);
  ASSERT_EQ(bones.size(), 2U);
  const auto &on_base = bones[0].reaction, &on_finger = bones[1].reaction;
  const double size = std::hypot(on_finger.force[0], on_finger.force[1], on_finger.force[2]);
  EXPECT_GT(size, 1e-3);
  // The moment on a bone is about the point of the bone that rests at the face frame's origin. The base has shifted
  // this point.
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

  // Each part of the bone that carries the bar contributes a force larger than the error of the sums.
  const std::vector<BodyFrame> bodies = bodies_in_face_frame(*solver, *model);
  if (hold == Hold::many)
  {
    EXPECT_GT(std::abs(bodies[1].reaction.force[2]), 0.01 * size);
  }
  const auto without = [&](auto Model::*part)
  {
    Model less = *model;
    (less.*part).clear();
    const auto force = bones_in_face_frame(*solver, less, true)[0].reaction.force;
    return std::hypot(force[0] - on_base.force[0], force[1] - on_base.force[1], force[2] - on_base.force[2]);
  };
  EXPECT_EQ(hold == Hold::attached, model->rigid.empty());
  if (hold != Hold::attached)
  {
    EXPECT_GT(without(&Model::rigid), 0.01 * size);
  }
  if (hold == Hold::many)
  {
    EXPECT_GT(without(&Model::sliding), 0.01 * size);
  }
  if (hold == Hold::attached || hold == Hold::guided)
  {
    EXPECT_GT(without(&Model::attached), 0.01 * size);
  }

  // Where the field of a surface has no normal, the bone carries the whole force. In equilibrium there is no other
  // part.
  if (hold == Hold::many || hold == Hold::guided)
  {
    Model blind = *model;
    blind.constraint_surfaces[0].field.origin = { { 1, 1, 1 } };
    const auto force = bones_in_face_frame(*solver, blind, true)[0].reaction.force;
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(force[axis], on_base.force[axis], 1e-3 * size) << axis;
  }

  const std::vector<BodyFrame> unasked = bones_in_face_frame(*solver, *model, false);
  EXPECT_EQ(unasked[0].reaction.force, (std::array<double, 3>{}));
  EXPECT_NEAR(unasked[0].pose.translation[2], 1.5e-3, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Backends, BoneForces,
                         testing::Combine(testing::Values("reference", "cpu"),
                                          testing::Values(Hold::rigid, Hold::many, Hold::attached, Hold::guided)),
                         [](const auto& of) { return std::get<0>(of.param) + "_" + name_of(std::get<1>(of.param)); });

}  // namespace
}  // namespace frontalis
