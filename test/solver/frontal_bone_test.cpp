#include "solver/contact/surface_contact.hpp"

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
using Point = SurfaceTree::Point;

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
  // a ridge at each brow
  const double brow = std::hypot(70 * (d.z - 0.1) / 6, 70 * (std::abs(d.y) - 0.3) / 15);
  const double ridge = d.x > 0 ? 4 * std::exp(-brow * brow) : 0;
  return outer ? 70 + waves + ridge : 64 + 0.7 * std::sin(17 * d.x) * std::sin(16 * d.y + 1) * std::sin(12 * d.z);
}

// An artificial closed skull of two tables, 4 to 10 mm apart, with brow ridges and bumps and about as many triangles as
// the real bone: the squares on a cube's faces, moved onto the tables.
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

double signed_distance(const SurfaceTree& tree, const Point& p, Point& foot)
{
  const auto c = tree.closest(p, 1);
  foot = c.point;
  const double distance = std::sqrt(c.squared_distance);
  return dot(p - c.point, c.normal) < 0 ? -distance : distance;
}

// Nodes slide over the whole bone, outside and inside, as the solver moves them: on a plane until slip is used up, then
// on a new one. Places are not counted where a ball somewhat larger than the distance, tangent at the foot, meets other
// parts of the bone, because there the bone curves more tightly than the distance.
void check_distance_is_kept(const TriangleMesh& mesh)
{
  const SurfaceTree tree(mesh);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  double worst = 0, slip = 0;
  int counted = 0, checked = 0, renewals = 0;
  for (int node = 0; node < 1500; ++node)
  {
    const auto& triangle = tree.triangles()[random() % tree.triangles().size()];
    const double wanted = 3e-3 * std::pow(unit(random), 3);
    Point p = 1.0 / 3 * (triangle.corner[0] + triangle.corner[1] + triangle.corner[2]) + wanted * triangle.face_normal;
    Point foot;
    const double distance = signed_distance(tree, p, foot);
    SurfaceContact contact(tree, distance);
    ContactPlane plane;
    int tight = -10;
    Point reference = p, heading{ 0, 0, 0 };
    for (int step = 0; step < 400; ++step)
    {
      if (step % 100 == 0)
        heading = 25e-6 * Point{ unit(random), unit(random), unit(random) };
      p = p + heading - dot(heading, plane.normal) * plane.normal;
      if (step == 0 || norm(p - reference) > plane.slip)
      {
        plane = contact.renew(p);
        reference = p;
        slip += plane.slip;
        ++renewals;
      }
      p = p - (dot(plane.normal, p) - plane.height) * plane.normal;
      const double now = signed_distance(tree, p, foot);
      ++checked;
      const Point away = p - foot;
      const Point centre = foot + (1.2 * std::abs(distance) / std::max(norm(away), 1e-12)) * away;
      Point other;
      if (std::abs(std::abs(signed_distance(tree, centre, other)) - 1.2 * std::abs(distance)) > 1e-6)
        tight = step;
      if (step < tight + 10)
        continue;
      ++counted;
      worst = std::max(worst, std::abs(now - distance));
    }
  }
  std::printf("worst %.2f um; %.0f %% of %d places counted; mean slip %.0f um\n", 1e6 * worst,
              100.0 * counted / checked, checked, 1e6 * slip / renewals);
  EXPECT_LT(worst, 10e-6);
  EXPECT_GT(counted, checked / 2);
}

}  // namespace

TEST(FrontalBone, DistanceIsKeptWithinTenMicrometresOnAMadeBone)
{
  const TriangleMesh mesh = made_bone();
  ASSERT_GT(mesh.triangles.size(), 30000U);
  check_distance_is_kept(mesh);
}

TEST(FrontalBone, DistanceIsKeptWithinTenMicrometresOnARealBone)
{
  const TriangleMesh mesh = read_stl(bone_file);
  if (mesh.triangles.empty())
    GTEST_SKIP() << "skipped: the meshes of the head are not here";
  check_distance_is_kept(mesh);
}
