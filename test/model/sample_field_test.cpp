#include "frontalis/model/sample_field.hpp"

#include "frontalis/physics/element/sliding_node.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace frontalis;
using physics::Vec3;

namespace
{

using Point = std::array<double, 3>;

template <class T>
physics::FieldValue<T> value_at(const SampledField& field, const Vec3<double>& rest, const Vec3<double>& moved)
{
  const physics::DistanceField of = view(field);
  const auto at = physics::field_point(of, rest);
  const Vec3<double> offset = at.offset + moved;
  physics::FieldValue<T> value{};
  EXPECT_TRUE(physics::sample<T>(of,
                                 { { at.cell[0], at.cell[1], at.cell[2] },
                                   { static_cast<T>(offset.x), static_cast<T>(offset.y), static_cast<T>(offset.z) } },
                                 value));
  return value;
}

// A quadratic function. A quadratic spline through its samples reproduces its slopes and curvature.
double quadratic(const Point& p)
{
  return 0.3 * p[0] - 0.4 * p[1] + 0.5 * p[2] + 8 * p[0] * p[0] - 6 * p[1] * p[2] + 5 * p[2] * p[2] + 4 * p[0] * p[1];
}

}  // namespace

TEST(SampleField, HasTheSlopesOfAQuadraticFunctionInFloatAndDouble)
{
  const SampledField field = sample_field({ { { 1e-3, 2e-3, 3e-3 } } }, quadratic, 0.5e-3, 20e-3);
  const Vec3<double> rest{ 1e-3, 2e-3, 3e-3 };
  for (int i = -10; i <= 10; ++i)
  {
    // The points lie on the level set, in several bricks of samples.
    const Vec3<double> moved{ 0.8e-3 * i, 0.6e-3 * i, 0.05e-3 * i };
    const Point p{ { rest.x + moved.x, rest.y + moved.y, rest.z + moved.z } };
    const auto found = value_at<double>(field, rest, moved);
    const double x = p[0], y = p[1], z = p[2];
    // The spline's value exceeds the function by the Laplacian times the squared spacing divided by 8.
    EXPECT_NEAR(found.value, quadratic(p) + 26 * 0.25e-6 / 8, 1e-8) << i;
    EXPECT_NEAR(found.gradient.x, 0.3 + 16 * x + 4 * y, 5e-5);
    EXPECT_NEAR(found.gradient.y, -0.4 - 6 * z + 4 * x, 5e-5);
    EXPECT_NEAR(found.gradient.z, 0.5 - 6 * y + 10 * z, 5e-5);
    EXPECT_NEAR(found.curvature, std::sqrt(16 * 16 + 10 * 10 + 2 * (4 * 4 + 6 * 6)), 0.5);
    const auto rough = value_at<float>(field, rest, moved);
    EXPECT_NEAR(rough.value, found.value, 2e-8);
    EXPECT_NEAR(rough.gradient.x, found.gradient.x, 1e-4);
    EXPECT_NEAR(rough.gradient.y, found.gradient.y, 1e-4);
    EXPECT_NEAR(rough.gradient.z, found.gradient.z, 1e-4);
  }
}

TEST(SampleField, CoversWhereNodesMayComeAndNoMore)
{
  const auto plane = [](const Point& p) { return p[2]; };
  const SampledField field = sample_field({ { { 0, 0, 1e-3 } }, { { 8e-3, 0, 2e-3 } } }, plane, 0.5e-3, 10e-3);
  for (double x = -10e-3; x <= 18e-3; x += 0.7e-3)
    for (double y = -10e-3; y <= 10e-3; y += 0.9e-3)
      for (const double z : { 0.6e-3, 1.4e-3, 1.6e-3, 2.4e-3 })
      {
        // Samples cover the level z of each of the two nodes, up to the travel of 10 mm from the node.
        const bool covered = z < 1.5e-3 ? x < 9.9e-3 : x > -1.9e-3;
        if (covered)
        {
          EXPECT_NEAR(level_at(field, { { x, y, z } }), z, 1e-9);
        }
      }
  EXPECT_TRUE(std::isnan(level_at(field, { { 0, 0, 8e-3 } })));
  EXPECT_TRUE(std::isnan(level_at(field, { { 0, 0, -8e-3 } })));
  EXPECT_TRUE(std::isnan(level_at(field, { { 30e-3, 0, 1e-3 } })));
}

TEST(SampleField, ALevelPlaneStaysNearTheLevelSetOfASphereAsFarAsItSays)
{
  const double radius = 12e-3;
  const SampledField exact = sphere_field({ { 1e-3, 2e-3, 3e-3 } }, radius);
  EXPECT_NEAR(level_at(exact, { { 1e-3, 2e-3, 18e-3 } }), 3e-3, 1e-12);
  const Point rest{ { 1e-3 + 12e-3, 2e-3, 3e-3 } };
  const auto distance = [&](const Point& p) { return std::hypot(p[0] - 1e-3, p[1] - 2e-3, p[2] - 3e-3) - radius; };
  for (const SampledField& field : { exact, sample_field({ rest }, distance, 0.5e-3, 3e-3) })
  {
    const double level = level_at(field, rest);
    const auto here = value_at<double>(field, { rest[0], rest[1], rest[2] }, { 20e-6, 0.4e-3, -0.3e-3 });
    physics::LevelPlane<double> plane{};
    ASSERT_TRUE(physics::level_plane(here, level, plane));
    // The plane is valid at most as far as the samples of the cell describe the field.
    EXPECT_LT(plane.slip, 100e-6);
    EXPECT_GT(plane.slip, field.radius > 0 ? 80e-6 : 15e-6);
    const Vec3<double> along = plane.slip * Vec3<double>{ -plane.normal.y, plane.normal.x, 0 };
    const auto there = value_at<double>(field, { rest[0], rest[1], rest[2] },
                                        Vec3<double>{ 20e-6, 0.4e-3, -0.3e-3 } - plane.distance * plane.normal + along);
    EXPECT_NEAR(there.value, level, physics::plane_error);
    // To second order the level set and its normal are ten times as close, also past that.
    const Vec3<double> reference{ 20e-6, 0.4e-3, -0.3e-3 };
    const physics::CurvedLevel<double> curved{
      plane.normal, dot(plane.normal, reference) - plane.distance, reference, plane.bend, { 0, 0, 0 }
    };
    Vec3<double> normal{};
    double off = 0;
    curved.at(reference - plane.distance * plane.normal + along, normal, off);
    const double slope = std::sqrt(dot(there.gradient, there.gradient));
    EXPECT_NEAR(off, (there.value - level) / slope, 0.1 * physics::plane_error);
    const Vec3<double> turned = normal - (1 / slope) * there.gradient, turn = normal - plane.normal;
    EXPECT_LT(std::sqrt(dot(turned, turned)), 0.1 * std::sqrt(dot(turn, turn)));
  }
}

// The nearest point of a surface may jump, but the field must be continuous.
TEST(SampleField, MakesASlopeOfAJump)
{
  const auto jumps = [](const Point& p) { return 0.5 * p[2] + (p[0] > 5.1e-3 ? 2e-3 : 0); };
  std::vector<Point> rest;
  for (int n = -6; n <= 16; ++n)
    rest.push_back({ { 1e-3 * n, 0, 0 } });
  const SampledField field = sample_field(rest, jumps, 0.5e-3, 4e-3);
  for (double x = -2e-3; x < 12e-3; x += 0.13e-3)
  {
    const auto found = value_at<double>(field, { 5e-3, 0, 0 }, { x - 5e-3, 0, 0.1e-3 });
    EXPECT_LT(std::abs(found.gradient.x), 1.02) << x;
    const double expected = 0.05e-3 + (x > 5.1e-3 ? 2e-3 : 0);
    EXPECT_NEAR(found.value, expected, std::abs(x - 5.1e-3) > 2e-3 ? 0.01e-3 : 1.2e-3) << x;
  }
}
