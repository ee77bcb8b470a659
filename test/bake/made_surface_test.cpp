// Surfaces that are made from others or from curves: offsets by a table of depths, and muscles with their fibres.

#include "bake/mesh/surface.hpp"
#include "bake/shapes/muscle_net.hpp"

#include "frontalis/error.hpp"

#include "bake/scene_pieces.hpp"

#include <gtest/gtest.h>

namespace
{

using namespace frontalis;

Surface offset_surface(const Surface& above, const std::vector<Shape::Depth>& depths, double edge)
{
  Surface surface;
  surface.name = "deeper";
  surface.shape = Shape();
  surface.shape->kind = Shape::Kind::offset;
  surface.shape->below = std::make_shared<Surface>(above);
  surface.shape->depths = depths;
  surface.shape->edge = edge;
  return surface;
}

Surface muscle_surface(const std::vector<std::vector<Vector3>>& curves, double thickness, bool ring = false)
{
  Surface surface;
  surface.name = "strand";
  surface.shape = Shape();
  surface.shape->kind = Shape::Kind::muscle;
  surface.shape->curves = curves;
  surface.shape->thickness = thickness;
  surface.shape->ring = ring;
  surface.shape->edge = 1e-3;
  return surface;
}

double distance_at(const TriangleMesh& mesh, const Vector3d& p) { return TriangleTree(mesh).closest(p).distance; }

TEST(Offset, LiesAtTheDepthsOfItsTable)
{
  const Surface ball = sphere_surface("ball", { 0, 0, 0 }, 40e-3, 2e-3);
  const TriangleMesh even = load_surface(offset_surface(ball, { { { 50e-3, 0, 0 }, 10e-3 } }, 2e-3), 1e-3).mesh;
  EXPECT_TRUE(unbalanced_edges(even).empty());
  EXPECT_NEAR(signed_volume(even) / (4.0 / 3 * pi * 27e-6), 1, 0.02);

  const std::vector<Shape::Depth> depths{
    { { 40e-3, 0, 0 }, 4e-3 }, { { -40e-3, 0, 0 }, 12e-3 }, { { 0, 40e-3, 0 }, 8e-3 }, { { 0, -40e-3, 0 }, 8e-3 }
  };
  const TriangleMesh table = load_surface(offset_surface(ball, depths, 1.5e-3), 1e-3).mesh;
  for (const auto& site : depths)
    EXPECT_NEAR(distance_at(table, to_vector(site.at)), site.depth, 0.3e-3);
  // between its places the depth is between theirs, also above and below, where there is none
  for (const Vector3& v : table.vertices)
  {
    const double depth = 40e-3 - to_vector(v).norm();
    ASSERT_GT(depth, 3.8e-3);
    ASSERT_LT(depth, 12.2e-3);
  }
  EXPECT_NEAR(distance_at(table, { 0, 0, 40e-3 }), 8e-3, 1e-3);
}

TEST(Offset, RoundsWhatIsThinnerThanItsDepths)
{
  // nothing of a ridge 6 mm thick is 4 mm deep
  const Surface plate = box_surface("plate", { 0, 0, 0 }, { 40e-3, 40e-3, 6e-3 }, 2e-3);
  EXPECT_THROW(load_surface(offset_surface(plate, { { { 0, 0, 3e-3 }, 4e-3 } }, 1e-3), 1e-3), Error);
  // an offset box has sharp corners
  const Surface box = box_surface("box", { 0, 0, 0 }, { 40e-3, 30e-3, 20e-3 }, 5e-3);
  const TriangleMesh mesh = load_surface(offset_surface(box, { { { 0, 0, 10e-3 }, 3e-3 } }, 1e-3), 1e-3).mesh;
  EXPECT_NEAR(signed_volume(mesh) / (34e-3 * 24e-3 * 14e-3), 1, 0.02);
}

TEST(Offset, IsClosedWhereDepthsJump)
{
  // half-way between the two sides the depth jumps from 4 to 12 mm
  const Surface box = box_surface("box", { 0, 0, 0 }, { 40e-3, 40e-3, 16e-3 }, 2e-3);
  const std::vector<Shape::Depth> depths{ { { 0, 0, 8e-3 }, 4e-3 }, { { 0, 0, -8e-3 }, 12e-3 } };
  const TriangleMesh mesh = load_surface(offset_surface(box, depths, 0.5e-3), 1e-3).mesh;
  EXPECT_TRUE(unbalanced_edges(mesh).empty());
  EXPECT_GT(signed_volume(mesh), 0);
}

TEST(Offset, RefusesOpenSurfacesAndAPlaceWithTwoDepths)
{
  EXPECT_THROW(load_surface(offset_surface(forehead_surface("skin"), { { { 0, 0, 0 }, 1e-3 } }, 3e-3), 1e-3), Error);
  const Surface ball = sphere_surface("ball", { 0, 0, 0 }, 40e-3, 4e-3);
  const Vector3 place{ 40e-3, 0, 0 };
  EXPECT_THROW(load_surface(offset_surface(ball, { { place, 4e-3 }, { place, 5e-3 } }, 3e-3), 1e-3), Error);
}

TEST(CurvedMuscle, HasTheCrossSectionOfItsCurvesAndThickness)
{
  const Surface strap =
      muscle_surface({ { { 0, -5e-3, 0 }, { 0, 5e-3, 0 } }, { { 30e-3, -5e-3, 0 }, { 30e-3, 5e-3, 0 } } }, 4e-3);
  const TriangleMesh mesh = load_surface(strap, 1e-3).mesh;
  EXPECT_TRUE(unbalanced_edges(mesh).empty());
  // its mean thickness is 4 mm across, times the mean of 1 - 0.4 (2 u - 1)^4 along it, 0.92
  EXPECT_NEAR(signed_volume(mesh) / (30e-3 * 10e-3 * 4e-3 * 0.92), 1, 0.04);
  const NurbsVolume volume = volume_of(curved_muscle_net(*strap.shape));
  EXPECT_LT((volume.at({ 0, 0.5, 0.5 }).position - Vector3d(0, 0, 0)).norm(), 1e-6);
  EXPECT_LT((volume.at({ 1, 0.5, 0.5 }).position - Vector3d(30e-3, 0, 0)).norm(), 1e-6);
}

TEST(CurvedMuscle, IsAnOpenSheetWithoutAThickness)
{
  const std::vector<std::vector<Vector3>> curves{ { { 0, -5e-3, 0 }, { 0, 5e-3, 0 } },
                                                  { { 30e-3, -5e-3, 0 }, { 30e-3, 5e-3, 0 } } };
  const TriangleMesh mesh = load_surface(muscle_surface(curves, 0), 1e-3).mesh;
  EXPECT_FALSE(unbalanced_edges(mesh).empty());
  EXPECT_NEAR(surface_area(mesh), 30e-3 * 10e-3, 1e-8);
}

/// The model of a block of fat around a muscle made of curves.
Model baked_muscle(const Surface& surface)
{
  Scene scene = plain_scene(1.5e-3);
  scene.surfaces = { box_surface("block", { 0, 0, 0 }, { 60e-3, 60e-3, 12e-3 }), surface };
  scene.volumes = { volume_inside("tissue", { "block" }, "fat", true),
                    volume_inside("strand", { surface.name }, "muscle", false, 1) };
  SceneMuscle muscle;
  muscle.name = muscle.volume = "strand";
  scene.muscles = { muscle };
  scene.skin.surface = "block";
  return bake(scene);
}

/// Mean angle between the fibres of a model and the directions around the z axis, or out from it [degrees].
double mean_angle(const Model& model, bool around)
{
  RigidTransform turn = model.to_scene;
  turn.translation = { 0, 0, 0 };
  double sum = 0, weights = 0;
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
    for (auto m = static_cast<std::size_t>(model.fibre_begin[e]);
         m < static_cast<std::size_t>(model.fibre_begin[e + 1]); ++m)
    {
      Vector3 centre{};
      for (std::size_t a = 0; a < 3; ++a)
        centre[a] = (model.voxels[e][a] + 0.5) * model.spacing[a];
      const Vector3d p = to_vector(transformed(model.to_scene, centre));
      const auto& f = model.fibre_direction[m];
      const Vector3d fibre = to_vector(transformed(turn, { f[0], f[1], f[2] })).normalized();
      const Vector3d radial = Vector3d(p[0], p[1], 0).normalized();
      const Vector3d expected = around ? Vector3d(-radial[1], radial[0], 0) : radial;
      const auto weight = static_cast<double>(model.fibre_weight[m]);
      sum += weight * 180 / pi * std::acos(std::min(1.0, std::abs(fibre.dot(expected))));
      weights += weight;
    }
  EXPECT_GT(weights, 20);
  return sum / weights;
}

/// Points on the arc of that radius [m] in the plane z = 0, from one angle to another [degrees].
std::vector<Vector3> arc(double radius, double from, double to, int count)
{
  std::vector<Vector3> points;
  for (int i = 0; i < count; ++i)
  {
    const double angle = (from + (to - from) * i / (count - 1)) * pi / 180;
    points.push_back({ radius * std::cos(angle), radius * std::sin(angle), 0 });
  }
  return points;
}

TEST(CurvedMuscle, HasFibresFromCurveToCurve)
{
  // lines across a quarter of a ring, so that fibres run around the axis
  std::vector<std::vector<Vector3>> spokes;
  for (const double angle : { 0.0, 18.0, 36.0, 54.0, 72.0, 90.0 })
    spokes.push_back({ arc(16e-3, angle, angle, 2).front(), arc(24e-3, angle, angle, 2).front() });
  EXPECT_LT(mean_angle(baked_muscle(muscle_surface(spokes, 4e-3)), true), 3);
  // a fan, whose curves are arcs, so that fibres run outwards
  EXPECT_LT(mean_angle(baked_muscle(muscle_surface({ arc(6e-3, -30, 30, 5), arc(25e-3, -30, 30, 9) }, 4e-3)), false),
            3);
}

TEST(CurvedMuscle, HasFibresAlongTheLoopsOfARing)
{
  const Surface ring = muscle_surface({ arc(15e-3, 0, 330, 12), arc(24e-3, 0, 330, 12) }, 4e-3, true);
  EXPECT_TRUE(unbalanced_edges(load_surface(ring, 1e-3).mesh).empty());
  EXPECT_LT(mean_angle(baked_muscle(ring), true), 3);
}

}  // namespace
