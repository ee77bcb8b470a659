// Fibre fields compared with analytic ones of simple shapes, and the messages if no fibres can be found.

#include "bake/scene_pieces.hpp"
#include "files.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <functional>

namespace frontalis
{
namespace
{

using Map = std::function<Vector3(double, double, double)>;
using Field = std::function<Vector3(const Vector3&)>;

double dot(const Vector3& a, const Vector3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Writes the surface of the unit cube, mapped into space, in millimetres. Each edge of the cube has n facets.
std::string block_file(const std::string& name, int n, const Map& map)
{
  static const TemporaryFolder folder;
  std::string path = folder / name + ".obj";
  std::ofstream file(path);
  file.precision(12);
  int count = 0;
  for (int face = 0; face < 6; ++face)
  {
    const auto a = static_cast<std::size_t>(face / 2), b = (a + 1) % 3, c = (a + 2) % 3;
    for (int i = 0; i <= n; ++i)
      for (int j = 0; j <= n; ++j)
      {
        Vector3 p{};
        p[a] = face % 2;
        p[b] = static_cast<double>(i) / n;
        p[c] = static_cast<double>(j) / n;
        p = map(p[0], p[1], p[2]);
        file << "v " << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
      }
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
      {
        const int v = count + i * (n + 1) + j + 1, w = v + n + 1;
        if (face % 2 != 0)
          file << "f " << v << ' ' << w << ' ' << w + 1 << ' ' << v + 1 << '\n';
        else
          file << "f " << v << ' ' << v + 1 << ' ' << w + 1 << ' ' << w << '\n';
      }
    count += (n + 1) * (n + 1);
  }
  return path;
}

/// A scene whose tissue is a single muscle.
Scene muscle_scene(const Surface& surface, double voxel)
{
  Scene scene = plain_scene(voxel);
  scene.surfaces = { surface };
  scene.volumes = { volume_inside("tissue", { surface.name }, "fat", true),
                    volume_inside("strand", { surface.name }, "muscle", false, 1) };
  SceneMuscle muscle;
  muscle.name = "strand";
  muscle.volume = "strand";
  muscle.line = 7;
  scene.muscles = { muscle };
  scene.skin.surface = surface.name;
  return scene;
}

Vector3 voxel_centre(const Model& model, std::size_t e)
{
  Vector3 p{};
  for (std::size_t a = 0; a < 3; ++a)
    p[a] = (model.voxels[e][a] + 0.5) * model.spacing[a];
  return transformed(model.to_scene, p);
}

Vector3 scene_direction(const Model& model, std::size_t entry)
{
  RigidTransform turn = model.to_scene;
  turn.translation = { 0, 0, 0 };
  const auto& d = model.fibre_direction[entry];
  return transformed(turn, { d[0], d[1], d[2] });
}

struct Angles
{
  double mean = 0, most = 0;  ///< [degrees]
};

/// Angles between a model's fibres and a field at its voxels, regardless of sign.
Angles angles(const Model& model, const Field& field)
{
  Angles result;
  double weights = 0;
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    const auto entry = static_cast<std::size_t>(model.fibre_begin[e]);
    if (model.fibre_begin[e + 1] == model.fibre_begin[e])
      continue;
    const Vector3 expected = field(voxel_centre(model, e));
    const double cosine = std::abs(dot(scene_direction(model, entry), expected)) / std::sqrt(dot(expected, expected));
    const double angle = 180 / pi * std::acos(std::min(1.0, cosine));
    const double weight = static_cast<double>(model.fibre_weight[entry]) * static_cast<double>(model.fill[e]);
    result.mean += weight * angle;
    weights += weight;
    result.most = std::max(result.most, angle);
  }
  result.mean /= weights;
  return result;
}

void expect_near(const char* shape, const Model& model, const Field& field, double mean)
{
  const Angles found = angles(model, field);
  std::printf("%s: fibre error %.2f degrees on average, %.2f at most\n", shape, found.mean, found.most);
  EXPECT_LE(found.mean, mean) << shape;
}

Vector3 around_z(const Vector3& p) { return { -p[1], p[0], 0 }; }

Surface bent_cylinder()
{
  // a square section mapped to a disc
  return file_surface(
      "bent",
      block_file(
          "bent_cylinder", 40,
          [](double u, double v, double w)
          {
            const double angle = (u - 0.5) * 120 * pi / 180;
            const double x = 2 * v - 1, y = 2 * w - 1;
            const double radius = 30 + 5 * x * std::sqrt(1 - y * y / 2);
            return Vector3{ radius * std::cos(angle), radius * std::sin(angle), 5 * y * std::sqrt(1 - x * x / 2) };
          }),
      1e-3);
}

Surface fan(double half_angle)
{
  return file_surface("fan",
                      block_file("fan" + std::to_string(static_cast<int>(half_angle)), 40,
                                 [half_angle](double u, double v, double w)
                                 {
                                   const double angle = (2 * v - 1) * half_angle * pi / 180;
                                   const double radius = 10 + 30 * u;
                                   return Vector3{ radius * std::cos(angle), radius * std::sin(angle), 3 * w };
                                 }),
                      1e-3);
}

Surface torus()
{
  Surface surface;
  surface.name = "torus";
  surface.shape = Shape();
  surface.shape->kind = Shape::Kind::torus;
  surface.shape->radius = 20e-3;
  surface.shape->minor_radius = 5e-3;
  return surface;
}

TEST(Fibres, FollowABentCylinder)
{
  expect_near("bent cylinder", bake(muscle_scene(bent_cylinder(), 1e-3)), around_z, 5);
}

TEST(Fibres, SpreadInAFan)
{
  expect_near(
      "fan of 44 degrees", bake(muscle_scene(fan(22), 1e-3)),
      [](const Vector3& p) {
        return Vector3{ p[0], p[1], 0 };
      },
      5);
}

TEST(Fibres, GoAroundATorus) { expect_near("torus", bake(muscle_scene(torus(), 1e-3)), around_z, 5); }

TEST(Fibres, GoAroundATorusThatIsTilted)
{
  Surface surface = torus();
  surface.shape->axis = { 1, 2, 2 };
  surface.shape->centre = { 10e-3, -5e-3, 1.5 };
  expect_near(
      "tilted torus", bake(muscle_scene(surface, 1e-3)),
      [](const Vector3& p)
      {
        const Vector3 d{ p[0] - 10e-3, p[1] + 5e-3, p[2] - 1.5 };
        return Vector3{ 2 * d[1] - 2 * d[2], d[2] - 2 * d[0], 2 * d[0] - d[1] };
      },
      5);
}

TEST(Fibres, FollowStriationsAcrossTheLongWay)
{
  // a plate longer along y, with grooves along x on both its sides
  const std::string file = block_file("grooves", 160,
                                      [](double u, double v, double w)
                                      {
                                        const double groove = 0.25 * std::sin(2 * pi * 20 * v);
                                        return Vector3{ 30 * u, 36 * v, (w - 0.5) * (3 + 2 * groove) };
                                      });
  const auto along_x = [](const Vector3&) { return Vector3{ 1, 0, 0 }; };
  expect_near("grooved plate", bake(muscle_scene(file_surface("plate", file, 1e-3), 1.5e-3)), along_x, 5);
}

TEST(Fibres, RunFromOriginToInsertion)
{
  Scene scene = muscle_scene(box_surface("plate", { 0, 0, 0 }, { 24e-3, 40e-3, 4e-3 }), 1e-3);
  expect_near(
      "plate", bake(scene),
      [](const Vector3&) {
        return Vector3{ 0, 1, 0 };
      },
      5);
  scene.muscles[0].origin.points = { { -12e-3, -20e-3, 0 }, { -12e-3, 20e-3, 0 } };
  scene.surfaces.push_back(box_surface("bone", { 17e-3, 0, 0 }, { 10e-3, 60e-3, 10e-3 }));
  scene.muscles[0].insertion.surface = "bone";
  expect_near(
      "plate from line to surface", bake(scene),
      [](const Vector3&) {
        return Vector3{ 1, 0, 0 };
      },
      5);

  // this muscle is wider than long, so that its shape alone does not determine the direction
  scene = muscle_scene(fan(45), 1e-3);
  for (int k = -4; k <= 4; ++k)
  {
    const double angle = k * 45.0 / 4 * pi / 180;
    scene.muscles[0].origin.points.push_back({ 10e-3 * std::cos(angle), 10e-3 * std::sin(angle), 1.5e-3 });
    scene.muscles[0].insertion.points.push_back({ 40e-3 * std::cos(angle), 40e-3 * std::sin(angle), 1.5e-3 });
  }
  expect_near(
      "fan of 90 degrees between its ends", bake(scene),
      [](const Vector3& p) {
        return Vector3{ p[0], p[1], 0 };
      },
      5);
}

TEST(Fibres, FollowAControlNet)
{
  // a quarter of a circle is a rational quadratic curve
  Scene scene = muscle_scene(bent_cylinder(), 1e-3);
  ControlNet net;
  net.size = { 3, 2, 2 };
  for (const Vector3& corner : { Vector3{ 0, -1, 0 }, Vector3{ 1.4142135623730951, 0, 0 }, Vector3{ 0, 1, 0 } })
    for (const double radius : { 20e-3, 40e-3 })
      for (const double z : { -10e-3, 10e-3 })
      {
        // the cylinder is rotated so that its arc is symmetric to x
        const double x = corner[0] > 0 ? corner[0] : 0.7071067811865476;
        const double y = corner[0] > 0 ? 0 : 0.7071067811865476 * corner[1];
        net.points.push_back({ radius * x, radius * y, z });
        net.weights.push_back(corner[0] > 0 ? 0.7071067811865476 : 1);
      }
  scene.muscles[0].net = net;
  // points of the cylinder beyond the control net get the direction at the net's end
  const auto clamped = [](const Vector3& p)
  {
    const double angle = std::max(-pi / 4, std::min(pi / 4, std::atan2(p[1], p[0])));
    return Vector3{ -std::sin(angle), std::cos(angle), 0 };
  };
  expect_near("net of a quarter circle", bake(scene), clamped, 0.5);

  // a ring of cubic splines
  scene = muscle_scene(torus(), 1e-3);
  net = {};
  net.size = { 12, 2, 2 };
  net.ring = true;
  for (int k = 0; k < 12; ++k)
    for (const double radius : { 14e-3, 28e-3 })
      for (const double z : { -6e-3, 6e-3 })
        net.points.push_back({ radius * std::cos(k * pi / 6), radius * std::sin(k * pi / 6), z });
  scene.muscles[0].net = net;
  expect_near("closed net", bake(scene), around_z, 0.5);
}

TEST(Fibres, OfEveryMuscleInAVoxelAreKept)
{
  Scene scene = plain_scene(1e-3);
  scene.surfaces = { box_surface("tissue", { 0, 0, 0 }, { 44e-3, 44e-3, 12e-3 }),
                     box_surface("first", { 0, 0, 0 }, { 40e-3, 8e-3, 8e-3 }),
                     box_surface("second", { 0, 0, 2e-3 }, { 8e-3, 40e-3, 4e-3 }) };
  scene.volumes = { volume_inside("tissue", { "tissue" }, "fat", true),
                    volume_inside("first", { "first" }, "muscle", false, 1),
                    volume_inside("second", { "second" }, "muscle", false, 1) };
  scene.muscles.resize(2);
  scene.muscles[0].name = scene.muscles[0].volume = "first";
  scene.muscles[1].name = scene.muscles[1].volume = "second";
  scene.skin.surface = "tissue";
  const Model model = bake(scene);
  int shared = 0;
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    const auto begin = static_cast<std::size_t>(model.fibre_begin[e]);
    const Vector3 p = voxel_centre(model, e);
    const bool in_first = std::abs(p[0]) < 20e-3 && std::abs(p[1]) < 4e-3 && std::abs(p[2]) < 4e-3;
    const bool in_second = std::abs(p[0]) < 4e-3 && std::abs(p[1]) < 20e-3 && p[2] > 0 && p[2] < 4e-3;
    const auto count = static_cast<std::size_t>(model.fibre_begin[e + 1]) - begin;
    ASSERT_EQ(count, (in_first ? 1U : 0U) + (in_second ? 1U : 0U));
    if (count == 2)
    {
      ++shared;
      EXPECT_EQ(model.fibre_muscle[begin], 0);
      EXPECT_EQ(model.fibre_muscle[begin + 1], 1);
      EXPECT_NEAR(model.fibre_weight[begin], 1, 1e-6);
      EXPECT_NEAR(model.fibre_weight[begin + 1], 1, 1e-6);
      EXPECT_GT(std::abs(scene_direction(model, begin)[0]), 0.98);
      EXPECT_GT(std::abs(scene_direction(model, begin + 1)[1]), 0.98);
    }
  }
  EXPECT_EQ(shared, 8 * 8 * 4);
}

TEST(Fibres, AreTheSameEachTime)
{
  const Scene scene = muscle_scene(fan(22), 2e-3);
  EXPECT_EQ(bake(scene).fibre_direction, bake(scene).fibre_direction);
}

TEST(Fibres, ReportHowWellTheirVolumeFits)
{
  BakeReport report;
  bake(muscle_scene(torus(), 2e-3), &report);
  std::string found;
  for (const std::string& finding : report.findings)
    if (finding.find("NURBS") != std::string::npos)
      found = finding;
  double length = 0, across = 0, volume = 0, mesh = 0, enclosed = 0, distance = 0;
  ASSERT_EQ(std::sscanf(found.c_str(),
                        "muscle 'strand': fibres in rings, on average %lf mm long, %lf mm across; NURBS volume %lf cm3 "
                        "beside %lf cm3 of its surface, of which it encloses %lf %%; rms distance %lf mm",
                        &length, &across, &volume, &mesh, &enclosed, &distance),
            6)
      << found;
  EXPECT_NEAR(length, 2 * pi * 20, 8);
  EXPECT_NEAR(volume, 2 * pi * pi * 20 * 25 / 1000, 0.05 * volume);
  EXPECT_NEAR(volume, mesh, 0.05 * mesh);
  EXPECT_GE(enclosed, 95);
  EXPECT_LE(distance, 0.2);
}

TEST(Fibres, ThatCannotBeFoundAreToldWithWhatToGive)
{
  const auto expect_fault = [](const Scene& scene, const std::string& text)
  {
    const std::string fault = fault_of(scene);
    EXPECT_EQ(fault.find("test.yaml:7: muscle 'strand': "), 0U) << fault;
    EXPECT_NE(fault.find(text), std::string::npos) << fault;
  };
  expect_fault(muscle_scene(box_surface("cube", { 0, 0, 0 }, { 20e-3, 20e-3, 20e-3 }), 2e-3),
               "times as long as wide; give 'origin' and 'insertion'");

  Scene scene = muscle_scene(box_surface("one", { 0, 0, 0 }, { 30e-3, 6e-3, 6e-3 }), 2e-3);
  scene.surfaces.push_back(box_surface("two", { 0, 40e-3, 0 }, { 30e-3, 6e-3, 6e-3 }));
  scene.volumes[0].inside = scene.volumes[1].inside = { "one", "two" };
  expect_fault(scene, "it is in pieces, the largest of which is 50 % of it");

  scene = muscle_scene(box_surface("bar", { 0, 0, 0 }, { 30e-3, 10e-3, 10e-3 }), 2e-3);
  scene.volumes[1].inside.clear();
  scene.volumes[1].within = "bar";
  scene.volumes[1].depth_max = 3e-3;
  expect_fault(scene, "bounded by depth alone; give 'origin'");

  scene = muscle_scene(box_surface("bar", { 0, 0, 0 }, { 30e-3, 10e-3, 10e-3 }), 2e-3);
  scene.muscles[0].ring = true;
  expect_fault(scene, "no hole through its middle");

  scene.muscles[0].ring.reset();
  scene.muscles[0].origin.points = { { -15e-3, 0, 0 } };
  scene.muscles[0].insertion.points = { { 0.5, 0, 0 } };
  expect_fault(scene, "insertion is 48");
  scene.muscles[0].insertion.points = { { -15e-3, 1e-3, 0 } };
  expect_fault(scene, "at the same place");
  scene.muscles[0].insertion = { "nowhere", {} };
  expect_fault(scene, "insertion: there is no surface 'nowhere'");

  scene.muscles[0].origin = scene.muscles[0].insertion = {};
  scene.muscles[0].net = ControlNet{ { 2, 2, 2 }, false, std::vector<Vector3>(8, Vector3{ 0, 0, 0 }), {} };
  expect_fault(scene, "no direction at");
}

}  // namespace
}  // namespace frontalis
