#include "bake/mesh/surface.hpp"

#include "bake/scene_pieces.hpp"
#include "files.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace
{

using namespace frontalis;

class OpenSurfaces : public testing::Test
{
protected:
  /// Writes a sphere without the triangles that have a vertex (on the unit sphere) for which `leave` is true.
  template <class Leave>
  Surface sphere_file(const std::string& name, double radius, const Leave& leave) const
  {
    TriangleMesh mesh = make_shape(*sphere_surface("", { 0, 0, 0 }, 1, 0.04).shape);
    join_vertices(mesh);
    const auto keep = [&](const Triangle& t)
    { return std::none_of(t.begin(), t.end(), [&](std::int32_t v) { return leave(mesh.vertices[v]); }); };
    write_obj(mesh, folder_ / (name + ".obj"), keep);
    return file_surface(name, folder_ / (name + ".obj"), radius);
  }

  TemporaryFolder folder_;
};

TEST_F(OpenSurfaces, AHeadOpenAtTheNeckHoldsItsTissue)
{
  Scene scene = plain_scene(1e-3);
  scene.surfaces = { sphere_file("head", 20e-3, [](const Vector3& v) { return v[2] < -0.9 || v[0] > 0.985; }) };
  scene.volumes = { volume_inside("tissue", { "head" }, "fat", true) };
  BakeReport report;
  const Model model = bake(scene, &report);
  // the opened cap is 0.7 % of the ball's volume; the bake may close the hole with an error of that order
  EXPECT_NEAR(tissue_volume(model) / (4.0 / 3 * pi * 8e-6), 1, 0.02);
  bool reported = false;
  for (const std::string& finding : report.findings)
    reported = reported || finding.find("is open") != std::string::npos;
  EXPECT_TRUE(reported);
}

TEST_F(OpenSurfaces, ABoneWithoutTissueMayBeOpen)
{
  Scene scene = plain_scene(2e-3);
  Surface bone = sphere_file("bone", 5e-3, [](const Vector3& v) { return v[2] > -0.9; });
  scene.surfaces = { sphere_surface("head", { 0, 0, 0 }, 30e-3, 3e-3), bone };
  scene.volumes = { volume_inside("tissue", { "head" }, "fat", true) };
  scene.volumes[0].within = "head";
  scene.volumes[0].depth_max = 10e-3;
  scene.volumes[0].outside = { "bone" };
  scene.skin.surface = "head";
  EXPECT_NO_THROW(bake(scene));
}

TEST_F(OpenSurfaces, HolesThatAreProbablyFaultsAreWarnedOf)
{
  const auto near = [](const Vector3& v, const Vector3& centre, double size)
  { return std::hypot(v[0] - centre[0], v[1] - centre[1], v[2] - centre[2]) < size; };
  const auto face = [&](const Vector3& v)
  {
    const bool eye = near(v, { 0.86, 0.4, 0.3 }, 0.15) || near(v, { 0.86, -0.4, 0.3 }, 0.15);
    return eye || near(v, { 0.87, 0, -0.5 }, 0.2) || v[2] < -0.9;
  };
  const auto warnings = [](const Scene& scene)
  {
    BakeReport report;
    bake(scene, &report);
    std::vector<std::string> out;
    for (const std::string& warning : report.warnings)
      if (warning.find("has a hole") != std::string::npos)
        out.push_back(warning);
    return out;
  };
  const auto whole = [](const Vector3&) { return false; };
  const auto at_the_temple = [&](const Vector3& v) { return near(v, { 0.43, 0.85, 0.3 }, 0.15); };
  Scene scene = plain_scene(6e-3);
  scene.surfaces = { sphere_file("skin", 60e-3, face), sphere_file("bone", 40e-3, whole),
                     sphere_surface("cheek_left", { 0, 30e-3, 0 }, 5e-3, 2e-3),
                     sphere_surface("cheek_right", { 0, -30e-3, 0 }, 5e-3, 2e-3) };
  scene.volumes = { volume_inside("tissue", { "skin" }, "fat", true) };
  scene.volumes[0].outside = { "bone" };
  scene.skin.surface = "skin";
  EXPECT_TRUE(warnings(scene).empty()) << "eyes, mouth and neck are open in many data";
  scene.volumes[0].crop.lower = scene.skin.crop.lower = { { -1, 10e-3, -1 } };
  EXPECT_TRUE(warnings(scene).empty()) << "the counterpart of an eye may lie outside of the tissue";
  scene.volumes[0].crop = scene.skin.crop = {};

  // This hole is as large as that of the eye beside it.
  scene.surfaces[0] = sphere_file("skin", 60e-3, [&](const Vector3& v) { return face(v) || at_the_temple(v); });
  scene.surfaces[1] = sphere_file("bone", 40e-3, [&](const Vector3& v) { return near(v, { 0.8, 0, 0.6 }, 0.25); });
  const auto told = warnings(scene);
  ASSERT_EQ(told.size(), 2u);
  EXPECT_EQ(told[0].find("surface 'bone' has a hole "), 0u) << told[0];
  EXPECT_NE(told[0].find("; tissue takes the place of what is missing there: close it"), std::string::npos) << told[0];
  EXPECT_EQ(told[1].find("surface 'skin' has a hole "), 0u) << told[1];
  EXPECT_NE(told[1].find(", on one side of the face alone; close it, if skin is missing there"), std::string::npos)
      << told[1];
}

TEST_F(OpenSurfaces, GapsBetweenTwoBonesLetNothingThrough)
{
  Scene scene = plain_scene(1e-3);
  // two halves of a skull with a gap of 0.5 mm: the space between them must not become tissue
  scene.surfaces = { sphere_surface("skin", { 0, 0, 0 }, 20e-3, 0.8e-3),
                     sphere_file("upper", 14e-3, [](const Vector3& v) { return v[2] < 0.03; }),
                     sphere_file("lower", 14e-3, [](const Vector3& v) { return v[2] > -0.03; }) };
  Volume tissue = volume_inside("tissue", { "skin" }, "fat", true);
  scene.volumes = { tissue, volume_inside("bone", {}, "muscle", false, 1) };
  scene.volumes[1].closed_by = { "upper", "lower" };
  const Model model = bake(scene);
  EXPECT_NEAR(tissue_volume(model, "muscle") / (4.0 / 3 * pi * 2.744e-6), 1, 0.02);
  EXPECT_NEAR(tissue_volume(model, "fat") / (4.0 / 3 * pi * (8e-6 - 2.744e-6)), 1, 0.02);
}

TEST_F(OpenSurfaces, DepthsEndAtTheBone)
{
  // a hollow bone: one closed mesh of an outer sheet and an inner one that faces the cavity
  TriangleMesh shell = make_shape(*sphere_surface("", { 0, 0, 0 }, 15, 0.8).shape);
  TriangleMesh inner = make_shape(*sphere_surface("", { 0, 0, 0 }, 13, 0.8).shape);
  flip(inner);
  append(shell, inner);
  write_obj(shell, folder_ / "bone.obj", [](const Triangle&) { return true; });

  Scene scene = plain_scene(1e-3);
  scene.surfaces = { sphere_surface("skin", { 0, 0, 0 }, 20e-3, 0.8e-3),
                     file_surface("bone", folder_ / "bone.obj", 1e-3) };
  scene.volumes = { volume_inside("tissue", { "skin" }, "fat", true) };
  scene.volumes[0].outside = { "bone" };
  const auto ball = [](double r) { return 4.0 / 3 * pi * r * r * r; };
  // without a depth, everything inside the skin and outside the bone is tissue, including the cavity
  EXPECT_NEAR(tissue_volume(bake(scene)) / (ball(20e-3) - ball(15e-3) + ball(13e-3)), 1, 0.01);
  // with a depth, tissue is not behind the bone, although the cavity from 10 to 13 mm is near enough to the skin
  scene.volumes[0].within = "skin";
  scene.volumes[0].depth_max = 10e-3;
  EXPECT_NEAR(tissue_volume(bake(scene)) / (ball(20e-3) - ball(15e-3)), 1, 0.01);
}

TEST_F(OpenSurfaces, AnOpeningHidesNothing)
{
  // a slot in the upper side of a block: an opening (`without`) does not hide the tissue below it
  Scene scene = plain_scene(1e-3);
  scene.surfaces = { box_surface("block", { 0, 0, 0 }, { 20e-3, 20e-3, 20e-3 }),
                     box_surface("slot", { 0, 0, 10e-3 }, { 10e-3, 10e-3, 4e-3 }) };
  scene.volumes = { volume_inside("tissue", { "block" }, "fat", true) };
  scene.volumes[0].within = "block";
  scene.volumes[0].depth_max = 5e-3;
  const double shell = 8e-6 - 1e-6, slot = 10e-3 * 10e-3 * 2e-3;
  scene.volumes[0].without = { "slot" };
  EXPECT_NEAR(tissue_volume(bake(scene)) / (shell - slot), 1, 0.01);
  // a bone (`outside`) hides the tissue behind it, which is left out too
  scene.volumes[0].without.clear();
  scene.volumes[0].outside = { "slot" };
  EXPECT_NEAR(tissue_volume(bake(scene)) / (shell - 2.5 * slot), 1, 0.01);
}

}  // namespace
