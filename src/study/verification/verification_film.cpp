// Films that are shells, baked from scenes: critical compression, wavelength and amplitude of their wrinkles.

#include "frontalis/physics/number.hpp"
#include "study/verification/film_slab.hpp"

#include <Eigen/Dense>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>

namespace frontalis
{
namespace
{

// The layers of a film as one plate, in plane strain.
struct Plate
{
  double stretching = 0, bending = 0;  // stiffness [N/m], [N m]
  double neutral = 0;                  // depth of the neutral surface below the top [m]
};

Plate plate_of(const std::vector<Slab::Layer>& layers)
{
  constexpr double plane_strain = 1 / (1 - shell_poisson * shell_poisson);
  double stretching = 0, first = 0, second = 0, depth = 0;
  for (const auto& [young, thickness] : layers)
  {
    const double middle = depth + 0.5 * thickness, share = plane_strain * young * thickness;
    stretching += share;
    first += share * middle;
    second += share * (middle * middle + thickness * thickness / 12);
    depth += thickness;
  }
  return { stretching, second - first * first / stretching, first / stretching };
}

// Normal traction [Pa/m] that gives the top of a layer waves of the wave number k, without motion along them. The
// layer, an incompressible neo-Hookean solid in plane strain, is first compressed to the stretch `along`; k, its height
// and the traction are per length before that. Its bottom is held by bone, or glides on it. Waves are then sums of sinh
// and cosh of y and of along² y (Biot 1965, Mechanics of Incremental Deformations).
double base_stiffness(double k, double height, double shear, double along, bool glides)
{
  const double s = along * along, x = k * height / s;
  const Eigen::RowVector4d up(std::sinh(x), std::sinh(s * x), std::cosh(x), std::cosh(s * x));
  const auto derivative = [s](const Eigen::RowVector4d& v, int order)
  {
    const double inner = std::pow(s, order);
    return Eigen::RowVector4d(v[2], inner * v[3], v[0], inner * v[1]);
  };
  Eigen::Matrix4d conditions;
  conditions.row(0) = up;
  conditions.row(1) = derivative(up, 1);
  conditions.row(2) << 0, 0, 1, 1;
  conditions.row(3) = glides ? Eigen::RowVector4d(0, 0, 1, s * s) : Eigen::RowVector4d(1, s, 0, 0);
  const Eigen::Vector4d wave = conditions.fullPivLu().solve(Eigen::Vector4d(1, 0, 0, 0));
  return -shear / s * k * derivative(up, 3).dot(wave.transpose());
}

// Waves in which a film folds first.
struct Waves
{
  double wavelength = 0, compression = 1;  // [m], 0..1
};

// Compression ε that a wave of the wave number k needs on a base of finite height: with λ = 1 - ε, the nominal force
// K ε of the film, of the bending stiffness D, meets K ε k² / λ = D k⁴ / λ² + (stiffness of the base at λ).
double needed_compression(const Film& film, const Plate& plate, double k)
{
  const double shear = film.base / (2 * (1 + shell_poisson)), height = film.height - plate.neutral;
  const auto excess = [&](double compression)
  {
    const double along = 1 - compression, base = base_stiffness(k, height, shear, along, film.glides);
    return plate.stretching * compression - plate.bending * k * k / along - along * base / (k * k);
  };
  return zero_between(1e-3, 0.3, excess, 20);
}

// The waves that need least. On a deep base the closed form of Cao & Hutchinson (2012).
Waves theory(const Film& film)
{
  if (film.height == 0)
  {
    const FilmWrinkles deep = expected_wrinkles(film.layers[0].young / film.base);
    return { film.layers[0].thickness * deep.wavelength, 0.01 * deep.compression };
  }
  const Plate plate = plate_of(film.layers);
  Waves found;
  for (double wavelength = film.height; wavelength < 10 * film.height; wavelength *= 1.002)
    if (const double compression = needed_compression(film, plate, 2 * physics::pi / wavelength);
        compression < found.compression)
      found = { wavelength, compression };
  return found;
}

struct FilmModel
{
  Model model;
  double length;  // [m]
};

std::array<double, 9> compressed(double compression)
{
  return { { 1 - compression, 0, 0, 0, 1, 0, 0, 0, free_stretch(1 - compression) } };
}

// A film on its base with a length of `waves` wavelengths. Ends and bottom are displaced as in a uniform compression,
// because ends that are free to rise would fold at half the compression, as the end of a free beam does.
FilmModel film_model(const Film& film, double waves, const BakeScene& bake, double compression = 0)
{
  const double edges = theory(film).wavelength / film.edge;
  const double height = film.height > 0 ? film.height / film.edge : 0.8 * edges;
  Slab slab{ { { static_cast<int>(std::lround(waves * edges)), 6, static_cast<int>(std::lround(height)) } } };
  slab.edge = film.edge;
  slab.base = film.base;
  slab.layers = film.layers;
  FilmModel made{ baked(slab, bake), slab.size[0] * slab.edge };
  Model& model = made.model;
  prescribe(model, nodes_where(model, [](const auto&) { return true; }), { { false, true, false } });
  const Vectors u = affine_displacements(model, compressed(compression));
  for (std::int32_t n = 0; n < static_cast<std::int32_t>(u.size()); ++n)
    if (const auto& place = model.nodes[n]; place[0] == 0 || place[0] == model.size[0] || place[2] == 0)
      prescribe(model, { n }, { { place[2] > 0 || !film.glides, false, true } }, u[n]);
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

// `halvings`: of the range of compressions that is searched, 0.9 of the expected one.
Instability instability(const Film& film, const FilmModel& made, int halvings)
{
  const auto [wavelength, expected] = theory(film);
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
      halvings);
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
  found.wavelength = strongest_wavelength(profile(made.model, mode), wavelength);
  return found;
}

// Checks the amplitude of a film that is compressed past its critical compression and has come to rest. In theory it is
// thickness * sqrt(compression / critical - 1) (Chen & Hutchinson 2004).
void check_growth(const Film& film, const Backend& backend, const BakeScene& bake, Finding& finding)
{
  // An error of 1 % in the critical compression would be one of 5 % in the amplitude at 1.1 times that compression.
  const Instability found = instability(film, film_model(film, 5, bake), 10);
  std::vector<double> excess, amplitude;
  for (const double ratio : { 1.1, 1.2, 1.4, 1.8 })
  {
    const double compression = ratio * found.compression, expected = film.layers[0].thickness * std::sqrt(ratio - 1);
    const auto model = std::make_shared<const Model>(film_model(film, 5, bake, compression).model);
    const auto solver = make_solver(model, { backend, 1, 0 });
    Vectors u = affine_displacements(*model, compressed(compression));
    for (std::size_t n = 0; n < u.size(); ++n)
      for (const std::size_t axis : { 0, 2 })
        u[n][axis] += expected * found.mode[n][axis];
    solver->set_displacements(u);
    const Equilibrium rest = solver->settle(solver->controls(), 1e-4, 10);
    solver->displacements(u);
    // that of the sine with the mean square of the heights along the three middle waves
    const auto heights = profile(*model, u);
    const std::size_t first = heights.size() / 5, last = heights.size() - first;
    double mean = 0, squared = 0;
    for (std::size_t i = first; i < last; ++i)
      mean += heights[i].second / static_cast<double>(last - first);
    for (std::size_t i = first; i < last; ++i)
      squared += std::pow(heights[i].second - mean, 2) / static_cast<double>(last - first);
    excess.push_back(ratio - 1);
    amplitude.push_back(std::sqrt(2 * squared));
    finding.checks.relative(fmt::format("film at {:g} times its critical compression: amplitude", ratio), "mm",
                            1e3 * expected, rest.reached ? 1e3 * amplitude.back() : std::nan(""), 0.15);
  }
  finding.checks.relative("power of the excess at which the amplitude grows", "1", 0.5, slope(excess, amplitude), 0.1);
}

}  // namespace

void check_film(const Film& film, const std::string& name, const BakeScene& bake, Table& table, Finding& finding)
{
  const Waves expected = theory(film);
  const Instability found = instability(film, film_model(film, 5, bake), 6);
  finding.checks.relative(name + ": wavelength", "mm", 1e3 * expected.wavelength, 1e3 * found.wavelength, 0.1);
  finding.checks.relative(name + ": critical compression", "%", 100 * expected.compression, 100 * found.compression,
                          0.15);
  const auto rounded = [](double x) { return std::round(100 * x) / 100; };
  table.add({ name, rounded(1e3 * film.edge), rounded(expected.wavelength / film.edge),
              rounded(1e3 * expected.wavelength), rounded(1e3 * found.wavelength), rounded(100 * expected.compression),
              rounded(100 * found.compression) });
}

Table film_table()
{
  return Table({ "film", "voxel [mm]", "wavelength over voxel", "wavelength [mm]", "found [mm]",
                 "critical compression [%]", "found [%]" });
}

void verify_wrinkle(const Backend& backend, const BakeScene& bake, Finding& finding)
{
  if (!runs(bake, finding))
    return;
  Table deep = film_table();
  const auto check_deep = [&](double contrast, double thickness, double edge)
  {
    check_film(
        { { { shell_young, thickness } }, shell_young / contrast, edge },
        fmt::format("film of {}, {} times as stiff, voxels of {}", millimetres(thickness), contrast, millimetres(edge)),
        bake, deep, finding);
  };
  for (const double contrast : { 30.0, 100.0, 300.0, 1000.0 })
    for (const double voxels : { 9.0, 12.0, 16.0 })
    {
      const double edge = 1e-3, thickness = voxels * edge / expected_wrinkles(contrast).wavelength;
      check_deep(contrast, 1e-5 * std::round(1e5 * thickness), edge);
    }
  for (const double edge : { 1.5e-3, 1e-3, 0.75e-3 })
    check_deep(300, 0.5e-3, edge);
  finding.tables.emplace_back("Wrinkles of films", deep);

  Table layers = film_table();
  for (const double contrast : { 100.0, 300.0 })
    for (const double height : { 4.5e-3, 3e-3 })
      for (const bool glides : { true, false })
        check_film({ { { shell_young, 0.5e-3 } }, shell_young / contrast, 0.75e-3, height, glides },
                   fmt::format("film {} times as stiff, base of {} that {}", contrast, millimetres(height),
                               glides ? "glides" : "is held"),
                   bake, layers, finding);
  finding.tables.emplace_back("Wrinkles of a film of 0.5 mm on a base of finite height", layers);

  // The skin of Warburton & Maddock: the corneum folds on the dermis, and both together on the hypodermis over bone.
  const Slab::Layer corneum{ 48e6, 0.02e-3 }, dermis{ 81.4e3, 1.8e-3 };
  Table skin = film_table();
  check_film({ { corneum }, dermis.young, 0.05e-3 }, "corneum on dermis", bake, skin, finding);
  for (const double height : { 6.75e-3, 4.5e-3 })
    for (const bool glides : { true, false })
      check_film({ { corneum, dermis }, 34e3, 0.75e-3, height, glides },
                 fmt::format("corneum and dermis on hypodermis that {}, {} in all", glides ? "glides" : "is held",
                             millimetres(height)),
                 bake, skin, finding);
  finding.tables.emplace_back("Two wavelengths of skin", skin);
  check_growth({ { { shell_young, 0.5e-3 } }, 0.01 * shell_young, 1e-3 }, backend, bake, finding);
}

}  // namespace frontalis
