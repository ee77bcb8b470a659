#include "../../src/bake/surface.hpp"

#include "bake/scene_pieces.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>

namespace
{

using namespace frontalis;

class OpenSurfaces : public testing::Test
{
protected:
  void SetUp() override
  {
    folder_ = std::filesystem::temp_directory_path() / ("frontalis_leak_test_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// Writes a sphere without the triangles that have a vertex where `leave` holds (unit coordinates).
  template <class Leave>
  Surface sphere_file(const std::string& name, double radius, const Leave& leave) const
  {
    TriangleMesh mesh = make_shape(*sphere_surface("", { 0, 0, 0 }, 1, 0.04).shape);
    join_vertices(mesh);
    std::ofstream out(folder_ / (name + ".obj"));
    char line[128];
    for (const Vector3& v : mesh.vertices)
    {
      std::snprintf(line, sizeof(line), "v %.9g %.9g %.9g\n", v[0], v[1], v[2]);
      out << line;
    }
    for (const Triangle& t : mesh.triangles)
    {
      bool left = false;
      for (const std::int32_t v : t)
        left = left || leave(mesh.vertices[static_cast<std::size_t>(v)]);
      if (!left)
        out << "f " << t[0] + 1 << " " << t[1] + 1 << " " << t[2] + 1 << "\n";
    }
    return file_surface(name, (folder_ / (name + ".obj")).string(), radius);
  }

  std::filesystem::path folder_;
};

TEST_F(OpenSurfaces, AHeadOpenAtTheNeckHoldsItsTissue)
{
  Scene scene = plain_scene(1e-3);
  scene.surfaces = { sphere_file("head", 20e-3, [](const Vector3& v) { return v[2] < -0.9 || v[0] > 0.985; }) };
  scene.volumes = { volume_inside("tissue", { "head" }, "fat", true) };
  BakeReport report;
  const Model model = bake(scene, &report);
  // the cap of the neck is 0.7 % of the ball; the surface across it may bulge, no more
  EXPECT_NEAR(tissue_volume(model) / (4.0 / 3 * pi * 8e-6), 1, 0.02);
  bool reported = false;
  for (const std::string& finding : report.findings)
    reported = reported || finding.find("is open") != std::string::npos;
  EXPECT_TRUE(reported);
}

TEST_F(OpenSurfaces, GapsBetweenTwoBonesLetNothingThrough)
{
  Scene scene = plain_scene(1e-3);
  // two halves of a skull, half a millimetre apart, around what must not become tissue
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

}  // namespace
