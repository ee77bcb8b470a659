#include "frontalis/error.hpp"
#include "bake/mesh/surface.hpp"

#include <fmt/format.h>

namespace frontalis
{
namespace
{

std::int32_t parts(double length, double edge, std::int32_t lowest)
{
  return std::max(lowest, static_cast<std::int32_t>(std::min(2000.0, std::ceil(length / edge - 1e-9))));
}

/// Right-handed orthonormal axes as columns; the last one is parallel to `axis`.
Eigen::Matrix3d frame_of(const Vector3& axis)
{
  const Vector3d along = to_vector(axis).norm() > 0 ? to_vector(axis).normalized() : Vector3d::UnitZ().eval();
  const Vector3d aside = std::abs(along[2]) < 0.9 ? Vector3d::UnitZ() : Vector3d::UnitX();
  Eigen::Matrix3d frame;
  frame.col(2) = along;
  frame.col(0) = aside.cross(along).normalized();
  frame.col(1) = along.cross(frame.col(0));
  return frame;
}

/// Adds the surface of the cube [-1, 1]^3, mapped by `place`, with n[a] squares along axis a.
void add_cube(TriangleMesh& mesh, const std::array<std::int32_t, 3>& n,
              const std::function<Vector3d(const Vector3d&)>& place)
{
  for (int a = 0; a < 3; ++a)
  {
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    for (const int side : { -1, 1 })
    {
      // The normal of (b, c) points along +a. Exchanging the two gives the outward normal of the lower side.
      const int first = side > 0 ? b : c, second = side > 0 ? c : b;
      add_sheet(mesh, n[first], n[second],
                [&](std::int32_t i, std::int32_t j)
                {
                  Vector3d p;
                  p[a] = side;
                  // The value is exactly 1 at the end, so that adjacent sides have equal vertices at their common edge.
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
  const Vector3d size = to_vector(shape.size);
  add_cube(mesh, { parts(size[0], edge, 1), parts(size[1], edge, 1), parts(size[2], edge, 1) },
           [&](const Vector3d& p) -> Vector3d { return to_vector(shape.centre) + 0.5 * size.cwiseProduct(p); });
  return mesh;
}

TriangleMesh ellipsoid(const Shape& shape, const Vector3d& radii, double edge)
{
  TriangleMesh mesh;
  const std::int32_t n = parts(0.5 * pi * radii.maxCoeff(), edge, 3);
  // The points are spaced by equal angles, so that the squares on the sphere have similar sizes.
  const auto place = [&](const Vector3d& p) -> Vector3d
  {
    const Vector3d q = (pi / 4 * p).array().tan().matrix().normalized();
    return to_vector(shape.centre) + radii.cwiseProduct(q);
  };
  add_cube(mesh, { n, n, n }, place);
  return mesh;
}

TriangleMesh cylinder(const Shape& shape, double edge)
{
  TriangleMesh mesh;
  const auto frame = frame_of(shape.axis);
  const std::int32_t around = parts(2 * pi * shape.radius, edge, 12);
  const std::int32_t along = parts(shape.length, edge, 1);
  const std::int32_t out = parts(shape.radius, edge, 1);
  const auto at = [&](double radius, std::int32_t i, double z) -> Vector3d
  {
    const double angle = 2 * pi * (i % around) / around;
    return to_vector(shape.centre) + frame * Vector3d(radius * std::cos(angle), radius * std::sin(angle), z);
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
  const auto at = [&](std::int32_t i, std::int32_t j) -> Vector3d
  {
    const double ring = 2 * pi * (i % around) / around, angle = 2 * pi * (j % tube) / tube;
    const double radius = shape.radius + shape.minor_radius * std::cos(angle);
    return to_vector(shape.centre) +
           frame * Vector3d(radius * std::cos(ring), radius * std::sin(ring), shape.minor_radius * std::sin(angle));
  };
  add_sheet(mesh, around, tube, at);
  return mesh;
}

void require(bool good, const std::string& what)
{
  if (!good)
    throw Error(what);
}

}  // namespace

void check_edges(double edge, double length)
{
  constexpr double most_edges = 1000;
  if (length > most_edges * edge)
    throw Error(fmt::format(
        "a shape {:.3g} mm long or around has edges of {:.3g} mm; at most {} edges are possible: use a longer "
        "'edge', or check the scene's 'unit'",
        1e3 * length, 1e3 * edge, most_edges));
}

TriangleMesh make_shape(const Shape& shape)
{
  const Vector3& s = shape.size;
  if (shape.edge > 0)
    check_edges(shape.edge, std::max({ s[0], s[1], s[2], shape.length,
                                       2 * pi * (std::max(shape.radius, 0.0) + std::max(shape.minor_radius, 0.0)) }));
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
      return ellipsoid(shape, to_vector(s), shape.edge > 0 ? shape.edge : std::max({ s[0], s[1], s[2] }) / 12);
    case Shape::Kind::cylinder:
      require(shape.radius > 0 && shape.length > 0, "cylinder: 'radius' and 'length' must be above 0");
      return cylinder(shape, shape.edge > 0 ? shape.edge : shape.radius / 6);
    case Shape::Kind::torus:
      require(shape.minor_radius > 0 && shape.radius > shape.minor_radius,
              "torus: 'minor_radius' must be above 0 and below 'radius'");
      return torus(shape, shape.edge > 0 ? shape.edge : shape.minor_radius / 3);
    case Shape::Kind::forehead:
    case Shape::Kind::head:
    case Shape::Kind::muscle:
    case Shape::Kind::offset:
      break;
  }
  throw Error("no mesh can be made of this shape");
}

}  // namespace frontalis
