#include "frontalis/model/model_file.hpp"
#include "frontalis/scene/read_scene.hpp"

#include "bake/mesh/surface.hpp"
#include "bake/scene_pieces.hpp"
#include "files.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>

namespace
{

using namespace frontalis;

const std::string source = FRONTALIS_SOURCE_DIRECTORY;
const std::string head = source + "/../shared/data/head";

double volume_in_report(const BakeReport& report, const std::string& muscle, const char* after)
{
  for (const std::string& finding : report.findings)
  {
    if (finding.find("muscle '" + muscle + "'") != std::string::npos)
      return 1e-6 * std::stod(finding.substr(finding.find(after) + std::string(after).size()));
  }
  return -1;
}

void expect_one_piece(const BakeReport& report)
{
  for (const std::string& finding : report.findings)
    EXPECT_EQ(finding.find(" removed: "), std::string::npos) << finding;
  EXPECT_TRUE(report.warnings.empty()) << testing::PrintToString(report.warnings);
}

void expect_whole_muscles(const Model& model, const BakeReport& report)
{
  for (std::size_t m = 0; m < model.muscles.size(); ++m)
  {
    const double inside = volume_in_report(report, model.muscles[m].name, ": ");
    // small muscles lose some volume beside bone, where nearly empty voxels are dropped
    EXPECT_NEAR(muscle_volume(model, static_cast<int>(m)) / inside, 1, 0.08) << model.muscles[m].name;
    EXPECT_GT(inside / volume_in_report(report, model.muscles[m].name, "tissue, "), 0.7) << model.muscles[m].name;
  }
}

/// `resolved` [m3]: voxels represent muscles of at least this volume.
void expect_measured_muscles(const BakeReport& report, double resolved = 0)
{
  for (const BakeReport::MuscleVolume& muscle : report.muscles)
  {
    if (muscle.in_tissue >= resolved)
    {
      EXPECT_NEAR(muscle.voxels / muscle.in_tissue, 1, 0.03) << muscle.name;
    }
    const double clipped = muscle.in_bone + muscle.beyond_skin + muscle.elsewhere;
    EXPECT_NEAR((muscle.in_tissue + clipped) / muscle.mesh, 1, 1e-9) << muscle.name;
  }
}

/// A head of spheres in mesh files, in the frame and the length unit of a real head: x to the subject's left, y
/// backwards, z up [mm]. The skin is open at the neck. The bone is a shell 10 to 12 mm below the skin. The scene's
/// range of depths includes some space behind the bone. Six muscles lie between skin and bone.
class MadeHead : public testing::Test
{
protected:
  static constexpr double skin = 90, outer_table = 80, inner_table = 78;  // radii [mm]

  void SetUp() override
  {
    const auto all = [](const Triangle&) { return true; };
    const TriangleMesh ball = sphere(skin);
    write_obj(ball, path("skin.obj"), [&](const Triangle& t) { return ball.vertices[t[0]][2] > -0.75 * skin; });
    TriangleMesh shell = sphere(outer_table);
    append(shell, sphere(inner_table), true);
    write_obj(shell, path("skull.obj"), all);
    const Vector3 brow{ 4, 2, 14 }, frown{ 12, 2, 4 }, nose{ 3, 2, 9 };
    for (const int side : { -1, 1 })
    {
      const std::string name = side > 0 ? "_left.obj" : "_right.obj";
      write_obj(ellipsoid(20. * side, 22, brow), path("frontalis" + name), all);
      write_obj(ellipsoid(18. * side, 0, frown), path("corrugator" + name), all);
      write_obj(ellipsoid(6. * side, -14, nose), path("procerus" + name), all);
    }
    std::ofstream(path("head.yaml")) << scene;
  }

  Model bake_head(BakeReport& report, double voxel) const
  {
    SceneOptions options;
    options.mesh_directory = folder_.path();
    options.voxel = voxel;
    return bake(read_scene(path("head.yaml"), options), &report);
  }

  /// Volume between skin and bone within the scene's crop [m3], counted on a lattice.
  static double soft_tissue()
  {
    constexpr double step = 0.5;
    double sum = 0;
    for (double x = -44.75; x < 45; x += step)
      for (double y = -94.75; y < -40; y += step)
        for (double z = -29.75; z < 50; z += step)
        {
          const double r = std::sqrt(x * x + y * y + z * z);
          sum += r > outer_table && r < skin ? 1e-9 * step * step * step : 0;
        }
    return sum;
  }

private:
  static constexpr const char* scene = R"(
unit: mm
frame: {id: face, origin: [0, -90, 0], forward: [0, -1, 0], up: [0, 0, 1]}
surfaces:
  skin: {file: skin.obj}
  skull: {file: skull.obj}
  frontalis_left: {file: frontalis_left.obj}
  frontalis_right: {file: frontalis_right.obj}
  corrugator_left: {file: corrugator_left.obj}
  corrugator_right: {file: corrugator_right.obj}
  procerus_left: {file: procerus_left.obj}
  procerus_right: {file: procerus_right.obj}
  cut: {shape: box, centre: [0, 0, 100], size: [400, 400, 100]}
  mandible: {shape: box, centre: [0, 0, -80], size: [400, 400, 100]}
volumes:
  tissue:
    inside: [skin]
    outside: [skull]
    within: {surface: skin, from: 0, to: 14}
    crop: {lower: [-45, -95, -30], upper: [45, -40, 50]}
    material: hypodermis
    tissue: true
  frontalis_left: {inside: [frontalis_left], material: muscle}
  frontalis_right: {inside: [frontalis_right], material: muscle}
  corrugator_left: {inside: [corrugator_left], material: muscle}
  corrugator_right: {inside: [corrugator_right], material: muscle}
  procerus_left: {inside: [procerus_left], material: muscle}
  procerus_right: {inside: [procerus_right], material: muscle}
materials:
  hypodermis: {young: 34 kPa, poisson: 0.49, density: 1000}
  muscle: {young: 0.5 MPa, poisson: 0.49, density: 1000}
muscles:
  frontalis_left: {}
  frontalis_right: {}
  corrugator_left: {}
  corrugator_right: {}
  procerus_left: {}
  procerus_right: {}
constraints:
  - {name: cut, rigid: cut}
  - {name: mandible, rigid: mandible, bone: mandible}
  - {name: skull, sliding: skull}
skin: {surface: skin, crop: {lower: [-44, -95, -29], upper: [44, -41, 49]}}
landmarks:
  glabella: [0, -90, 0]
accuracy:
  standard: {voxel: 2}
)";

  std::string path(const std::string& name) const { return folder_ / name; }
  static TriangleMesh sphere(double radius)
  {
    TriangleMesh mesh = make_shape(*sphere_surface("", { 0, 0, 0 }, radius, 4).shape);
    join_vertices(mesh);
    return mesh;
  }
  static TriangleMesh ellipsoid(double x, double z, const Vector3& size)
  {
    Shape shape;
    shape.kind = Shape::Kind::ellipsoid;
    shape.centre = { x, -std::sqrt(85. * 85 - x * x - z * z), z };
    shape.size = size;
    shape.edge = 1;
    return make_shape(shape);
  }

  TemporaryFolder folder_;
};

TEST_F(MadeHead, BakesFromMeshFiles)
{
  BakeReport report;
  const Model model = bake_head(report, 2e-3);
  expect_one_piece(report);
  EXPECT_NEAR(tissue_volume(model) / soft_tissue(), 1, 0.03);
  // there is no tissue behind the bone: no voxel is deeper than the outer table by more than half its diagonal
  for (const auto& voxel : model.voxels)
  {
    const Vector3d p = to_vector(
        transformed(model.to_scene, { (voxel[0] + 0.5) * model.spacing[0], (voxel[1] + 0.5) * model.spacing[1],
                                      (voxel[2] + 0.5) * model.spacing[2] }));
    ASSERT_GT(p.norm(), 1e-3 * outer_table - 1.75e-3);
  }
  ASSERT_EQ(model.muscles.size(), 6u);
  expect_whole_muscles(model, report);
  EXPECT_EQ(model.landmarks.size(), 1u);
  EXPECT_GT(model.skin.vertices.size(), 400u);
  EXPECT_GT(model.rigid.size(), 300u);
  EXPECT_GT(model.sliding.size(), 1000u);
}

TEST_F(MadeHead, MeasuresItsMuscles)
{
  BakeReport report;
  report.measure_muscles = true;
  const Model model = bake_head(report, 1.5e-3);
  ASSERT_EQ(report.muscles.size(), 6u);
  expect_measured_muscles(report);
  EXPECT_EQ(model.bones, std::vector<std::string>{ "mandible" });
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
    // the model has the volume of the mesh in the tissue, except for voxels dropped at the tissue's edges
    const double meshed = volume_in_report(report, model.muscles[m].name, ": ");
    EXPECT_NEAR(muscle_volume(model, static_cast<int>(m)) / meshed, 1, 0.03) << model.muscles[m].name;
  }
  // nodes at the brow are free, nodes at the hairline are held
  double lowest = 1;
  for (const RigidNode& node : model.rigid)
  {
    const Vector3 p = transformed(model.to_face, node_position(model, node.node));
    if (std::abs(p[1]) > 15e-3 && std::abs(p[1]) < 55e-3)
      lowest = std::min(lowest, p[2]);
  }
  EXPECT_GT(lowest, 60e-3);
  // the whole skin is published, and in the face frame
  EXPECT_GT(model.skin.vertices.size(), 3000u);
  for (std::size_t l = 0; l < model.landmarks.size(); ++l)
  {
    const Vector3 p = transformed(model.to_face, model.landmark_positions[l]);
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

// A study of accuracy compares skins vertex by vertex.
TEST(ForeheadScene, KeepsItsSkinWhenVoxelsChange)
{
  Scene scene = read_scene(source + "/config/forehead.yaml");
  const std::size_t vertices = bake(scene).skin.vertices.size();
  scene.accuracy.voxel.fill(1.5e-3);
  EXPECT_EQ(bake(scene).skin.vertices.size(), vertices);
  SceneOptions fine;
  fine.voxel = 1e-3;
  const std::size_t more = bake(read_scene(source + "/config/forehead.yaml", fine)).skin.vertices.size();
  EXPECT_NEAR(static_cast<double>(more) / static_cast<double>(vertices), 1.75 * 1.75, 0.2) << "as fine as the voxels";
}

TEST(ForeheadScene, BakingTwiceGivesTheSameBytes)
{
  const TemporaryFolder folder;
  const Scene scene = read_scene(source + "/config/forehead.yaml");
  write_model(bake(scene), folder / "a.vtkhdf");
  write_model(bake(scene), folder / "b.vtkhdf");
  EXPECT_TRUE(text_of(folder / "a.vtkhdf") == text_of(folder / "b.vtkhdf"));
}

TEST(GeneratedHead, BakesWithAllItsMuscles)
{
  SceneOptions options;
  options.accuracy = "draft";
  BakeReport report;
  report.measure_muscles = true;
  const Model model = bake(read_scene(source + "/config/head.yaml", options), &report);
  expect_one_piece(report);
  for (const auto& voxel : model.voxels)
  {
    const Vector3 p =
        transformed(model.to_scene, { (voxel[0] + 0.5) * model.spacing[0], (voxel[1] + 0.5) * model.spacing[1],
                                      (voxel[2] + 0.5) * model.spacing[2] });
    if (std::abs(p[1]) < 20e-3 && p[2] > 20e-3 && p[2] < 45e-3)
    {
      // bone is 4 mm below the skin, which is at x of at least -7 mm here, and half a voxel's diagonal is 2.6 mm
      EXPECT_GT(p[0], -14e-3);
    }
  }
  ASSERT_EQ(report.muscles.size(), 53u);
  // Straps of half a voxel's thickness depend on where the 64 samples of a voxel lie, which differs between the sides.
  expect_measured_muscles(report, 10 * 27e-9);  // ten voxels
  EXPECT_EQ(model.landmarks.size(), 25u);
  EXPECT_GT(model.skin.vertices.size(), 1000u);
  EXPECT_GT(model.rigid.size(), 500u);
  EXPECT_GT(model.sliding.size(), 1000u);
  // skull, septum and canthi are one surface to nodes, although two constraints name the skull
  std::vector<std::string> slide_on;
  for (const ConstraintSurface& surface : model.constraint_surfaces)
    slide_on.push_back(surface.name);
  EXPECT_EQ(slide_on, (std::vector<std::string>{ "skull", "mandible", "eye_left", "eye_right" }));
  EXPECT_EQ(model.bones.size(), 9u) << "the mandible, the eyeballs, and three parts of the lids of each eye";
}

// MadeHead and GeneratedHead are checked in the same way where the meshes of a real head are missing.

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

  // the model is connected and has no tissue behind the bone, because all tissue is less than 10 mm deep
  expect_one_piece(report);
  EXPECT_GT(tissue_volume(model), 80e-6);
  EXPECT_LT(tissue_volume(model), 160e-6);
  for (const auto& voxel : model.voxels)
  {
    const Vector3 p =
        transformed(model.to_scene, { (voxel[0] + 0.5) * model.spacing[0], (voxel[1] + 0.5) * model.spacing[1],
                                      (voxel[2] + 0.5) * model.spacing[2] });
    if (std::abs(p[0]) < 20e-3 && p[2] > 1.560 && p[2] < 1.585)
    {
      EXPECT_LT(p[1], -0.168);
    }
  }
  ASSERT_EQ(model.muscles.size(), 6u);
  expect_whole_muscles(model, report);
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
  ASSERT_EQ(report.muscles.size(), 44u);
  expect_measured_muscles(report);
  EXPECT_EQ(model.landmarks.size(), 24u);
  EXPECT_EQ(model.bones.size(), 9u) << "the mandible, the eyeballs, and three parts of the lids of each eye";
}

}  // namespace
