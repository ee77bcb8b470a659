// The parametric head of config/head/: its skin, dimensions, bones and muscles, and the subdivision that makes its
// skin.

#include "bake/mesh/surface.hpp"
#include "bake/shapes/head/head.hpp"
#include "bake/shapes/muscle_net.hpp"

#include "frontalis/error.hpp"
#include "frontalis/scene/read_scene.hpp"

#include "bake/scene_pieces.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <filesystem>
#include <fstream>

namespace
{

using namespace frontalis;

std::shared_ptr<const HeadTemplate> shipped()
{
  static const auto head = read_head_template(FRONTALIS_SOURCE_DIRECTORY "/config/head/head.yaml");
  return head;
}

const Head& default_head()
{
  static const Head head(shipped(), {});
  return head;
}

/// Largest distance [m] from `mesh` of the vertices of `image`, mirrored at y = 0.
double asymmetry(const TriangleMesh& mesh, const TriangleMesh& image)
{
  const TriangleTree tree(mesh);
  double worst = 0;
  for (const Vector3& p : image.vertices)
    worst = std::max(worst, tree.closest({ p[0], -p[1], p[2] }).distance);
  return worst;
}

TEST(Head, HasDimensionsWithinOneDeviationOfTheMeans)
{
  EXPECT_GE(shipped()->dimensions.size(), 25u);
  for (const auto& d : shipped()->dimensions)
    EXPECT_LE(std::abs(default_head().dimension(d.name) - d.mean), d.deviation) << d.name;
}

TEST(Head, TakesEachDimensionThatIsAskedFor)
{
  for (const auto& d : shipped()->dimensions)
  {
    if (!d.derived_from.empty())
      continue;
    for (const double side : { -1.0, 1.0 })
    {
      const double wanted = d.mean + side * d.deviation;
      SCOPED_TRACE(d.name);
      ASSERT_NO_THROW(EXPECT_NEAR(Head(shipped(), { { d.name, wanted } }).dimension(d.name), wanted, 1e-3));
    }
  }
}

TEST(Head, RefusesDimensionsThatFoldTheSkin)
{
  // lips that are higher than the place between nose and mouth
  try
  {
    Head(shipped(), { { "sn_sto", 13e-3 }, { "ls_sto", 13.1e-3 } });
    FAIL() << "the skin is folded";
  }
  catch (const Error& error)
  {
    EXPECT_NE(std::string(error.what()).find("'ls_sto' 13.1 mm, 'sn_sto' 13.0 mm fold the skin at ("),
              std::string::npos)
        << error.what();
  }
}

TEST(Head, TakesTheMeansOfEitherSex)
{
  for (const bool men : { true, false })
  {
    std::map<std::string, double> means;
    for (const auto& d : shipped()->dimensions)
      if (d.derived_from.empty())
        means[d.name] = men ? d.men : d.women;
    const Head head(shipped(), means);
    for (const auto& [name, mean] : means)
      EXPECT_NEAR(head.dimension(name), mean, 1e-3) << name;
  }
}

TEST(Head, HasTheDimensionsOfEachAge)
{
  ASSERT_EQ(shipped()->ages.size(), 3u);
  for (const auto& [age, changes] : shipped()->ages)
  {
    std::map<std::string, double> wanted;
    for (const auto& d : shipped()->dimensions)
      if (const auto change = changes.find(d.name); change != changes.end())
        wanted[d.name] = d.mean + change->second;
    const Head head(shipped(), wanted);
    for (const auto& [name, value] : wanted)
      EXPECT_NEAR(head.dimension(name), value, 1e-3) << age << ": " << name;
  }
}

TEST(Head, HasItsBonesDeeperBelowFullTissue)
{
  const PreparedSurface skin("skin", default_head().part("skin", 3e-3));
  for (const char* preset : { "lean", "average", "full" })
  {
    const HeadBones bones(*shipped(), skin.tree(), shipped()->tissues.at(preset));
    for (const auto& site : shipped()->depths)
      for (const char* name : { "frontal", "malar", "zygion", "mid_body", "mental_eminence" })
        if (site.name == name)
        {
          const ClosestPoint closest = skin.tree().closest(to_vector(site.at));
          const bool directed = to_vector(site.direction).norm() > 0;
          const Vector3d inward = directed ? to_vector(site.direction) : -skin.pseudonormal(closest);
          const double depth = (directed ? 1 : shipped()->tissues.at(preset)) * site.depth;
          EXPECT_NEAR(bones.hull(closest.point + depth * inward), 0, 1e-3) << preset << ": " << name;
        }
  }
}

TEST(Head, HasTheStandardLandmarksOnItsSkin)
{
  const TriangleMesh skin = default_head().part("face", 2e-3);
  const TriangleTree tree(skin);
  const auto& points = shipped()->points.at("ibug");
  ASSERT_EQ(points.size(), 68u);
  std::map<std::string, Vector3d> place;
  for (const auto& point : points)
  {
    place[point.name] = default_head().place(point);
    EXPECT_LT(tree.closest(place[point.name]).distance, 3e-4) << point.name;
    EXPECT_LT((place[point.name] - to_vector(point.at).cwiseProduct(Vector3d(1, point.right ? -1 : 1, 1))).norm(), 6e-3)
        << point.name;
  }
  // the 68 points run from the subject's right ear to the left one, with the chin in the midline
  ASSERT_EQ(place.size(), 68u);
  for (int n = 1; n < 17; ++n)
    EXPECT_LT(place.at(fmt::format("ibug_{}", n))[1], place.at(fmt::format("ibug_{}", n + 1))[1]);
  EXPECT_EQ(place.at("ibug_9")[1], 0);
}

TEST(Head, OpensItsJawDownAndForwards)
{
  const auto& joint = shipped()->joints.at("mandible");
  const double angle = 32 * pi / 180;
  const Vector3d at = to_vector(joint.at);
  const auto moved = [&](const Vector3d& p) -> Vector3d
  { return at + Eigen::AngleAxisd(angle, to_vector(joint.axis)) * (p - at) + angle * to_vector(joint.slide); };
  // full opening (Ferrario 2005, Travers 2000): incisors part by 46 to 56 mm, condyles move by 11.9 mm
  const Vector3d incisor(0, 0, -77e-3);
  EXPECT_NEAR((moved(incisor) - incisor).norm(), 51e-3, 10e-3);
  EXPECT_NEAR((moved(at) - at).norm(), 11.9e-3, 2e-3);
  EXPECT_LT(moved(incisor)[2], incisor[2] - 35e-3);
}

TEST(Head, HasItsLandmarksOnTheSkinAlsoWhenChanged)
{
  const Head head(shipped(), { { "zy_zy", 0.145 }, { "n_sn", 0.056 } });
  const TriangleMesh skin = head.part("skin", 2e-3);
  const TriangleTree tree(skin);
  for (const auto& [name, v] : shipped()->landmarks)
    EXPECT_LT(tree.closest(head.landmark(name)).distance, 2e-4) << name;
}

TEST(Head, RefusesDimensionsThatContradictEachOther)
{
  try
  {
    const Head head(shipped(), { { "n_gn", 0.105 } });
    FAIL();
  }
  catch (const Error& error)
  {
    const std::string text = error.what();
    EXPECT_NE(text.find("n_gn"), std::string::npos) << text;
    EXPECT_NE(text.find("n_sn"), std::string::npos) << text;
  }
  EXPECT_THROW(Head(shipped(), { { "nose", 0.05 } }), Error);
  EXPECT_THROW(Head(shipped(), { { "zy_zy", 0.25 } }), Error);
}

TEST(Head, IsClosedAndMirrorsItself)
{
  for (const char* part : { "skin", "skull", "mandible", "teeth_upper", "teeth_lower" })
  {
    TriangleMesh mesh = default_head().part(part, 3e-3);
    join_vertices(mesh);
    EXPECT_TRUE(unbalanced_edges(mesh).empty()) << part;
    EXPECT_GT(signed_volume(mesh), 0) << part;
    double middle = 0;
    for (const Vector3& p : mesh.vertices)
      middle += p[1];
    EXPECT_LT(std::abs(middle), 1e-9 * static_cast<double>(mesh.vertices.size())) << part;
  }
  for (const char* part : { "skull", "mandible", "teeth_upper", "teeth_lower" })
  {
    const TriangleMesh mesh = default_head().part(part, 3e-3);
    EXPECT_LT(asymmetry(mesh, mesh), 1e-9) << part;
  }
  // the mirror image of each vertex is a vertex; this need not hold for triangles, because a square has two diagonals
  const TriangleMesh skin = default_head().part("skin", 3e-3);
  const auto less = [](const Vector3& a, const Vector3& b) { return a < b; };
  const auto rounded = [](const Vector3& p, double side) {
    return Vector3{ std::round(p[0] * 1e8), std::round(side * p[1] * 1e8) + 0.0, std::round(p[2] * 1e8) };
  };
  std::vector<Vector3> there, image;
  for (const Vector3& p : skin.vertices)
  {
    there.push_back(rounded(p, 1));
    image.push_back(rounded(p, -1));
  }
  std::sort(there.begin(), there.end(), less);
  std::sort(image.begin(), image.end(), less);
  std::size_t different = 0;
  for (std::size_t i = 0; i < there.size(); ++i)
    different += there[i] != image[i] ? 1 : 0;
  EXPECT_LE(different, there.size() / 500) << "rounding alone may part a few";
}

TEST(Head, HasHairBetweenHairlineAndNapeThatLeavesFaceAndEarsFree)
{
  for (const double size : { 0.0, 2.0 })
  {
    std::map<std::string, double> dimensions;
    for (const auto& d : shipped()->dimensions)
      if (d.derived_from.empty() && size > 0)
        dimensions[d.name] = d.mean + size * d.deviation;
    const Head head(shipped(), dimensions);
    const TriangleMesh hair = head.part("hair", 3e-3);
    EXPECT_LT(asymmetry(hair, hair), 0.3e-3) << "squares have two diagonals";
    const TriangleTree tree(hair);
    const auto away = [&](const std::string& landmark) { return tree.closest(head.landmark(landmark)).distance; };
    EXPECT_LT(away("tr"), 4e-3);
    EXPECT_LT(away("eu"), 10e-3);
    EXPECT_LT(away("op"), 20e-3);
    for (const char* bare : { "metopion", "ft", "zy", "t", "sba" })
      EXPECT_GT(away(bare), 5e-3) << bare;
    // between it and the skin is as much hair as grows at most, and it goes under the skin at its border alone
    const TriangleMesh skin = head.part("visible", 3e-3);
    const TriangleTree below(skin);
    double thickest = 0;
    for (const Vector3& p : hair.vertices)
      thickest = std::max(thickest, below.closest(to_vector(p)).distance);
    EXPECT_GT(thickest, 8e-3);
    EXPECT_LT(thickest, 16e-3);
  }
}

TEST(Head, HasALiningOfTheMouthThatFacesOutOfTheTissue)
{
  Shape lining;
  lining.kind = Shape::Kind::head;
  lining.head = shipped();
  lining.part = "mucosa";
  Surface surface;
  surface.shape = lining;
  const TriangleMesh mouth = load_surface(surface, 1).mesh;
  const PreparedSurface skin("skin", default_head().part("skin", 2e-3));
  const auto height = [&skin](const Vector3d& p) { return skin.signed_distance(p, skin.tree().closest(p)); };
  const std::vector<Vector3d> outwards = vertex_normals(mouth);
  ASSERT_GT(mouth.vertices.size(), 100u);
  for (std::size_t v = 0; v < mouth.vertices.size(); ++v)
  {
    const Vector3d p = to_vector(mouth.vertices[v]);
    EXPECT_NEAR(height(p), 0, 0.3e-3);
    EXPECT_LT(height(p - 0.6e-3 * outwards[v]), 0) << p.transpose();
    EXPECT_LT(p[0], 10e-3) << "behind the red of the lips";
  }
}

TEST(Head, HasBonesAtTheDepthsOfItsTable)
{
  const TriangleMesh bones = [&]
  {
    TriangleMesh all = default_head().part("skull", 1.5e-3);
    append(all, default_head().part("mandible", 1.5e-3));
    return all;
  }();
  const TriangleTree tree(bones);
  const TriangleMesh skin = default_head().part("skin", 2e-3);
  const TriangleTree skin_tree(skin);
  for (const auto& site : shipped()->depths)
    for (const char* name : { "glabella", "supraglabella", "frontal", "nasion", "malar", "zygion", "euryon",
                              "mental_eminence", "chin_side", "gonion", "opisthocranion" })
      if (site.name == name)
      {
        const Vector3d p = skin_tree.closest(to_vector(site.at)).point;
        // at sites with a direction of their own, the closest bone is nearer than the depth along this direction
        EXPECT_NEAR(tree.closest(p).distance, site.depth, 0.15 * site.depth + 0.5e-3) << site.name;
      }
}

TEST(Head, HasClosedMusclesThatMirrorEachOther)
{
  for (const auto& muscle : shipped()->muscles)
  {
    TriangleMesh left = default_head().part(muscle.name + (muscle.sided ? "_left" : ""), 2e-3);
    join_vertices(left);
    EXPECT_TRUE(unbalanced_edges(left).empty()) << muscle.name;
    EXPECT_GT(std::abs(signed_volume(left)), 1e-9) << muscle.name;
    if (muscle.sided)
    {
      const TriangleMesh right = default_head().part(muscle.name + "_right", 2e-3);
      EXPECT_LT(asymmetry(left, right), 1e-9) << muscle.name;
    }
  }
  EXPECT_THROW(default_head().part("tail", 0), Error);
}

TEST(Head, HasMusclesBetweenSkinAndBone)
{
  const TriangleMesh coarse = default_head().part("skin", 3e-3);
  const TriangleTree tree(coarse);
  const HeadBones bones(*shipped(), tree);
  const PreparedSurface skin("skin", default_head().part("skin", 2e-3));
  for (const auto& muscle : shipped()->muscles)
  {
    const auto net = default_head().net(muscle.name + (muscle.sided ? "_left" : ""));
    const NurbsVolume volume = volume_of(*net);
    int count = 0, in_bone = 0, outside = 0;
    for (double u = 0.02; u < 1; u += 0.04)
      for (double v = 0.05; v < 1; v += 0.1)
        for (double w = 0.1; w < 1; w += 0.2, ++count)
        {
          const Vector3d p = volume.at({ u, v, w }).position;
          in_bone += bones.any(p) < 0 ? 1 : 0;
          outside += skin.signed_distance(p, skin.tree().closest(p)) > 0 ? 1 : 0;
        }
    EXPECT_LE(in_bone, 0.05 * count) << muscle.name << " of " << count;
    EXPECT_LE(outside, 0.05 * count) << muscle.name << " of " << count;
  }
}

PolygonMesh cube()
{
  PolygonMesh mesh;
  for (int c = 0; c < 8; ++c)
    mesh.vertices.emplace_back(c & 1 ? 1 : -1, c & 2 ? 1 : -1, c & 4 ? 1 : -1);
  mesh.faces = { { 0, 2, 3, 1 }, { 4, 5, 7, 6 }, { 0, 1, 5, 4 }, { 2, 6, 7, 3 }, { 0, 4, 6, 2 }, { 1, 3, 7, 5 } };
  mesh.groups.assign(6, 0);
  mesh.groups[1] = 1;
  mesh.group_names = { "rest", "top" };
  return mesh;
}

TEST(Subdivision, HasTheSameLimitAtEveryLevel)
{
  const TriangleMesh coarse = subdivide(cube(), 1), fine = subdivide(cube(), 4);
  EXPECT_EQ(coarse.triangles.size(), 6u * 4 * 2);
  EXPECT_TRUE(unbalanced_edges(fine).empty());
  // the limit for valence 3 is (9 v + 4 sum of neighbours + sum of opposite corners) / 24; here the sums are 1 and -1
  const double corner = (9.0 + 4 * 1 - 1) / 24;
  for (std::size_t v = 0; v < coarse.vertices.size(); ++v)
    EXPECT_LT((vertex(coarse, static_cast<std::int32_t>(v)) - vertex(fine, static_cast<std::int32_t>(v))).norm(),
              1e-12);
  EXPECT_NEAR(fine.vertices[7][0], corner, 1e-12);
  EXPECT_EQ(subdivide(cube(), 2, { "top" }).triangles.size(), 16u * 2);
}

TEST(Subdivision, RefusesACageThatIsNoManifold)
{
  PolygonMesh twice = cube();
  twice.faces.push_back(twice.faces.front());
  twice.groups.push_back(0);
  EXPECT_THROW(subdivide(twice, 1), Error);
}

TEST(Subdivision, MirrorsAndSmoothsAFile)
{
  const std::string file = (std::filesystem::temp_directory_path() / "frontalis_half_cube.obj").string();
  std::ofstream(file) << "v 0 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv 0 1 -1\nv 0 -1 1\nv 1 -1 1\nv 1 1 1\nv 0 1 1\n"
                         "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 4 8 7 3\nf 2 3 7 6\n";
  Surface surface = file_surface("cube", file);
  surface.subdivide = 3;
  surface.mirror = 0;
  const TriangleMesh mesh = load_surface(surface, 1).mesh;
  EXPECT_TRUE(unbalanced_edges(mesh).empty());
  EXPECT_EQ(mesh.triangles.size(), 10u * 64 * 2);
  EXPECT_LT(signed_volume(mesh), 8);
  EXPECT_GT(signed_volume(mesh), 3.5);
  std::filesystem::remove(file);
}

}  // namespace
