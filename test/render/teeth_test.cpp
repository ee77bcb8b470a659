#include "frontalis/render/face_appearance.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace frontalis
{
namespace
{

// A wall of 60 x 40 mm, bent around the mouth to an arch of 20 mm depth, with its middle at the corners of the mouth.
TriangleMesh arch()
{
  constexpr int columns = 60, rows = 40;
  TriangleMesh mesh;
  for (int r = 0; r <= rows; ++r)
    for (int c = 0; c <= columns; ++c)
    {
      const double y = -30e-3 + 1e-3 * c;
      mesh.vertices.push_back({ 20e-3 * std::sqrt(1 - std::pow(y / 30.01e-3, 2)), y, -20e-3 + 1e-3 * r });
    }
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c)
    {
      const std::int32_t first = r * (columns + 1) + c, above = first + columns + 1;
      mesh.triangles.push_back({ first, first + 1, above });
      mesh.triangles.push_back({ first + 1, above + 1, above });
    }
  return mesh;
}

// What a painted row shows at a place of its middle part.
std::pair<std::array<float, 3>, std::uint8_t> at(const RenderMesh& mesh, double y, double z)
{
  std::size_t closest = 0;
  double least = 1;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    if (const double away = std::hypot(mesh.vertices[v][1] - y, mesh.vertices[v][2] - z); away < least)
    {
      least = away;
      closest = v;
    }
  return { mesh.colours[closest], mesh.labels[closest] };
}

// A body that fills the arch has teeth along its front only.
TEST(Teeth, end_where_palate_and_floor_of_the_mouth_begin)
{
  TriangleMesh filled = arch();
  const TriangleMesh front = filled;
  const auto first = static_cast<std::int32_t>(front.vertices.size());
  for (const auto& v : front.vertices)
    filled.vertices.push_back({ v[0] - 12e-3, v[1], v[2] });
  for (const auto& t : front.triangles)
    filled.triangles.push_back({ t[0] + first, t[1] + first, t[2] + first });
  for (const bool lower : { false, true })
  {
    const RenderMesh mesh = painted_teeth(filled, lower, 0);
    int behind = 0, in_front = 0;
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    {
      if (std::abs(mesh.vertices[v][1]) > 15e-3F)
        continue;
      const bool is_gum = mesh.colours[v][0] > 1.4F * mesh.colours[v][1];
      if (mesh.vertices[v][0] < 6e-3F)
      {
        ++behind;
        EXPECT_TRUE(is_gum);
      }
      else
        in_front += is_gum ? 0 : 1;
    }
    EXPECT_GT(behind, 100);
    EXPECT_GT(in_front, 100);
  }
}

TEST(Teeth, are_painted_between_gums_and_their_edges)
{
  const TriangleMesh surface = arch();
  for (const bool lower : { false, true })
  {
    const RenderMesh mesh = painted_teeth(surface, lower, 0);
    ASSERT_EQ(mesh.colours.size(), mesh.vertices.size());
    const double up = lower ? -1 : 1;
    const auto tooth = at(mesh, lower ? 2.7e-3 : 4.3e-3, up * 6e-3);
    EXPECT_EQ(tooth.first, teeth_colour);
    EXPECT_EQ(tooth.second, body_label);
    // between the two middle teeth it is darker, as on both sides of the midline
    EXPECT_LT(at(mesh, 0, up * 6e-3).first[0], 0.7F * teeth_colour[0]);
    EXPECT_EQ(at(mesh, 4e-3, up * 6e-3), at(mesh, -4e-3, up * 6e-3));
    // gums are red, and the body ends with the edges of the teeth, which are thin in front and flat at the sides
    const auto gum = at(mesh, 4e-3, up * 15e-3);
    EXPECT_GT(gum.first[0], 1.4F * gum.first[1]);
    EXPECT_EQ(gum.second, body_label);
    float lowest = 1, front = -1;
    for (const auto& p : mesh.vertices)
    {
      lowest = std::min(lowest, static_cast<float>(up) * p[2]);
      front = std::max(front, p[0]);
    }
    EXPECT_NEAR(lowest, lower ? 1.2e-3 : -2.5e-3, 0.1e-3);
    // where the rows overlap, the lower one is behind the upper one
    EXPECT_NEAR(front, lower ? 17e-3 : 20e-3, 0.1e-3);
  }
}

TEST(Teeth, are_painted_where_the_mouth_is_in_the_face_frame)
{
  Model model;
  model.to_face.translation = { 10e-3, -20e-3, -60e-3 };
  model.landmarks = { "mouth_corner_left" };
  model.landmark_positions = { { 0, 25e-3, 5e-3 } };
  Contact contact;
  contact.name = "teeth_above";
  contact.shape = arch();
  for (auto& p : contact.shape.vertices)
    p = { p[0] - 10e-3, p[1] + 20e-3, p[2] + 5e-3 };
  model.contacts = { contact };
  const RenderMesh mesh = body_at_rest(model, body_shapes(model)[0]), expected = painted_teeth(arch(), false, 0);
  // The vertices on the edges are merged where they coincide, which rounding decides for a few of them.
  EXPECT_NEAR(double(mesh.vertices.size()), double(expected.vertices.size()), 1e-3 * double(expected.vertices.size()));
  for (std::size_t v = 0; v < 1000; ++v)
  {
    EXPECT_NEAR(mesh.vertices[v][2], expected.vertices[v][2] - 55e-3F, 1e-6F);
    EXPECT_EQ(mesh.colours[v], expected.colours[v]);
  }
}

}  // namespace
}  // namespace frontalis
