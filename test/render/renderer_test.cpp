#include "frontalis/error.hpp"
#include "frontalis/render/face_appearance.hpp"
#include "frontalis/render/renderer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

namespace frontalis
{
namespace
{

using Vector = std::array<double, 3>;

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector minus(const Vector& a, const Vector& b) { return { a[0] - b[0], a[1] - b[1], a[2] - b[2] }; }
Vector cross(const Vector& a, const Vector& b)
{
  return { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0] };
}

void finish(RenderMesh& mesh, std::uint8_t label = skin_label)
{
  mesh.colours.assign(mesh.vertices.size(), { 0.5F, 0.5F, 0.5F });
  mesh.labels.assign(mesh.vertices.size(), label);
}

/// The skin of the generated head, as coarse as its control cage: left half and mirror image, four-sided faces halved.
RenderMesh head_cage()
{
  RenderMesh mesh;
  std::ifstream file(FRONTALIS_SOURCE_DIRECTORY "/config/head/skin.obj");
  std::string line, word;
  std::vector<std::array<std::int32_t, 3>> half;
  while (std::getline(file, line))
  {
    std::istringstream words(line);
    words >> word;
    if (word == "v")
    {
      std::array<float, 3> v{};
      words >> v[0] >> v[1] >> v[2];
      mesh.vertices.push_back({ 1e-3F * v[0], 1e-3F * v[1], 1e-3F * v[2] });
    }
    if (word == "f")
    {
      std::vector<std::int32_t> corners;
      for (std::int32_t corner = 0; words >> corner;)
        corners.push_back(corner - 1);
      for (std::size_t c = 2; c < corners.size(); ++c)
        half.push_back({ corners[0], corners[c - 1], corners[c] });
    }
  }
  const auto count = static_cast<std::int32_t>(mesh.vertices.size());
  mesh.triangles = half;
  for (std::int32_t v = 0; v < count; ++v)
    mesh.vertices.push_back({ mesh.vertices[v][0], -mesh.vertices[v][1], mesh.vertices[v][2] });
  for (const auto& [a, b, c] : half)
    mesh.triangles.push_back({ count + a, count + c, count + b });
  finish(mesh);
  return mesh;
}

/// Depth of the first triangle on a ray in double precision, by Moeller & Trumbore (1997), over all triangles; 0: none.
double exact_depth(const RenderMesh& mesh, const PinholeCamera& camera, int column, int row)
{
  const Vector direction{ (column - camera.cx) / camera.fx, (row - camera.cy) / camera.fy, 1 };
  double first = std::numeric_limits<double>::infinity();
  for (const auto& t : mesh.triangles)
  {
    const Vector a = camera.to_camera(mesh.vertices[t[0]]);
    const Vector ab = minus(camera.to_camera(mesh.vertices[t[1]]), a),
                 ac = minus(camera.to_camera(mesh.vertices[t[2]]), a);
    const Vector p = cross(direction, ac), q = cross({ -a[0], -a[1], -a[2] }, ab);
    const double determinant = dot(ab, p), u = -dot(a, p) / determinant, v = dot(direction, q) / determinant,
                 z = dot(ac, q) / determinant;
    if (determinant != 0 && u >= 0 && v >= 0 && u + v <= 1 && z > 0 && z < first)
      first = z;
  }
  return std::isinf(first) ? 0 : first;
}

TEST(Renderer, DepthOfAHeadIsThatOfAnExactRayCast)
{
  const RenderMesh mesh = head_cage();
  ASSERT_GT(mesh.triangles.size(), 2000u);
  PinholeCamera camera = camera_with(96, 72, 0.6);
  camera.to_camera = look_at({ 0.45, 0.2, 0.05 }, { -0.05, 0, -0.03 }, 0.2);
  const Images images = Renderer({ { mesh }, {} }, camera).images({});
  int seen = 0, borders = 0;
  for (int row = 0; row < camera.height; ++row)
    for (int column = 0; column < camera.width; ++column)
    {
      const double exact = exact_depth(mesh, camera, column, row);
      const float depth = images.depth[static_cast<std::size_t>(row * camera.width + column)];
      // a ray that grazes an edge to within rounding may miss it
      if ((exact == 0) != (depth == 0))
        ++borders;
      else if (std::abs(depth - exact) > 1e-4)
        ++borders;
      seen += exact > 0 ? 1 : 0;
    }
  EXPECT_GT(seen, 2000);
  EXPECT_EQ(borders, 0);
}

TEST(Renderer, DepthNormalsAndShadeOfABallAndAPlaneAreThoseOfClosedForms)
{
  // a plane x = 0, and a ball in front of it
  RenderMesh plane;
  plane.vertices = { { 0, -1, -1 }, { 0, 1, -1 }, { 0, 1, 1 }, { 0, -1, 1 } };
  plane.triangles = { { 0, 1, 2 }, { 0, 2, 3 } };
  finish(plane);
  const RenderBall ball{ { 0.1, 0.02, 0.01 }, 0.03, { 1, 1, 1 }, eye_label };
  PinholeCamera camera = camera_with(80, 60, 0.5);
  const Vector eye{ 0.5, 0.1, 0.05 };
  camera.to_camera = look_at(eye, { 0, 0, 0 });
  Light light;
  light.key = { 1, 0, 0 };
  light.fill_strength = light.highlight = 0;
  const Images images = Renderer({ { plane }, { ball } }, camera).images(light);
  const Vector plane_normal = camera.to_camera.turned(Vector{ 1, 0, 0 }), origin = camera.to_camera(Vector{ 0, 0, 0 }),
               centre = camera.to_camera(ball.centre);
  int on_ball = 0, shadow = 0;
  for (int row = 0; row < camera.height; ++row)
    for (int column = 0; column < camera.width; ++column)
    {
      const auto pixel = static_cast<std::size_t>(row * camera.width + column);
      const Vector d{ (column - camera.cx) / camera.fx, (row - camera.cy) / camera.fy, 1 };
      const double a = dot(d, d), b = dot(d, centre), root = b * b - a * (dot(centre, centre) - 0.03 * 0.03);
      const bool hits = root > 0;
      const double z = hits ? (b - std::sqrt(root)) / a : dot(plane_normal, origin) / dot(plane_normal, d);
      ASSERT_NEAR(images.depth[pixel], z, 1e-6);
      ASSERT_EQ(images.label[pixel], hits ? eye_label : skin_label);
      const Vector at{ z * d[0], z * d[1], z };
      for (std::size_t i = 0; i < 3; ++i)
        ASSERT_NEAR(images.normal[pixel][i], hits ? (at[i] - centre[i]) / 0.03 : plane_normal[i], 1e-3);
      on_ball += hits ? 1 : 0;
      // the light comes along x: the ball's shadow is the disc below it
      Vector place = minus(at, origin);
      place = { 0, dot(place, camera.to_camera.turned(Vector{ 0, 1, 0 })),
                dot(place, camera.to_camera.turned(Vector{ 0, 0, 1 })) };
      const double from_axis = std::hypot(place[1] - 0.02, place[2] - 0.01);
      if (hits || std::abs(from_axis - 0.03) < 1e-5)
        continue;
      shadow += from_axis < 0.03 ? 1 : 0;
      ASSERT_NEAR(images.colour[pixel][0], 255 * 0.5 * (from_axis < 0.03 ? 0.24 : 0.9), 0.51);
    }
  EXPECT_GT(on_ball, 100);
  EXPECT_GT(shadow, 20);
}

TEST(Renderer, APatchIsWhereTheCameraModelSaysAndHidesWhatIsBehind)
{
  // a disc that faces a camera from the side: its middle in the picture is the projection of its centre
  PinholeCamera camera = camera_with(160, 120, 0.7);
  camera.fy *= 1.25;
  camera.cx = 70.3;
  camera.to_camera = look_at({ 0.5, -0.2, 0.1 }, { 0, 0, 0 }, -0.3);
  const Vector centre{ 0.02, 0.03, -0.04 };
  RenderMesh disc;
  disc.vertices.push_back({ 0.02F, 0.03F, -0.04F });
  for (int i = 0; i < 64; ++i)
  {
    const double angle = i * 3.14159265358979323846 / 32;
    disc.vertices.push_back({ 0.02F, static_cast<float>(0.03 + 0.02 * std::cos(angle)),
                              static_cast<float>(-0.04 + 0.02 * std::sin(angle)) });
    disc.triangles.push_back({ 0, 1 + i, 1 + (i + 1) % 64 });
  }
  finish(disc);
  const Renderer renderer({ { disc }, {} }, camera);
  const Images images = renderer.images({});
  double u = 0, v = 0, count = 0;
  for (int row = 0; row < camera.height; ++row)
    for (int column = 0; column < camera.width; ++column)
      if (images.label[static_cast<std::size_t>(row * camera.width + column)] == skin_label)
      {
        u += column;
        v += row;
        ++count;
      }
  ASSERT_GT(count, 100);
  const auto expected = camera.project(camera.to_camera(centre));
  EXPECT_LT(std::hypot(u / count - expected[0], v / count - expected[1]), 0.5);

  EXPECT_TRUE(renderer.sees(centre));
  EXPECT_FALSE(renderer.sees({ 0, 0.035, -0.045 }));  // behind the disc
  EXPECT_TRUE(renderer.sees({ 0, 0.09, -0.045 }));    // beside it
  EXPECT_FALSE(renderer.sees({ 0.02, 0.9, -0.04 }));  // out of the picture
  EXPECT_FALSE(renderer.sees({ 1, -0.4, 0.2 }));      // behind the camera
}

TEST(Renderer, DepthOfATriangleSeenEdgeOnIsBetweenThoseOfItsCorners)
{
  // triangles in the planes of the rays of columns, but for rounding
  const PinholeCamera camera = camera_with(64, 48, 0.6);
  int seen = 0;
  for (int trial = 0; trial < 40; ++trial)
  {
    RenderMesh mesh;
    for (int column = 0; column < camera.width; ++column)
    {
      for (const auto& [y, z] : { std::pair{ -0.1, 0.4 + 1e-3 * trial }, { 0.1, 0.45 }, { 0.02, 0.6 } })
        mesh.vertices.push_back(
            { static_cast<float>((column - camera.cx) / camera.fx * z), static_cast<float>(y), static_cast<float>(z) });
      mesh.triangles.push_back({ 3 * column, 3 * column + 1, 3 * column + 2 });
    }
    finish(mesh);
    for (const float depth : Renderer({ { mesh }, {} }, camera).images({}).depth)
      if (depth != 0)
      {
        ++seen;
        EXPECT_GE(depth, 0.4F);
        EXPECT_LE(depth, 0.6F);
      }
  }
  EXPECT_GT(seen, 100);
}

TEST(Renderer, BacksOfSurfacesAndEmptyScenesAreShownAsSuch)
{
  RenderMesh plane;
  plane.vertices = { { 0, -1, -1 }, { 0, 1, -1 }, { 0, 0, 1 } };
  plane.triangles = { { 0, 2, 1 } };
  finish(plane);
  PinholeCamera camera = camera_with(4, 4, 0.2);
  camera.to_camera = look_at({ 1, 0, 0 }, { 0, 0, 0 });
  const Images back = Renderer({ { plane }, {} }, camera).images({}, 3);
  EXPECT_EQ(back.label[5], inside_label);
  EXPECT_EQ(back.colour[5][0], std::lround(255 * inside_colour[0]));
  const Images empty = Renderer({ {}, {} }, camera).images({}, 2);
  EXPECT_EQ(empty.label[5], background_label);
  EXPECT_EQ(empty.depth[5], 0);
  EXPECT_EQ(empty.colour[5][0], 255);

  plane.labels.pop_back();
  EXPECT_THROW(Renderer({ { plane }, {} }, camera), Error);
  EXPECT_THROW(camera_with(0, 4, 0.2), Error);
  EXPECT_THROW(camera_with(4, 4, 4), Error);
  EXPECT_THROW(look_at({ 0, 0, 1 }, { 0, 0, 0 }), Error);
}

TEST(FaceAppearance, LabelsFollowTheLandmarks)
{
  const std::vector<std::string> landmarks{ "upper_lip", "lower_lip",  "mouth_corner_left",
                                            "chin",      "cheek_left", "cheek_right" };
  const std::vector<std::array<float, 3>> places{ { 0.01F, 0, 0.01F },    { 0.01F, 0, -0.01F }, { 0, 0.025F, 0 },
                                                  { 0.005F, 0, -0.035F }, { -0.01F, 0.05F, 0 }, { -0.01F, -0.05F, 0 } };
  const SkinAppearance appearance = skin_appearance(landmarks, places,
                                                    { { 0.012F, 0, 0.005F },
                                                      { 0.012F, 0, -0.005F },
                                                      { 0.005F, 0.001F, -0.036F },
                                                      { -0.01F, 0.05F, 0.01F },
                                                      { -0.01F, -0.05F, 0.01F },
                                                      { 0, 0, 0.2F } });
  const std::vector<std::string> names = label_names();
  std::vector<std::string> found;
  for (const std::uint8_t label : appearance.labels)
    found.push_back(names.at(label));
  EXPECT_EQ(found, (std::vector<std::string>{ "lip_upper", "lip_lower", "chin", "cheek_left", "cheek_right", "skin" }));
  ASSERT_TRUE(appearance.mouth);
  EXPECT_LT(appearance.colours[0][1], appearance.colours[5][1]);
}

TEST(FaceAppearance, LashesAreAlongTheEdgesOfTheLids)
{
  const RenderBall eye{ { 0, 0.03, 0 }, 0.012, {} };
  // the edge of the upper lid, that of the lower one, the middle of the upper lid, and a cheek
  const std::vector<std::array<float, 3>> vertices{
    { 0.0125F, 0.03F, 0.004F }, { 0.0115F, 0.03F, -0.005F }, { 0.011F, 0.03F, 0.009F }, { 0.012F, 0.03F, -0.02F }
  };
  const auto colours = skin_appearance({}, {}, vertices, { eye }).colours,
             bare = skin_appearance({}, {}, vertices).colours;
  EXPECT_LT(colours[0][0], 0.5F * bare[0][0]);
  EXPECT_LT(colours[1][0], 0.9F * bare[1][0]);
  EXPECT_EQ(colours[2], bare[2]);
  EXPECT_EQ(colours[3], bare[3]);
}

TEST(FaceAppearance, BodiesHaveTheColourOfTeethSkinHairTongueOrMetal)
{
  const TriangleMesh none;
  const auto teeth = body_appearance("hair", false, none), skin = body_appearance("head", true, none),
             hair = body_appearance("hair", true, none), tongue = body_appearance("tongue", true, none);
  EXPECT_EQ(teeth.label, body_label);
  EXPECT_EQ(skin.label, skin_label);
  EXPECT_EQ(label_names().at(hair.label), "hair");
  EXPECT_EQ(tongue.label, body_label);
  EXPECT_LT(tongue.colour[1], 0.6F * tongue.colour[0]);
  EXPECT_EQ(body_appearance("mouth", true, none).label, inside_label);
  EXPECT_EQ(body_appearance("mouth", true, none).colour, inside_colour);
  EXPECT_EQ(body_appearance("mouth", false, none).colour, teeth.colour);
  const auto core = body_appearance("core_jaw", true, none);
  EXPECT_EQ(core.label, body_label);
  EXPECT_GT(core.colour[2], core.colour[0]);  // bluish, as metal is
  EXPECT_EQ(body_appearance("core_jaw", false, none).colour, teeth.colour);
  EXPECT_EQ(body_appearance("gums_above", false, none).colour, gum_colour);
  EXPECT_EQ(skin.colour, skin_appearance({}, {}, { { 0, 0, 0 } }).colours[0]);
  // hair is thin at the border of its surface, and dense where that is far away
  TriangleMesh fan;
  fan.vertices = { { 0, 0, 0 }, { 0.02, 0, 0 }, { 0, 0.02, 0 }, { -0.02, -0.02, 0 } };
  fan.triangles = { { 0, 1, 2 }, { 0, 2, 3 }, { 0, 3, 1 } };
  const auto colours = body_appearance("hair", true, fan).colours;
  EXPECT_NEAR(colours[0][0], hair.colour[0], 1e-6);
  EXPECT_EQ(colours[1], skin.colour);
}

}  // namespace
}  // namespace frontalis
