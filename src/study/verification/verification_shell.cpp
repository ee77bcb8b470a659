#include "frontalis/physics/number.hpp"
// Layers that are shells, baked from scenes: strained membranes, bent plates, a cantilever, films that wrinkle.
#include "frontalis/physics/number.hpp"

#include "frontalis/physics/number.hpp"
#include "study/verification/verification_cases.hpp"
#include "frontalis/physics/number.hpp"

#include "frontalis/physics/number.hpp"
#include <fmt/format.h>
#include "frontalis/physics/number.hpp"

#include "frontalis/physics/number.hpp"
#include <algorithm>
#include "frontalis/physics/number.hpp"
#include <cmath>
#include "frontalis/physics/number.hpp"
#include <complex>
#include "frontalis/physics/number.hpp"
#include <map>
#include "frontalis/physics/number.hpp"
#include <tuple>
#include "frontalis/physics/number.hpp"

#include "frontalis/physics/number.hpp"
namespace frontalis
#include "frontalis/physics/number.hpp"
{
#include "frontalis/physics/number.hpp"
namespace
#include "frontalis/physics/number.hpp"
{
#include "frontalis/physics/number.hpp"

#include "frontalis/physics/number.hpp"
constexpr double shell_young = 1e6, shell_poisson = 0.49;  // Young's modulus [Pa] and Poisson's ratio of the shell
#include "frontalis/physics/number.hpp"

#include "frontalis/physics/number.hpp"
// A box of tissue with a layer that is a shell. The box is cut out of a larger one, so that the layer covers only the
#include "frontalis/physics/number.hpp"
// top.
#include "frontalis/physics/number.hpp"
struct Slab
#include "frontalis/physics/number.hpp"
{
#include "frontalis/physics/number.hpp"
  Voxel size;
#include "frontalis/physics/number.hpp"
  double edge = 1e-3;  // edge of voxels [m]
#include "frontalis/physics/number.hpp"
  double base = 1e3;  // Young's modulus below the shell [Pa]
#include "frontalis/physics/number.hpp"
  double thickness = 2e-4;  // thickness of the shell [m]
#include "frontalis/physics/number.hpp"
  double depth = 0;  // depth of the shell's upper side below the top [m]
#include "frontalis/physics/number.hpp"
};
#include "frontalis/physics/number.hpp"

#include "frontalis/physics/number.hpp"
Model baked(const Slab& slab, const BakeScene& bake)
#include "frontalis/physics/number.hpp"
{
#include "frontalis/physics/number.hpp"
  Scene scene;
#include "frontalis/physics/number.hpp"
  scene.file = "slab";
#include "frontalis/physics/number.hpp"
  Volume tissue;
#include "frontalis/physics/number.hpp"
  tissue.name = tissue.material = "tissue";
#include "frontalis/physics/number.hpp"
  tissue.inside = { "tissue" };
#include "frontalis/physics/number.hpp"
  tissue.tissue = true;
#include "frontalis/physics/number.hpp"
  const double length = slab.size[0] * slab.edge, width = slab.size[1] * slab.edge, height = slab.size[2] * slab.edge;
#include "frontalis/physics/number.hpp"
  const double margin = 8 * slab.edge;
#include "frontalis/physics/number.hpp"
  tissue.crop.lower = { 0, 0, -height };
#include "frontalis/physics/number.hpp"
  tissue.crop.upper = { length, width, 0 };
#include "frontalis/physics/number.hpp"
  for (const auto& [name, top] : { std::make_pair("tissue", 0.0), std::make_pair("film", -slab.depth) })
#include "frontalis/physics/number.hpp"
  {
#include "frontalis/physics/number.hpp"
    Surface surface;
#include "frontalis/physics/number.hpp"
    surface.name = name;
#include "frontalis/physics/number.hpp"
    surface.shape = Shape();
#include "frontalis/physics/number.hpp"
    surface.shape->size = { length + margin, width + margin, height + margin };
#include "frontalis/physics/number.hpp"
    surface.shape->centre = { 0.5 * length, 0.5 * width, top - 0.5 * (height + margin) };
#include "frontalis/physics/number.hpp"
    surface.shape->edge = 2 * slab.edge;
#include "frontalis/physics/number.hpp"
    scene.surfaces.push_back(surface);
#include "frontalis/physics/number.hpp"
  }
#include "frontalis/physics/number.hpp"
  for (const auto& [name, modulus] : { std::make_pair("tissue", slab.base), std::make_pair("film", shell_young) })
#include "frontalis/physics/number.hpp"
  {
#include "frontalis/physics/number.hpp"
    SceneMaterial material;
#include "frontalis/physics/number.hpp"
    material.name = name;
#include "frontalis/physics/number.hpp"
    material.density = 1000;
#include "frontalis/physics/number.hpp"
    material.parameters = { { "young", modulus }, { "poisson", shell_poisson } };
#include "frontalis/physics/number.hpp"
    scene.materials.push_back(material);
#include "frontalis/physics/number.hpp"
  }
#include "frontalis/physics/number.hpp"
  scene.volumes = { tissue };
#include "frontalis/physics/number.hpp"
  scene.layers = { { "film", "film", "tissue", "film", slab.thickness, 0, true } };
#include "frontalis/physics/number.hpp"
  scene.skin.surface = "tissue";
#include "frontalis/physics/number.hpp"
  scene.skin.crop = tissue.crop;
#include "frontalis/physics/number.hpp"
  scene.accuracy.voxel = { slab.edge, slab.edge, slab.edge };
#include "frontalis/physics/number.hpp"
  scene.accuracy.precision = "double";
#include "frontalis/physics/number.hpp"
  Model model = bake(scene);
#include "frontalis/physics/number.hpp"
  if (model.size != slab.size || model.to_scene.rotation != RigidTransform().rotation)
#include "frontalis/physics/number.hpp"
    throw Error("a slab was not baked with the axes and voxels that it was meant to have");
#include "frontalis/physics/number.hpp"
  return model;
#include "frontalis/physics/number.hpp"
}
#include "frontalis/physics/number.hpp"

#include "frontalis/physics/number.hpp"
double bending_stiffness(double thickness)
{
  return shell_young * std::pow(thickness, 3) / (12 * (1 - shell_poisson * shell_poisson));
}
#include "frontalis/physics/number.hpp"

#include "frontalis/physics/number.hpp"
double shell_energy(const Model& model, const Vectors& u)
#include "frontalis/physics/number.hpp"
{
#include "frontalis/physics/number.hpp"
  SolverSettings settings{ "reference", 1, 0 };
#include "frontalis/physics/number.hpp"
  settings.ledger = true;
#include "frontalis/physics/number.hpp"
  const auto solver = make_solver(std::make_shared<const Model>(model), settings);
#include "frontalis/physics/number.hpp"
  solver->set_displacements(u);
#include "frontalis/physics/number.hpp"
  return solver->ledger()["shell"];
#include "frontalis/physics/number.hpp"
}
#include "frontalis/physics/number.hpp"

#include "frontalis/physics/number.hpp"
// Energy of a plate that is bent to an oblong bump, divided by that of plate theory. `angle`: rotation of the bump
#include "frontalis/physics/number.hpp"
// relative to the voxels [rad].
#include "frontalis/physics/number.hpp"
double bump_energy(const Model& model, const Slab& slab, double angle)
#include "frontalis/physics/number.hpp"
{
#include "frontalis/physics/number.hpp"
  const double side = slab.size[0] * slab.edge, amplitude = 1e-3 * slab.edge, radius[2] = { 0.24 * side, 0.45 * side };
#include "frontalis/physics/number.hpp"
  // With w = a (1 - (x / r0)^2 - (y / r1)^2)^4 the bump needs no moment at its rim.
#include "frontalis/physics/number.hpp"
  const auto bump = [&](double x, double y)
#include "frontalis/physics/number.hpp"
  {
#include "frontalis/physics/number.hpp"
    const double q = 1 - std::pow(x / radius[0], 2) - std::pow(y / radius[1], 2);
#include "frontalis/physics/number.hpp"
    return q > 0 ? amplitude * std::pow(q, 4) : 0;
#include "frontalis/physics/number.hpp"
  };
#include "frontalis/physics/number.hpp"
  double squared = 0;  // integral of (w_xx + w_yy)^2; the integral of the Gaussian curvature is 0
#include "frontalis/physics/number.hpp"
  const double step = 2e-3 * side;
#include "frontalis/physics/number.hpp"
  for (double x = -radius[0]; x < radius[0]; x += step)
#include "frontalis/physics/number.hpp"
    for (double y = -radius[1]; y < radius[1]; y += step)
#include "frontalis/physics/number.hpp"
      squared += std::pow(
#include "frontalis/physics/number.hpp"
          (bump(x + step, y) + bump(x - step, y) + bump(x, y + step) + bump(x, y - step) - 4 * bump(x, y)) / step, 2);
#include "frontalis/physics/number.hpp"
  Vectors u(model.nodes.size());
#include "frontalis/physics/number.hpp"
  for (std::size_t n = 0; n < u.size(); ++n)
#include "frontalis/physics/number.hpp"
  {
#include "frontalis/physics/number.hpp"
    const Point p = rest_position(model, n);
#include "frontalis/physics/number.hpp"
    const double x = p[0] - 0.5 * side, y = p[1] - 0.5 * side;
#include "frontalis/physics/number.hpp"
    u[n][2] = bump(std::cos(angle) * x + std::sin(angle) * y, std::cos(angle) * y - std::sin(angle) * x);
#include "frontalis/physics/number.hpp"
  }
#include "frontalis/physics/number.hpp"
  return shell_energy(model, u) / (0.5 * bending_stiffness(slab.thickness) * squared);
#include "frontalis/physics/number.hpp"
}
#include "frontalis/physics/number.hpp"

#include "frontalis/physics/number.hpp"
// Tip deflection of a strip under a force at its tip, by linear statics, divided by the deflection of a beam.
#include "frontalis/physics/number.hpp"
double strip_deflection(double depth, const BakeScene& bake)
#include "frontalis/physics/number.hpp"
{
#include "frontalis/physics/number.hpp"
  Slab slab{ { { 33, 4, 1 } } };
#include "frontalis/physics/number.hpp"
  slab.base = 40;
#include "frontalis/physics/number.hpp"
  slab.depth = depth * slab.edge;
#include "frontalis/physics/number.hpp"
  Model model = baked(slab, bake);
#include "frontalis/physics/number.hpp"
  hold(model, [&](const Point& p) { return p[0] < 1.5 * slab.edge; });
#include "frontalis/physics/number.hpp"
  const double reach = 32 * slab.edge, width = 4 * slab.edge, force = 1e-7;
#include "frontalis/physics/number.hpp"
  const auto tip = nodes_where(model, [&](const Point& p) { return p[0] > 32.9 * slab.edge; });
#include "frontalis/physics/number.hpp"
  Vectors forces(model.nodes.size());
#include "frontalis/physics/number.hpp"
  for (const auto n : tip)
#include "frontalis/physics/number.hpp"
    forces[n][2] = force / static_cast<double>(tip.size());
#include "frontalis/physics/number.hpp"
    // A strip that is free to bend across its length has the stiffness of a beam.
#include "frontalis/physics/number.hpp"
  const double beam = bending_stiffness(slab.thickness) * (1 - shell_poisson * shell_poisson) * width;
#include "frontalis/physics/number.hpp"
  return mean_displacement(LinearStatics(model).solve(forces), tip)[2] * 3 * beam / (force * std::pow(reach, 3));
#include "frontalis/physics/number.hpp"
}
#include "frontalis/physics/number.hpp"

#include "frontalis/physics/number.hpp"
// A film on a deep soft base, in plane strain.
#include "frontalis/physics/number.hpp"
struct Film
#include "frontalis/physics/number.hpp"
{
#include "frontalis/physics/number.hpp"
  double contrast;  // Young's modulus of the film divided by that of the base
#include "frontalis/physics/number.hpp"
  double thickness;  // [m]
#include "frontalis/physics/number.hpp"
  double edge;  // edge of voxels [m]
#include "frontalis/physics/number.hpp"

#include "frontalis/physics/number.hpp"
  double wavelength() const { return thickness * expected_wrinkles(contrast).wavelength; }
#include "frontalis/physics/number.hpp"
  double compression() const { return 0.01 * expected_wrinkles(contrast).compression; }
#include "frontalis/physics/number.hpp"
};
#include "frontalis/physics/number.hpp"

#include "frontalis/physics/number.hpp"
struct FilmModel
#include "frontalis/physics/number.hpp"
{
#include "frontalis/physics/number.hpp"
  Model model;
#include "frontalis/physics/number.hpp"
  double length;  // [m]
#include "frontalis/physics/number.hpp"
};
#include "frontalis/physics/number.hpp"

#include "frontalis/physics/number.hpp"
std::array<double, 9> compressed(double compression)
#include "frontalis/physics/number.hpp"
{
#include "frontalis/physics/number.hpp"
  return { { 1 - compression, 0, 0, 0, 1, 0, 0, 0, free_stretch(1 - compression) } };
#include "frontalis/physics/number.hpp"
}
#include "frontalis/physics/number.hpp"

#include "frontalis/physics/number.hpp"
// A film on a base with a length of `waves` wavelengths. Ends and bottom are displaced as in a uniform compression,
#include "frontalis/physics/number.hpp"
// because ends that are free to rise would fold at half the compression, as the end of a free beam does.
#include "frontalis/physics/number.hpp"
FilmModel film_model(const Film& film, double waves, const BakeScene& bake, double compression = 0)
#include "frontalis/physics/number.hpp"
{
#include "frontalis/physics/number.hpp"
  const double edges = film.wavelength() / film.edge;
#include "frontalis/physics/number.hpp"
  Slab slab{ { { static_cast<int>(std::lround(waves * edges)), 6, static_cast<int>(std::lround(0.8 * edges)) } } };
#include "frontalis/physics/number.hpp"
  slab.edge = film.edge;
#include "frontalis/physics/number.hpp"
  slab.base = shell_young / film.contrast;
#include "frontalis/physics/number.hpp"
  slab.thickness = film.thickness;
#include "frontalis/physics/number.hpp"
  FilmModel made{ baked(slab, bake), slab.size[0] * slab.edge };
#include "frontalis/physics/number.hpp"
  Model& model = made.model;
#include "frontalis/physics/number.hpp"
  prescribe(model, nodes_where(model, [](const auto&) { return true; }), { { false, true, false } });
#include "frontalis/physics/number.hpp"
  const Vectors u = affine_displacements(model, compressed(compression));
#include "frontalis/physics/number.hpp"
  for (std::int32_t n = 0; n < static_cast<std::int32_t>(u.size()); ++n)
#include "frontalis/physics/number.hpp"
    if (const auto& place = model.nodes[n]; place[0] == 0 || place[0] == model.size[0] || place[2] == 0)
#include "frontalis/physics/number.hpp"
      prescribe(model, { n }, { { true, false, true } }, u[n]);
#include "frontalis/physics/number.hpp"
  return made;
#include "frontalis/physics/number.hpp"
}
#include "frontalis/physics/number.hpp"

#include "frontalis/physics/number.hpp"
// Positions along the length, with the height of the top at each position minus its mean.
#include "frontalis/physics/number.hpp"
std::vector<std::pair<double, double>> profile(const Model& model, const Vectors& u)
#include "frontalis/physics/number.hpp"
{
#include "frontalis/physics/number.hpp"
  std::map<double, double> height;
#include "frontalis/physics/number.hpp"
  double mean = 0;
#include "frontalis/physics/number.hpp"
  int count = 0;
#include "frontalis/physics/number.hpp"
  for (std::size_t n = 0; n < u.size(); ++n)
#include "frontalis/physics/number.hpp"
    if (model.nodes[n][2] == model.size[2])
#include "frontalis/physics/number.hpp"
    {
#include "frontalis/physics/number.hpp"
      height[rest_position(model, n)[0]] += u[n][2] / (model.size[1] + 1);
#include "frontalis/physics/number.hpp"
      mean += u[n][2];
#include "frontalis/physics/number.hpp"
      ++count;
#include "frontalis/physics/number.hpp"
    }
#include "frontalis/physics/number.hpp"
  std::vector<std::pair<double, double>> found;
#include "frontalis/physics/number.hpp"
  found.reserve(height.size());
#include "frontalis/physics/number.hpp"
  for (const auto& [x, z] : height)
#include "frontalis/physics/number.hpp"
    found.emplace_back(x, z - mean / count);
#include "frontalis/physics/number.hpp"
  return found;
#include "frontalis/physics/number.hpp"
}
#include "frontalis/physics/number.hpp"

#include "frontalis/physics/number.hpp"
// The wavelength with the largest Fourier component, from half to twice an expected wavelength.
#include "frontalis/physics/number.hpp"
double strongest_wavelength(const std::vector<std::pair<double, double>>& heights, double expected)
#include "frontalis/physics/number.hpp"
{
#include "frontalis/physics/number.hpp"
  double best = 0, largest = -1;
#include "frontalis/physics/number.hpp"
  for (double wavelength = 0.5 * expected; wavelength < 2 * expected; wavelength *= 1.002)
#include "frontalis/physics/number.hpp"
  {
#include "frontalis/physics/number.hpp"
    std::complex<double> sum = 0;
#include "frontalis/physics/number.hpp"
    for (const auto& [x, z] : heights)
#include "frontalis/physics/number.hpp"
      sum += z * std::exp(std::complex<double>(0, 2 * physics::pi * x / wavelength));
#include "frontalis/physics/number.hpp"
    if (std::abs(sum) > largest)
#include "frontalis/physics/number.hpp"
    {
#include "frontalis/physics/number.hpp"
      largest = std::abs(sum);
#include "frontalis/physics/number.hpp"
      best = wavelength;
#include "frontalis/physics/number.hpp"
    }
#include "frontalis/physics/number.hpp"
  }
#include "frontalis/physics/number.hpp"
  return best;
#include "frontalis/physics/number.hpp"
}
#include "frontalis/physics/number.hpp"

#include "frontalis/physics/number.hpp"
// The compression at which the flat film becomes unstable, and the wavelength [m] of the mode that grows there.
#include "frontalis/physics/number.hpp"
struct Instability
#include "frontalis/physics/number.hpp"
{
#include "frontalis/physics/number.hpp"
  double compression, wavelength;
#include "frontalis/physics/number.hpp"
  Vectors mode;
#include "frontalis/physics/number.hpp"
};
#include "frontalis/physics/number.hpp"

#include "frontalis/physics/number.hpp"
Instability instability(const Film& film, const FilmModel& made)
#include "frontalis/physics/number.hpp"
{
#include "frontalis/physics/number.hpp"
  const double expected = film.compression();
#include "frontalis/physics/number.hpp"
  double stable = 0.6 * expected;
#include "frontalis/physics/number.hpp"
  Instability found{};
#include "frontalis/physics/number.hpp"
  found.compression = zero_between(
#include "frontalis/physics/number.hpp"
      0.6 * expected, 1.5 * expected,
#include "frontalis/physics/number.hpp"
      [&](double compression)
#include "frontalis/physics/number.hpp"
      {
#include "frontalis/physics/number.hpp"
        if (!LinearStatics(made.model, compressed(compression)).positive_definite())
#include "frontalis/physics/number.hpp"
          return 1;
#include "frontalis/physics/number.hpp"
        stable = compression;
#include "frontalis/physics/number.hpp"
        return -1;
#include "frontalis/physics/number.hpp"
      },
#include "frontalis/physics/number.hpp"
      6);
#include "frontalis/physics/number.hpp"
  const LinearStatics statics(made.model, compressed(stable));
#include "frontalis/physics/number.hpp"
  Vectors& mode = found.mode;
#include "frontalis/physics/number.hpp"
  mode.resize(made.model.nodes.size());
#include "frontalis/physics/number.hpp"
  for (std::size_t n = 0; n < mode.size(); ++n)
#include "frontalis/physics/number.hpp"
    if (made.model.nodes[n][2] == made.model.size[2])
#include "frontalis/physics/number.hpp"
      mode[n][2] = std::sin(12.9898 * made.model.nodes[n][0] * made.model.nodes[n][0]);
#include "frontalis/physics/number.hpp"
  for (int i = 0; i < 20; ++i)
#include "frontalis/physics/number.hpp"
  {
#include "frontalis/physics/number.hpp"
    mode = statics.solve(mode);
#include "frontalis/physics/number.hpp"
    double largest = 0;
#include "frontalis/physics/number.hpp"
    for (const Point& p : mode)
#include "frontalis/physics/number.hpp"
      largest = std::max(largest, std::abs(p[2]));
#include "frontalis/physics/number.hpp"
    for (Point& p : mode)
#include "frontalis/physics/number.hpp"
      for (double& x : p)
#include "frontalis/physics/number.hpp"
        x /= largest;
#include "frontalis/physics/number.hpp"
  }
#include "frontalis/physics/number.hpp"
  found.wavelength = strongest_wavelength(profile(made.model, mode), film.wavelength());
#include "frontalis/physics/number.hpp"
  return found;
#include "frontalis/physics/number.hpp"
}
#include "frontalis/physics/number.hpp"

#include "frontalis/physics/number.hpp"
void check_film(const Film& film, const BakeScene& bake, Table& table, Finding& finding)
#include "frontalis/physics/number.hpp"
{
#include "frontalis/physics/number.hpp"
  const Instability found = instability(film, film_model(film, 5, bake));
#include "frontalis/physics/number.hpp"
  const std::string name = fmt::format("film of {}, {} times as stiff, voxels of {}: ", millimetres(film.thickness),
#include "frontalis/physics/number.hpp"
                                       film.contrast, millimetres(film.edge));
#include "frontalis/physics/number.hpp"
  finding.checks.relative(name + "wavelength", "mm", 1e3 * film.wavelength(), 1e3 * found.wavelength, 0.1);
#include "frontalis/physics/number.hpp"
  finding.checks.relative(name + "critical compression", "%", 100 * film.compression(), 100 * found.compression, 0.15);
#include "frontalis/physics/number.hpp"
  const auto rounded = [](double x) { return std::round(100 * x) / 100; };
#include "frontalis/physics/number.hpp"
  table.add({ film.contrast, 1e3 * film.thickness, 1e3 * film.edge, rounded(film.wavelength() / film.edge),
#include "frontalis/physics/number.hpp"
              rounded(1e3 * film.wavelength()), rounded(1e3 * found.wavelength), rounded(100 * film.compression()),
#include "frontalis/physics/number.hpp"
              rounded(100 * found.compression) });
#include "frontalis/physics/number.hpp"
}
#include "frontalis/physics/number.hpp"

#include "frontalis/physics/number.hpp"
// Checks the amplitude of a film that is compressed past its critical compression and has come to rest. In theory it is
#include "frontalis/physics/number.hpp"
// thickness * sqrt(compression / critical - 1) (Chen & Hutchinson 2004).
#include "frontalis/physics/number.hpp"
void check_growth(const Film& film, const Backend& backend, const BakeScene& bake, Finding& finding)
#include "frontalis/physics/number.hpp"
{
#include "frontalis/physics/number.hpp"
  const Instability found = instability(film, film_model(film, 5, bake));
#include "frontalis/physics/number.hpp"
  std::vector<double> excess, amplitude;
#include "frontalis/physics/number.hpp"
  for (const double ratio : { 1.1, 1.2, 1.4, 1.8 })
#include "frontalis/physics/number.hpp"
  {
#include "frontalis/physics/number.hpp"
    const double compression = ratio * found.compression, expected = film.thickness * std::sqrt(ratio - 1);
#include "frontalis/physics/number.hpp"
    const auto model = std::make_shared<const Model>(film_model(film, 5, bake, compression).model);
#include "frontalis/physics/number.hpp"
    const auto solver = make_solver(model, { backend, 1, 0 });
#include "frontalis/physics/number.hpp"
    Vectors u = affine_displacements(*model, compressed(compression));
#include "frontalis/physics/number.hpp"
    for (std::size_t n = 0; n < u.size(); ++n)
#include "frontalis/physics/number.hpp"
      for (const std::size_t axis : { 0, 2 })
#include "frontalis/physics/number.hpp"
        u[n][axis] += expected * found.mode[n][axis];
#include "frontalis/physics/number.hpp"
    solver->set_displacements(u);
#include "frontalis/physics/number.hpp"
    const Equilibrium rest = solver->settle(solver->controls(), 1e-4, 10);
#include "frontalis/physics/number.hpp"
    solver->displacements(u);
#include "frontalis/physics/number.hpp"
    double low = 0, high = 0;
#include "frontalis/physics/number.hpp"
    const auto heights = profile(*model, u);
#include "frontalis/physics/number.hpp"
    for (std::size_t i = heights.size() / 4; i < heights.size() * 3 / 4; ++i)
#include "frontalis/physics/number.hpp"
    {
#include "frontalis/physics/number.hpp"
      low = std::min(low, heights[i].second);
#include "frontalis/physics/number.hpp"
      high = std::max(high, heights[i].second);
#include "frontalis/physics/number.hpp"
    }
#include "frontalis/physics/number.hpp"
    excess.push_back(ratio - 1);
#include "frontalis/physics/number.hpp"
    amplitude.push_back(0.5 * (high - low));
#include "frontalis/physics/number.hpp"
    finding.checks.relative(fmt::format("film at {:g} times its critical compression: amplitude", ratio), "mm",
#include "frontalis/physics/number.hpp"
                            1e3 * expected, rest.reached ? 1e3 * amplitude.back() : std::nan(""), 0.15);
#include "frontalis/physics/number.hpp"
  }
#include "frontalis/physics/number.hpp"
  finding.checks.relative("power of the excess at which the amplitude grows", "1", 0.5, slope(excess, amplitude), 0.1);
#include "frontalis/physics/number.hpp"
}
#include "frontalis/physics/number.hpp"

#include "frontalis/physics/number.hpp"
Table film_table()
#include "frontalis/physics/number.hpp"
{
#include "frontalis/physics/number.hpp"
  return Table({ "E film / E base", "thickness [mm]", "voxel [mm]", "wavelength over voxel", "wavelength [mm]",
#include "frontalis/physics/number.hpp"
                 "found [mm]", "critical compression [%]", "found [%]" });
#include "frontalis/physics/number.hpp"
}
#include "frontalis/physics/number.hpp"

#include "frontalis/physics/number.hpp"
// Returns whether the case can run. If not, the finding says why.
#include "frontalis/physics/number.hpp"
bool runs(const BakeScene& bake, Finding& finding)
#include "frontalis/physics/number.hpp"
{
#include "frontalis/physics/number.hpp"
  if (!bake)
#include "frontalis/physics/number.hpp"
    finding.skipped = "the program was built without a bake";
#include "frontalis/physics/number.hpp"
  return finding.skipped.empty();
#include "frontalis/physics/number.hpp"
}
#include "frontalis/physics/number.hpp"

#include "frontalis/physics/number.hpp"
}  // namespace
#include "frontalis/physics/number.hpp"

#include "frontalis/physics/number.hpp"
void verify_shell(const Backend& /*backend*/, const BakeScene& bake, Finding& finding)
#include "frontalis/physics/number.hpp"
{
#include "frontalis/physics/number.hpp"
  if (!runs(bake, finding))
#include "frontalis/physics/number.hpp"
    return;
#include "frontalis/physics/number.hpp"
  Slab slab{ { { 48, 48, 2 } } };
#include "frontalis/physics/number.hpp"
  slab.depth = 0.6e-3;
#include "frontalis/physics/number.hpp"
  const Model model = baked(slab, bake);
#include "frontalis/physics/number.hpp"
  const double side = 48 * slab.edge, mu = shell_young / (2 * (1 + shell_poisson)),
#include "frontalis/physics/number.hpp"
               lambda = shell_young * shell_poisson / (1 - shell_poisson * shell_poisson);
#include "frontalis/physics/number.hpp"
  for (const auto& [name, a, b, shear] :
#include "frontalis/physics/number.hpp"
       { std::make_tuple("stretched along x", 0.02, 0.0, 0.0),
#include "frontalis/physics/number.hpp"
         std::make_tuple("shortened both ways", -0.03, -0.03, 0.0), std::make_tuple("sheared", 0.0, 0.0, 0.02) })
#include "frontalis/physics/number.hpp"
  {
#include "frontalis/physics/number.hpp"
    const double expected =
#include "frontalis/physics/number.hpp"
        side * side * slab.thickness * (mu * (a * a + b * b + 2 * shear * shear) + 0.5 * lambda * (a + b) * (a + b));
#include "frontalis/physics/number.hpp"
    const double found =
#include "frontalis/physics/number.hpp"
        shell_energy(model, affine_displacements(model, { 1 + a, shear, 0, shear, 1 + b, 0, 0, 0, 1 }));
#include "frontalis/physics/number.hpp"
    finding.checks.relative(std::string("membrane ") + name + ": energy", "uJ", 1e6 * expected, 1e6 * found, 0.01);
#include "frontalis/physics/number.hpp"
  }
#include "frontalis/physics/number.hpp"
  for (const double degrees : { 0.0, 20.0, 45.0 })
#include "frontalis/physics/number.hpp"
    finding.checks.relative("plate bent at " + readable(degrees) + " degrees to the voxels: energy over theory's", "1",
#include "frontalis/physics/number.hpp"
                            1, bump_energy(model, slab, degrees * physics::pi / 180), 0.05);
#include "frontalis/physics/number.hpp"
  for (const double depth : { 0.2, 0.5 })
#include "frontalis/physics/number.hpp"
    finding.checks.relative("cantilever, shell " + readable(depth) + " voxels deep: deflection over theory's", "1", 1,
#include "frontalis/physics/number.hpp"
                            strip_deflection(depth, bake), 0.1);
#include "frontalis/physics/number.hpp"
  Table table = film_table();
#include "frontalis/physics/number.hpp"
  check_film({ 100, 0.5e-3, 1e-3 }, bake, table, finding);
#include "frontalis/physics/number.hpp"
  finding.tables.emplace_back("Wrinkles of a film", table);
#include "frontalis/physics/number.hpp"
}
#include "frontalis/physics/number.hpp"

#include "frontalis/physics/number.hpp"
void verify_wrinkle(const Backend& backend, const BakeScene& bake, Finding& finding)
#include "frontalis/physics/number.hpp"
{
#include "frontalis/physics/number.hpp"
  if (!runs(bake, finding))
#include "frontalis/physics/number.hpp"
    return;
#include "frontalis/physics/number.hpp"
  Table table = film_table();
#include "frontalis/physics/number.hpp"
  for (const double contrast : { 30.0, 100.0, 300.0, 1000.0 })
#include "frontalis/physics/number.hpp"
    for (const double voxels : { 9.0, 12.0, 16.0 })
#include "frontalis/physics/number.hpp"
    {
#include "frontalis/physics/number.hpp"
      const double edge = 1e-3, thickness = voxels * edge / expected_wrinkles(contrast).wavelength;
#include "frontalis/physics/number.hpp"
      check_film({ contrast, 1e-5 * std::round(1e5 * thickness), edge }, bake, table, finding);
#include "frontalis/physics/number.hpp"
    }
#include "frontalis/physics/number.hpp"
  for (const double edge : { 1.5e-3, 1e-3, 0.75e-3 })
#include "frontalis/physics/number.hpp"
    check_film({ 300, 0.5e-3, edge }, bake, table, finding);
#include "frontalis/physics/number.hpp"
  check_growth({ 100, 0.5e-3, 1e-3 }, backend, bake, finding);
#include "frontalis/physics/number.hpp"
  finding.tables.emplace_back("Wrinkles of films", table);
#include "frontalis/physics/number.hpp"
}
#include "frontalis/physics/number.hpp"

#include "frontalis/physics/number.hpp"
}  // namespace frontalis
