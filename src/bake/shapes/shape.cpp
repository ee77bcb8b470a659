#include "frontalis/error.hpp"
#include "bake/shapes/sheet_mesh.hpp"
#include "bake/mesh/surface.hpp"

#include <cmath>
#include <functional>

namespace frontalis
{
namespace
{

constexpr double pi = 3.14159265358979323846;

std::int32_t parts(double length, double edge, std::int32_t lowest)
{
  return std::max(lowest, static_cast<std::int32_t>(std::min(2000.0, std::ceil(length / edge - 1e-9))));
}

/// Two unit vectors that make a right-handed frame with `axis`.
std::array<Vector3, 3> frame_of(const Vector3& axis)
{
  const Vector3 w = norm(axis) > 0 ? normalised(axis) : Vector3{ 0, 0, 1 };
  const Vector3 helper = std::abs(w[2]) < 0.9 ? Vector3{ 0, 0, 1 } : Vector3{ 1, 0, 0 };
  const Vector3 u = normalised(cross(helper, w));
  return { u, cross(w, u), w };
}

/// Cube [-1, 1]^3 with n[a] squares along axis a; `place` maps its points.
void add_cube(TriangleMesh& mesh, const std::array<std::int32_t, 3>& n,
              const std::function<Vector3(const Vector3&)>& place)
{
  for (std::size_t a = 0; a < 3; ++a)
  {
    const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
    for (const int side : { -1, 1 })
    {
      // b x c = a: swap the two directions on the lower side
      const std::size_t first = side > 0 ? b : c, second = side > 0 ? c : b;
      add_sheet(mesh, n[first], n[second],
                [&](std::int32_t i, std::int32_t j)
                {
                  Vector3 p{ 0, 0, 0 };
                  p[a] = side;
                  // the ends exactly, so that sheets join
                  p[first] = i == n[first] ? 1 : -1 + 2.0 * i / n[first];
                  p[second] = j == n[second] ? 1 : -1 + 2.0 * j / n[second];
                  return place(p);
                });
    }
  }
}

TriangleMesh box(const Shape& shape, double edge)
{
  TriangleMesh mesh;
  std::array<std::int32_t, 3> n{};
  for (std::size_t a = 0; a < 3; ++a)
    n[a] = parts(shape.size[a], edge, 1);
  add_cube(mesh, n,
           [&](const Vector3& p)
           {
             return shape.centre +
                    Vector3{ 0.5 * shape.size[0] * p[0], 0.5 * shape.size[1] * p[1], 0.5 * shape.size[2] * p[2] };
           });
  return mesh;
}

TriangleMesh ellipsoid(const Shape& shape, const Vector3& radii, double edge)
{
  TriangleMesh mesh;
  const std::int32_t n = parts(0.5 * pi * std::max({ radii[0], radii[1], radii[2] }), edge, 3);
  add_cube(
      mesh, { n, n, n },
      [&](const Vector3& p)
      {
        // equal angles, so that squares on the sphere are alike
        const Vector3 q = normalised({ std::tan(pi / 4 * p[0]), std::tan(pi / 4 * p[1]), std::tan(pi / 4 * p[2]) });
        return shape.centre + Vector3{ radii[0] * q[0], radii[1] * q[1], radii[2] * q[2] };
      });
  return mesh;
}

TriangleMesh cylinder(const Shape& shape, double edge)
{
  TriangleMesh mesh;
  const auto frame = frame_of(shape.axis);
  const std::int32_t around = parts(2 * pi * shape.radius, edge, 12);
  const std::int32_t along = parts(shape.length, edge, 1);
  const std::int32_t out = parts(shape.radius, edge, 1);
  const auto at = [&](double radius, std::int32_t i, double z)
  {
    const double angle = 2 * pi * (i % around) / around;
    return shape.centre + (radius * std::cos(angle)) * frame[0] + (radius * std::sin(angle)) * frame[1] + z * frame[2];
  };
  const double half = 0.5 * shape.length;
  const auto height = [&](std::int32_t j) { return j == along ? half : -half + shape.length * j / along; };
  const auto reach = [&](std::int32_t j) { return j == out ? shape.radius : shape.radius * j / out; };
  add_sheet(mesh, around, along, [&](std::int32_t i, std::int32_t j) { return at(shape.radius, i, height(j)); });
  add_sheet(mesh, out, around, [&](std::int32_t j, std::int32_t i) { return at(reach(j), i, half); });
  add_sheet(mesh, around, out, [&](std::int32_t i, std::int32_t j) { return at(reach(j), i, -half); });
  return mesh;
}

TriangleMesh torus(const Shape& shape, double edge)
{
  TriangleMesh mesh;
  const auto frame = frame_of(shape.axis);
  const std::int32_t around = parts(2 * pi * (shape.radius + shape.minor_radius), edge, 12);
  const std::int32_t tube = parts(2 * pi * shape.minor_radius, edge, 8);
  add_sheet(mesh, around, tube,
            [&](std::int32_t i, std::int32_t j)
            {
              const double ring = 2 * pi * (i % around) / around, angle = 2 * pi * (j % tube) / tube;
              const double radius = shape.radius + shape.minor_radius * std::cos(angle);
              return shape.centre + (radius * std::cos(ring)) * frame[0] + (radius * std::sin(ring)) * frame[1] +
                     (shape.minor_radius * std::sin(angle)) * frame[2];
            });
  return mesh;
}

void require(bool good, const std::string& what)
{
  if (!good)
    throw Error(what);
}

}  // namespace

TriangleMesh make_shape(const Shape& shape)
{
  const Vector3& s = shape.size;
  switch (shape.kind)
  {
    case Shape::Kind::box:
      require(s[0] > 0 && s[1] > 0 && s[2] > 0, "box: every edge of 'size' must be above 0");
      return box(shape, shape.edge > 0 ? shape.edge : std::max({ s[0], s[1], s[2] }));
    case Shape::Kind::sphere:
      require(shape.radius > 0, "sphere: 'radius' must be above 0");
      return ellipsoid(shape, { shape.radius, shape.radius, shape.radius },
                       shape.edge > 0 ? shape.edge : shape.radius / 12);
    case Shape::Kind::ellipsoid:
      require(s[0] > 0 && s[1] > 0 && s[2] > 0, "ellipsoid: every semi-axis of 'size' must be above 0");
      return ellipsoid(shape, s, shape.edge > 0 ? shape.edge : std::max({ s[0], s[1], s[2] }) / 12);
    case Shape::Kind::cylinder:
      require(shape.radius > 0 && shape.length > 0, "cylinder: 'radius' and 'length' must be above 0");
      return cylinder(shape, shape.edge > 0 ? shape.edge : shape.radius / 6);
    case Shape::Kind::torus:
      require(shape.minor_radius > 0 && shape.radius > shape.minor_radius,
              "torus: 'minor_radius' must be above 0 and below 'radius'");
      return torus(shape, shape.edge > 0 ? shape.edge : shape.minor_radius / 3);
    case Shape::Kind::forehead:
      break;
  }
  throw Error("the shape has no maker");
}

}  // namespace frontalis
