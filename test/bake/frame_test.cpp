#include "frontalis/error.hpp"

#include "bake/scene_pieces.hpp"

#include <gtest/gtest.h>

namespace
{

using namespace frontalis;

/// An ellipsoid 1.5 m above the origin, longest along `axis`.
Scene ellipsoid_scene(std::size_t axis)
{
  Scene scene = plain_scene(1e-3);
  Vector3 size{ 6e-3, 6e-3, 6e-3 };
  size[axis] = 15e-3;
  Surface surface = box_surface("body", { 0.3, -0.2, 1.5 }, size, 0.8e-3);
  surface.shape->kind = Shape::Kind::ellipsoid;
  scene.surfaces = { surface };
  scene.volumes = { volume_inside("tissue", { "body" }, "fat", true),
                    volume_inside("core", { "body" }, "muscle", false, 1) };
  scene.muscles = { { "core", "core", { 1, 2, -3 }, 0.3e6, false, true, 1 } };
  scene.skin.surface = "body";
  scene.landmarks = { { "tip", { 0.3, -0.2, 1.5 }, 12 } };
  scene.landmarks[0].position[axis] += 15.5e-3;
  scene.gravity = { 1, 2, -9 };
  scene.frame.origin = { 0.1, 0.2, 0.3 };
  scene.frame.forward = { 0, -1, 0 };
  scene.frame.up = { 0, 0.3, 1 };
  return scene;
}

class Frame : public testing::TestWithParam<std::size_t>
{
};

TEST_P(Frame, LocalAxesArePermutedConsistently)
{
  const std::size_t axis = GetParam();
  const Scene scene = ellipsoid_scene(axis);
  const Model model = bake(scene);
  const auto& r = model.to_scene.rotation;
  // the local frame is right-handed, and rows of voxels run along the longest axis
  const double determinant =
      r[0] * (r[4] * r[8] - r[5] * r[7]) - r[1] * (r[3] * r[8] - r[5] * r[6]) + r[2] * (r[3] * r[7] - r[4] * r[6]);
  EXPECT_EQ(determinant, 1);
  EXPECT_EQ(r[3 * axis], 1);
  EXPECT_GE(model.size[0], 29);

  // skin, landmark, muscle and gravity have their values when transformed back to scene coordinates
  for (std::size_t v = 0; v < model.skin.vertices.size(); ++v)
  {
    const Vector3 p = transformed(model.to_scene, model.skin.vertices[v]);
    double sum = 0;
    for (std::size_t a = 0; a < 3; ++a)
    {
      const double radius = a == axis ? 15e-3 : 6e-3;
      const double d = p[a] - scene.surfaces[0].shape->centre[a];
      sum += d * d / (radius * radius);
    }
    EXPECT_NEAR(sum, 1, 1e-9);
  }
  const Vector3 tip = transformed(model.to_scene, model.landmark_positions.at(0));
  EXPECT_NEAR(tip[axis], scene.surfaces[0].shape->centre[axis] + 15e-3, 0.1e-3);
  RigidTransform turn = model.to_scene;
  turn.translation = { 0, 0, 0 };
  const auto& fibre = model.fibre_direction.at(0);
  const Vector3 direction = transformed(turn, { fibre[0], fibre[1], fibre[2] });
  EXPECT_NEAR(direction[0], 1 / std::sqrt(14.0), 1e-6);
  EXPECT_NEAR(direction[1], 2 / std::sqrt(14.0), 1e-6);
  EXPECT_NEAR(direction[2], -3 / std::sqrt(14.0), 1e-6);
  const Vector3 gravity = transformed(turn, model.gravity);
  EXPECT_EQ(gravity, scene.gravity);

  // the face frame: its origin, x forward, z along `up` made perpendicular to x
  const auto face_of = [&](const Vector3& scene_point)
  {
    Vector3 local{};
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t row = 0; row < 3; ++row)
        local[c] += r[3 * row + c] * (scene_point[row] - model.to_scene.translation[row]);
    return transformed(model.to_face, local);
  };
  const Vector3 origin = face_of(scene.frame.origin);
  const Vector3 forward = face_of({ 0.1, 0.2 - 1, 0.3 }), left = face_of({ 1.1, 0.2, 0.3 });
  const Vector3 up = face_of({ 0.1, 0.2, 1.3 });
  for (std::size_t a = 0; a < 3; ++a)
  {
    EXPECT_NEAR(origin[a], 0, 1e-12);
    EXPECT_NEAR(forward[a], a == 0 ? 1 : 0, 1e-12);
    EXPECT_NEAR(left[a], a == 1 ? 1 : 0, 1e-12);
    EXPECT_NEAR(up[a], a == 2 ? 1 : 0, 1e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(Axes, Frame, testing::Values(0u, 1u, 2u));

TEST(Binding, ReproducesAffineMotion)
{
  const Model model = bake(ellipsoid_scene(1));
  ASSERT_FALSE(model.skin.vertices.empty());
  const auto field = [](const Vector3& p)
  {
    return Vector3{ 0.01 + 1.1 * p[0] - 0.2 * p[1] + 0.3 * p[2], -0.02 + 0.4 * p[0] + 0.9 * p[1] - 0.1 * p[2],
                    0.05 * p[0] + 0.07 * p[1] + 1.3 * p[2] };
  };
  double farthest = 0;
  for (std::size_t v = 0; v < model.skin.vertices.size(); ++v)
  {
    const Vector3 expected = field(model.skin.vertices[v]);
    const Vector3 found = interpolated(model, model.skin_binding, v, field);
    for (std::size_t a = 0; a < 3; ++a)
    {
      EXPECT_NEAR(found[a], expected[a], 1e-9);
      const auto c = static_cast<double>(model.skin_binding.coordinates[v][a]);
      farthest = std::max({ farthest, -c, c - 1 });
    }
  }
  EXPECT_LT(farthest, 2);
  // the landmark's binding is as precise as that of the skin
  const Vector3 expected = field(model.landmark_positions[0]);
  const Vector3 found = interpolated(model, model.landmark_binding, 0, field);
  for (std::size_t a = 0; a < 3; ++a)
    EXPECT_NEAR(found[a], expected[a], 1e-9);
}

TEST(Binding, AVertexThatNoVoxelCanCarryIsAnError)
{
  Scene scene = ellipsoid_scene(0);
  scene.landmarks.clear();
  scene.volumes[0].crop.upper[0] = 0.3 + 5e-3;
  const std::string fault = fault_of(scene);
  EXPECT_NE(fault.find("a vertex that no voxel can carry"), std::string::npos) << fault;
  EXPECT_NE(fault.find("farther than 2 mm"), std::string::npos) << fault;
  scene.skin.extrapolation = 20e-3;
  EXPECT_EQ(fault_of(scene), "");
}

TEST(Binding, KeepsTheOrderOfTheSurface)
{
  Scene scene = ellipsoid_scene(0);
  scene.landmarks.clear();
  const Model whole = bake(scene);
  scene.skin.crop.upper[0] = 0.3 + 5e-3;
  scene.volumes[0].crop.upper[0] = 0.3 + 5e-3;
  const Model cut = bake(scene);
  EXPECT_LT(cut.skin.triangles.size(), whole.skin.triangles.size());
  std::size_t at = 0;
  for (const Vector3& v : cut.skin.vertices)
  {
    const Vector3 p = transformed(cut.to_scene, v);
    if (std::abs(p[0] - scene.skin.crop.upper[0]) < 1e-9)
      continue;  // the vertex is a new one on the cut
    const auto same = [&](const Vector3& w)
    {
      const Vector3 q = transformed(whole.to_scene, w);
      return std::abs(p[0] - q[0]) + std::abs(p[1] - q[1]) + std::abs(p[2] - q[2]) < 1e-9;
    };
    while (at < whole.skin.vertices.size() && !same(whole.skin.vertices[at]))
      ++at;
    ASSERT_LT(at, whole.skin.vertices.size());
  }
}

TEST(Binding, NothingToBindAndFarLandmarksAreErrors)
{
  Scene scene = ellipsoid_scene(0);
  scene.skin.crop.upper[2] = 1.0;
  EXPECT_NE(fault_of(scene).find("skin: no triangle"), std::string::npos) << fault_of(scene);
  scene = ellipsoid_scene(0);
  scene.landmarks[0].position = { 0.3, -0.2, 1.6 };
  EXPECT_NE(fault_of(scene).find("test.yaml:12: landmark 'tip'"), std::string::npos) << fault_of(scene);
  EXPECT_NE(fault_of(scene).find("20 mm"), std::string::npos) << fault_of(scene);
}

TEST(Loads, SurfacesAreCutAndBound)
{
  Scene scene = ellipsoid_scene(2);
  SceneLoad pull;
  pull.name = "pull";
  pull.surface = "body";
  pull.value = { 1, 2, 3 };
  pull.crop.lower[2] = 1.5;
  SceneLoad push = pull;
  push.name = "push";
  push.kind = SceneLoad::Kind::pressure;
  push.value = { 500, 0, 0 };
  scene.loads = { pull, push };
  const Model model = bake(scene);
  ASSERT_EQ(model.loads.size(), 2u);
  RigidTransform turn = model.to_scene;
  turn.translation = { 0, 0, 0 };
  EXPECT_EQ(transformed(turn, model.loads[0].value), pull.value);
  EXPECT_EQ(model.loads[1].value[0], 500);
  EXPECT_FALSE(model.loads[0].mesh.triangles.empty());
  for (const Vector3& v : model.loads[0].mesh.vertices)
    EXPECT_GE(transformed(model.to_scene, v)[2], 1.5 - 1e-12);
  const auto place = [](const Vector3& p) { return p; };
  for (std::size_t v = 0; v < model.loads[0].mesh.vertices.size(); ++v)
    EXPECT_NEAR(interpolated(model, model.loads[0].binding, v, place)[0], model.loads[0].mesh.vertices[v][0], 1e-9);
}

}  // namespace
