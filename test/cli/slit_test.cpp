// The opening of a slit of zero width in a block that is pulled, and in skin under tension.

#include "frontalis/runner/named_controls.hpp"
#include "frontalis/solver/solver.hpp"

#include "bake/scene_pieces.hpp"

#include "files.hpp"

#include <gtest/gtest.h>

#include <filesystem>

namespace
{

using namespace frontalis;

constexpr std::array<double, 4> places{ 1e-3, 5e-3, 10e-3, 14e-3 };  // along the slit, which is 18 mm long [m]

const TemporaryFolder& folder()
{
  static const TemporaryFolder made;
  return made;
}

SceneConstraint held(const std::string& surface, const std::string& bone)
{
  SceneConstraint out;
  out.name = surface;
  out.surfaces = { surface };
  out.bone = bone;
  return out;
}

/// A block of 36 x 6 x 24 mm with a slit from its side x = 0 to `end` [m], and landmarks on both sides of the slit.
Scene slit_block(double voxel, double z, double end = 18e-3)
{
  Scene scene = plain_scene(voxel);
  scene.accuracy.assumed_strain = true;
  const std::string file = folder() / "opening.obj";
  TriangleMesh mesh;
  for (const double x : { -1e-3, end })
    for (const double y : { -1e-3, 7e-3 })
      mesh.vertices.push_back({ x, y, z });
  mesh.triangles = { { 0, 2, 1 }, { 1, 2, 3 } };
  write_obj(mesh, file, [](const auto&) { return true; });
  scene.surfaces = { box_surface("block", { 18e-3, 3e-3, 12e-3 }, { 36e-3, 6e-3, 24e-3 }),
                     box_surface("floor", { 18e-3, 3e-3, -1e-3 }, { 60e-3, 60e-3, 2e-3 }),
                     box_surface("roof", { 18e-3, 3e-3, 25e-3 }, { 60e-3, 60e-3, 2e-3 }), file_surface("slit", file) };
  scene.volumes = { volume_inside("tissue", { "block" }, "fat", true) };
  scene.volumes[0].slits = { "slit" };
  scene.constraints = { held("floor", ""), held("roof", "lid") };
  for (SceneConstraint& constraint : scene.constraints)
    constraint.within = 0.2e-3;
  scene.skin.surface = "block";
  for (const double x : places)
    for (const double height : { z - 0.01e-3, z + 0.01e-3 })
      scene.landmarks.push_back({ std::to_string(x) + (height < z ? " below" : " above"), { x, 0, height } });
  return scene;
}

/// Width of the slit at `places` after the upper side of the block was lifted by 2 mm [m].
std::vector<double> opening(const Model& model, const std::string& backend)
{
  const auto solver = make_solver(std::make_shared<const Model>(model), { backend, 0, 0 });
  Controls lifted;
  lifted.bone.resize(1);
  for (std::size_t a = 0; a < 3; ++a)
    lifted.bone[0].translation[a] = 2e-3 * model.to_scene.rotation[6 + a];
  solver->advance(0.02, lifted);
  EXPECT_TRUE(solver->settle(lifted, 2e-3, 5).reached);
  SkinState skin;
  solver->skin(skin);
  std::vector<double> width;
  for (std::size_t p = 0; p < skin.landmarks.size(); p += 2)
  {
    const auto z = [&](std::size_t n)
    {
      Vector3 at;
      for (std::size_t a = 0; a < 3; ++a)
        at[a] = static_cast<double>(skin.landmarks[n][a]);
      return transformed(model.to_scene, at)[2];
    };
    width.push_back(z(p + 1) - z(p));
  }
  return width;
}

TEST(Slit, OpensToOneShapeAtAnyVoxelSize)
{
  // the first slit lies in planes of all grids, the second passes through voxels
  for (const double height : { 12e-3, 11.3e-3 })
  {
    const std::vector<double> fine = opening(bake(slit_block(1e-3, height)), "cpu");
    ASSERT_EQ(fine.size(), places.size());
    EXPECT_GT(fine[0], 1e-3);
    for (const double voxel : { 2e-3, 3e-3 })
    {
      const std::vector<double> coarse = opening(bake(slit_block(voxel, height)), "cpu");
      for (std::size_t p = 0; p < places.size(); ++p)
        EXPECT_NEAR(coarse[p], fine[p], 0.1 * fine[0]) << height << " " << voxel << " at " << places[p];
    }
  }
}

TEST(Slit, OpensToOneShapeIfItEndsWithinVoxels)
{
  // the slit crosses most of the voxels of 3 and of 2 mm in which it ends
  for (const double end : { 17.3e-3, 17.8e-3 })
  {
    const std::vector<double> fine = opening(bake(slit_block(1e-3, 11.3e-3, end)), "cpu");
    for (const double voxel : { 2e-3, 3e-3 })
    {
      const std::vector<double> coarse = opening(bake(slit_block(voxel, 11.3e-3, end)), "cpu");
      for (std::size_t p = 0; p < places.size(); ++p)
        EXPECT_NEAR(coarse[p], fine[p], 0.1 * fine[0]) << end << " " << voxel << " at " << places[p];
    }
  }
}

TEST(Slit, OpensAlikeWithBoundariesAtTheirPlaces)
{
  // floor and roof are 0.3 mm inside the block, where no grid has nodes
  const auto scene = [](double voxel, const char* boundary)
  {
    Scene out = slit_block(voxel, 11.3e-3);
    out.surfaces[1] = box_surface("floor", { 18e-3, 3e-3, -0.7e-3 }, { 60e-3, 60e-3, 2e-3 });
    out.surfaces[2] = box_surface("roof", { 18e-3, 3e-3, 24.7e-3 }, { 60e-3, 60e-3, 2e-3 });
    out.accuracy.boundary = boundary;
    for (SceneConstraint& constraint : out.constraints)
      constraint.within = -1;
    return out;
  };
  const std::vector<double> fine = opening(bake(scene(1e-3, "true")), "cpu");
  EXPECT_GT(fine[0], 1e-3);
  for (const double voxel : { 2e-3, 3e-3 })
  {
    const Model model = bake(scene(voxel, "true"));
    EXPECT_FALSE(model.attached.empty());
    EXPECT_FALSE(model.joints.empty());
    for (const Backend& backend : available_backends())
    {
      if (backend == "reference" && voxel < 3e-3)
        continue;
      const std::vector<double> coarse = opening(model, backend);
      for (std::size_t p = 0; p < places.size(); ++p)
        EXPECT_NEAR(coarse[p], fine[p], 0.1 * fine[0]) << backend << " " << voxel << " at " << places[p];
    }
  }
}

TEST(Slit, JointsAreOneNodeOnEachBackend)
{
  const Model model = bake(slit_block(3e-3, 11.3e-3));
  ASSERT_FALSE(model.joints.empty());
  const std::vector<double> reference = opening(model, "reference");
  for (const Backend& backend : available_backends())
  {
    const std::vector<double> width = opening(model, backend);
    for (std::size_t p = 0; p < places.size(); ++p)
      EXPECT_NEAR(width[p], reference[p], 0.01 * reference[0]) << backend;
    const auto solver = make_solver(std::make_shared<const Model>(model), { backend, 0, 0 });
    Controls lifted;
    lifted.bone.resize(1);
    lifted.bone[0].translation = { 1e-3, -1e-3, 2e-3 };
    solver->advance(0.01, lifted);
    std::vector<std::array<double, 3>> u;
    solver->displacements(u);
    for (const Model::Joint& joint : model.joints)
      for (std::size_t a = 0; a < 3; ++a)
        EXPECT_NEAR(u[static_cast<std::size_t>(joint.node)][a], u[static_cast<std::size_t>(joint.master)][a], 1e-12)
            << backend;
  }
}

// Skin of 2 mm under tension, on 4 mm of soft tissue that is held below. The edge of a cut draws back by
// N / sqrt(K k), the displacement of a sheet of stiffness K on a layer of the shear stiffness k per area.
TEST(Slit, TensionOpensItAsASheetOnALayerWould)
{
  constexpr double length = 160e-3, width = 4e-3, skin = 2e-3, below = 4e-3, young = 100e3, soft = 2.6e3, ratio = 0.3;
  constexpr double stress = 2e3;
  const std::string file = folder() / "cut.obj";
  TriangleMesh cut;
  for (const double y : { -1e-3, 5e-3 })
    for (const double z : { 0.5 * below, 8e-3 })  // deeper than the skin, whose lower nodes would stay joined
      cut.vertices.push_back({ 0.5 * length, y, z });
  cut.triangles = { { 0, 2, 1 }, { 1, 2, 3 } };
  write_obj(cut, file, [](const auto&) { return true; });
  Scene scene = plain_scene(2e-3);
  scene.accuracy.assumed_strain = true;
  const double middle = 0.5 * length, y = 0.5 * width, height = skin + below;
  scene.surfaces = { box_surface("block", { middle, y, 0.5 * height }, { length, width, height }),
                     box_surface("upper", { middle, y, below + skin }, { 2 * length, 2 * width, 2 * skin }),
                     box_surface("floor", { middle, y, -1e-3 }, { 2 * length, 60e-3, 2e-3 }),
                     box_surface("left", { -1e-3, y, 0 }, { 2e-3, 60e-3, 60e-3 }),
                     box_surface("right", { length + 1e-3, y, 0 }, { 2e-3, 60e-3, 60e-3 }),
                     file_surface("cut", file) };
  for (const auto& [name, modulus] : { std::pair{ "skin", young }, std::pair{ "soft", soft } })
  {
    scene.materials.push_back(material(name, modulus));
    scene.materials.back().parameters["poisson"] = ratio;
  }
  scene.volumes = { volume_inside("tissue", { "block" }, "soft", true),
                    volume_inside("skin", { "upper" }, "skin", false, 1) };
  scene.constraints = { held("floor", ""), held("left", ""), held("right", "") };
  for (SceneConstraint& constraint : scene.constraints)
    constraint.within = 0.2e-3;
  SceneMuscle tension;
  tension.name = tension.volume = "skin";
  tension.fibre = { 1, 0, 0 };
  tension.stress_reference = stress;
  tension.tension_length = false;
  tension.tone = 1;
  scene.muscles = { tension };
  scene.skin.surface = "block";
  for (const double x : { middle - 0.01e-3, middle + 0.01e-3 })
    scene.landmarks.push_back({ x < middle ? "left" : "right", { x, y, height } });

  const double stretching = young * skin, shear = soft / (2 * (1 + ratio)) / below;
  const double end = std::tanh(middle * std::sqrt(shear / stretching));  // the far ends are held
  const double expected = 2 * stress * skin / std::sqrt(stretching * shear) * end;
  for (const bool cuts : { false, true })
  {
    scene.volumes[0].slits = cuts ? std::vector<std::string>{ "cut" } : std::vector<std::string>{};
    const Model model = bake(scene);
    const auto solver = make_solver(std::make_shared<const Model>(model), { "cpu", 0, 0 });
    EXPECT_TRUE(solver->settle(rest_controls(model), 1e-3, 5).reached);
    SkinState skin_now;
    solver->skin(skin_now);
    double gape = 0, away = 0;
    for (std::size_t a = 0; a < 3; ++a)
      gape += std::pow(double(skin_now.landmarks[1][a] - skin_now.landmarks[0][a]), 2);
    gape = std::sqrt(gape);
    for (std::size_t v = 0; v < model.skin.vertices.size(); ++v)
      for (std::size_t a = 0; a < 3; ++a)
        away = std::max(away, std::abs(double(skin_now.vertices[v][a]) - model.skin.vertices[v][a]));
    if (cuts)
      EXPECT_NEAR(gape, expected, 0.15 * expected);
    else
      EXPECT_LT(away, 0.1e-3);
  }
}

}  // namespace
