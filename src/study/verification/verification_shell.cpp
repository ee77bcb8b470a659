// Layers that are shells, baked from scenes: strained membranes, bent plates, a plate under pressure, a cantilever.

#include "frontalis/physics/number.hpp"
#include "frontalis/solver/shell_mesh.hpp"
#include "study/verification/film_slab.hpp"

#include <cmath>
#include <tuple>

namespace frontalis
{
namespace
{

double bending_stiffness(double thickness)
{
  return shell_young * std::pow(thickness, 3) / (12 * (1 - shell_poisson * shell_poisson));
}

double shell_energy(const Model& model, const Vectors& u)
{
  SolverSettings settings{ "reference", 1, 0 };
  settings.ledger = true;
  const auto solver = make_solver(std::make_shared<const Model>(model), settings);
  solver->set_displacements(u);
  return solver->ledger()["shell"];
}

// Energy of a plate that is bent to an oblong bump, divided by that of plate theory. `angle`: rotation of the bump
// relative to the voxels [rad].
double bump_energy(const Model& model, const Slab& slab, double angle)
{
  const double side = slab.size[0] * slab.edge, amplitude = 1e-3 * slab.edge, radius[2] = { 0.24 * side, 0.45 * side };
  // With w = a (1 - (x / r0)^2 - (y / r1)^2)^4 the bump needs no moment at its rim.
  const auto bump = [&](double x, double y)
  {
    const double q = 1 - std::pow(x / radius[0], 2) - std::pow(y / radius[1], 2);
    return q > 0 ? amplitude * std::pow(q, 4) : 0;
  };
  double squared = 0;  // integral of (w_xx + w_yy)^2; the integral of the Gaussian curvature is 0
  const double step = 2e-3 * side;
  for (double x = -radius[0]; x < radius[0]; x += step)
    for (double y = -radius[1]; y < radius[1]; y += step)
      squared += std::pow(
          (bump(x + step, y) + bump(x - step, y) + bump(x, y + step) + bump(x, y - step) - 4 * bump(x, y)) / step, 2);
  Vectors u(model.nodes.size());
  for (std::size_t n = 0; n < u.size(); ++n)
  {
    const Point p = rest_position(model, n);
    const double x = p[0] - 0.5 * side, y = p[1] - 0.5 * side;
    u[n][2] = bump(std::cos(angle) * x + std::sin(angle) * y, std::cos(angle) * y - std::sin(angle) * x);
  }
  return shell_energy(model, u) / (0.5 * bending_stiffness(slab.layers[0].thickness) * squared);
}

// Mean deflection of a square shell alone, supported at its edges, under a uniform pressure, divided by that of plate
// theory (Navier's series).
double pressed_deflection(const Model& model, double side)
{
  const ShellMesh mesh(model);
  const double pressure = 1;
  Vectors loads(mesh.binding.voxel.size());
  std::vector<std::array<bool, 3>> held;
  for (std::size_t v = 0; v < loads.size(); ++v)
  {
    const Voxel& voxel = model.voxels[mesh.binding.voxel[v]];
    bool edge = false;
    for (std::size_t axis = 0; axis < 2; ++axis)
    {
      const double at = (voxel[axis] + double(mesh.binding.coordinates[v][axis])) * model.spacing[axis] / side;
      edge = edge || at < 1e-6 || at > 1 - 1e-6;
    }
    held.push_back({ { true, true, edge } });
  }
  for (const auto& triangle : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i)
      loads[triangle.vertex[i]][2] += pressure / (6 * triangle.rest.inverse_area);
  const Vectors u = LinearStatics(model, held).solve(loads);
  double work = 0, expected = 0;
  for (std::size_t v = 0; v < u.size(); ++v)
    work += loads[v][2] * u[v][2];
  for (int m = 1; m < 100; m += 2)
    for (int n = 1; n < 100; n += 2)
      expected += std::pow(m * n * (m * m + n * n), -2.0);
  expected *= 64 / std::pow(physics::pi, 8) * pressure * std::pow(side, 4) / bending_stiffness(shell_thickness);
  return work / (pressure * side * side) / expected;
}

// A square shell of 2 n^2 triangles in a single voxel. Diagonals of its squares have one direction, or two in turn.
Model ruled_plate(int n, double side, bool in_turn)
{
  Model model = voxel_model({ { 1, 1, 1 } }, side, neo_hookean(shell_young, shell_poisson));
  Shell shell;
  shell.name = "plate";
  shell.thickness = shell_thickness;
  shell.surface = grid_mesh(n, n, [side](double s, double t) { return Point{ { s * side, t * side, 0 } }; });
  for (int i = 0; i < n && in_turn; ++i)
    for (int j = i % 2; j < n; j += 2)
    {
      auto* const pair = &shell.surface.triangles[2 * (i * n + j)];
      const std::int32_t corner = pair[0][0], below = pair[0][1], across = pair[0][2], beside = pair[1][2];
      pair[0] = { { corner, below, beside } };
      pair[1] = { { below, across, beside } };
    }
  shell.binding = bind_points(model, shell.surface.vertices);
  model.shells = { shell };
  return model;
}

// Tip deflection of a strip under a force at its tip, by linear statics, divided by the deflection of a beam.
double strip_deflection(double depth, const BakeScene& bake, double rough = 2)
{
  Slab slab{ { { 33, 4, 1 } } };
  slab.rough = rough;
  slab.base = 40;
  slab.depth = depth * slab.edge;
  Model model = baked(slab, bake);
  hold(model, [&](const Point& p) { return p[0] < 1.5 * slab.edge; });
  const double reach = 32 * slab.edge, width = 4 * slab.edge, force = 1e-7;
  const auto tip = nodes_where(model, [&](const Point& p) { return p[0] > 32.9 * slab.edge; });
  Vectors forces(model.nodes.size());
  for (const auto n : tip)
    forces[n][2] = force / static_cast<double>(tip.size());
  // A strip that is free to bend across its length has the stiffness of a beam.
  const double beam = bending_stiffness(slab.layers[0].thickness) * (1 - shell_poisson * shell_poisson) * width;
  return mean_displacement(LinearStatics(model).solve(forces), tip)[2] * 3 * beam / (force * std::pow(reach, 3));
}

}  // namespace

Model baked(const Slab& slab, const BakeScene& bake)
{
  Scene scene;
  scene.file = "slab";
  Volume tissue;
  tissue.name = tissue.material = "tissue";
  tissue.inside = { "tissue" };
  tissue.tissue = true;
  const double length = slab.size[0] * slab.edge, width = slab.size[1] * slab.edge, height = slab.size[2] * slab.edge;
  const double margin = 8 * slab.edge;
  tissue.crop.lower = { 0, 0, -height };
  tissue.crop.upper = { length, width, 0 };
  for (const auto& [name, top] : { std::make_pair("tissue", 0.0), std::make_pair("film", -slab.depth) })
  {
    Surface surface;
    surface.name = name;
    surface.shape = Shape();
    surface.shape->size = { length + margin, width + margin, height + margin };
    surface.shape->centre = { 0.5 * length, 0.5 * width, top - 0.5 * (height + margin) };
    surface.shape->edge = slab.rough * slab.edge;
    scene.surfaces.push_back(surface);
  }
  const auto add_material = [&](const std::string& name, double modulus)
  {
    SceneMaterial material;
    material.name = name;
    material.density = 1000;
    material.parameters = { { "young", modulus }, { "poisson", shell_poisson } };
    scene.materials.push_back(material);
  };
  scene.volumes = { tissue };
  add_material("tissue", slab.base);
  for (const auto& layer : slab.layers)
  {
    const std::string name = "layer_" + std::to_string(scene.layers.size());
    add_material(name, layer.young);
    scene.layers.push_back({ name, "film", "tissue", name, layer.thickness, 0, true });
  }
  scene.skin.surface = "tissue";
  scene.skin.crop = tissue.crop;
  scene.accuracy.voxel = { slab.edge, slab.edge, slab.edge };
  scene.accuracy.precision = "double";
  Model model = bake(scene);
  if (model.size != slab.size || model.to_scene.rotation != RigidTransform().rotation)
    throw Error("a slab was not baked with the axes and voxels that it was meant to have");
  return model;
}

bool runs(const BakeScene& bake, Finding& finding)
{
  if (!bake)
    finding.skipped = "the program was built without a bake";
  return finding.skipped.empty();
}

void verify_shell(const Backend& /*backend*/, const BakeScene& bake, Finding& finding)
{
  if (!runs(bake, finding))
    return;
  Slab slab{ { { 48, 48, 2 } } };
  slab.depth = 0.6e-3;
  const Model model = baked(slab, bake);
  const double side = 48 * slab.edge, mu = shell_young / (2 * (1 + shell_poisson)),
               lambda = shell_young * shell_poisson / (1 - shell_poisson * shell_poisson);
  for (const auto& [name, a, b, shear] :
       { std::make_tuple("stretched along x", 0.02, 0.0, 0.0),
         std::make_tuple("shortened both ways", -0.03, -0.03, 0.0), std::make_tuple("sheared", 0.0, 0.0, 0.02) })
  {
    const double expected = side * side * slab.layers[0].thickness *
                            (mu * (a * a + b * b + 2 * shear * shear) + 0.5 * lambda * (a + b) * (a + b));
    const double found =
        shell_energy(model, affine_displacements(model, { 1 + a, shear, 0, shear, 1 + b, 0, 0, 0, 1 }));
    finding.checks.relative(std::string("membrane ") + name + ": energy", "uJ", 1e6 * expected, 1e6 * found, 0.01);
  }
  for (const double degrees : { 0.0, 20.0, 45.0 })
    finding.checks.relative("plate bent at " + readable(degrees) + " degrees to the voxels: energy over theory's", "1",
                            1, bump_energy(model, slab, degrees * physics::pi / 180), 0.05);
  const auto pressed = [&](const std::string& name, const Model& plate, double bound)
  {
    const double deflection = pressed_deflection(plate, side);
    finding.checks.relative("plate under pressure, " + name + ": deflection over theory's", "1", 1, deflection, bound);
    return deflection;
  };
  pressed("triangles in rows", ruled_plate(40, side, false), 0.01);
  pressed("diagonals in turn", ruled_plate(40, side, true), std::nan(""));
  Table rough({ "triangles of the surface [voxel edges]", "plate bent at 20 degrees: energy", "plate under pressure",
                "cantilever" });
  for (const double edges : { 2.0, 7.3, 13.0, 100.0 })
  {
    Slab other = slab;
    other.rough = edges;
    const Model plate = baked(other, bake);
    const double deflection = pressed("triangles of the surface of " + readable(edges) + " voxel edges", plate, 0.05);
    rough.add({ edges, bump_energy(plate, other, physics::pi / 9), deflection, strip_deflection(0.5, bake, edges) });
  }
  for (const double depth : { 0.2, 0.5 })
    finding.checks.relative("cantilever, shell " + readable(depth) + " voxels deep: deflection over theory's", "1", 1,
                            strip_deflection(depth, bake), 0.1);
  finding.tables.emplace_back("The same slabs from surfaces with other triangles, over theory's", rough);
  Table table = film_table();
  check_film({ { { shell_young, 0.5e-3 } }, 0.01 * shell_young, 1e-3 }, "film 100 times as stiff as its base", bake,
             table, finding);
  finding.tables.emplace_back("Wrinkles of a film", table);
}

}  // namespace frontalis
