#include "scene_pieces.hpp"

#include "frontalis/bake/bake.hpp"
#include "frontalis/physics/materials/lookup.hpp"

#include <gtest/gtest.h>

using namespace frontalis;

namespace
{

// a block of one material
Model bake_material(const SceneMaterial& material, double bulk_modulus_max = 0)
{
  Scene scene;
  Surface block;
  block.name = "block";
  block.shape = Shape{};
  block.shape->size = { 8e-3, 6e-3, 4e-3 };
  scene.surfaces.push_back(block);
  Volume tissue;
  tissue.name = "tissue";
  tissue.inside = { "block" };
  tissue.material = material.name;
  tissue.tissue = true;
  scene.volumes.push_back(tissue);
  scene.materials.push_back(material);
  scene.skin.surface = "block";
  scene.accuracy.voxel = { 1e-3, 1e-3, 1e-3 };
  scene.accuracy.assumed_strain = true;
  scene.accuracy.bulk_modulus_max = bulk_modulus_max;
  return bake(scene);
}

SceneMaterial of_law(const std::string& law, const std::map<std::string, double>& parameters)
{
  SceneMaterial material;
  material.name = "stuff";
  material.law = law;
  material.density = 1000;
  material.parameters = parameters;
  material.parameters["poisson"] = 0.45;
  return material;
}

// bulk modulus for a shear modulus at a Poisson ratio of 0.45
double bulk(double shear) { return shear * 2 * 1.45 / (3 * 0.1); }

}  // namespace

TEST(Materials, EveryLawArrivesWithItsBulkModulus)
{
  for (const auto& description : physics::material_table)
  {
    std::map<std::string, double> given;
    for (const auto& parameter : description)
      given[parameter.key] = parameter.example;
    const Material material = bake_material(of_law(description.name, given)).materials[0];
    ASSERT_EQ(physics::description_of(material.law).name, description.name);
    const auto expected = physics::example_of(material.law, 0.45);
    for (int slot = 0; slot < physics::first_direction; ++slot)
      EXPECT_EQ(material.parameters[slot], expected[slot]) << description.name;
    EXPECT_NEAR(material.parameters[1], bulk(physics::shear_modulus_of(material.law, expected)), 1e-6);
  }

  const Model rubber = bake_material(of_law("mooney_rivlin", { { "c1", 4e3 }, { "c2", 1e3 } }));
  EXPECT_EQ(rubber.materials[0].law, law_of<physics::MooneyRivlin>);
  EXPECT_NEAR(rubber.materials[0].parameters[1], bulk(10e3), 1e-6);
  EXPECT_EQ(rubber.materials[0].parameters[2], 1e3);
  EXPECT_EQ(rubber.hourglass, HourglassControl::assumed_strain);

  const Model ogden =
      bake_material(of_law("ogden", { { "mu1", 6e3 }, { "alpha1", 2.5 }, { "mu2", -2e3 }, { "alpha2", -2 } }));
  EXPECT_EQ(ogden.materials[0].law, law_of<physics::Ogden>);
  EXPECT_NEAR(ogden.materials[0].parameters[1], bulk(0.5 * (15e3 + 4e3)), 1e-6);
  EXPECT_EQ(ogden.materials[0].parameters[4], -2);

  const Model fung = bake_material(of_law("fung", { { "shear", 8e3 }, { "b", 1.5 } }));
  EXPECT_EQ(fung.materials[0].law, law_of<physics::FungExponential>);
  EXPECT_NEAR(fung.materials[0].parameters[1], bulk(8e3), 1e-6);

  const Model heart = bake_material(of_law("guccione", { { "c", 2e3 }, { "bf", 8 }, { "bt", 2 }, { "bfs", 4 } }));
  EXPECT_EQ(heart.materials[0].law, law_of<physics::Guccione>);
  EXPECT_NEAR(heart.materials[0].parameters[1], bulk(8e3), 1e-6);
  EXPECT_EQ(heart.materials[0].parameters[4], 4);
}

TEST(Materials, BulkModuliAreLimited)
{
  SceneMaterial material = of_law("neo_hookean", { { "young", 60e3 } });
  material.parameters["poisson"] = 0.49;
  const auto bulk = [&](double limit)
  {
    const Material baked = bake_material(material, limit).materials.at(0);
    EXPECT_NEAR(physics::shear_modulus_of(baked.law, baked.parameters), 60e3 / 2.98, 1) << "it stays";
    return baked.parameters[physics::bulk_modulus_slot];
  };
  EXPECT_NEAR(bulk(0), 1e6, 1);
  EXPECT_NEAR(bulk(2e6), 1e6, 1);
  EXPECT_NEAR(bulk(250e3), 250e3, 1);
  EXPECT_NEAR(bulk(1e3), 14.0 / 3 * 60e3 / 2.98, 1) << "that of Poisson's ratio 0.4";
}

TEST(Materials, FibreFamiliesTurnIntoLocalAxes)
{
  SceneMaterial skin = of_law("holzapfel", { { "shear", 5e3 }, { "k1", 6e3 }, { "k2", 0.8 }, { "dispersion", 0.1 } });
  skin.families = { { { 0.8, 0.6, 0 }, { 0, 0, 1 } } };
  const Model model = bake_material(skin);
  // transform directions back to the scene's axes
  for (std::size_t family = 0; family < 2; ++family)
    for (std::size_t row = 0; row < 3; ++row)
    {
      double x = 0;
      for (std::size_t column = 0; column < 3; ++column)
        x += model.to_scene.rotation[3 * row + column] * model.materials[0].parameters[5 + 3 * family + column];
      EXPECT_NEAR(x, skin.families[family][row], 1e-12);
    }
}

TEST(Materials, FibreFamiliesFollowASurface)
{
  Scene scene = plain_scene(1e-3);
  scene.surfaces = { sphere_surface("ball", { 0, 0, 0 }, 8e-3, 0.5e-3) };
  SceneMaterial skin = of_law("holzapfel", { { "shear", 5e3 }, { "k1", 6e3 }, { "k2", 0.8 }, { "dispersion", 0.1 } });
  skin.families = { { { 0, 0.8, 0.6 }, { 0, 0.8, -0.6 } } };
  skin.along = "ball";
  scene.materials = { skin };
  scene.volumes = { volume_inside("tissue", { "ball" }, "stuff", true) };
  scene.skin.surface = "ball";
  const Model model = bake(scene);
  ASSERT_EQ(model.material_directions.size(), model.voxels.size());
  double most_normal = 0;
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    Vector3 p{}, out{};
    for (std::size_t a = 0; a < 3; ++a)
      p[a] = (model.voxels[e][a] + 0.5) * model.spacing[a];
    out = transformed(model.to_scene, p);
    const double radius = std::sqrt(out[0] * out[0] + out[1] * out[1] + out[2] * out[2]);
    // near the centre the error from the mesh's facets dominates
    if (radius < 4e-3)
      continue;
    const auto& d = model.material_directions[e];
    double between = 0;
    for (std::size_t family = 0; family < 2; ++family)
    {
      double along = 0;
      for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 3; ++column)
          along += model.to_scene.rotation[3 * row + column] * double(d[3 * family + column]) * out[row] / radius;
      most_normal = std::max(most_normal, std::abs(along));
    }
    for (std::size_t a = 0; a < 3; ++a)
      between += double(d[a]) * double(d[3 + a]);
    EXPECT_NEAR(between, 0.28, 1e-5);
  }
  // the facets of edges of 0.5 mm cause errors of normals below this bound
  EXPECT_LT(most_normal, 0.07);
  // where the surface is normal to the plane of the given families, the model's directions equal the given ones
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    Vector3 p{};
    for (std::size_t a = 0; a < 3; ++a)
      p[a] = (model.voxels[e][a] + 0.5) * model.spacing[a];
    p = transformed(model.to_scene, p);
    if (p[0] < 6e-3 || std::abs(p[1]) > 0.6e-3 || std::abs(p[2]) > 0.6e-3)
      continue;
    const auto& d = model.material_directions[e];
    for (std::size_t row = 0; row < 3; ++row)
    {
      double x = 0;
      for (std::size_t column = 0; column < 3; ++column)
        x += model.to_scene.rotation[3 * row + column] * double(d[column]);
      EXPECT_NEAR(std::abs(x), std::abs(skin.families[0][row]), 0.15);
    }
  }
}

TEST(Materials, FibresNormalToTheSurfaceOfTheirFamiliesAreReported)
{
  Scene scene = plain_scene(1e-3);
  scene.surfaces = { box_surface("block", { 4e-3, 4e-3, 2e-3 }, { 8e-3, 8e-3, 4e-3 }) };
  scene.materials = { of_law("holzapfel", { { "shear", 5e3 }, { "k1", 6e3 }, { "k2", 0.8 }, { "dispersion", 0.1 } }) };
  scene.materials[0].name = "skin";
  scene.materials[0].about = "pull";
  scene.materials[0].along = "block";
  scene.volumes = { volume_inside("tissue", { "block" }, "skin", true) };
  SceneMuscle pull;
  pull.name = "pull";
  pull.volume = "tissue";
  scene.muscles = { pull };
  scene.skin.surface = "block";
  const auto finding = [&](const Vector3& fibre)
  {
    scene.muscles[0].fibre = fibre;
    BakeReport report;
    bake(scene, &report);
    for (const std::string& found : report.findings)
      if (found.find("are normal to surface 'block'") != std::string::npos)
        return found;
    return std::string();
  };
  const std::string found = finding({ 0, 0, 1 });
  EXPECT_EQ(found.find("material 'skin': in "), 0U) << found;
  EXPECT_NE(found.find(" voxels the fibres of muscle 'pull'"), std::string::npos) << found;
  EXPECT_EQ(finding(to_array(Vector3d(1, 1, 1).normalized())), "");
}

// A sphere whose pole is off the fibres of a muscle: its families lie on either side of the fibres, in the surface.
TEST(Materials, FibreFamiliesLieAboutTheFibresOfAMuscle)
{
  constexpr double angle = 0.6;
  Scene scene = plain_scene(1e-3);
  scene.surfaces = { sphere_surface("ball", { 0, 0, 0 }, 8e-3, 0.5e-3) };
  SceneMaterial skin = of_law("holzapfel", { { "shear", 5e3 }, { "k1", 6e3 }, { "k2", 0.8 }, { "dispersion", 0.1 } });
  skin.about = "pull";
  skin.angle = angle;
  skin.along = "ball";
  scene.materials = { skin };
  scene.volumes = { volume_inside("tissue", { "ball" }, "stuff", true) };
  SceneMuscle pull;
  pull.name = "pull";
  pull.volume = "tissue";
  pull.fibre = { 0, 1, 0 };
  scene.muscles = { pull };
  scene.skin.surface = "ball";
  const Model model = bake(scene);
  ASSERT_EQ(model.material_directions.size(), model.voxels.size());
  std::size_t checked = 0;
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    const auto& d = model.material_directions[e];
    Eigen::Matrix3d to_scene;
    Vector3 local{};
    for (int a = 0; a < 3; ++a)
    {
      local[a] = (model.voxels[e][a] + 0.5) * model.spacing[a];
      for (int b = 0; b < 3; ++b)
        to_scene(a, b) = model.to_scene.rotation[3 * a + b];
    }
    const Vector3d first = to_scene * Vector3d(d[0], d[1], d[2]), second = to_scene * Vector3d(d[3], d[4], d[5]);
    const Vector3d out = to_vector(transformed(model.to_scene, local)).normalized();
    EXPECT_NEAR(first.norm(), 1, 1e-6);
    EXPECT_NEAR(first.dot(second), std::cos(2 * angle), 1e-5);
    // the error of the facets' normals dominates near the centre, and near the poles there are hardly any fibres
    if (to_vector(transformed(model.to_scene, local)).norm() < 4e-3 || std::abs(out[1]) > 0.7)
      continue;
    const Vector3d middle = (first + second).normalized(), fibre = Vector3d(0, 1, 0) - out[1] * out;
    EXPECT_NEAR(middle.dot(fibre.normalized()), 1, 0.01);
    EXPECT_NEAR(middle.dot(out), 0, 0.07);
    ++checked;
  }
  EXPECT_GT(checked, 500u);
}
