// Layers that are shells, baked from scenes: strained membranes, bent plates, a cantilever, films that wrinkle.

#include "frontalis/physics/number.hpp"
#include "study/verification/verification_cases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <tuple>

namespace frontalis
{
namespace
{

constexpr double shell_young = 1e6, shell_poisson = 0.49;  // Young's modulus [Pa] and Poisson's ratio of the shell

// A box of tissue with a layer that is a shell. The box is cut out of a larger one, so that the layer covers only the
// top.
struct Slab
{
  Voxel size;
  double edge = 1e-3;       // edge of voxels [m]
  double base = 1e3;        // Young's modulus below the shell [Pa]
  double thickness = 2e-4;  // thickness of the shell [m]
  double depth = 0;         // depth of the shell's upper side below the top [m]
};

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
    surface.shape->edge = 2 * slab.edge;
    scene.surfaces.push_back(surface);
  }
  for (const auto& [name, modulus] : { std::make_pair("tissue", slab.base), std::make_pair("film", shell_young) })
  {
    SceneMaterial material;
    material.name = name;
    material.density = 1000;
    material.parameters = { { "young", modulus }, { "poisson", shell_poisson } };
    scene.materials.push_back(material);
  }
  scene.volumes = { tissue };
  scene.layers = { { "film", "film", "tissue", "film", slab.thickness, 0, true } };
  scene.skin.surface = "tissue";
  scene.skin.crop = tissue.crop;
  scene.accuracy.voxel = { slab.edge, slab.edge, slab.edge };
  scene.accuracy.precision = "double";
  Model model = bake(scene);
  if (model.size != slab.size || model.to_scene.rotation != RigidTransform().rotation)
    throw Error("a slab was not baked with the axes and voxels that it was meant to have");
  return model;
}

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
  return shell_energy(model, u) / (0.5 * bending_stiffness(slab.thickness) * squared);
}

// Tip deflection of a strip under a force at its tip, by linear statics, divided by the deflection of a beam.
double strip_deflection(double depth, const BakeScene& bake)
{
  Slab slab{ { { 33, 4, 1 } } };
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
  const double beam = bending_stiffness(slab.thickness) * (1 - shell_poisson * shell_poisson) * width;
  return mean_displacement(LinearStatics(model).solve(forces), tip)[2] * 3 * beam / (force * std::pow(reach, 3));
}

// A film on a deep soft base, in plane strain.
struct Film
{
  double contrast;   // Young's modulus of the film divided by that of the base
  double thickness;  // [m]
  double edge;       // edge of voxels [m]

  double wavelength() const { return thickness * expected_wrinkles(contrast).wavelength; }
  double compression() const { return 0.01 * expected_wrinkles(contrast).compression; }
};

struct FilmModel
{
  Model model;
  double length;  // [m]
};

std::array<double, 9> compressed(double compression)
{
  return { { 1 - compression, 0, 0, 0, 1, 0, 0, 0, free_stretch(1 - compression) } };
}

// A film on a base with a length of `waves` wavelengths. Ends and bottom are displaced as in a uniform compression,
// because ends that are free to rise would fold at half the compression, as the end of a free beam does.
FilmModel film_model(const Film& film, double waves, const BakeScene& bake, double compression = 0)
{
  const double edges = film.wavelength() / film.edge;
  Slab slab{ { { static_cast<int>(std::lround(waves * edges)), 6, static_cast<int>(std::lround(0.8 * edges)) } } };
  slab.edge = film.edge;
  slab.base = shell_young / film.contrast;
  slab.thickness = film.thickness;
  FilmModel made{ baked(slab, bake), slab.size[0] * slab.edge };
  Model& model = made.model;
  prescribe(model, nodes_where(model, [](const auto&) { return true; }), { { false, true, false } });
  const Vectors u = affine_displacements(model, compressed(compression));
  for (std::int32_t n = 0; n < static_cast<std::int32_t>(u.size()); ++n)
    if (const auto& place = model.nodes[n]; place[0] == 0 || place[0] == model.size[0] || place[2] == 0)
      prescribe(model, { n }, { { true, false, true } }, u[n]);
  return made;
}

// Positions along the length, with the height of the top at each position minus its mean.
std::vector<std::pair<double, double>> profile(const Model& model, const Vectors& u)
{
  std::map<double, double> height;
  double mean = 0;
  int count = 0;
  for (std::size_t n = 0; n < u.size(); ++n)
    if (model.nodes[n][2] == model.size[2])
    {
      height[rest_position(model, n)[0]] += u[n][2] / (model.size[1] + 1);
      mean += u[n][2];
      ++count;
    }
  std::vector<std::pair<double, double>> found;
  found.reserve(height.size());
  for (const auto& [x, z] : height)
    found.emplace_back(x, z - mean / count);
  return found;
}

// The wavelength with the largest Fourier component, from half to twice an expected wavelength.
double strongest_wavelength(const std::vector<std::pair<double, double>>& heights, double expected)
{
  double best = 0, largest = -1;
  for (double wavelength = 0.5 * expected; wavelength < 2 * expected; wavelength *= 1.002)
  {
    std::complex<double> sum = 0;
    for (const auto& [x, z] : heights)
      sum += z * std::exp(std::complex<double>(0, 2 * physics::pi * x / wavelength));
    if (std::abs(sum) > largest)
    {
      largest = std::abs(sum);
      best = wavelength;
    }
  }
  return best;
}

// The compression at which the flat film becomes unstable, and the wavelength [m] of the mode that grows there.
struct Instability
{
  double compression, wavelength;
  Vectors mode;
};

Instability instability(const Film& film, const FilmModel& made)
{
  const double expected = film.compression();
  double stable = 0.6 * expected;
  Instability found{};
  found.compression = zero_between(
      0.6 * expected, 1.5 * expected,
      [&](double compression)
      {
        if (!LinearStatics(made.model, compressed(compression)).positive_definite())
          return 1;
        stable = compression;
        return -1;
      },
      6);
  const LinearStatics statics(made.model, compressed(stable));
  Vectors& mode = found.mode;
  mode.resize(made.model.nodes.size());
  for (std::size_t n = 0; n < mode.size(); ++n)
    if (made.model.nodes[n][2] == made.model.size[2])
      mode[n][2] = std::sin(12.9898 * made.model.nodes[n][0] * made.model.nodes[n][0]);
  for (int i = 0; i < 20; ++i)
  {
    mode = statics.solve(mode);
    double largest = 0;
    for (const Point& p : mode)
      largest = std::max(largest, std::abs(p[2]));
    for (Point& p : mode)
      for (double& x : p)
        x /= largest;
  }
  found.wavelength = strongest_wavelength(profile(made.model, mode), film.wavelength());
  return found;
}

void check_film(const Film& film, const BakeScene& bake, Table& table, Finding& finding)
{
  const Instability found = instability(film, film_model(film, 5, bake));
  const std::string name = fmt::format("film of {}, {} times as stiff, voxels of {}: ", millimetres(film.thickness),
                                       film.contrast, millimetres(film.edge));
  finding.checks.relative(name + "wavelength", "mm", 1e3 * film.wavelength(), 1e3 * found.wavelength, 0.1);
  finding.checks.relative(name + "critical compression", "%", 100 * film.compression(), 100 * found.compression, 0.15);
  const auto rounded = [](double x) { return std::round(100 * x) / 100; };
  table.add({ film.contrast, 1e3 * film.thickness, 1e3 * film.edge, rounded(film.wavelength() / film.edge),
              rounded(1e3 * film.wavelength()), rounded(1e3 * found.wavelength), rounded(100 * film.compression()),
              rounded(100 * found.compression) });
}

// Checks the amplitude of a film that is compressed past its critical compression and has come to rest. In theory it is
// thickness * sqrt(compression / critical - 1) (Chen & Hutchinson 2004).
void check_growth(const Film& film, const Backend& backend, const BakeScene& bake, Finding& finding)
{
  const Instability found = instability(film, film_model(film, 5, bake));
  std::vector<double> excess, amplitude;
  for (const double ratio : { 1.1, 1.2, 1.4, 1.8 })
  {
    const double compression = ratio * found.compression, expected = film.thickness * std::sqrt(ratio - 1);
    const auto model = std::make_shared<const Model>(film_model(film, 5, bake, compression).model);
    const auto solver = make_solver(model, { backend, 1, 0 });
    Vectors u = affine_displacements(*model, compressed(compression));
    for (std::size_t n = 0; n < u.size(); ++n)
      for (const std::size_t axis : { 0, 2 })
        u[n][axis] += expected * found.mode[n][axis];
    solver->set_displacements(u);
    const Equilibrium rest = solver->settle(solver->controls(), 1e-4, 10);
    solver->displacements(u);
    double low = 0, high = 0;
    const auto heights = profile(*model, u);
    for (std::size_t i = heights.size() / 4; i < heights.size() * 3 / 4; ++i)
    {
      low = std::min(low, heights[i].second);
      high = std::max(high, heights[i].second);
    }
    excess.push_back(ratio - 1);
    amplitude.push_back(0.5 * (high - low));
    finding.checks.relative(fmt::format("film at {:g} times its critical compression: amplitude", ratio), "mm",
                            1e3 * expected, rest.reached ? 1e3 * amplitude.back() : std::nan(""), 0.15);
  }
  finding.checks.relative("power of the excess at which the amplitude grows", "1", 0.5, slope(excess, amplitude), 0.1);
}

Table film_table()
{
  return Table({ "E film / E base", "thickness [mm]", "voxel [mm]", "wavelength over voxel", "wavelength [mm]",
                 "found [mm]", "critical compression [%]", "found [%]" });
}

// Returns whether the case can run. If not, the finding says why.
bool runs(const BakeScene& bake, Finding& finding)
{
  if (!bake)
    finding.skipped = "the program was built without a bake";
  return finding.skipped.empty();
}

}  // namespace

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
    const double expected =
        side * side * slab.thickness * (mu * (a * a + b * b + 2 * shear * shear) + 0.5 * lambda * (a + b) * (a + b));
    const double found =
        shell_energy(model, affine_displacements(model, { 1 + a, shear, 0, shear, 1 + b, 0, 0, 0, 1 }));
    finding.checks.relative(std::string("membrane ") + name + ": energy", "uJ", 1e6 * expected, 1e6 * found, 0.01);
  }
  for (const double degrees : { 0.0, 20.0, 45.0 })
    finding.checks.relative("plate bent at " + readable(degrees) + " degrees to the voxels: energy over theory's", "1",
                            1, bump_energy(model, slab, degrees * physics::pi / 180), 0.05);
  for (const double depth : { 0.2, 0.5 })
    finding.checks.relative("cantilever, shell " + readable(depth) + " voxels deep: deflection over theory's", "1", 1,
                            strip_deflection(depth, bake), 0.1);
  Table table = film_table();
  check_film({ 100, 0.5e-3, 1e-3 }, bake, table, finding);
  finding.tables.emplace_back("Wrinkles of a film", table);
}

void verify_wrinkle(const Backend& backend, const BakeScene& bake, Finding& finding)
{
  if (!runs(bake, finding))
    return;
  Table table = film_table();
  for (const double contrast : { 30.0, 100.0, 300.0, 1000.0 })
    for (const double voxels : { 9.0, 12.0, 16.0 })
    {
      const double edge = 1e-3, thickness = voxels * edge / expected_wrinkles(contrast).wavelength;
      check_film({ contrast, 1e-5 * std::round(1e5 * thickness), edge }, bake, table, finding);
    }
  for (const double edge : { 1.5e-3, 1e-3, 0.75e-3 })
    check_film({ 300, 0.5e-3, edge }, bake, table, finding);
  check_growth({ 100, 0.5e-3, 1e-3 }, backend, bake, finding);
  finding.tables.emplace_back("Wrinkles of films", table);
}

}  // namespace frontalis
