#include "bake/mesh/surface.hpp"

#include "frontalis/error.hpp"

#include "bake/scene_pieces.hpp"

#include <gtest/gtest.h>

namespace
{

using namespace frontalis;

TEST(Voxelise, SphereHasItsVolume)
{
  Scene scene = plain_scene(1e-3);
  scene.surfaces = { sphere_surface("ball", { 0.1, 0.2, 1.5 }, 10e-3, 0.5e-3) };
  scene.volumes = { volume_inside("tissue", { "ball" }, "fat", true) };
  const Model model = bake(scene);
  EXPECT_NEAR(tissue_volume(model) / (4.0 / 3 * pi * 1e-6), 1, 0.01);
  // with the default fill_min, dropping nearly empty voxels costs little volume
  scene.accuracy.fill_min = 0.2;
  EXPECT_NEAR(tissue_volume(bake(scene)) / (4.0 / 3 * pi * 1e-6), 1, 0.01);
}

TEST(Voxelise, CrossingBoxesShareByPriority)
{
  Scene scene = plain_scene(1e-3);
  // two bars cross in a block; no side of block or bars lies on voxel faces
  scene.surfaces = { box_surface("block", { 0, 0, 0 }, { 30e-3, 30e-3, 30e-3 }),
                     box_surface("bar_x", { 0.13e-3, 0.21e-3, 0.37e-3 }, { 20.3e-3, 6.7e-3, 6.1e-3 }),
                     box_surface("bar_y", { 0.41e-3, 0.29e-3, 0.17e-3 }, { 6.3e-3, 18.9e-3, 7.7e-3 }) };
  scene.volumes = { volume_inside("tissue", { "block" }, "fat", true),
                    volume_inside("x", { "bar_x" }, "dermis", false, 1),
                    volume_inside("y", { "bar_y" }, "muscle", false, 1) };
  const double x = 20.3e-3 * 6.7e-3 * 6.1e-3, y = 6.3e-3 * 18.9e-3 * 7.7e-3;
  const double low = std::max(0.37e-3 - 3.05e-3, 0.17e-3 - 3.85e-3),
               high = std::min(0.37e-3 + 3.05e-3, 0.17e-3 + 3.85e-3);
  const double both = 6.3e-3 * 6.7e-3 * (high - low);

  const Model shared = bake(scene);
  EXPECT_NEAR(tissue_volume(shared, "dermis") / (x - both / 2), 1, 0.01);
  EXPECT_NEAR(tissue_volume(shared, "muscle") / (y - both / 2), 1, 0.01);
  EXPECT_NEAR(tissue_volume(shared) / 27e-6, 1, 1e-6);
  EXPECT_EQ(shared.voxels.size(), 27000u);

  scene.volumes[2].priority = 2;
  const Model ruled = bake(scene);
  EXPECT_NEAR(tissue_volume(ruled, "dermis") / (x - both), 1, 0.01);
  EXPECT_NEAR(tissue_volume(ruled, "muscle") / y, 1, 0.01);
}

TEST(Voxelise, ShellLayersHaveTheirVolumes)
{
  Scene scene = plain_scene(1e-3);
  const double outer = 20e-3, inner = 14e-3;
  scene.surfaces = { sphere_surface("skin", { 0, 0, 0 }, outer, 0.7e-3),
                     sphere_surface("bone", { 0, 0, 0 }, inner, 0.7e-3) };
  scene.volumes = { volume_inside("tissue", { "skin" }, "fat", true) };
  scene.volumes[0].outside = { "bone" };
  scene.materials.push_back(material("corneum"));
  scene.layers = { { "corneum", "skin", "tissue", "corneum", 0.02e-3, 1 },
                   { "dermis", "skin", "tissue", "dermis", 1.8e-3, 2 } };
  BakeReport report;
  const Model model = bake(scene, &report);
  const auto ball = [](double r) { return 4.0 / 3 * pi * r * r * r; };
  EXPECT_NEAR(tissue_volume(model, "corneum") / (ball(outer) - ball(outer - 0.02e-3)), 1, 0.01);
  EXPECT_NEAR(tissue_volume(model, "dermis") / (ball(outer - 0.02e-3) - ball(outer - 1.82e-3)), 1, 0.01);
  EXPECT_NEAR(tissue_volume(model, "fat") / (ball(outer - 1.82e-3) - ball(inner)), 1, 0.01);

  // only voxels at the surface have a part of the thin layer
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    Vector3 centre;
    for (std::size_t a = 0; a < 3; ++a)
      centre[a] = (model.voxels[e][a] + 0.5) * model.spacing[a];
    const Vector3 p = transformed(model.to_scene, centre);
    const double radius = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    for (auto m = static_cast<std::size_t>(model.mixture_begin[e]);
         m < static_cast<std::size_t>(model.mixture_begin[e + 1]); ++m)
    {
      if (model.mixture_material[m] == 3)
      {
        EXPECT_GT(radius, outer - 1.8e-3);
      }
    }
  }
}

TEST(Voxelise, ThinLayerOnAFlatFaceIsItsShareOfTheOuterVoxels)
{
  for (const double offset : { 0.0, 0.3e-3, 0.9e-3 })
  {
    Scene scene = plain_scene(1e-3);
    scene.accuracy.fill_min = 0.2;
    scene.surfaces = { box_surface("block", { 0, 0, 0.5 * offset }, { 10e-3, 8e-3, 6e-3 + offset }) };
    scene.volumes = { volume_inside("tissue", { "block" }, "fat", true) };
    scene.layers = { { "thin", "block", "tissue", "dermis", 0.02e-3, 1 } };
    const Model model = bake(scene);
    const double area = 2 * (10e-3 * 8e-3 + (10e-3 + 8e-3) * (6e-3 + offset));
    EXPECT_NEAR(tissue_volume(model, "dermis") / (area * 0.02e-3), 1, 0.005) << offset;
  }
}

TEST(Voxelise, VolumeClosedByOpenSurfacesTogetherInAnyOrientation)
{
  Scene scene = plain_scene(2e-3);
  scene.surfaces = { forehead_surface("tissue"), forehead_surface("skin"), forehead_surface("rim") };
  scene.volumes = { volume_inside("whole", { "tissue" }, "fat", true) };
  const double whole = tissue_volume(bake(scene));
  // build the same body from skin, rim and bone: without a margin, the bone's surface is the deep face of `tissue`
  scene.surfaces.push_back(forehead_surface("skull"));
  scene.surfaces.back().shape->dimensions = { { "margin", 1e-9 } };
  scene.volumes[0].inside.clear();
  scene.volumes[0].closed_by = { "skin", "rim", "skull" };
  EXPECT_NEAR(tissue_volume(bake(scene)) / whole, 1, 1e-3);
}

TEST(Voxelise, DepthBandBelowASurface)
{
  Scene scene = plain_scene(0.5e-3);
  scene.surfaces = { sphere_surface("skin", { 0, 0, 0 }, 10e-3, 0.4e-3) };
  Volume band;
  band.name = "band";
  band.within = "skin";
  band.depth_min = 1e-3;
  band.depth_max = 3e-3;
  band.material = "fat";
  band.tissue = true;
  scene.volumes = { band };
  EXPECT_NEAR(tissue_volume(bake(scene)) / (4.0 / 3 * pi * (729e-9 - 343e-9)), 1, 0.01);
}

TEST(Voxelise, DepthBandAboveASurface)
{
  Scene scene = plain_scene(0.5e-3);
  scene.surfaces = { sphere_surface("bone", { 0, 0, 0 }, 7e-3, 0.4e-3) };
  Volume band;
  band.name = "periosteum";
  band.within = "bone";
  band.depth_min = -2e-3;
  band.depth_max = 0;
  band.material = "fat";
  band.tissue = true;
  scene.volumes = { band };
  EXPECT_NEAR(tissue_volume(bake(scene)) / (4.0 / 3 * pi * (729e-9 - 343e-9)), 1, 0.01);
}

TEST(Voxelise, CropCutsExactly)
{
  Scene scene = plain_scene(1e-3);
  scene.surfaces = { box_surface("block", { 0, 0, 0 }, { 20e-3, 20e-3, 20e-3 }) };
  scene.volumes = { volume_inside("tissue", { "block" }, "fat", true) };
  scene.volumes[0].crop.upper[2] = 3.3e-3;
  scene.volumes[0].crop.lower[0] = -4.2e-3;
  EXPECT_NEAR(tissue_volume(bake(scene)) / (14.2e-3 * 20e-3 * 13.3e-3), 1, 0.005);
}

TEST(Voxelise, MuscleWeightIsItsShareOfTheTissue)
{
  Scene scene = plain_scene(1e-3);
  scene.surfaces = { box_surface("block", { 0, 0, 0 }, { 20e-3, 12e-3, 12e-3 }),
                     box_surface("a", { 0, 0, 0 }, { 30e-3, 4.6e-3, 4.6e-3 }),
                     box_surface("b", { 0, 0, 0 }, { 4.6e-3, 30e-3, 4.6e-3 }) };
  scene.volumes = { volume_inside("tissue", { "block" }, "fat", true), volume_inside("a", { "a" }, "muscle", false, 1),
                    volume_inside("b", { "b" }, "muscle", false, 1) };
  scene.muscles = { { "a", "a", { 2, 0, 0 }, 0.3e6, false, true, 1 },
                    { "b", "b", { 0, 1, 0 }, 0.3e6, false, true, 2 } };
  BakeReport report;
  const Model model = bake(scene, &report);
  // muscles are clipped to the tissue; where the two bars cross, both fill the whole voxel
  EXPECT_NEAR(muscle_volume(model, 0) / (20e-3 * 4.6e-3 * 4.6e-3), 1, 0.01);
  EXPECT_NEAR(muscle_volume(model, 1) / (4.6e-3 * 12e-3 * 4.6e-3), 1, 0.01);
  bool clipped = false;
  for (const std::string& finding : report.findings)
    clipped = clipped || finding.find("'a'") != std::string::npos;
  EXPECT_TRUE(clipped);
}

TEST(Voxelise, WarnsOfBonesThatTissueFills)
{
  Scene scene = plain_scene(3e-3);
  const std::string bone = testing::TempDir() + "filled_bone.obj", cartilage = testing::TempDir() + "filled_small.obj";
  const auto all = [](const auto&) { return true; };
  write_obj(make_shape(*box_surface("", { 0, 0, 0 }, { 30e-3, 30e-3, 30e-3 }).shape), bone, all);
  write_obj(make_shape(*box_surface("", { 0, 0, 20e-3 }, { 9e-3, 9e-3, 9e-3 }).shape), cartilage, all);
  scene.surfaces = { box_surface("block", { 0, 0, 0 }, { 60e-3, 60e-3, 60e-3 }), file_surface("bone", bone),
                     file_surface("cartilage", cartilage), sphere_surface("ball", { 0, 0, 0 }, 20e-3, 3e-3) };
  scene.volumes = { volume_inside("tissue", { "block" }, "fat", true) };
  BakeReport report;
  bake(scene, &report);
  ASSERT_EQ(report.warnings.size(), 2u);  // no node is held
  EXPECT_NE(report.warnings[0].find("surface 'bone' lies in the tissue, but no volume names it, so that tissue fills "
                                    "100 % of it"),
            std::string::npos)
      << report.warnings[0];
  scene.volumes[0].outside = { "bone" };
  bake(scene, &report);
  EXPECT_EQ(report.warnings.size(), 1u);
  scene.accuracy.voxel = { { 30e-3, 30e-3, 30e-3 } };
  scene.volumes[0].outside.clear();
  bake(scene, &report);
  EXPECT_NE(report.warnings[1].find("the tissue has 8 voxels only"), std::string::npos) << report.warnings[1];
}

TEST(Voxelise, WarnsOfMusclesMostlyClippedAndOfSurfacesFarFromTheTissue)
{
  Scene scene = plain_scene(1e-3);
  scene.surfaces = { box_surface("block", { 0, 0, 0 }, { 20e-3, 12e-3, 12e-3 }),
                     box_surface("a", { 14e-3, 0, 0 }, { 20e-3, 4.6e-3, 4.6e-3 }),
                     box_surface("bone", { 0, 0, 40e-3 }, { 5e-3, 5e-3, 5e-3 }) };
  scene.volumes = { volume_inside("tissue", { "block" }, "fat", true),
                    volume_inside("a", { "a" }, "muscle", false, 1) };
  scene.volumes[0].outside = { "bone" };
  scene.muscles = { { "a", "a", { 2, 0, 0 }, 0.3e6, false, true, 1 } };
  BakeReport report;
  bake(scene, &report);
  ASSERT_EQ(report.warnings.size(), 3u);
  EXPECT_EQ(
      report.warnings[0].find("surface 'bone' bounds no tissue: it spans (-2.5, -2.5, 37.5) to (2.5, 2.5, 42.5) mm"),
      0u)
      << report.warnings[0];
  EXPECT_EQ(report.warnings[1].find("muscle 'a' lies in the tissue with 30 % of its volume"), 0u) << report.warnings[1];
  EXPECT_NE(report.warnings[2].find("no node is held or slides"), std::string::npos) << report.warnings[2];
  scene.surfaces[2] = box_surface("bone", { 2e-3, 0, 0 }, { 5e-6, 5e-6, 5e-6 });
  bake(scene, &report);
  EXPECT_EQ(report.warnings[0].find("surface 'bone' is smaller than a voxel: it spans"), 0u) << report.warnings[0];
  scene.surfaces[1] = box_surface("a", { 4e-3, 0, 0 }, { 20e-3, 4.6e-3, 4.6e-3 });
  scene.surfaces[2] = box_surface("bone", { 0, 0, 8e-3 }, { 5e-3, 5e-3, 5e-3 });
  bake(scene, &report);
  EXPECT_EQ(report.warnings.size(), 1u);

  scene.materials[0].density = 1.1;
  scene.muscles[0].cross_section = 60;
  bake(scene, &report);
  ASSERT_EQ(report.warnings.size(), 4u);
  EXPECT_NE(report.warnings[0].find("density is 1.1 kg/m3, expected 100 to 20000"), std::string::npos);
  EXPECT_NE(report.warnings[1].find("muscle 'a': cross_section is 60 m2"), std::string::npos);
  EXPECT_NE((report.warnings[2] + report.warnings[3]).find("of its cross-section of 6e+07 mm2"), std::string::npos);
}

TEST(Voxelise, WarnsOfSidesThatDifferOrLieBeforeEachOtherAndOfTissueLargerThanAHead)
{
  Scene scene = plain_scene(1e-3);
  scene.surfaces = { box_surface("block", { 0, 0, 0 }, { 20e-3, 12e-3, 12e-3 }),
                     box_surface("a_left", { 0, 8e-3, 0 }, { 6e-3, 8e-3, 6e-3 }),
                     box_surface("a_right", { 0, -4e-3, 0 }, { 6e-3, 4e-3, 6e-3 }) };
  scene.volumes = { volume_inside("tissue", { "block" }, "fat", true),
                    volume_inside("a_left", { "a_left" }, "muscle", false, 1),
                    volume_inside("a_right", { "a_right" }, "muscle", false, 1) };
  scene.muscles = { { "a_left", "a_left", { 1, 0, 0 }, 0.3e6, false, true, 1 },
                    { "a_right", "a_right", { 1, 0, 0 }, 0.3e6, false, true, 2 } };
  scene.frame.forward = { 1, 0, 0 };
  scene.frame.up = { 0, 0, 1 };
  BakeReport report;
  bake(scene, &report);
  ASSERT_EQ(report.warnings.size(), 4u);  // the others: a_left is clipped, no node is held
  EXPECT_EQ(report.warnings[1].find("muscle 'a_left' lies in the tissue with 25 % of its volume, 'a_right' with 100 %"),
            0u)
      << report.warnings[1];
  EXPECT_EQ(report.warnings[2].find("muscle 'a_left' has 0.288 cm3, 'a_right' 0.144 cm3"), 0u) << report.warnings[2];
  scene.frame.forward = { 0, 1, 0 };
  bake(scene, &report);
  ASSERT_EQ(report.warnings.size(), 5u);
  EXPECT_NE(report.warnings[0].find("'a_left' lies 12 mm from 'a_right', but not to its left"), std::string::npos)
      << report.warnings[0];
  scene = plain_scene(0.1);
  scene.surfaces = { box_surface("block", { 0, 0, 0 }, { 0.9, 0.4, 0.4 }) };
  scene.volumes = { volume_inside("tissue", { "block" }, "fat", true) };
  bake(scene, &report);
  EXPECT_NE(report.warnings[0].find("more than a head"), std::string::npos) << report.warnings[0];
  scene.surfaces[0].shape->size[0] = 1.8;
  scene.unit = 1e-2;
  std::string fault = fault_of(scene);
  EXPECT_NE(fault.find("more than a head; check 'unit': with 'unit: mm' it would span 180 mm"), std::string::npos)
      << fault;
  scene.surfaces[0] = box_surface("block", { 0, 0, 0 }, { 7e-3, 4e-3, 4e-3 });
  scene.unit = 1e-3;
  fault = fault_of(scene);
  EXPECT_NE(fault.find("with 'unit: cm' it would span 70 mm, with 'unit: in' 178 mm, as a face does"),
            std::string::npos)
      << fault;
}

TEST(Voxelise, WarnsOfASideThatIsUsedTwiceAndOfConstraintsThatHoldAllOrNothing)
{
  Scene scene = plain_scene(1e-3);
  scene.surfaces = { box_surface("block", { 0, 0, 0 }, { 20e-3, 40e-3, 12e-3 }),
                     box_surface("a_left", { 0, 12.5e-3, 0 }, { 6e-3, 8e-3, 6e-3 }),
                     box_surface("a_right", { 0, 12e-3, 0 }, { 6e-3, 8e-3, 6e-3 }),
                     box_surface("b_left", { 0, 12e-3, 3e-3 }, { 6e-3, 4e-3, 6e-3 }),
                     box_surface("b_right", { 0, -12e-3, 3e-3 }, { 6e-3, 4e-3, 6e-3 }),
                     box_surface("c_left", { 0, 8e-3, 3e-3 }, { 6e-3, 4e-3, 6e-3 }),
                     box_surface("c_right", { 0, -8e-3, 3e-3 }, { 6e-3, 4e-3, 6e-3 }) };
  scene.volumes = { volume_inside("tissue", { "block" }, "fat", true) };
  SceneConstraint all;
  all.name = "all";
  all.surfaces = { "block" };
  all.within = 0.1;
  scene.constraints = { all, all };
  scene.constraints[1].name = "none";
  scene.frame.forward = { 1, 0, 0 };
  scene.frame.up = { 0, 0, 1 };
  BakeReport report;
  bake(scene, &report);
  ASSERT_EQ(report.warnings.size(), 3u);
  EXPECT_NE(report.warnings[0].find("'a_right' lie on the left side of the face, 0.5 mm apart"), std::string::npos)
      << report.warnings[0];
  EXPECT_NE(report.warnings[1].find("constraints hold every node"), std::string::npos) << report.warnings[1];
  EXPECT_NE(report.warnings[2].find("constraint 'none': holds no node"), std::string::npos) << report.warnings[2];
  // The middle of the pairs counts, wherever the origin of the frame is.
  scene.frame.origin = { 0, 0.12, 0 };
  scene.surfaces[2] = box_surface("a_right", { 0, -12.5e-3, 0 }, { 6e-3, 8e-3, 6e-3 });
  bake(scene, &report);
  EXPECT_EQ(report.warnings.size(), 2u);
}

TEST(Voxelise, SameBytesFromRunToRun)
{
  Scene scene = plain_scene(1e-3);
  scene.surfaces = { sphere_surface("ball", { 0, 0, 0 }, 12e-3), sphere_surface("core", { 2e-3, 0, 0 }, 5e-3) };
  scene.volumes = { volume_inside("tissue", { "ball" }, "fat", true),
                    volume_inside("core", { "core" }, "muscle", false, 1) };
  scene.layers = { { "dermis", "ball", "tissue", "dermis", 1.3e-3, 1 } };
  const Model a = bake(scene), b = bake(scene);
  EXPECT_EQ(a.voxels, b.voxels);
  EXPECT_EQ(a.fill, b.fill);
  EXPECT_EQ(a.mixture_proportion, b.mixture_proportion);
}

TEST(Voxelise, RefusesSizesThatSpeakOfWrongUnits)
{
  Scene scene = plain_scene(1e-3);
  scene.surfaces = { box_surface("block", { 0, 0, 0 }, { 100, 100, 100 }) };
  scene.volumes = { volume_inside("tissue", { "block" }, "fat", true) };
  const std::string large = fault_of(scene);
  EXPECT_NE(large.find("1e+15 voxels"), std::string::npos) << large;
  EXPECT_NE(large.find("units"), std::string::npos) << large;
  scene.surfaces[0].shape->size = { 1e-4, 1e-4, 1e-4 };
  const std::string small = fault_of(scene);
  EXPECT_NE(small.find("at least 8"), std::string::npos) << small;
}

TEST(Voxelise, NamesEmptyVolumesAndMusclesOutside)
{
  Scene scene = plain_scene(1e-3);
  scene.surfaces = { box_surface("block", { 0, 0, 0 }, { 10e-3, 10e-3, 10e-3 }),
                     box_surface("far", { 1, 0, 0 }, { 10e-3, 10e-3, 10e-3 }),
                     box_surface("shell", { 0, 0, 0 }, { 12e-3, 12e-3, 12e-3 }) };
  scene.volumes = { volume_inside("tissue", { "block" }, "fat", true),
                    volume_inside("far", { "far" }, "muscle", false, 1) };
  scene.volumes[1].line = 17;
  scene.muscles = { { "far_muscle", "far", { 1, 0, 0 }, 0.3e6, false, true, 30 } };
  const std::string muscle = fault_of(scene);
  EXPECT_NE(muscle.find("test.yaml:17"), std::string::npos) << muscle;
  EXPECT_NE(muscle.find("'far_muscle' lies wholly outside"), std::string::npos) << muscle;
  scene.muscles.clear();
  scene.volumes.pop_back();
  scene.volumes[0].outside = { "shell" };
  scene.volumes[0].line = 4;
  const std::string empty = fault_of(scene);
  EXPECT_NE(empty.find("test.yaml:4: volume 'tissue': is empty"), std::string::npos) << empty;
}

TEST(Voxelise, StopsWhenAskedTo)
{
  Scene scene = plain_scene(1e-3);
  scene.surfaces = { box_surface("block", { 0, 0, 0 }, { 10e-3, 10e-3, 10e-3 }) };
  scene.volumes = { volume_inside("tissue", { "block" }, "fat", true) };
  std::vector<std::string> stages;
  bake(scene, nullptr,
       [&](const std::string& stage, double)
       {
         if (stages.empty() || stages.back() != stage)
           stages.push_back(stage);
         return true;
       });
  EXPECT_GE(stages.size(), 4u);
  try
  {
    bake(scene, nullptr, [](const std::string& stage, double) { return stage != "voxels"; });
    FAIL();
  }
  catch (const Error& error)
  {
    EXPECT_STREQ(error.what(), "interrupted");
  }
}

}  // namespace
