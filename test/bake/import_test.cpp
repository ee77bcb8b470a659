// Import of meshes with faults that are repaired or reported. Meshes that are refused are in test/model/bad.

#include "bake/mesh/surface.hpp"
#include "bake/mesh/mesh_faults.hpp"
#include "bake/mesh/triangle_tree.hpp"

#include "frontalis/error.hpp"

#include "bake/scene_pieces.hpp"
#include "files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>

namespace
{

using namespace frontalis;

TriangleMesh sphere(const Vector3& centre, double radius)
{
  TriangleMesh mesh = make_shape(*sphere_surface("", centre, radius, 0.3 * radius).shape);
  join_vertices(mesh);
  return mesh;
}

TriangleMesh box(const Vector3& centre, const Vector3& size)
{
  TriangleMesh mesh = make_shape(*box_surface("", centre, size).shape);
  join_vertices(mesh);
  return mesh;
}

TriangleMesh together(TriangleMesh a, const TriangleMesh& b)
{
  const auto base = static_cast<std::int32_t>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const Triangle& t : b.triangles)
    a.triangles.push_back({ base + t[0], base + t[1], base + t[2] });
  return a;
}

class Import : public testing::Test
{
protected:
  /// Writes the mesh with coordinates in millimetres and loads it.
  LoadedSurface load(const TriangleMesh& mesh) const
  {
    const std::string file = folder_ / "mesh.obj";
    std::ofstream out(file);
    char line[128];
    for (const Vector3& v : mesh.vertices)
    {
      std::snprintf(line, sizeof(line), "v %.9g %.9g %.9g\n", v[0], v[1], v[2]);
      out << line;
    }
    for (const Triangle& t : mesh.triangles)
      out << "f " << t[0] + 1 << " " << t[1] + 1 << " " << t[2] + 1 << "\n";
    out.close();
    return load_surface(file_surface("body", file, 1e-3), 1e-3);
  }

  static bool told(const LoadedSurface& surface, const std::string& what)
  {
    for (const std::string& finding : surface.findings)
    {
      if (finding == "surface 'body': " + what)
        return true;
    }
    return false;
  }

  TemporaryFolder folder_;
};

TEST_F(Import, AGoodMeshHasNoFindings)
{
  const LoadedSurface surface = load(sphere({ 1, 2, 1500 }, 10));
  EXPECT_TRUE(surface.findings.empty()) << surface.findings.front();
  EXPECT_NEAR(signed_volume(surface.mesh) / (4.0 / 3 * pi * 1e-6), 1, 0.05);
}

TEST_F(Import, AnInsideOutSphereIsTurned)
{
  TriangleMesh mesh = sphere({ 0, 0, 0 }, 10);
  const double size = signed_volume(mesh);
  flip(mesh);
  const LoadedSurface surface = load(mesh);
  EXPECT_TRUE(told(surface, "was inside-out; turned"));
  EXPECT_NEAR(signed_volume(surface.mesh) / (1e-9 * size), 1, 1e-6);
}

TEST_F(Import, AnInsideOutPieceIsTurnedAndACavityIsNot)
{
  TriangleMesh inside_out = sphere({ 30, 0, 0 }, 10), cavity = sphere({ 0, 0, 0 }, 5);
  flip(inside_out);
  flip(cavity);
  const LoadedSurface surface = load(together(together(sphere({ 0, 0, 0 }, 10), cavity), inside_out));
  EXPECT_TRUE(told(surface, "1 piece inside-out; turned"));
  const double ball = signed_volume(sphere({ 0, 0, 0 }, 1));
  EXPECT_NEAR(1e9 * signed_volume(surface.mesh) / (ball * (1000 - 125 + 1000)), 1, 0.02);
}

TEST_F(Import, AnInsideOutPieceBesideAnOpenOneIsTurnedAndAnInnerWallIsNot)
{
  TriangleMesh outer = sphere({ 0, 0, 0 }, 10), wall = sphere({ 0, 0, 0 }, 8), other = sphere({ 30, 0, 0 }, 10);
  const auto open = [](TriangleMesh& mesh)
  {
    mesh.triangles.erase(std::remove_if(mesh.triangles.begin(), mesh.triangles.end(),
                                        [&](const Triangle& t) { return mesh.vertices[t[0]][2] < -7; }),
                         mesh.triangles.end());
  };
  open(outer);
  open(wall);
  flip(wall);
  flip(other);
  for (const bool closed : { true, false })
  {
    if (!closed)
      open(other);
    const LoadedSurface surface = load(together(together(outer, wall), other));
    EXPECT_TRUE(told(surface, "1 piece inside-out; turned"));
    const TriangleTree tree(surface.mesh);
    EXPECT_NEAR(tree.winding_number({ 0, 0, 5e-3 }), 0, 0.1) << "in the cavity";
    EXPECT_NEAR(tree.winding_number({ 0, 0, 9e-3 }), 1, 0.1) << "between the walls";
    EXPECT_NEAR(tree.winding_number({ 30e-3, 0, 5e-3 }), 1, 0.1) << "in the other piece";
  }
}

TEST_F(Import, HalvesOfAnyFormatAreMirrored)
{
  const std::string file = folder_ / "half.stl";
  std::ofstream out(file);
  out << "solid half\n";
  const TriangleMesh half = box({ 5, 0, 0 }, { 10, 10, 10 });
  // coordinates of files are rounded
  TriangleMesh rounded = half;
  for (Vector3& v : rounded.vertices)
    v[0] += v[0] == 0 ? 2e-5 : 0;
  for (const Triangle& t : half.triangles)
  {
    if (half.vertices[t[0]][0] == 0 && half.vertices[t[1]][0] == 0 && half.vertices[t[2]][0] == 0)
      continue;
    out << "facet normal 0 0 0\nouter loop\n";
    for (const std::int32_t v : t)
      out << "vertex " << rounded.vertices[v][0] << " " << rounded.vertices[v][1] << " " << rounded.vertices[v][2]
          << "\n";
    out << "endloop\nendfacet\n";
  }
  out << "endsolid half\n";
  out.close();
  Surface surface = file_surface("body", file, 1e-3);
  surface.mirror = 0;
  EXPECT_NEAR(signed_volume(load_surface(surface, 1e-3).mesh), 2e-6, 1e-12);
}

TEST_F(Import, TrianglesThatDisagreeAreTurned)
{
  TriangleMesh mesh = box({ 0, 0, 0 }, { 10, 10, 10 });
  std::swap(mesh.triangles[3][0], mesh.triangles[3][1]);
  const LoadedSurface surface = load(mesh);
  EXPECT_TRUE(told(surface, "1 triangle turned to agree with its neighbours"));
  EXPECT_NEAR(signed_volume(surface.mesh), 1e-6, 1e-12);
}

TEST_F(Import, RepeatedCollapsedAndBackToBackTrianglesAreLeftOut)
{
  TriangleMesh mesh = box({ 0, 0, 0 }, { 10, 10, 10 });
  const std::size_t triangles = mesh.triangles.size();
  mesh.vertices.insert(mesh.vertices.end(), { { 20, 0, 0 }, { 30, 0, 0 }, { 20, 10, 0 } });
  const auto last = static_cast<std::int32_t>(mesh.vertices.size());
  mesh.triangles.push_back({ 0, 1, 1 });
  mesh.triangles.push_back({ last - 3, last - 2, last - 1 });
  mesh.triangles.push_back({ last - 3, last - 1, last - 2 });
  const LoadedSurface surface = load(mesh);
  EXPECT_TRUE(told(surface, "1 pair of triangles back to back left out"));
  EXPECT_EQ(surface.mesh.triangles.size(), triangles);
  EXPECT_EQ(surface.mesh.vertices.size(), 8u);
  EXPECT_NEAR(signed_volume(surface.mesh), 1e-6, 1e-12);
}

TEST_F(Import, ColoursWeightsCommentsAndCarriageReturnsAreNoFaults)
{
  const TriangleMesh mesh = box({ 5, 5, 5 }, { 10, 10, 10 });
  for (const char* more : { "", " 1", " 0.5 0.25 1", "\r" })
  {
    const std::string file = folder_ / "mesh.obj";
    std::ofstream out(file);
    out << "# brow, left\nvn 0 0 1\n";
    for (const Vector3& v : mesh.vertices)
      out << "v\t" << v[0] << "  " << v[1] << " " << v[2] << more << "\n";
    for (const Triangle& t : mesh.triangles)
      out << "f " << t[0] + 1 << " " << t[1] + 1 << " " << t[2] + 1 << "\n";
    out.close();
    EXPECT_NEAR(signed_volume(load_surface(file_surface("body", file, 1e-3), 1e-3).mesh), 1e-6, 1e-12) << more;
  }
}

TEST_F(Import, SmallPiecesApartAreTold)
{
  const TriangleMesh body = box({ 0, 0, 0 }, { 40, 40, 40 });
  EXPECT_TRUE(load(together(body, box({ 0, 0, 24 }, { 3, 3, 3 }))).warnings.empty());
  EXPECT_TRUE(load(together(body, box({ 0, 0, 90 }, { 20, 20, 20 }))).warnings.empty());
  EXPECT_EQ(load(together(body, box({ 0, 0, 0 }, { 3, 3, 3 }))).warnings.size(), 1u) << "it is enclosed twice";
  TriangleMesh many = box({ 0, 0, 0 }, { 1, 1, 1 });
  for (int i = 1; i < 150; ++i)
    many = together(many, box({ 3.0 * i, 0, 0 }, { 1, 1, 1 }));
  EXPECT_TRUE(load(many).warnings.empty());
  const auto warnings = load(together(body, box({ 0, 0, 90 }, { 3, 3, 3 }))).warnings;
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].find("surface 'body' has 1 piece of less than a hundredth of its area apart from the others or "
                             "inside of them, at (0, 0, 90) mm"),
            0u)
      << warnings[0];
}

TEST_F(Import, SpikesAreTold)
{
  TriangleMesh mesh = sphere({ 0, 0, 0 }, 10);
  EXPECT_TRUE(load(mesh).warnings.empty());
  // a cone whose tip is no farther from its base than twice the base's width is no fault
  for (double& coordinate : mesh.vertices[7])
    coordinate *= 1.6;
  EXPECT_TRUE(load(mesh).warnings.empty());
  for (double& coordinate : mesh.vertices[7])
    coordinate *= 5;
  const auto warnings = load(mesh).warnings;
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].find("surface 'body' has 1 spike, the highest by "), 0u) << warnings[0];
  EXPECT_NE(warnings[0].find(" mm: remove such vertices"), std::string::npos) << warnings[0];
}

TEST_F(Import, AnOpenSurfaceThatIsGivenTwiceKeepsItsBorder)
{
  TriangleMesh mesh = box({ 5, 5, 5 }, { 10, 10, 10 });
  std::vector<bool> keep(mesh.triangles.size(), true);
  keep[0] = false;
  mesh = keep_triangles(mesh, keep);
  const std::size_t triangles = mesh.triangles.size();
  const LoadedSurface surface = load(together(mesh, mesh));
  EXPECT_EQ(surface.mesh.triangles.size(), triangles);
  const auto holes = find_holes(surface.mesh);
  ASSERT_EQ(holes.size(), 1u);
  EXPECT_NEAR(holes[0].length, (20 + std::sqrt(200.0)) * 1e-3, 1e-9);
}

TEST_F(Import, ATriangleWithoutAreaGivesItsCornerToItsNeighbour)
{
  // the midpoint of an edge is a vertex of only one of its two triangles, and a triangle without area fills the crack
  TriangleMesh mesh = box({ 5, 5, 5 }, { 10, 10, 10 });
  const Triangle split = mesh.triangles[0];
  const auto middle = static_cast<std::int32_t>(mesh.vertices.size());
  const Vector3d a = vertex(mesh, split[0]), b = vertex(mesh, split[1]);
  mesh.vertices.push_back(to_array(0.5 * (a + b)));
  mesh.triangles[0] = { split[0], middle, split[2] };
  mesh.triangles.push_back({ middle, split[1], split[2] });
  mesh.triangles.push_back({ split[0], split[1], middle });
  const std::size_t triangles = mesh.triangles.size();
  const LoadedSurface surface = load(mesh);
  EXPECT_TRUE(told(surface, "1 triangle without area left out"));
  EXPECT_EQ(surface.mesh.triangles.size(), triangles);  // one triangle is removed, and its neighbour is split in two
  EXPECT_TRUE(unbalanced_edges(surface.mesh).empty());
  EXPECT_EQ(find_mesh_faults(surface.mesh).flat.count, 0u);
  EXPECT_NEAR(signed_volume(surface.mesh), 1e-6, 1e-12);
}

TEST_F(Import, HolesAreDataAndMeasured)
{
  TriangleMesh mesh = box({ 5, 5, 5 }, { 10, 10, 10 });
  // leave out the upper side
  std::vector<bool> keep;
  for (const Triangle& t : mesh.triangles)
  {
    double lowest = 1e9;
    for (const std::int32_t v : t)
      lowest = std::min(lowest, mesh.vertices[v][2]);
    keep.push_back(lowest < 9);
  }
  const LoadedSurface surface = load(keep_triangles(mesh, keep));
  EXPECT_TRUE(told(surface, "is open: 1 hole, the largest 40 mm around, at (5, 5, 10) mm"));
  const auto holes = find_holes(surface.mesh);
  ASSERT_EQ(holes.size(), 1u);
  EXPECT_NEAR(holes[0].length, 40e-3, 1e-9);
  EXPECT_NEAR(holes[0].centre[2], 10e-3, 1e-9);
}

TEST_F(Import, BodiesThatTouchAlongAnEdgeAreData)
{
  const LoadedSurface surface = load(together(box({ 5, 5, 5 }, { 10, 10, 10 }), box({ 15, 15, 5 }, { 10, 10, 10 })));
  EXPECT_TRUE(told(surface, "1 edge where bodies touch (non-manifold), at (10, 10, 5) mm"));
  EXPECT_NEAR(signed_volume(surface.mesh), 2e-6, 1e-12);
}

TEST_F(Import, ASmallCrossingIsDataAndALargeOneAnError)
{
  const LoadedSurface surface = load(together(sphere({ 0, 0, 0 }, 10), sphere({ 19.5, 0, 0 }, 10)));
  ASSERT_FALSE(surface.findings.empty());
  EXPECT_NE(surface.findings.back().find("pairs of triangles cross"), std::string::npos) << surface.findings.back();
  const TriangleMesh overlapping = together(sphere({ 0, 0, 0 }, 10), sphere({ 14, 0, 0 }, 10));
  const auto load_with_speck = [&] { load(together(overlapping, box({ 0, 0, 90 }, { 1, 1, 1 }))); };
  EXPECT_THAT(load_with_speck, testing::ThrowsMessage<Error>(testing::HasSubstr("less than a hundredth of its area")));
}

TEST_F(Import, HolesThatTouchAtACornerAreHoles)
{
  TriangleMesh mesh = sphere({ 0, 0, 0 }, 10);
  const auto corner = mesh.triangles.front()[0];
  std::vector<std::size_t> around;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (std::count(mesh.triangles[t].begin(), mesh.triangles[t].end(), corner) > 0)
      around.push_back(t);
  const auto touches = [&](std::size_t a, std::size_t b)
  {
    const auto& of_b = mesh.triangles[b];
    return std::count_if(mesh.triangles[a].begin(), mesh.triangles[a].end(),
                         [&](std::int32_t v) { return std::count(of_b.begin(), of_b.end(), v) > 0; }) == 1;
  };
  const auto other = std::find_if(around.begin(), around.end(), [&](auto t) { return touches(around.front(), t); });
  ASSERT_NE(other, around.end());
  mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(*other));
  mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(around.front()));
  const LoadedSurface surface = load(mesh);
  ASSERT_EQ(surface.findings.size(), 1u) << surface.findings.front();
  EXPECT_EQ(surface.findings[0].find("surface 'body': is open"), 0u) << surface.findings[0];
}

// The triangles of both cubes meet in common edges everywhere.
TEST_F(Import, CubesThatOverlapOnACommonGridAreAnError)
{
  const auto cube = [](double from)
  {
    TriangleMesh mesh;
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (int cell = 0; cell < 8; ++cell)
      {
        const double side = from + 20 * (cell / 4), u = from + 10 * (cell % 2), v = from + 10 * (cell / 2 % 2);
        const auto first = static_cast<std::int32_t>(mesh.vertices.size());
        for (const auto& [du, dv] : { std::pair<double, double>{ 0, 0 }, { 10, 0 }, { 10, 10 }, { 0, 10 } })
        {
          Vector3 p;
          p[axis] = side;
          p[(axis + 1) % 3] = u + du;
          p[(axis + 2) % 3] = v + dv;
          mesh.vertices.push_back(p);
        }
        const std::int32_t b = cell / 4 == 0 ? 3 : 1, d = 4 - b;
        mesh.triangles.push_back({ first, first + b, first + 2 });
        mesh.triangles.push_back({ first, first + 2, first + d });
      }
    join_vertices(mesh);
    return mesh;
  };
  EXPECT_NEAR(signed_volume(load(cube(0)).mesh), 8e-6, 1e-12);
  TriangleMesh both = together(cube(0), cube(10));
  join_vertices(both);
  EXPECT_THROW(load(both), Error);
}

TEST(MeshFaults, FoldsOverACommonCornerOrEdgeAreCrossings)
{
  // Copies of corners stand for those that the half-edge structure makes where holes touch.
  const auto crossings = [](const Triangle& second)
  {
    TriangleMesh mesh;
    mesh.vertices = { { 0, 0, 0 }, { 10, 0, 0 }, { 0, 10, 0 }, { 0, 0, 0 },   { 10, 0, 0 }, { 0, -10, 0 },
                      { 5, 5, 5 }, { 3, 3, -2 }, { 2, 2, 2 },  { 2, 8, 0.5 }, { 4, 1, 0 } };
    mesh.triangles = { { 0, 1, 2 }, second };
    return find_mesh_faults(mesh).crossings.count;
  };
  EXPECT_EQ(crossings({ 3, 5, 6 }), 0u) << "a common corner";
  EXPECT_EQ(crossings({ 3, 7, 8 }), 1u) << "a common corner, through the other triangle";
  EXPECT_EQ(crossings({ 3, 4, 5 }), 0u) << "a common edge in the same plane";
  EXPECT_EQ(crossings({ 3, 4, 6 }), 0u) << "a common edge";
  EXPECT_EQ(crossings({ 3, 4, 10 }), 1u) << "a common edge, over the other triangle";
}

TEST(MeshFaults, CountsSliversAndCrossings)
{
  // a long thin triangle, and one that passes through it
  TriangleMesh mesh;
  mesh.vertices = { { 0, 0, 0 }, { 100, 0, 0 }, { 50, 1, 0 }, { 50, 0.3, -5 }, { 51, 0.3, 5 }, { 49, 0.3, 5 } };
  mesh.triangles = { { 0, 1, 2 }, { 3, 4, 5 } };
  const MeshFaults faults = find_mesh_faults(mesh);
  EXPECT_EQ(faults.slivers.count, 1u);
  EXPECT_EQ(faults.crossings.count, 1u);
  EXPECT_EQ(faults.flat.count, 0u);
  EXPECT_EQ(faults.holes.size(), 2u);
  EXPECT_GT(faults.crossing_extent, 99);
  EXPECT_EQ(faults.piece.size(), 2u);
}

}  // namespace
