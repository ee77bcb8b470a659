#include "study/verification/boundary_bodies.hpp"

#include "frontalis/physics/number.hpp"
#include "frontalis/study/table.hpp"

#include <Eigen/Dense>
#include <Eigen/Sparse>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

namespace frontalis
{
namespace
{

constexpr double body_young = 30e3, body_density = 1000;  // [Pa], [kg/m3]

Point to_point(const Eigen::Vector3d& v) { return { { v[0], v[1], v[2] } }; }
Eigen::Vector3d to_vector(const Point& p) { return { p[0], p[1], p[2] }; }

Surface shape_surface(const std::string& name, Shape::Kind kind, double radius, double edge)
{
  Surface surface;
  surface.name = name;
  surface.shape = Shape();
  surface.shape->kind = kind;
  surface.shape->radius = radius;
  surface.shape->edge = edge;
  return surface;
}

SceneMaterial material_of(const std::string& name, double modulus, double poisson)
{
  SceneMaterial material;
  material.name = name;
  material.density = body_density;
  material.parameters = { { "young", modulus }, { "poisson", poisson } };
  return material;
}

// Tissue between an outer surface, which is the skin, and an inner one.
Scene scene_between(const Surface& inner, const Surface& outer, double poisson)
{
  Scene scene;
  scene.file = "boundary body";
  scene.surfaces = { inner, outer };
  scene.materials = { material_of("tissue", body_young, poisson) };
  Volume volume;
  volume.name = "tissue";
  volume.inside = { outer.name };
  volume.outside = { inner.name };
  volume.material = "tissue";
  volume.tissue = true;
  scene.volumes = { volume };
  scene.skin.surface = outer.name;
  scene.accuracy.precision = "double";
  return scene;
}

void keep_an_eighth(Scene& scene)
{
  Region eighth;
  eighth.lower = { 0, 0, 0 };
  scene.volumes[0].crop = scene.skin.crop = eighth;
}

SceneConstraint constraint_at(const std::string& surface, SceneConstraint::Kind kind)
{
  SceneConstraint constraint;
  constraint.name = surface;
  constraint.kind = kind;
  constraint.surfaces = { surface };
  return constraint;
}

// U and W (see curved_layer()) at the outer radius b of a layer on a sphere of radius a. The layer is stiff beyond the
// radius c. The body force f [N/m3] acts against z.
std::pair<double, double> radial_solution(double a, double b, double c, double poisson, bool slides, double f)
{
  constexpr int n = 4000;
  using Row = Eigen::Vector4d;  // coefficients of U and W at the lower node, then at the upper node
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd force = Eigen::VectorXd::Zero(2 * n + 2);
  for (int e = 0; e < n; ++e)
  {
    const double d = (b - a) / n, r = a + (e + 0.5) * d;
    const double mu = shear_modulus(body_young, poisson) * (r > c ? 10 : 1);
    const double lambda =
        (bulk_modulus(body_young, poisson) - 2.0 / 3 * shear_modulus(body_young, poisson)) * (r > c ? 10 : 1);
    const Row stretch(-1 / d, 0, 1 / d, 0), hoop = Row::Constant(0.5) / r, slope(0, -1 / d, 0, 1 / d);
    const Row volume = stretch + 2 * hoop, shear = slope - hoop;
    const Eigen::Matrix4d k =
        r * r * d *
        (lambda * volume * volume.transpose() +
         2 * mu * (stretch * stretch.transpose() + 2 * hoop * hoop.transpose() + shear * shear.transpose()));
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j)
        entries.emplace_back(2 * e + i, 2 * e + j, k(i, j));
    for (const int node : { e, e + 1 })
    {
      force[2 * node] -= 0.5 * f * r * r * d;
      force[2 * node + 1] += f * r * r * d;
    }
  }
  for (int i = 0; i < (slides ? 1 : 2); ++i)
    entries.emplace_back(i, i, 1e30);
  Eigen::SparseMatrix<double> matrix(2 * n + 2, 2 * n + 2);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::VectorXd solution = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(matrix).solve(force);
  return { solution[2 * n], solution[2 * n + 1] };
}

// Writes a box as an OBJ file. `lower`, `upper`: its corners in the frame `turn`.
Surface box_surface(const std::string& name, const Eigen::Matrix3d& turn, const Eigen::Vector3d& lower,
                    const Eigen::Vector3d& upper, const std::string& folder)
{
  Surface surface;
  surface.name = name;
  surface.file = folder + "/" + name + ".obj";
  std::ofstream out(surface.file);
  out.precision(12);
  for (int corner = 0; corner < 8; ++corner)
  {
    Eigen::Vector3d p;
    for (int axis = 0; axis < 3; ++axis)
      p[axis] = corner >> axis & 1 ? upper[axis] : lower[axis];
    out << "v " << (turn * p).transpose() << "\n";
  }
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side)
    {
      // Corners of a side, in the order that makes its normal point outwards.
      const int base = 1 + (side << axis), b = 1 << (axis + 1) % 3, c = 1 << (axis + 2) % 3;
      const int first = side == 1 ? b : c, second = side == 1 ? c : b;
      out << "f " << base << " " << base + first << " " << base + first + second << "\n";
      out << "f " << base << " " << base + first + second << " " << base + second << "\n";
    }
  if (!out.flush())
    throw Error(surface.file + ": cannot be written");
  return surface;
}

Eigen::Vector3d vertex(const TriangleMesh& mesh, std::int32_t index) { return to_vector(mesh.vertices[index]); }

double triangle_area(const TriangleMesh& mesh, const std::array<std::int32_t, 3>& t)
{
  const Eigen::Vector3d a = vertex(mesh, t[0]);
  return 0.5 * (vertex(mesh, t[1]) - a).cross(vertex(mesh, t[2]) - a).norm();
}

}  // namespace

BoundaryBody curved_layer(double thickness, double poisson, bool slides, bool stiff)
{
  constexpr double a = 60.37e-3, edge = 1.5e-3;
  const double b = a + thickness, c = stiff ? b - 1e-3 : b;
  BoundaryBody body;
  body.name = std::string(stiff ? "stiff skin, " : "layer, ") + (slides ? "sliding" : "held") + ", Poisson's ratio " +
              readable(poisson);
  body.scene = scene_between(shape_surface("base", Shape::Kind::sphere, a, edge),
                             shape_surface("skin", Shape::Kind::sphere, b, edge), poisson);
  keep_an_eighth(body.scene);
  body.mirror = BoundaryBody::Mirror::antisymmetric_z;
  if (stiff)
  {
    body.scene.materials.push_back(material_of("stiff", 10 * body_young, poisson));
    body.scene.layers.push_back({ "stiff", "skin", "tissue", "stiff", b - c });
  }
  body.scene.constraints = { constraint_at("base",
                                           slides ? SceneConstraint::Kind::sliding : SceneConstraint::Kind::rigid) };
  if (!stiff)
    body.bounds = { { 0.02, 0.01 } };
  body.converges = !(stiff && slides);
  // Gravity is so weak that strains are about 1e-4.
  const double gravity = slides ? 0.1 : 1;
  body.scene.gravity = { 0, 0, -gravity };
  const auto [radial, tangential] = radial_solution(a, b, c, poisson, slides, body_density * gravity);
  body.exact = [u = radial, w = tangential](const Point& p) -> Point
  {
    const Eigen::Vector3d er = to_vector(p).normalized();
    return to_point(u * er[2] * er + w * (er[2] * er - Eigen::Vector3d::UnitZ()));
  };
  const double speed = std::sqrt(shear_modulus(body_young, poisson) / body_density);
  body.period = slides ? 2 * b / speed : 4 * thickness / speed;
  return body;
}

BoundaryBody pressed_sphere(double poisson)
{
  constexpr double a = 20e-3, b = 40e-3, pressure = 10;
  BoundaryBody body;
  body.name = "hollow sphere, Poisson's ratio " + readable(poisson);
  body.scene = scene_between(shape_surface("hollow", Shape::Kind::sphere, a, 0.7e-3),
                             shape_surface("skin", Shape::Kind::sphere, b, 1e-3), poisson);
  keep_an_eighth(body.scene);
  body.mirror = BoundaryBody::Mirror::symmetric;
  body.bounds = { { 0.01, 0.005 } };
  SceneLoad load;
  load.name = "pressure";
  load.kind = SceneLoad::Kind::pressure;
  load.surface = "hollow";
  load.crop = body.scene.skin.crop;
  load.value = { pressure, 0, 0 };
  body.scene.loads = { load };
  body.exact = [=](const Point& p) -> Point
  {
    const double r = std::hypot(p[0], p[1], p[2]);
    const double over_radius = pressure * a * a * a / (body_young * (b * b * b - a * a * a)) *
                               ((1 - 2 * poisson) + (1 + poisson) * b * b * b / (2 * r * r * r));
    return { { over_radius * p[0], over_radius * p[1], over_radius * p[2] } };
  };
  body.period = 4 * b / std::sqrt(body_young / 3 / body_density);
  return body;
}

BoundaryBody turned_bar(bool round, BarLoad load, const std::string& folder)
{
  const double length = round ? 30e-3 : 40e-3, half = round ? 5e-3 : 4e-3;
  constexpr double below = 2.7e-3;    // length of the bar inside the bone [m], so that the grid starts in the bone
  constexpr double curvature = 0.03;  // curvature, or twist per length [1/m]
  const bool bends = load == BarLoad::bending;
  const double poisson = bends ? 0 : 0.3;
  const Eigen::Matrix3d turn = (Eigen::AngleAxisd(physics::pi / 6, Eigen::Vector3d::UnitY()) *
                                Eigen::AngleAxisd(physics::pi / 6, Eigen::Vector3d::UnitX()))
                                   .toRotationMatrix();
  const Surface bone = box_surface("bone", turn, { -15e-3, -15e-3, -8e-3 }, { 15e-3, 15e-3, 0 }, folder);
  Surface bar;
  if (round)
  {
    bar = shape_surface("bar", Shape::Kind::cylinder, half, 0.25e-3);
    bar.shape->axis = to_point(turn.col(2));
    bar.shape->centre = to_point(0.5 * (length - below) * turn.col(2));
    bar.shape->length = length + below;
  }
  else
    bar = box_surface("bar", turn, { -half, -half, -below }, { half, half, length }, folder);

  BoundaryBody body;
  body.name = std::string(round ? "round bar, " : "square bar turned, ") + (bends ? "bending" : "torsion");
  body.scene = scene_between(bone, bar, poisson);
  body.scene.skin.extrapolation = 10e-3;  // part of the skin is inside the bone, far from the tissue
  body.scene.constraints = { constraint_at("bone", SceneConstraint::Kind::rigid) };
  body.exact = [=](const Point& p) -> Point
  {
    const Eigen::Vector3d y = turn.transpose() * to_vector(p);
    if (y[2] < 0.1e-3)
      return { { std::numeric_limits<double>::quiet_NaN(), 0, 0 } };
    const Eigen::Vector3d u =
        bends ? Eigen::Vector3d(0.5 * y[2] * y[2], 0, -y[0] * y[2]) : Eigen::Vector3d(-y[2] * y[1], y[2] * y[0], 0);
    return to_point(curvature * (turn * u));
  };
  body.end = grid_mesh(8, round ? 24 : 8,
                       [&](double s, double t) -> Point
                       {
                         const Eigen::Vector3d y =
                             round ? Eigen::Vector3d(s * half * std::cos(2 * physics::pi * t),
                                                     s * half * std::sin(2 * physics::pi * t), length)
                                   : Eigen::Vector3d((2 * s - 1) * half, (2 * t - 1) * half, length);
                         return to_point(turn * y);
                       });
  const double modulus = bends ? body_young : shear_modulus(body_young, poisson);
  const auto unit_traction = [=](const Point& p) -> Eigen::Vector3d
  {
    const Eigen::Vector3d y = turn.transpose() * to_vector(p);
    return turn * (bends ? Eigen::Vector3d(0, 0, -y[0]) : Eigen::Vector3d(-y[1], y[0], 0));
  };
  // Tractions act at the middles of the end's triangles. They are scaled so that their moment is exact.
  const double moment = (round ? physics::pi / 4 : 4.0 / 3) * std::pow(half, 4) * (bends ? 1 : 2);
  double of_triangles = 0;
  for (const auto& t : body.end.triangles)
  {
    const Eigen::Vector3d middle = (vertex(body.end, t[0]) + vertex(body.end, t[1]) + vertex(body.end, t[2])) / 3;
    of_triangles += triangle_area(body.end, t) * unit_traction(to_point(middle)).squaredNorm();
  }
  body.traction = [=](const Point& p) -> Point
  { return to_point(moment / of_triangles * modulus * curvature * unit_traction(p)); };
  // The period of bending is that of a cantilever's first mode, with the wave number 1.875 / length. Torsion is faster.
  const double slowness = bends ? 0.5 * half : length / 1.875;
  body.period = bends ? 2 * physics::pi * length * length / (3.516 * slowness * std::sqrt(body_young / body_density))
                      : 4 * length / std::sqrt(modulus / body_density);
  return body;
}

}  // namespace frontalis
