// Warnings of surfaces, landmarks, centres and muscles at a place, or of a size, that is probably wrong.

#include "bake/scene_pieces.hpp"
#include "bake/mesh/surface.hpp"
#include "files.hpp"
#include "frontalis/scene/read_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace frontalis
{
namespace
{

// A slab of tissue on two bones, of which a hinge moves the lower one, with four pairs of bars in it.
const std::string scene =
    "unit: mm\nframe: {origin: [0, 0, 0], forward: [1, 0, 0], up: [0, 0, 1]}\nsurfaces:\n"
    "  slab: {shape: box, centre: [10, 0, 0], size: [20, 80, 80]}\n"
    "  skull: {shape: box, centre: [-5, 0, 21], size: [10, 80, 38]}\n"
    "  jaw: {shape: box, centre: [-5, 0, -21], size: [10, 80, 38]}\n"
    "  a_left: {shape: box, centre: [10, 30, 30], size: [4, 8, 8]}\n"
    "  a_right: {shape: box, centre: [10, -30, 30], size: [4, 8, 8]}\n"
    "  b_left: {shape: box, centre: [10, 30, 10], size: [4, 8, 8]}\n"
    "  b_right: {shape: box, centre: [10, -30, 10], size: [4, 8, 8]}\n"
    "  c_left: {shape: box, centre: [10, 30, -10], size: [4, 8, 8]}\n"
    "  c_right: {shape: box, centre: [10, -30, -10], size: [4, 8, 8]}\n"
    "volumes:\n"
    "  slab: {inside: slab, outside: [skull, jaw], material: fat, tissue: true}\n"
    "  a_left: {inside: a_left, material: fat}\n"
    "materials:\n  fat: {young: 4 kPa, poisson: 0.45, density: 1000}\n"
    "muscles:\n  a_left: {fibre: [0, 0, 1], stress_reference: 0.3 MPa, cross_section: 20 mm2}\n"
    "bones: {jaw: {centre: [-5, 0, 0]}}\n"
    "constraints:\n  - {name: still, rigid: skull}\n  - {name: hinge, rigid: jaw, bone: jaw}\n"
    "skin: {surface: slab}\n"
    "landmarks: {corner_left: [20, 25, -30], corner_right: [20, -25, -30]}\n"
    "accuracy:\n  only: {voxel: 4}\n";

std::string with(const std::string& old, const std::string& changed)
{
  std::string text = scene;
  const std::size_t at = text.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  return text.replace(at, old.size(), changed);
}

BakeReport report_of(const std::string& text)
{
  const TemporaryFolder folder;
  BakeReport report;
  bake(read_scene(folder.write("scene.yaml", text)), &report);
  return report;
}

void expect_warning(const std::string& text, const std::string& warning)
{
  const auto warnings = report_of(text).warnings;
  ASSERT_EQ(warnings.size(), 1U) << testing::PrintToString(warnings);
  EXPECT_NE(warnings[0].find(warning), std::string::npos) << warnings[0];
}

TEST(Places, that_are_right_give_no_warning) { EXPECT_TRUE(report_of(scene).warnings.empty()); }

TEST(Places, of_bones_that_overlap_are_told)
{
  const std::string overlap =
      with("centre: [-5, 0, -21], size: [10, 80, 38]", "centre: [-5, 0, -11], size: [10, 70, 38], edge: 3");
  expect_warning(overlap, "surfaces 'skull' and 'jaw', which move with different bones, overlap by 5 mm at (");
  // those that move alike may
  const std::string still = "rigid: skull";
  EXPECT_TRUE(report_of(std::string(overlap).replace(overlap.find(still), still.size(), still + ", bone: jaw"))
                  .warnings.empty());
}

TEST(Places, of_one_side_that_are_no_mirror_image_are_told)
{
  expect_warning(with("c_left: {shape: box, centre: [10, 30, -10]", "c_left: {shape: box, centre: [10, 30, -22]"),
                 "surface 'c_left' lies 12 mm from the mirror image of 'c_right', half of the pairs within 0");
  expect_warning(with("corner_left: [20, 25, -30]", "corner_left: [20, 25, -10]"),
                 "landmark 'corner_left' lies 20 mm from the mirror image of 'corner_right'");
}

TEST(Places, of_centres_and_landmarks_are_checked)
{
  expect_warning(with("jaw: {centre: [-5, 0, 0]}", "jaw: {centre: [-5, 200, 0]}"),
                 "the centre of bone 'jaw', (-5, 200, 0) mm, lies 160 mm from the surfaces that move with it");
  expect_warning(with("corner_left: [20, 25, -30]", "corner_left: [27, 25, -30]"),
                 "landmark 'corner_left' lies 7 mm from the published skin and was moved to it");
}

TEST(Places, of_bones_that_carry_the_whole_face_are_told)
{
  const std::string still = "rigid: skull", jaw = "expressions: {open: {bones: {jaw: {turn: [0, 10, 0]}}}}\naccuracy:";
  EXPECT_TRUE(report_of(with("accuracy:", jaw)).warnings.empty());
  std::string text = with("accuracy:", jaw);
  text.replace(text.find(still), still.size(), still + ", bone: jaw");
  expect_warning(text, "bone 'jaw', which expressions move, has 100 % of the nodes that are held or slide");
}

TEST(Sides, under_other_names_are_told)
{
  std::string text = scene;
  for (const auto& [old, changed] : { std::pair("c_left", "c_links"), std::pair("c_right", "c_rechts") })
    text.replace(text.find(old), std::string(old).size(), changed);
  expect_warning(text,
                 "'c_links' and 'c_rechts' look like two sides, but only NAME_left and NAME_right are taken for "
                 "such: rename them, here to 'c_left' and 'c_right'");
  for (const auto& [old, changed] : { std::pair("c_links", "left_c"), std::pair("c_rechts", "right_c") })
    text.replace(text.find(old), std::string(old).size(), changed);
  expect_warning(text, "'left_c' and 'right_c' look like two sides");
}

TEST(Places, that_no_constraint_names_are_reported)
{
  const BakeReport report = report_of(with("  - {name: still, rigid: skull}\n", ""));
  EXPECT_TRUE(report.warnings.empty());
  EXPECT_NE(std::find(report.findings.begin(), report.findings.end(),
                      "surface 'skull' bounds the tissue, but no constraint names it: the tissue can move through its "
                      "place, unless another surface is in front of it"),
            report.findings.end());
}

TEST(Places, of_muscles_without_thickness_are_told)
{
  expect_warning(with("cross_section: 20 mm2", "cross_section: 640 mm2"),
                 "muscle 'a_left' has 21 mm2 of its cross-section of 640 mm2 in the model, so that its stress is 30 "
                 "times");
}

TEST(Places, of_open_muscles_are_checked_and_what_clips_them_is_named)
{
  Scene model = plain_scene(1e-3);
  const std::string file = testing::TempDir() + "open_muscle.obj";
  TriangleMesh muscle = make_shape(*box_surface("", { 14e-3, 0, 0 }, { 20e-3, 4.6e-3, 4.6e-3 }, 1e-3).shape);
  muscle.triangles.pop_back();
  write_obj(muscle, file, [](const auto&) { return true; });
  model.surfaces = { box_surface("block", { 0, 0, 0 }, { 20e-3, 12e-3, 12e-3 }), file_surface("a", file),
                     box_surface("bone", { 13e-3, 0, 0 }, { 12e-3, 6e-3, 6e-3 }) };
  model.volumes = { volume_inside("tissue", { "block" }, "fat", true),
                    volume_inside("a", { "a" }, "muscle", false, 1) };
  model.muscles = { { "a", "a", { 2, 0, 0 }, 0.3e6, false, true, 1 } };
  BakeReport report;
  bake(model, &report);
  ASSERT_EQ(report.warnings.size(), 2u) << testing::PrintToString(report.warnings);  // no node is held
  EXPECT_NE(report.warnings[0].find("most of what is clipped lies outside of the skin"), std::string::npos)
      << report.warnings[0];
  model.surfaces[0] = box_surface("block", { 0, 0, 0 }, { 50e-3, 12e-3, 12e-3 });
  model.surfaces[2].shape->size[0] = 16e-3;
  model.volumes[0].outside = { "bone" };
  bake(model, &report);
  ASSERT_EQ(report.warnings.size(), 2u) << testing::PrintToString(report.warnings);
  EXPECT_EQ(report.warnings[0].find("muscle 'a' lies in the tissue with 20 %"), 0u) << report.warnings[0];
  EXPECT_NE(report.warnings[0].find("most of what is clipped lies in surface 'bone'"), std::string::npos)
      << report.warnings[0];
}

TEST(Places, of_bones_outside_of_the_skin_are_told)
{
  Scene model = plain_scene(4e-3);
  model.surfaces = { sphere_surface("skin", { 0, 0, 0 }, 20e-3, 3e-3),
                     box_surface("bone", { 18e-3, 18e-3, 18e-3 }, { 4e-3, 4e-3, 4e-3 }) };
  model.volumes = { volume_inside("tissue", { "skin" }, "fat", true) };
  model.volumes[0].outside = { "bone" };
  BakeReport report;
  bake(model, &report);
  ASSERT_EQ(report.warnings.size(), 2u);  // no node is held
  EXPECT_EQ(report.warnings[0].find("surface 'bone' lies wholly outside of 'skin' and bounds no tissue: it spans (16,"),
            0u)
      << report.warnings[0];
  model.surfaces[1] = box_surface("bone", { 0, 0, 0 }, { 60e-3, 4e-3, 4e-3 });  // all corners lie outside
  bake(model, &report);
  EXPECT_EQ(report.warnings.size(), 1u);
  // one of two parts suffices
  model.surfaces.push_back(box_surface("part", { 0, 0, 60e-3 }, { 10e-3, 10e-3, 10e-3 }));
  model.volumes[0].inside = { "skin", "part" };
  bake(model, &report);
  EXPECT_EQ(report.warnings.size(), 1u) << testing::PrintToString(report.warnings);
}

}  // namespace
}  // namespace frontalis
