// layers that are shells: strained membranes, bent plates, a cantilever

#include "study/verification/verification_cases.hpp"

#include "frontalis/solver/backend.hpp"

#include <cmath>

namespace frontalis
{
namespace
{

constexpr double young = 1e6, poisson = 0.3, edge = 1e-3;  // of the shell; edge of voxels [m]

double bending_stiffness(double thickness) { return young * std::pow(thickness, 3) / (12 * (1 - poisson * poisson)); }

// Adds a shell across a box at a height [m]: irregular triangles with edges of `ratio` voxel edges on average.
void add_shell(Model& model, double height, double thickness, double ratio)
{
  Shell shell;
  shell.name = "shell";
  shell.thickness = thickness;
  shell.material = static_cast<std::int32_t>(model.materials.size());
  model.materials.push_back(neo_hookean(young, poisson));
  const double length = model.size[0] * edge, width = model.size[1] * edge, leg = ratio * edge / 1.14;
  const int columns = static_cast<int>(std::lround(length / leg)), rows = static_cast<int>(std::lround(width / leg));
  shell.surface = grid_mesh(rows, columns,
                            [&](double s, double t)
                            {
                              const bool inside = s > 0.01 / columns && s < 1 - 0.01 / columns && t > 0.01 / rows &&
                                                  t < 1 - 0.01 / rows;
                              const double shift = inside ? 0.15 * leg : 0;
                              return Point{ { length * s + shift * std::sin(40 * s * columns + 7 * t),
                                              width * t + shift * std::cos(30 * t * rows + 11 * s), height } };
                            });
  shell.binding = bind_points(model, shell.surface.vertices);
  model.shells.push_back(shell);
}

Model soft_box(const Voxel& size, double base)
{
  Model model = voxel_model(size, edge, neo_hookean(base, 0.3));
  model.precision = Precision::double_precision;
  return model;
}

double shell_energy(const Model& model, const Backend& backend, const Vectors& u)
{
  const auto solver = make_solver(std::make_shared<const Model>(model), { backend, 1, 0, true });
  solver->set_displacements(u);
  return solver->ledger()["shell"];
}

// A cylindrical bump of a plate over its energy in plate theory; ridge at an angle to the voxels, lengths in voxels.
double bump_energy(const Backend& backend, double ratio, double angle, double height)
{
  const int side = 48;
  Model model = soft_box({ { side, side, 2 } }, 1e3);
  const double thickness = 0.2 * edge, radius = 16 * edge, middle = 0.5 * side * edge, amplitude = 1e-3 * edge;
  add_shell(model, height * edge, thickness, ratio);
  // w = a (1 - (x / r)^2)^4, so that w'' is continuous and zero at the bump's ends
  double squared = 0;  // integral of w''^2
  const auto bump = [&](double x)
  {
    const double q = 1 - x * x / (radius * radius);
    return q > 0 ? amplitude * std::pow(q, 4) : 0;
  };
  const double step = 1e-3 * radius;
  for (double x = -radius; x < radius; x += step)
    squared += step * std::pow((bump(x + step) - 2 * bump(x) + bump(x - step)) / (step * step), 2);
  Vectors u(model.nodes.size());
  for (std::size_t n = 0; n < u.size(); ++n)
  {
    const Point p = rest_position(model, n);
    u[n][2] = bump(std::cos(angle) * (p[0] - middle) + std::sin(angle) * (p[1] - middle));
  }
  const double ridge = side * edge / std::cos(angle);
  return shell_energy(model, backend, u) / (0.5 * bending_stiffness(thickness) * squared * ridge);
}

// Tip deflection of a strip under its weight over that of a beam; `height` of the shell in its layer of voxels.
double strip_deflection(const Backend& backend, int length, double height)
{
  constexpr double thickness = 0.2 * edge, density = 1000;
  const int width = 4;
  Model model = soft_box({ { length + 1, width, 1 } }, 40);
  model.materials[0].density = density;
  add_shell(model, height * edge, thickness, 1.2);
  hold(model, [](const Point& p) { return p[0] < 1.5 * edge; });
  const double reach = length * edge, stiffness = young * std::pow(thickness, 3) / 12;
  const double wanted = 0.02 * reach;
  model.gravity = { { 0, 0, -8 * stiffness * wanted / (density * edge * std::pow(reach, 4)) } };
  const double period = 2 * std::acos(-1.0) / 3.516 * reach * reach * std::sqrt(density * edge / stiffness);
  const RestState rest = find_equilibrium(model, { backend, period, 1e-3 });
  const double tip = (length + 1) * edge;
  const auto at_tip = nodes_where(model, [&](const Point& p) { return p[0] > tip - 0.1 * edge; });
  return -mean_displacement(rest.displacements, at_tip)[2] / wanted;
}

// Wrinkles of a film on a deep soft base that is slowly compressed, in plane strain.
struct Film
{
  double contrast;   // Young's modulus of the film over the base's
  double thickness;  // in voxels
};
struct FilmWrinkles
{
  double wavelength = 0, compression = 0;  // [mm], [%]
};

FilmWrinkles expected_wrinkles(const Film& film)
{
  // both plane-strain moduli: Poisson's ratios 0.3 of the film and 0.49 of the base
  const double ratio = film.contrast * (1 - 0.49 * 0.49) / (1 - poisson * poisson);
  return { 2e3 * std::acos(-1.0) * film.thickness * edge * std::cbrt(ratio / 3), 25 * std::pow(3 / ratio, 2.0 / 3) };
}

// Squared amplitude of the deflection along a row of nodes, and the number of its zeros, without its mean.
std::pair<double, int> waves(const Vectors& u, const std::vector<std::int32_t>& row)
{
  double mean = 0, squared = 0;
  for (const auto n : row)
    mean += u[n][2] / static_cast<double>(row.size());
  int zeros = 0;
  double before = 0;
  for (const auto n : row)
  {
    const double w = u[n][2] - mean;
    squared += 2 * w * w / static_cast<double>(row.size());
    zeros += w * before < 0 ? 1 : 0;
    before = w;
  }
  return { squared, zeros };
}

// Compressed from 0 to 2.5 times the expected compression. The squared amplitude grows in proportion to the excess of
// compression; a line through it from 1.6 times on shows where it begins.
FilmWrinkles film_wrinkles(const Film& film, Plot::Curve& curve)
{
  constexpr int length = 160, width = 8, depth = 20;
  constexpr double time = 0.5;
  const FilmWrinkles expected = expected_wrinkles(film);
  Model model = voxel_model({ { length, width, depth } }, edge, neo_hookean(young / film.contrast, 0.49));
  model.hourglass = HourglassControl::assumed_strain;
  add_shell(model, depth * edge, film.thickness * edge, 1.2);
  const double shortening = 2.5 * 0.01 * expected.compression * length * edge;
  const double last = length * edge;
  prescribe(model, nodes_where(model, [](const Point&) { return true; }), { { false, true, false } });
  prescribe(model, nodes_where(model, [](const Point& p) { return p[2] == 0; }), { { false, false, true } });
  prescribe(model, nodes_where(model, [](const Point& p) { return p[0] == 0; }), { { true, false, false } });
  prescribe(model, nodes_where(model, [&](const Point& p) { return p[0] > last - 0.1 * edge; }),
            { { true, false, false } }, { { -shortening, 0, 0 } }, time);
  model.damping = 100;
  const auto row = nodes_where(
      model, [&](const Point& p) { return p[2] > (depth - 0.1) * edge && std::abs(p[1] - 0.5 * width * edge) < 1e-9; });
  const auto solver = make_solver(std::make_shared<const Model>(model), { "cpu", 0, 0 });
  Vectors v(model.nodes.size());
  for (std::size_t n = 0; n < v.size(); ++n)
    if (rest_position(model, n)[2] > (depth - 0.1) * edge)
      v[n][2] = 1e-5 * std::sin(12.9898 * static_cast<double>(model.nodes[n][0] * model.nodes[n][0]));
  solver->set_velocities(v);
  Vectors u;
  double sums[4] = {};
  FilmWrinkles found;
  constexpr int looks = 50;
  for (int look = 1; look <= looks; ++look)
  {
    solver->advance(time / looks, solver->controls());
    solver->displacements(u);
    const double compression = 2.5 * expected.compression * look / looks;
    const auto [squared, zeros] = waves(u, row);
    curve.add(compression, 1e3 * std::sqrt(squared));
    found.wavelength = 2e3 * last * (1 - 0.01 * compression) / std::max(zeros, 1);
    if (compression < 1.6 * expected.compression)
      continue;
    const double terms[4] = { 1, compression, squared, compression * squared };
    sums[0] += terms[0];
    sums[1] += terms[1];
    sums[2] += terms[2];
    sums[3] += terms[3];
    found.compression += compression * compression;
  }
  const double slope = (sums[0] * sums[3] - sums[1] * sums[2]) / (sums[0] * found.compression - sums[1] * sums[1]);
  found.compression = (sums[1] - sums[2] / slope) / sums[0];
  return found;
}

}  // namespace

void verify_film(const Backend& backend, Finding& finding)
{
  if (backend == "cuda")
  {
    finding.skipped = "the cuda backend does not compute shells";
    return;
  }
  Plot plot{ "Wrinkles of a film that is a shell, on a soft base", "compression [%]", "amplitude [mm]" };
  for (const Film& film : { Film{ 1000, 0.3 }, Film{ 3000, 0.2 } })
  {
    const std::string name = "film " + readable(film.contrast) + " times as stiff: ";
    Plot::Curve curve{ name, {}, {}, Plot::Style::line };
    const FilmWrinkles expected = expected_wrinkles(film), found = film_wrinkles(film, curve);
    finding.checks.relative(name + "wavelength", "mm", expected.wavelength, found.wavelength, 0.1);
    finding.checks.relative(name + "critical compression", "%", expected.compression, found.compression, 0.15);
    plot.curves.push_back(curve);
  }
  finding.plots.emplace_back("shell_film", plot);
}

void verify_shell(const Backend& backend, Finding& finding)
{
  if (backend == "cuda")
  {
    finding.skipped = "the cuda backend does not compute shells";
    return;
  }
  Model membrane = soft_box({ { 12, 12, 2 } }, 1e3);
  add_shell(membrane, 1.3 * edge, 0.2 * edge, 1.2);
  const double mu = young / (2 * (1 + poisson)), lambda = young * poisson / (1 - poisson * poisson);
  for (const auto& [name, a, b, shear] :
       { std::make_tuple("stretched along x", 0.02, 0.0, 0.0), std::make_tuple("both ways", -0.03, -0.03, 0.0),
         std::make_tuple("sheared", 0.0, 0.0, 0.02) })
  {
    const double expected =
        144 * edge * edge * 0.2 * edge * (mu * (a * a + b * b + 2 * shear * shear) + 0.5 * lambda * (a + b) * (a + b));
    // pure shear strain by a symmetric gradient
    const double found = shell_energy(
        membrane, backend, affine_displacements(membrane, { { 1 + a, shear, 0, shear, 1 + b, 0, 0, 0, 1 } }));
    finding.checks.relative(std::string("membrane ") + name + ": energy", "uJ", 1e6 * expected, 1e6 * found, 0.001);
  }
  const double degree = std::acos(-1.0) / 180;
  for (const double angle : { 0.0, 20.0, 45.0 })
    finding.checks.relative("plate bent at " + readable(angle) + " degrees to the voxels: energy over theory's", "1", 1,
                            bump_energy(backend, 1.2, angle * degree, 1.7), 0.05);
  Plot plot{ "Energy of a bent plate over that of plate theory", "edge of triangles over edge of voxels [1]", "[1]" };
  plot.curves.push_back({ "shell on bound vertices", {}, {}, Plot::Style::points });
  for (const double ratio : { 0.4, 0.6, 0.8, 1.0, 1.2, 1.6, 2.0 })
    plot.curves[0].add(ratio, bump_energy(backend, ratio, 20 * degree, 1.7));
  finding.plots.emplace_back("shell", plot);
  for (const double height : { 0.5, 0.8 })
    finding.checks.relative("cantilever, shell at " + readable(height) + " of a voxel: tip deflection over theory's",
                            "1", 1, strip_deflection(backend, 32, height), 0.1);
}

}  // namespace frontalis
