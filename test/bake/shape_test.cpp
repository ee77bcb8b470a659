#include "bake/mesh/surface.hpp"

#include "frontalis/bake/forehead_shape.hpp"
#include "frontalis/error.hpp"

#include "bake/scene_pieces.hpp"
#include "files.hpp"

#include <gtest/gtest.h>

#include <cstdio>

namespace
{

using namespace frontalis;

TriangleMesh joined(TriangleMesh mesh)
{
  join_vertices(mesh);
  return mesh;
}

Shape cylinder(double radius, double length)
{
  Shape shape;
  shape.kind = Shape::Kind::cylinder;
  shape.axis = { 1, 2, 3 };
  shape.centre = { 5, 6, 7 };
  shape.radius = radius;
  shape.length = length;
  shape.edge = 0.05 * radius;
  return shape;
}

TEST(BuiltInShape, IsClosedOutwardAndOfTheRightVolume)
{
  const auto check = [](const Shape& shape, double volume, double tolerance)
  {
    const TriangleMesh mesh = joined(make_shape(shape));
    EXPECT_TRUE(unbalanced_edges(mesh).empty());
    TriangleMesh copy = mesh;
    EXPECT_EQ(make_orientation_consistent(copy), 0u);
    EXPECT_NEAR(signed_volume(mesh) / volume, 1, tolerance);
  };
  check(*box_surface("", { 1, 2, 3 }, { 1, 2, 3 }, 0.3).shape, 6, 1e-12);
  check(*sphere_surface("", { 1, 2, 3 }, 2, 0.1).shape, 4.0 / 3 * pi * 8, 3e-3);
  Shape ellipsoid = *box_surface("", { 0, 0, 0 }, { 1, 2, 3 }, 0.1).shape;
  ellipsoid.kind = Shape::Kind::ellipsoid;
  check(ellipsoid, 4.0 / 3 * pi * 6, 3e-3);
  check(cylinder(1, 3), pi * 3, 3e-3);
  Shape torus = cylinder(3, 0);
  torus.kind = Shape::Kind::torus;
  torus.minor_radius = 1;
  torus.edge = 0.1;
  check(torus, 2 * pi * pi * 3, 5e-3);
}

TEST(BuiltInShape, RefusesSizesThatMakeNoBody)
{
  EXPECT_THROW(make_shape(*box_surface("", { 0, 0, 0 }, { 1, 0, 1 }).shape), Error);
  EXPECT_THROW(make_shape(*sphere_surface("", { 0, 0, 0 }, 0).shape), Error);
  Shape torus = cylinder(1, 0);
  torus.kind = Shape::Kind::torus;
  torus.minor_radius = 2;
  EXPECT_THROW(make_shape(torus), Error);
}

class MeshFile : public testing::Test
{
protected:
  std::string fault(const std::string& file) const
  {
    try
    {
      import_mesh(file, 1);
    }
    catch (const Error& error)
    {
      return error.what();
    }
    return "";
  }
  TemporaryFolder folder_;
};

TEST_F(MeshFile, QuadsAreSplitAndUnitsApplied)
{
  const std::string file = folder_.write("quad.obj", "v 0 0 0\nv 2 0 0\nv 2 3 0\nv 0 3 0\nf 1 2 3 4\n");
  const TriangleMesh mesh = joined(import_mesh(file, 1e-3));
  EXPECT_EQ(mesh.triangles.size(), 2u);
  ASSERT_EQ(mesh.vertices.size(), 4u);
  EXPECT_NEAR(bounding_box(mesh).max()[1], 3e-3, 1e-9);
}

TEST_F(MeshFile, StlPlyAndObjGiveTheSameTriangle)
{
  const std::string obj = folder_.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const std::string stl =
      folder_.write("a.stl",
                    "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
                    "endloop\nendfacet\nendsolid a\n");
  const std::string ply =
      folder_.write("a.ply",
                    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                    "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
                    "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  for (const std::string& file : { obj, stl, ply })
  {
    const TriangleMesh mesh = joined(import_mesh(file, 1));
    ASSERT_EQ(mesh.triangles.size(), 1u) << file;
    const auto [a, b, c] = corners(mesh, mesh.triangles[0]);
    EXPECT_NEAR((b - a).cross(c - a)[2], 1, 1e-6) << file;
  }
}

TEST_F(MeshFile, BadFilesAreNamedWithTheReason)
{
  const std::string none = folder_ / "none.obj";
  EXPECT_NE(fault(none).find(none), std::string::npos);
  EXPECT_NE(fault(none).find("no such file"), std::string::npos);
  EXPECT_NE(fault(folder_.write("text.stl", "no mesh at all")).find("text.stl"), std::string::npos);
  const std::string lines = fault(folder_.write("lines.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n"));
  EXPECT_NE(lines.find("lines.obj"), std::string::npos);
  EXPECT_NE(lines.find("triangles"), std::string::npos);
  // a binary STL file whose first vertex is NaN
  std::string nan(84, '\0');
  nan[80] = 1;
  std::string triangle(50, '\0');
  const float corners[9] = { std::nanf(""), 0, 0, 1, 0, 0, 0, 1, 0 };
  std::copy_n(reinterpret_cast<const char*>(corners), 36, triangle.begin() + 12);
  const std::string what = fault(folder_.write("nan.stl", nan + triangle));
  EXPECT_NE(what.find("nan.stl"), std::string::npos);
  EXPECT_NE(what.find("finite"), std::string::npos) << what;
}

TEST_F(MeshFile, InsideOutAndMixedSurfacesAreTurnedAndReported)
{
  const auto write_box = [&](const std::string& name, bool inside_out, bool one_turned)
  {
    TriangleMesh mesh = joined(make_shape(*box_surface("", { 0, 0, 0 }, { 1, 1, 1 }, 0.5).shape));
    if (inside_out)
      flip(mesh);
    if (one_turned)
      std::swap(mesh.triangles[3][0], mesh.triangles[3][1]);
    std::string text;
    for (const Vector3& v : mesh.vertices)
      text += "v " + std::to_string(v[0]) + " " + std::to_string(v[1]) + " " + std::to_string(v[2]) + "\n";
    for (const Triangle& t : mesh.triangles)
      text += "f " + std::to_string(t[0] + 1) + " " + std::to_string(t[1] + 1) + " " + std::to_string(t[2] + 1) + "\n";
    return folder_.write(name, text);
  };
  Scene scene = plain_scene(0.1);
  scene.surfaces = { file_surface("good", write_box("good.obj", false, false)),
                     file_surface("turned", write_box("turned.obj", true, false)),
                     file_surface("mixed", write_box("mixed.obj", false, true)) };
  BakeReport report;
  const BakeProgress progress;
  BakeMonitor monitor(&report, progress);
  for (const auto& surface : prepare_surfaces(scene, monitor))
    EXPECT_NEAR(signed_volume(surface->mesh()), 1, 1e-6) << surface->name();
  const auto reported = [&](const std::string& name, const std::string& text)
  {
    for (const std::string& finding : report.findings)
      if (finding.find("'" + name + "'") != std::string::npos && finding.find(text) != std::string::npos)
        return true;
    return false;
  };
  EXPECT_FALSE(reported("good", "turned"));
  EXPECT_TRUE(reported("turned", "inside-out"));
  EXPECT_TRUE(reported("mixed", "1 triangle turned"));
}

TriangleMesh forehead(const std::string& part) { return joined(make_forehead(*forehead_surface(part).shape)); }

TEST(Forehead, ClosedPartsAreClosedAndOutward)
{
  for (const char* part :
       { "tissue", "frontalis_left", "frontalis_right", "corrugator_left", "corrugator_right", "procerus", "galea" })
  {
    TriangleMesh mesh = forehead(part);
    EXPECT_TRUE(unbalanced_edges(mesh).empty()) << part;
    EXPECT_EQ(make_orientation_consistent(mesh), 0u) << part;
    EXPECT_GT(signed_volume(mesh), 0) << part;
  }
  // the tissue covers about 110 cm2 and is 4 to 8 mm thick
  const double tissue = signed_volume(forehead("tissue"));
  EXPECT_GT(tissue, 45e-6);
  EXPECT_LT(tissue, 80e-6);
}

TEST(Forehead, HasTheStatedDimensions)
{
  const TriangleMesh skin = forehead("skin");
  const Box box = bounding_box(skin);
  EXPECT_NEAR(box.max()[2], 88e-3, 3e-3);  // hairline: brow height and forehead height over the sellion
  EXPECT_NEAR(box.min()[2], -3e-3, 1e-3);
  EXPECT_NEAR(box.max()[1], -box.min()[1], 1e-12);
  EXPECT_GT(box.max()[1], 60e-3);
  EXPECT_LT(box.max()[1], 75e-3);
  // the sellion is the origin, and the skin faces forwards
  const PreparedSurface surface("skin", skin);
  EXPECT_LT(surface.tree().closest({ 0, 0, 0 }).distance, 0.2e-3);
  double area_x = 0;
  for (const Triangle& t : skin.triangles)
  {
    const auto [a, b, c] = corners(skin, t);
    area_x += (b - a).cross(c - a)[0];
  }
  EXPECT_GT(area_x, 0.01);
  // the soft tissue is 8 mm thick at the brow and 4 mm at the hairline
  const PreparedSurface skull("skull", forehead("skull"));
  double thinnest = 1, thickest = 0;
  for (const Vector3& v : skin.vertices)
  {
    const ClosestPoint closest = skull.tree().closest(to_vector(v));
    EXPECT_GT(skull.signed_distance(to_vector(v), closest), 0);
    EXPECT_FALSE(skull.rim_within(closest.point, 1e-3));
    thinnest = std::min(thinnest, closest.distance);
    thickest = std::max(thickest, closest.distance);
  }
  EXPECT_NEAR(thinnest, 4.5e-3, 0.3e-3);
  EXPECT_NEAR(thickest, 8e-3, 0.3e-3);
}

TEST(Forehead, SkinIsEvenlyTriangulated)
{
  const TriangleMesh skin = forehead("skin");
  double shortest = 1, longest = 0;
  for (const Triangle& t : skin.triangles)
  {
    for (std::size_t c = 0; c < 3; ++c)
    {
      const double edge = (vertex(skin, t[c]) - vertex(skin, t[(c + 1) % 3])).norm();
      shortest = std::min(shortest, edge);
      longest = std::max(longest, edge);
    }
  }
  EXPECT_GT(shortest, 0.5e-3);
  EXPECT_LT(longest, 4.2e-3);
}

TEST(Forehead, MusclesLieBetweenSkinAndBone)
{
  const PreparedSurface tissue("tissue", forehead("tissue"));
  for (const char* part : { "frontalis_left", "frontalis_right", "corrugator_left", "corrugator_right", "procerus" })
  {
    const TriangleMesh mesh = forehead(part);
    std::size_t outside = 0;
    for (const Vector3& v : mesh.vertices)
      outside += tissue.tree().winding_number(to_vector(v)) < 0.5 ? 1 : 0;
    EXPECT_LT(static_cast<double>(outside), 0.25 * static_cast<double>(mesh.vertices.size())) << part;
  }
}

TEST(Forehead, LeftAndRightMirror)
{
  EXPECT_NEAR(signed_volume(forehead("frontalis_left")), signed_volume(forehead("frontalis_right")), 1e-12);
  EXPECT_GT(bounding_box(forehead("corrugator_left")).min()[1], 0);
  EXPECT_NEAR(bounding_box(forehead("corrugator_left")).max()[1], -bounding_box(forehead("corrugator_right")).min()[1],
              1e-12);
}

TEST(Forehead, UnknownPartsAndDimensionsAreListed)
{
  Shape shape = *forehead_surface("ear").shape;
  try
  {
    make_forehead(shape);
    FAIL();
  }
  catch (const Error& error)
  {
    EXPECT_NE(std::string(error.what()).find("frontalis_left"), std::string::npos);
  }
  shape.part = "skin";
  shape.dimensions = { { "hight", 0.07 } };
  try
  {
    make_forehead(shape);
    FAIL();
  }
  catch (const Error& error)
  {
    EXPECT_NE(std::string(error.what()).find("brow_thickness"), std::string::npos);
  }
}

}  // namespace
