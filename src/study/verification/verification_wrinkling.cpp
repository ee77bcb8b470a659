// Wrinkling of a stiff film on a soft base: critical compression and wavelength.

#include "study/verification/verification_cases.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace frontalis
{
namespace
{

constexpr double film_poisson = 0.49, base_young = 1e4;

// A film on a base, as planes of voxels.
struct Layers
{
  std::array<double, 3> spacing{ { 1e-3, 1e-3, 1e-3 } };  // edges of voxels [m]
  int base = 0;                                           // number of planes of voxels
  // Young's modulus of each plane of voxels of the film, lowest first, divided by that of the base
  std::vector<double> film;
};

// Compression (0..1) at which a cell of `half` voxels, half a wavelength long, becomes unstable.
double critical_compression(const Layers& layers, int half)
{
  VoxelBox box{ { { half, 1, layers.base + static_cast<int>(layers.film.size()) } },
                layers.spacing,
                { neo_hookean(base_young, film_poisson) } };
  for (const double contrast : layers.film)
    box.materials.push_back(neo_hookean(contrast * base_young, film_poisson));
  box.material = [&](const auto& voxel) { return std::max(0, voxel[2] - layers.base + 1); };
  Model model = voxel_model(box);
  model.hourglass = HourglassControl::assumed_strain;
  const double width = half * box.spacing[0];
  prescribe(model, nodes_where(model, [](const auto&) { return true; }), { { false, true, false } });
  prescribe(model, nodes_where(model, [&](const auto& p) { return p[0] == 0 || p[0] > 0.999 * width; }),
            { { true, false, false } });
  prescribe(model, nodes_where(model, [](const auto& p) { return p[2] == 0; }), { { true, false, true } });
  const auto unstable = [&](double compression)
  {
    const std::array<double, 9> F{ { 1 - compression, 0, 0, 0, 1, 0, 0, 0, free_stretch(1 - compression) } };
    return LinearStatics(model, F).positive_definite() ? -1 : 1;
  };
  return zero_between(0, 0.3, unstable, 12);
}

// Finds the wrinkles that need the least compression, with half wavelengths from `first` to `last` voxels. `curve`
// receives the critical compression [%] over the wavelength in units of `unit` voxels.
FilmWrinkles find_wrinkles(const std::function<Layers(int)>& layers, int first, int last, int step, double unit,
                           Plot::Curve& curve)
{
  for (int half = first; half <= last; half += step)
    curve.add(2.0 * half / unit, 100 * critical_compression(layers(half), half));
  const std::size_t least = std::min_element(curve.y.begin(), curve.y.end()) - curve.y.begin();
  if (least == 0 || least + 1 == curve.y.size())
    return { curve.x[least], curve.y[least] };
  // The minimum of the parabola through the three lowest points.
  const double left = curve.y[least - 1], middle = curve.y[least], right = curve.y[least + 1];
  const double shift = 0.5 * (left - right) / (left - 2 * middle + right);
  return { curve.x[least] + shift * (curve.x[1] - curve.x[0]), middle - 0.25 * (left - right) * shift };
}

// Wrinkles of a film of `film` voxels on a deep base; wavelengths in units of the film's thickness.
FilmWrinkles film_wrinkles(double contrast, int film, Plot::Curve& curve)
{
  const int expected = static_cast<int>(std::lround(expected_wrinkles(contrast).wavelength / 2));
  const auto layers = [&](int half) {
    return Layers{ { { 1e-3, 1e-3, 1e-3 } }, 2 * half, std::vector<double>(film, contrast) };
  };
  return find_wrinkles(layers, (expected - 4) * film, (expected + 4) * film, film, film, curve);
}

// Wrinkles of skin on hypodermis of a depth [m] over bone, for wavelengths around `expected` [m]. Corneum (48 MPa,
// 0.02 mm) and dermis (0.0814 MPa, 1.8 mm) are replaced by one plate of equal stretching and bending stiffness, so that
// the corneum cannot wrinkle alone. The resulting wavelength [mm] is measured after the compression.
FilmWrinkles skin_wrinkles(double depth, double expected)
{
  constexpr double young[2] = { 48e6, 81.4e3 }, thickness[2] = { 0.02e-3, 1.8e-3 }, hypodermis = 34e3;
  constexpr double middle_of[2] = { thickness[1] + 0.5 * thickness[0], 0.5 * thickness[1] };
  constexpr double stretching = young[0] * thickness[0] + young[1] * thickness[1];
  constexpr double neutral =
      (young[0] * thickness[0] * middle_of[0] + young[1] * thickness[1] * middle_of[1]) / stretching;
  double bending = 0;
  for (int l = 0; l < 2; ++l)
    bending += young[l] * thickness[l] * (thickness[l] * thickness[l] / 12 + std::pow(middle_of[l] - neutral, 2));
  const double plate = std::sqrt(12 * bending / stretching);
  constexpr int planes = 5;
  constexpr double along = 0.4e-3;
  const double across = plate / planes;
  const Layers layers{ { { along, along, across } },
                       static_cast<int>(std::lround(depth / across)),
                       std::vector<double>(planes, stretching / plate / hypodermis) };
  const int middle = static_cast<int>(std::lround(expected / (2 * along)));
  Plot::Curve curve;
  FilmWrinkles found =
      find_wrinkles([&](int) { return Layers(layers); }, std::max(3, middle - 5), middle + 5, 1, 1e-3 / along, curve);
  found.wavelength *= 1 - 0.01 * found.compression;
  return found;
}

}  // namespace

FilmWrinkles expected_wrinkles(double contrast)
{
  return { 2 * std::acos(-1.0) * std::cbrt(contrast / 3), 25 * std::pow(3 / contrast, 2.0 / 3) };
}

double free_stretch(double along)
{
  const double mu = shear_modulus(1, film_poisson), kappa = bulk_modulus(1, film_poisson);
  return zero_between(0.5, 2,
                      [=](double z)
                      {
                        const double J = along * z, I1 = along * along + 1 + z * z;
                        return mu * std::pow(J, -2.0 / 3) * (z - I1 / (3 * z)) + kappa * (J - 1) * along;
                      });
}

void verify_wrinkling(const Backend&, Finding& finding)
{
  constexpr double contrast = 100;
  const double pi = std::acos(-1.0);
  Plot plot{ "Compression at which a film wrinkles", "wavelength over film thickness [1]", "compression [%]" };
  plot.curves.push_back({ "plate theory", {}, {}, Plot::Style::line });
  for (double wavelength = 10; wavelength < 30; wavelength += 0.5)
  {
    const double kh = 2 * pi / wavelength;
    plot.curves[0].add(wavelength, 100 * (kh * kh / 12 + 1 / (2 * contrast * kh)));
  }
  const FilmWrinkles expected = expected_wrinkles(contrast);
  for (const int film : { 1, 2 })
  {
    Plot::Curve curve{ film == 1 ? "film of 1 voxel" : "film of 2 voxels", {}, {}, Plot::Style::points };
    const FilmWrinkles found = film_wrinkles(contrast, film, curve);
    finding.checks.relative("wavelength over h, " + curve.name, "1", expected.wavelength, found.wavelength, 0.1);
    finding.checks.relative("critical compression, " + curve.name, "%", expected.compression, found.compression, 0.1);
    plot.curves.push_back(curve);
  }
  // The film is corneum of 48 MPa and 0.02 mm on dermis of 0.0814 MPa, in voxels of 0.02 mm.
  constexpr double skin_contrast = 48 / 0.0814, thickness = 0.02;
  Plot::Curve skin;
  const FilmWrinkles of_skin = film_wrinkles(skin_contrast, 1, skin);
  finding.checks.relative("corneum on dermis: wavelength", "mm", 0.731, thickness * of_skin.wavelength, 0.1);
  finding.checks.relative("corneum on dermis: critical compression", "%", 0.74, of_skin.compression, 0.1);
  finding.plots.emplace_back("wrinkling", plot);
  // Results of plate theory on an elastic layer that is bonded to bone. Columns: depth of the hypodermis [mm];
  // wavelength [mm] and compression [%] with ν = 0.49 and a plate that slides on the layer; wavelength and compression
  // with ν = 0.5 and a plate that does not slide.
  constexpr double plates[][5] = { { 5, 12.46, 7.13, 12.1, 7.3 },
                                   { 3, 10.44, 9.12, 9.7, 9.7 },
                                   { 2, 9.04, 11.61, 8.1, 13 } };
  for (const auto& plate : plates)
  {
    const FilmWrinkles found = skin_wrinkles(1e-3 * plate[0], 1e-3 * plate[1]);
    const std::string name = "skin on " + readable(plate[0]) + " mm of hypodermis: ";
    const double unbounded = std::nan("");
    finding.checks.relative(name + "wavelength", "mm", plate[1], found.wavelength, 0.1);
    finding.checks.relative(name + "compression", "%", plate[2], found.compression, 0.15);
    finding.checks.relative(name + "wavelength, held", "mm", plate[3], found.wavelength, unbounded);
    finding.checks.relative(name + "compression, held", "%", plate[4], found.compression, unbounded);
  }
}

}  // namespace frontalis
