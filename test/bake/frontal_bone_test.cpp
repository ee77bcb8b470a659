// Nodes that slide over a bone stay on level sets of a distance field, the distance from the side that faces tissue.

#include "bake/fibres/fibres.hpp"
#include "bake/mesh/surface.hpp"
#include "bake/voxels/model_stages.hpp"
#include "bake/voxels/tissue_sheet.hpp"
#include "frontalis/model/sample_field.hpp"
#include "frontalis/scene/read_scene.hpp"
#include "solver/contact/kept_level.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <string>

using namespace frontalis;
using Point = physics::Vec3<double>;

namespace
{

const std::string bone_file = std::string(FRONTALIS_SOURCE_DIRECTORY) + "/../shared/data/head/bones/frontal.stl";

// Builds a mesh from triangles given by their corners [mm]; equal vertices are merged.
class MeshBuilder
{
public:
  using Corner = std::array<float, 3>;

  void add(const std::array<Corner, 3>& corners)
  {
    std::array<std::int32_t, 3> triangle{};
    for (std::size_t c = 0; c < 3; ++c)
    {
      const Corner& v = corners[c];
      const auto entry = known_.emplace(v, static_cast<std::int32_t>(mesh.vertices.size()));
      if (entry.second)
        mesh.vertices.push_back({ { 1e-3 * v[0], 1e-3 * v[1], 1e-3 * v[2] } });
      triangle[c] = entry.first->second;
    }
    if (triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0])
      mesh.triangles.push_back(triangle);
  }

  TriangleMesh mesh;

private:
  std::map<Corner, std::int32_t> known_;
};

// Reads a binary STL file in millimetres.
TriangleMesh read_stl(const std::string& path)
{
  std::ifstream in(path, std::ios::binary);
  const std::string bytes{ std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>() };
  MeshBuilder builder;
  for (std::size_t at = 84; at + 50 <= bytes.size(); at += 50)
  {
    std::array<MeshBuilder::Corner, 3> corners{};
    std::memcpy(corners.data(), bytes.data() + at + 12, 36);
    builder.add(corners);
  }
  return builder.mesh;
}

// Distance of the outer or inner table of an artificial skull from its centre, along the unit vector d [mm].
double table_radius(const Point& d, bool outer)
{
  const double waves = std::sin(15 * d.x + 1) * std::sin(13 * d.y) * std::sin(14 * d.z + 2);
  // a ridge above each eye
  const double brow = std::hypot(70 * (d.z - 0.1) / 6, 70 * (std::abs(d.y) - 0.3) / 15);
  const double ridge = d.x > 0 ? 4 * std::exp(-brow * brow) : 0;
  return outer ? 70 + waves + ridge : 64 + 0.7 * std::sin(17 * d.x) * std::sin(16 * d.y + 1) * std::sin(12 * d.z);
}

// An artificial closed skull with an outer and an inner table, 4 to 10 mm apart, with brow ridges and bumps and about
// as many triangles as the real bone. Its vertices are those of squares on a cube's faces, moved onto the tables.
TriangleMesh made_bone()
{
  constexpr int squares = 38;
  MeshBuilder builder;
  for (int face = 0; face < 12; ++face)
  {
    const int axis = face % 3;
    const double side = face / 3 % 2 == 0 ? 1 : -1;
    const bool outer = face < 6;
    const auto at = [&](int i, int j)
    {
      const auto along = [](int k) {
        return k == squares ? 1 : k == 0 ? -1 : std::tan(std::atan(1.0) * (2.0 * k / squares - 1));
      };
      const double u = along(i), v = along(j);
      Point d = axis == 0 ? Point{ side, u, v } : axis == 1 ? Point{ v, side, u } : Point{ u, v, side };
      d = 1 / norm(d) * d;
      const Point p = table_radius(d, outer) * d;
      return MeshBuilder::Corner{ static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z) };
    };
    for (int i = 0; i < squares; ++i)
    {
      for (int j = 0; j < squares; ++j)
      {
        const auto a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
        // the normals point out of the bone
        const bool forward = (side > 0) == outer;
        builder.add(forward ? std::array<MeshBuilder::Corner, 3>{ a, b, c }
                            : std::array<MeshBuilder::Corner, 3>{ a, c, b });
        builder.add(forward ? std::array<MeshBuilder::Corner, 3>{ a, c, d }
                            : std::array<MeshBuilder::Corner, 3>{ a, d, c });
      }
    }
  }
  return builder.mesh;
}

Point point(const std::array<double, 3>& p) { return { p[0], p[1], p[2] }; }

// A bone under tissue, which lies at z of at least `lowest` [m]; `forward` points from the bone to the tissue.
struct CoveredBone
{
  PreparedSurfaces surfaces;
  LocalFrame frame;
  Model model;

  CoveredBone(const TriangleMesh& mesh, const Vector3d& forward, double edge, double lowest = -1)
  {
    surfaces.push_back(std::make_unique<PreparedSurface>("bone", mesh));
    const PreparedSurface& bone = *surfaces[0];
    frame.origin = bone.box().min() - Vector3d::Constant(10e-3);
    model.spacing = { { edge, edge, edge } };
    for (int axis = 0; axis < 3; ++axis)
      model.size[axis] = static_cast<std::int32_t>((bone.box().sizes()[axis] + 20e-3) / edge);
    const auto is_tissue = [&](const Vector3d& p)
    {
      if (p[2] < lowest)
        return false;
      const ClosestPoint closest = bone.tree().closest(p);
      const double distance = bone.signed_distance(p, closest);
      // tissue begins half an edge below the surface, because voxels reach into the bone
      return distance > -0.5 * edge && distance < 5e-3 && bone.pseudonormal(closest).dot(forward) > 0.4 &&
             (closest.point - bone.box().center()).dot(forward) > 0;
    };
    for (std::int32_t k = 0; k < model.size[2]; ++k)
      for (std::int32_t j = 0; j < model.size[1]; ++j)
        for (std::int32_t i = 0; i < model.size[0]; ++i)
          if (is_tissue(frame.grid_point(model, i + 0.5, j + 0.5, k + 0.5)))
          {
            model.voxels.push_back({ { i, j, k } });
            model.fill.push_back(1);
          }
    build_nodes(model);
    Scene scene;
    SceneConstraint glide;
    glide.name = "glide";
    glide.kind = SceneConstraint::Kind::sliding;
    glide.surfaces = { "bone" };
    scene.constraints = { glide };
    BakeMonitor monitor(nullptr, progress);
    restrict_nodes(scene, surfaces, {}, frame, model, monitor);
  }

  PreparedSurface sheet() const { return { "sheet", tissue_sheet(*surfaces[0], 1, {}, frame, model) }; }
  const SampledField& field() const { return model.constraint_surfaces.at(0).field; }
  BakeProgress progress;
};

// A node that moves along a level set as in the solver, on a tangent plane for as long as the plane's slip allows.
struct Walker
{
  KeptLevel level;
  Point p, v{ 0, 0, 0 };
  physics::LevelPlane<double> plane{};
  double height = 0;
  Point reference{ 0, 0, 0 };

  void step(double dt)
  {
    p = p + dt * v;
    if (height == 0 || norm(p - reference) > plane.slip)
    {
      const Point from = plane.normal;
      ASSERT_TRUE(level.plane_at(p, plane));
      v = physics::turned_with_normal(from, plane.normal, v);
      height = dot(plane.normal, p) - plane.distance;
      reference = p;
    }
    physics::slide(plane.normal, height, p, v);
  }
};

// Checks that the field does not jump where the nearest point jumps from the rim of the sheet to another part: the
// field's gradient is about 1.
void check_slopes(const CoveredBone& bone)
{
  const physics::DistanceField field = view(bone.field());
  int steep = 0;
  for (const SlidingNode& node : bone.model.sliding)
  {
    physics::FieldValue<double> value{};
    ASSERT_TRUE(sample(field, field_point(field, point(rest_position(bone.model, node.node))), value));
    steep += norm(value.gradient) > 1.3 ? 1 : 0;
  }
  EXPECT_LE(steep, static_cast<int>(bone.model.sliding.size() / 1000));
}

void check_paths(const CoveredBone& bone)
{
  const Model& model = bone.model;
  const physics::DistanceField field = view(bone.field());
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  double most_turn = 0, most_loss = 0, most_off = 0;
  int sharpest = 0;
  std::size_t renewals = 0;
  for (int path = 0; path < 100; ++path)
  {
    const SlidingNode& node = model.sliding[random() % model.sliding.size()];
    Walker walker{ { &field, node.distance }, point(rest_position(model, node.node)) };
    walker.step(1);  // this step finds the first plane
    const Point& n = walker.plane.normal;
    const Point heading = cross(n, Point{ unit(random), unit(random), unit(random) });
    walker.v = 0.1 / norm(heading) * heading;
    // 10,000 steps of 5 us at 0.1 m/s are 5 mm
    for (int i = 0; i < 10000; ++i)
    {
      const Point reference = walker.reference;
      walker.step(5e-6);
      renewals += norm(reference - walker.reference) > 0 ? 1 : 0;
      if (i % 20 == 0)
      {
        physics::FieldValue<double> value{};
        ASSERT_TRUE(sample(field, field_point(field, walker.p), value));
        most_off = std::max(most_off, std::abs(value.value - node.distance));
      }
    }
    most_loss = std::max(most_loss, std::abs(dot(walker.v, walker.v) / 0.01 - 1));
    // largest angle by which the normal turns within a micrometre
    double turn = 0;
    Walker slow = walker;
    for (int i = 0; i < 5000; ++i)
    {
      physics::LevelPlane<double> before = slow.plane;
      ASSERT_TRUE(slow.level.plane_at(slow.p, before));
      slow.step(1e-6 / 0.1);
      physics::LevelPlane<double> after = slow.plane;
      ASSERT_TRUE(slow.level.plane_at(slow.p, after));
      turn = std::max(turn, std::atan2(norm(cross(before.normal, after.normal)), dot(before.normal, after.normal)));
    }
    sharpest += turn > 1 * pi / 180 ? 1 : 0;
    most_turn = std::max(most_turn, turn);
  }
  std::printf("largest turn in a micrometre %.3f degrees, energy %.2e, off the level %.2f um, %.4f renewals per step\n",
              most_turn * 180 / pi, most_loss, 1e6 * most_off, static_cast<double>(renewals) / 1e6);
  EXPECT_EQ(sharpest, 0);
  EXPECT_LT(most_loss, 1e-3);
  EXPECT_LT(most_off, 5e-6);
}

// Checks that levels of the field agree with the true distance from the sheet at points that nodes may reach.
void check_distances(const CoveredBone& bone)
{
  const Model& model = bone.model;
  const PreparedSurface sheet = bone.sheet();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<double> errors;
  double away = 0;
  while (errors.size() < 20000)
  {
    const SlidingNode& node = model.sliding[random() % model.sliding.size()];
    auto p = rest_position(model, node.node);
    for (double& x : p)
      x += 0.5 * model.spacing[0] * unit(random);
    const Vector3d at = bone.frame.to_scene(to_vector(p));
    const ClosestPoint closest = sheet.tree().closest(at);
    const double distance = sheet.signed_distance(at, closest);
    // nodes do not leave their level by more than this
    if (std::abs(distance - node.distance) > 0.3e-3)
      continue;
    const double level = level_at(bone.field(), p);
    if (std::isnan(level) && sheet.rim_within(closest.point, 1e-6))
      continue;
    ASSERT_FALSE(std::isnan(level)) << distance << " " << node.distance;
    errors.push_back(std::abs(level - distance));
    away += errors.back();
  }
  std::sort(errors.begin(), errors.end());
  std::printf("%zu nodes, field %.1f MB, levels off the distance by %.1f um, 99 %% %.0f, worst %.0f\n",
              model.sliding.size(), 4e-6 * static_cast<double>(bone.field().samples.size()),
              1e6 * away / static_cast<double>(errors.size()), 1e6 * errors[errors.size() * 99 / 100],
              1e6 * errors.back());
  EXPECT_EQ(bone.field().spacing, 0.5e-3);
  EXPECT_LT(errors[errors.size() * 99 / 100], 0.1e-3);
}

}  // namespace

TEST(FrontalBone, NodesKeepToTheOuterTableOfAMadeBone)
{
  const CoveredBone bone(made_bone(), { 1, 0, 0 }, 3e-3);
  EXPECT_GT(bone.model.sliding.size(), 1000U);
  // the sheet has no triangle of the inner table, and no node slides on it
  const PreparedSurface sheet = bone.sheet();
  EXPECT_GT(sheet.mesh().triangles.size(), 3000U);
  for (const auto& v : sheet.mesh().vertices)
  {
    const double radius = norm(point(v));
    EXPECT_NEAR(radius, 1e-3 * table_radius(1 / radius * point(v), true), 1e-5);
  }
  const physics::DistanceField field = view(bone.field());
  int inside = 0;
  for (const SlidingNode& node : bone.model.sliding)
  {
    const auto p = rest_position(bone.model, node.node);
    physics::LevelPlane<double> plane{};
    ASSERT_TRUE((KeptLevel{ &field, node.distance }.plane_at(point(p), plane)));
    EXPECT_NEAR(plane.distance, 0, 1e-12);
    EXPECT_GT(dot(plane.normal, point(to_array(bone.frame.to_scene(to_vector(p))))), 0);
    inside += node.distance < 0 ? 1 : 0;
  }
  EXPECT_GT(inside, 300);
  check_slopes(bone);
  check_distances(bone);
  check_paths(bone);
}

TEST(FrontalBone, NodesKeepToTheForeheadOfTheGeneratedHead)
{
  const Scene scene = read_scene(FRONTALIS_SOURCE_DIRECTORY "/config/head.yaml");
  const auto skull = std::find_if(scene.surfaces.begin(), scene.surfaces.end(),
                                  [](const Surface& surface) { return surface.name == "skull"; });
  ASSERT_NE(skull, scene.surfaces.end());
  // below the brows the tissue of this test would fill the orbits
  const CoveredBone bone(load_surface(*skull, scene.unit).mesh, { 1, 0, 0 }, 3e-3, 10e-3);
  EXPECT_GT(bone.model.sliding.size(), 500U);
  check_slopes(bone);
  check_distances(bone);
  check_paths(bone);
}

TEST(FrontalBone, NodesKeepToTheOuterTableOfARealBone)
{
  const TriangleMesh mesh = read_stl(bone_file);
  if (mesh.triangles.empty())
    GTEST_SKIP() << "skipped: the meshes of the head are not here";
  const CoveredBone bone(mesh, { 0, -1, 0 }, 3e-3);
  EXPECT_GT(bone.model.sliding.size(), 500U);
  check_slopes(bone);
  check_distances(bone);
  check_paths(bone);
}

TEST(TissueSheet, ClosedSpheresGetTheirClosedForm)
{
  MeshBuilder builder;
  constexpr int squares = 40;
  for (int i = 0; i < squares; ++i)
    for (int j = 0; j < 2 * squares; ++j)
    {
      const auto at = [](int a, int b)
      {
        const double polar = pi * a / squares, around = pi * b / squares;
        const auto turned = b == 2 * squares ? 0.0 : around;
        return MeshBuilder::Corner{ static_cast<float>(3 + 12 * std::sin(polar) * std::cos(turned)),
                                    static_cast<float>(12 * (a % squares == 0 ? 0 : std::sin(polar)) *
                                                       std::sin(turned)),
                                    static_cast<float>(12 * std::cos(polar)) };
      };
      builder.add({ at(i, j), at(i + 1, j), at(i + 1, j + 1) });
      builder.add({ at(i, j), at(i + 1, j + 1), at(i, j + 1) });
    }
  const CoveredBone eye(builder.mesh, { 0, 0, 1 }, 2e-3);
  EXPECT_TRUE(eye.surfaces[0]->closed());
  EXPECT_NEAR(eye.field().radius, 12e-3, 1e-6);
  EXPECT_TRUE(eye.field().samples.empty());
  ASSERT_FALSE(eye.model.sliding.empty());
  for (const SlidingNode& node : eye.model.sliding)
  {
    const Vector3d p = eye.frame.to_scene(to_vector(rest_position(eye.model, node.node)));
    EXPECT_NEAR(node.distance, (p - Vector3d(3e-3, 0, 0)).norm() - 12e-3, 1e-6);
  }
}
