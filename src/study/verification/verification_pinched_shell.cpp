// Curved layers that are shells, baked from scenes: a cylinder and a hemisphere that point loads pinch.

#include "frontalis/physics/number.hpp"
#include "frontalis/solver/bound_displacement.hpp"
#include "frontalis/solver/shell_mesh.hpp"
#include "study/verification/film_slab.hpp"

#include <cmath>

namespace frontalis
{
namespace
{

constexpr double pinched_poisson = 0.3;

// A force at a point of a shell, outwards.
struct PointLoad
{
  Point at;
  double force;
};

// A benchmark, in a unit of length of its own.
struct Benchmark
{
  std::string name;
  Shape::Kind kind = Shape::Kind::sphere;
  double radius = 0, thickness = 0, young = 0;
  Region crop;
  std::vector<PointLoad> loads;  // of equal size
  double displacement = 0;       // at each load, along it
  double unit = 1;               // [m]
};

// A cylinder whose ends are diaphragms (Belytschko et al. 1985), and a hemisphere with a hole of 18 degrees (MacNeal &
// Harder 1985; their 0.0924 is for the hemisphere without a hole). Both are whole, because no moment would pass the
// edges at planes of symmetry.
std::vector<Benchmark> benchmarks()
{
  Benchmark cylinder, hemisphere;
  cylinder.name = "cylinder";
  cylinder.kind = Shape::Kind::cylinder;
  cylinder.radius = 300;
  cylinder.thickness = 3;
  cylinder.young = 3e6;
  cylinder.crop.lower[0] = 0;
  cylinder.crop.upper[0] = 600;
  cylinder.loads = { { { 300, 300, 0 }, -1 }, { { 300, -300, 0 }, -1 } };
  cylinder.displacement = 1.8248e-5;
  cylinder.unit = 1e-4;
  hemisphere.name = "hemisphere";
  hemisphere.kind = Shape::Kind::sphere;
  hemisphere.radius = 10;
  hemisphere.thickness = 0.04;
  hemisphere.young = 6.825e7;
  hemisphere.crop.lower[2] = 0;
  hemisphere.crop.upper[2] = hemisphere.radius * std::sin(72 * physics::pi / 180);
  hemisphere.loads = { { { 10, 0, 0 }, 2 }, { { -10, 0, 0 }, 2 }, { { 0, 10, 0 }, -2 }, { { 0, -10, 0 }, -2 } };
  hemisphere.displacement = 0.0940;
  hemisphere.unit = 1e-3;
  return { cylinder, hemisphere };
}

// The shell in voxels of a tissue that is too soft to matter. `edge`: of the voxels.
Model baked(const Benchmark& of, double edge, const BakeScene& bake)
{
  constexpr double softness = 1e-9;
  const double depth = 1.2 * edge * of.unit;
  Scene scene;
  scene.file = of.name;
  Surface surface;
  surface.name = "shell";
  surface.shape = Shape();
  surface.shape->kind = of.kind;
  surface.shape->radius = (of.radius + 0.5 * of.thickness) * of.unit;
  surface.shape->axis = { 1, 0, 0 };
  surface.shape->length = 4 * of.radius * of.unit;
  surface.shape->centre = { of.kind == Shape::Kind::cylinder ? of.radius * of.unit : 0, 0, 0 };
  surface.shape->edge = edge * of.unit;
  scene.surfaces = { surface };
  Volume tissue;
  tissue.name = tissue.material = "tissue";
  tissue.within = "shell";
  tissue.depth_min = -depth;
  tissue.depth_max = depth;
  tissue.tissue = true;
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    tissue.crop.lower[axis] = of.crop.lower[axis] * of.unit;
    tissue.crop.upper[axis] = of.crop.upper[axis] * of.unit;
  }
  scene.volumes = { tissue };
  for (const auto& [name, young] : { std::make_pair("tissue", softness * of.young), std::make_pair("shell", of.young) })
  {
    SceneMaterial material;
    material.name = name;
    material.density = 1000;
    material.parameters = { { "young", young }, { "poisson", pinched_poisson } };
    scene.materials.push_back(material);
  }
  scene.layers.push_back({ "shell", "shell", "tissue", "shell", of.thickness * of.unit, 0, true });
  scene.skin.surface = "shell";
  scene.skin.crop = tissue.crop;
  scene.accuracy.voxel = { edge * of.unit, edge * of.unit, edge * of.unit };
  scene.accuracy.precision = "double";
  return bake(scene);
}

double distance(const Point& a, const Point& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

std::size_t nearest(const Vectors& points, const Point& at)
{
  std::size_t best = 0;
  for (std::size_t p = 0; p < points.size(); ++p)
    if (distance(points[p], at) < distance(points[best], at))
      best = p;
  return best;
}

// Components of points, by the axes of the benchmark, that supports hold. The diaphragms of the cylinder resist motion
// across its axis; the other supports stop rigid motions only, and carry no load.
std::vector<std::array<bool, 3>> supports(const Benchmark& of, const Vectors& points)
{
  std::vector<std::array<bool, 3>> held(points.size());
  if (of.kind == Shape::Kind::cylinder)
  {
    const double rounding = 1e-6 * of.radius;
    for (std::size_t p = 0; p < points.size(); ++p)
      if (points[p][0] < of.crop.lower[0] + rounding || points[p][0] > of.crop.upper[0] - rounding)
        held[p] = { { false, true, true } };
    held[nearest(points, { { of.radius, 0, of.radius } })][0] = true;
    return held;
  }
  const double top = of.crop.upper[2];
  for (const std::size_t load : { 0, 1 })
    held[nearest(points, of.loads[load].at)] = { { false, true, true } };
  held[nearest(points, of.loads[2].at)][0] = true;
  held[nearest(points, { { std::sqrt(of.radius * of.radius - top * top), 0, top } })][1] = true;
  return held;
}

struct Pinched
{
  const Benchmark& of;
  Model model;
  ShellMesh mesh;
  Vectors vertices;  // in axes and units of the benchmark

  Pinched(const Benchmark& benchmark, double edge, const BakeScene& bake)
      : of(benchmark), model(baked(benchmark, edge, bake)), mesh(model)
  {
    std::vector<double> at[3];
    for (std::size_t n = 0; n < model.nodes.size(); ++n)
      for (std::size_t axis = 0; axis < 3; ++axis)
        at[axis].push_back(rest_position(model, n)[axis]);
    const double* const nodes[3] = { at[0].data(), at[1].data(), at[2].data() };
    for (std::size_t v = 0; v < mesh.binding.voxel.size(); ++v)
      vertices.push_back(in_benchmark(bound_displacement(model, mesh.binding, v, nodes)));
  }

  Point in_benchmark(const Point& local) const
  {
    const Point p = model.to_scene(local);
    return { { p[0] / of.unit, p[1] / of.unit, p[2] / of.unit } };
  }

  // Values per axis of the benchmark, in the order of the model's axes.
  template <class T>
  std::array<T, 3> in_model(const std::array<T, 3>& values) const
  {
    std::array<T, 3> out{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t local = 0; local < 3; ++local)
        if (model.to_scene.rotation[3 * axis + local] != 0)
          out[local] = values[axis];
    return out;
  }

  // Forces at the vertices next to the loads [N], with the scene's unit of length.
  std::vector<physics::Vec3<double>> forces() const
  {
    std::vector<physics::Vec3<double>> out(vertices.size(), { 0, 0, 0 });
    for (const auto& [at, force] : of.loads)
    {
      const std::size_t v = nearest(vertices, at);
      const Point& p = vertices[v];
      const double along = of.kind == Shape::Kind::cylinder ? 0 : p[0];
      const double per_length = force * of.unit * of.unit / std::hypot(along, p[1], p[2]);
      const Point f = in_model(Point{ { per_length * along, per_length * p[1], per_length * p[2] } });
      out[v] = { f[0], f[1], f[2] };
    }
    return out;
  }

  // Mean displacement at the loads, from their work.
  double displacement(const Vectors& u, const Vectors& forces) const
  {
    double work = 0;
    for (std::size_t p = 0; p < u.size(); ++p)
      for (std::size_t axis = 0; axis < 3; ++axis)
        work += forces[p][axis] * u[p][axis];
    return work / (static_cast<double>(of.loads.size()) * std::abs(of.loads[0].force) * std::pow(of.unit, 3));
  }

  double alone() const
  {
    auto held = supports(of, vertices);
    for (auto& axes : held)
      axes = in_model(axes);
    Vectors loads;
    for (const auto& f : forces())
      loads.push_back({ { f.x, f.y, f.z } });
    return displacement(LinearStatics(model, held).solve(loads), loads);
  }

  double carried() const
  {
    Model supported = model;
    Vectors nodes, loads(model.nodes.size());
    for (std::size_t n = 0; n < model.nodes.size(); ++n)
      nodes.push_back(in_benchmark(rest_position(model, n)));
    const auto held = supports(of, nodes);
    for (std::size_t n = 0; n < held.size(); ++n)
      if (held[n][0] || held[n][1] || held[n][2])
        prescribe(supported, { static_cast<std::int32_t>(n) }, in_model(held[n]));
    spread_forces(model, mesh.binding, forces(), loads);
    return displacement(LinearStatics(supported).solve(loads), loads);
  }
};

}  // namespace

void verify_pinched_shell(const Backend& /*backend*/, const BakeScene& bake, Finding& finding)
{
  if (!runs(bake, finding))
    return;
  Table table({ "shell", "radius over voxel", "vertices", "displacement over the published one", "error [%]" });
  for (const Benchmark& of : benchmarks())
    for (const double finer : { 10, 20, 40 })
    {
      const Pinched shell(of, of.radius / finer, bake);
      const double alone = shell.alone(), found = alone / of.displacement;
      table.add({ of.name, finer, static_cast<double>(shell.vertices.size()), found, 100 * (found - 1) });
      if (finer == 10)
        finding.checks.relative("pinched " + of.name + " in voxels: displacement over that of the shell alone", "1", 1,
                                shell.carried() / alone, 0.01);
      if (finer == 40)
        finding.checks.relative("pinched " + of.name + ": displacement over the published one", "1", 1, found, 0.05);
    }
  finding.tables.emplace_back("Pinched shells, displacement at the loads", table);
}

}  // namespace frontalis
