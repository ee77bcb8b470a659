#include "frontalis/model/model_file.hpp"
#include "frontalis/scene/read_scene.hpp"

#include "bake/scene_pieces.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace
{

using namespace frontalis;

const std::string source = FRONTALIS_SOURCE_DIRECTORY;
const std::string head = source + "/../shared/data/head";

std::string bytes(const std::filesystem::path& file)
{
  std::ifstream in(file, std::ios::binary);
  return { std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>() };
}

double volume_in_report(const BakeReport& report, const std::string& muscle, const char* after)
{
  for (const std::string& finding : report.findings)
  {
    if (finding.find("muscle '" + muscle + "'") != std::string::npos)
      return 1e-6 * std::stod(finding.substr(finding.find(after) + std::string(after).size()));
  }
  return -1;
}

TEST(ForeheadScene, BakesWithAllItsParts)
{
  const Scene scene = read_scene(source + "/config/forehead.yaml");
  BakeReport report;
  const Model model = bake(scene, &report);
  EXPECT_EQ(model.muscles.size(), 5u);
  EXPECT_EQ(model.landmarks.size(), 6u);
  EXPECT_FALSE(model.rigid.empty());
  EXPECT_FALSE(model.sliding.empty());
  EXPECT_EQ(model.scene_hash.size(), 16u);
  ASSERT_EQ(model.demo.size(), 4u);
  for (std::size_t m = 0; m < model.muscles.size(); ++m)
  {
    // what the kept voxels carry is what lies in the tissue, but for voxels dropped at its edges
    const double meshed = volume_in_report(report, model.muscles[m].name, ": ");
    EXPECT_NEAR(muscle_volume(model, static_cast<int>(m)) / meshed, 1, 0.03) << model.muscles[m].name;
  }
  // the brow is a free edge, the hairline is held
  double lowest = 1;
  for (const RigidNode& node : model.rigid)
  {
    const Vector3d p = transformed(model.to_face, node_position(model, node.node));
    if (std::abs(p[1]) > 15e-3 && std::abs(p[1]) < 55e-3)
      lowest = std::min(lowest, p[2]);
  }
  EXPECT_GT(lowest, 60e-3);
  // the whole skin is published, in the face frame
  EXPECT_GT(model.skin.vertices.size(), 3000u);
  for (std::size_t l = 0; l < model.landmarks.size(); ++l)
  {
    const Vector3d p = transformed(model.to_face, model.landmark_positions[l]);
    if (model.landmarks[l] == "brow_left")
    {
      EXPECT_GT(p[1], 20e-3);
    }
    if (model.landmarks[l] == "hairline")
    {
      EXPECT_GT(p[2], 70e-3);
    }
  }
}

TEST(ForeheadScene, BakingTwiceGivesTheSameBytes)
{
  const auto folder = std::filesystem::temp_directory_path() / ("frontalis_bake_test_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  const Scene scene = read_scene(source + "/config/forehead.yaml");
  write_model(bake(scene), (folder / "a.vtkhdf").string());
  write_model(bake(scene), (folder / "b.vtkhdf").string());
  EXPECT_TRUE(bytes(folder / "a.vtkhdf") == bytes(folder / "b.vtkhdf"));
  std::filesystem::remove_all(folder);
}

TEST(RealHead, BakesFromSegmentedMeshes)
{
  if (!std::filesystem::exists(head + "/skin/skin.obj"))
    GTEST_SKIP() << "skipped: the meshes of the head are not here";
  SceneOptions options;
  options.mesh_directory = head;
  options.voxel = 2e-3;
  const Scene scene = read_scene(source + "/config/real_head.yaml", options);
  BakeReport report;
  const Model model = bake(scene, &report);

  // one piece, with nothing behind the bone: in the forehead the soft tissue is less than 10 mm deep
  for (const std::string& finding : report.findings)
    EXPECT_EQ(finding.find("voxels removed"), std::string::npos) << finding;
  EXPECT_GT(tissue_volume(model), 80e-6);
  EXPECT_LT(tissue_volume(model), 160e-6);
  for (const auto& voxel : model.voxels)
  {
    const Vector3d p =
        transformed(model.to_scene, { (voxel[0] + 0.5) * model.spacing[0], (voxel[1] + 0.5) * model.spacing[1],
                                      (voxel[2] + 0.5) * model.spacing[2] });
    if (std::abs(p[0]) < 20e-3 && p[2] > 1.560 && p[2] < 1.585)
    {
      EXPECT_LT(p[1], -0.168);
    }
  }
  ASSERT_EQ(model.muscles.size(), 6u);
  for (std::size_t m = 0; m < model.muscles.size(); ++m)
  {
    const double inside = volume_in_report(report, model.muscles[m].name, ": ");
    // the smallest muscles lose a little with voxels that bone leaves too little tissue in
    EXPECT_NEAR(muscle_volume(model, static_cast<int>(m)) / inside, 1, 0.08) << model.muscles[m].name;
    EXPECT_GT(inside / volume_in_report(report, model.muscles[m].name, "tissue, "), 0.7) << model.muscles[m].name;
  }
  EXPECT_EQ(model.landmarks.size(), 6u);
  EXPECT_GT(model.skin.vertices.size(), 1000u);
  EXPECT_GT(model.rigid.size(), 500u);
  EXPECT_GT(model.sliding.size(), 1000u);
}

TEST(RealFace, BakesWithAllItsMuscles)
{
  if (!std::filesystem::exists(head + "/skin/skin.obj"))
    GTEST_SKIP() << "skipped: the meshes of the head are not here";
  SceneOptions options;
  options.mesh_directory = head;
  options.voxel = 1.5e-3;
  BakeReport report;
  report.measure_muscles = true;
  const Model model = bake(read_scene(source + "/config/real_face.yaml", options), &report);
  ASSERT_EQ(report.muscles.size(), 27u);
  for (const BakeReport::MuscleVolume& muscle : report.muscles)
  {
    EXPECT_NEAR(muscle.voxels / muscle.in_tissue, 1, 0.03) << muscle.name;
    const double clipped = muscle.in_bone + muscle.beyond_skin + muscle.elsewhere;
    EXPECT_NEAR((muscle.in_tissue + clipped) / muscle.mesh, 1, 1e-9) << muscle.name;
  }
  EXPECT_EQ(model.landmarks.size(), 7u);
  EXPECT_EQ(model.bones, std::vector<std::string>{ "mandible" });
}

}  // namespace
