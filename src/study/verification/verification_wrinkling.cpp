// wrinkling of a stiff film on a soft base: critical compression and wavelength

#include "frontalis/study/linear_statics.hpp"
#include "study/verification/verification_cases.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace frontalis
{
namespace
{

constexpr double poisson = 0.49, base_young = 1e4;

// stress-free stretch across the layers at a given stretch along them, in plane strain
double free_stretch(double along)
{
  const double mu = shear_modulus(1, poisson), kappa = bulk_modulus(1, poisson);
  double low = 0.5, high = 2;
  for (int i = 0; i < 60; ++i)
  {
    const double z = 0.5 * (low + high), J = along * z, I1 = along * along + 1 + z * z;
    const double stress = mu * std::pow(J, -2.0 / 3) * (z - I1 / (3 * z)) + kappa * (J - 1) * along;
    (stress > 0 ? high : low) = z;
  }
  return 0.5 * (low + high);
}

// a film on a base: the spacing of voxels, the number of planes of the base, and for each plane of the film, the lowest
// first, its stiffness over that of the base
struct Layers
{
  std::array<double, 3> spacing{ { 1e-3, 1e-3, 1e-3 } };  // [m]
  int base = 0;
  std::vector<double> film;
};

Layers film_on_deep_base(double contrast, int film, int half)
{
  Layers layers;
  layers.base = 2 * half;
  layers.film.assign(static_cast<std::size_t>(film), contrast);
  return layers;
}

// compression at which a cell of half a wavelength, `half` voxels, becomes unstable
double critical_compression(const Layers& layers, int half)
{
  VoxelBox box;
  box.spacing = layers.spacing;
  box.size = { { half, 1, layers.base + static_cast<int>(layers.film.size()) } };
  box.materials = { neo_hookean(base_young, poisson) };
  for (const double contrast : layers.film)
    box.materials.push_back(neo_hookean(contrast * base_young, poisson));
  box.material = [&](const auto& voxel) { return std::max(0, voxel[2] - layers.base + 1); };
  Model model = voxel_model(box);
  model.hourglass = HourglassControl::assumed_strain;
  const double width = half * box.spacing[0];
  prescribe(model, nodes_where(model, [](const auto&) { return true; }), { { false, true, false } });
  prescribe(model, nodes_where(model, [&](const auto& p) { return p[0] == 0 || p[0] > 0.999 * width; }),
            { { true, false, false } });
  prescribe(model, nodes_where(model, [](const auto& p) { return p[2] == 0; }), { { true, false, true } });
  double low = 0, high = 0.3;
  for (int i = 0; i < 12; ++i)
  {
    const double compression = 0.5 * (low + high);
    const LinearStatics tangent(model, { { 1 - compression, 0, 0, 0, 1, 0, 0, 0, free_stretch(1 - compression) } });
    (tangent.positive_definite() ? low : high) = compression;
  }
  return 0.5 * (low + high);
}

struct Wrinkles
{
  double wavelength = 0;   ///< in units of the film's thickness
  double compression = 0;  ///< [%]
};

// the wrinkles of plate theory
Wrinkles expected_wrinkles(double contrast)
{
  return { 2 * std::acos(-1.0) * std::cbrt(contrast / 3), 25 * std::pow(3 / contrast, 2.0 / 3) };
}

// The wrinkles that need the least compression among half wavelengths from `first` to `last` voxels. `curve` gets the
// compression of each wavelength; wavelengths are in voxels.
Wrinkles find_wrinkles(const std::function<Layers(int)>& layers, int first, int last, int step, Plot::Curve& curve)
{
  std::size_t least = 0;
  for (int half = first; half <= last; half += step)
  {
    curve.add(2.0 * half, 100 * critical_compression(layers(half), half));
    if (curve.y.back() < curve.y[least])
      least = curve.y.size() - 1;
  }
  if (least == 0 || least + 1 == curve.y.size())
    return { curve.x[least], curve.y[least] };
  // the minimum of a parabola through the three lowest points
  const double left = curve.y[least - 1], middle = curve.y[least], right = curve.y[least + 1];
  const double shift = 0.5 * (left - right) / (left - 2 * middle + right);
  return { curve.x[least] + shift * (curve.x[1] - curve.x[0]), middle - 0.25 * (left - right) * shift };
}

// wrinkles of a film of `film` voxels on a deep base; wavelengths in units of the film's thickness
Wrinkles film_wrinkles(double contrast, int film, Plot::Curve& curve)
{
  const int expected = static_cast<int>(std::lround(expected_wrinkles(contrast).wavelength / 2));
  Wrinkles found = find_wrinkles([=](int half) { return film_on_deep_base(contrast, film, half); },
                                 (expected - 4) * film, (expected + 4) * film, film, curve);
  for (double& wavelength : curve.x)
    wavelength /= film;
  found.wavelength /= film;
  return found;
}

// Wrinkles of the published skin on hypodermis over bone. Corneum (48 MPa, 0.02 mm) and dermis (0.0814 MPa, 1.8 mm) are
// replaced by one plate of equal stretching and bending stiffness, so that the corneum cannot wrinkle alone.
// Wavelengths are in mm; that of the result is measured after the compression.
Wrinkles skin_wrinkles(double depth, double expected, Plot::Curve& curve)
{
  constexpr double young[2] = { 48e6, 81.4e3 }, thickness[2] = { 0.02e-3, 1.8e-3 }, hypodermis = 34e3;
  const double middle_of[2] = { thickness[1] + 0.5 * thickness[0], 0.5 * thickness[1] };
  double stretching = 0, moment = 0, bending = 0;
  for (int l = 0; l < 2; ++l)
  {
    stretching += young[l] * thickness[l];
    moment += young[l] * thickness[l] * middle_of[l];
  }
  for (int l = 0; l < 2; ++l)
    bending +=
        young[l] * thickness[l] * (thickness[l] * thickness[l] / 12 + std::pow(middle_of[l] - moment / stretching, 2));
  const double plate = std::sqrt(12 * bending / stretching);
  constexpr int planes = 5;
  constexpr double along = 0.4e-3;
  const double across = plate / planes;
  Layers layers;
  layers.spacing = { { along, along, across } };
  layers.base = static_cast<int>(std::lround(depth / across));
  layers.film.assign(planes, stretching / plate / hypodermis);
  const int middle = static_cast<int>(std::lround(expected / (2 * along)));
  Wrinkles found = find_wrinkles([&](int) { return layers; }, std::max(3, middle - 5), middle + 5, 1, curve);
  for (double& wavelength : curve.x)
    wavelength *= 1e3 * along;
  found.wavelength *= 1e3 * along * (1 - 0.01 * found.compression);
  return found;
}

}  // namespace

Finding verify_wrinkling(const VerificationSettings&)
{
  Finding finding;
  constexpr double contrast = 100;
  const double pi = std::acos(-1.0);
  Plot plot{ "Compression at which a film wrinkles", "wavelength over film thickness [1]", "compression [%]" };
  plot.curves.push_back({ "plate theory", {}, {}, Plot::Style::line });
  for (double wavelength = 10; wavelength < 30; wavelength += 0.5)
  {
    const double kh = 2 * pi / wavelength;
    plot.curves[0].add(wavelength, 100 * (kh * kh / 12 + 1 / (2 * contrast * kh)));
  }
  const Wrinkles expected = expected_wrinkles(contrast);
  for (const int film : { 1, 2 })
  {
    Plot::Curve curve{
      fmt::format("film of {} {}", film, film == 1 ? "voxel" : "voxels"), {}, {}, Plot::Style::points
    };
    const Wrinkles found = film_wrinkles(contrast, film, curve);
    finding.checks.relative("wavelength over h, " + curve.name, "1", expected.wavelength, found.wavelength, 0.1);
    finding.checks.relative("critical compression, " + curve.name, "%", expected.compression, found.compression, 0.1);
    plot.curves.push_back(curve);
  }
  // 48 MPa and 0.02 mm on 0.0814 MPa, in voxels of 0.02 mm
  constexpr double skin_contrast = 48 / 0.0814, thickness = 0.02;
  Plot::Curve skin;
  const Wrinkles of_skin = film_wrinkles(skin_contrast, 1, skin);
  finding.checks.relative("corneum on dermis: wavelength", "mm", 0.731, thickness * of_skin.wavelength, 0.1);
  finding.checks.relative("corneum on dermis: critical compression", "%", 0.74, of_skin.compression, 0.1);
  finding.plots.emplace_back("wrinkling", plot);
  // hypodermis over bone: depth [m]; wavelength [mm] and compression [%] by plate theory on an elastic layer that is
  // bonded to bone, ν = 0.49 and free to shear at the plate, and ν = 0.5 and held there
  constexpr double plates[][5] = { { 5e-3, 12.46, 7.13, 12.1, 7.3 },
                                   { 3e-3, 10.44, 9.12, 9.7, 9.7 },
                                   { 2e-3, 9.04, 11.61, 8.1, 13 } };
  for (const auto& plate : plates)
  {
    Plot::Curve curve;
    const Wrinkles found = skin_wrinkles(plate[0], 1e-3 * plate[1], curve);
    const std::string name = "skin on " + readable(1e3 * plate[0]) + " mm of hypodermis: ";
    const double unbounded = std::nan("");
    finding.checks.relative(name + "wavelength", "mm", plate[1], found.wavelength, 0.1);
    finding.checks.relative(name + "compression", "%", plate[2], found.compression, 0.15);
    finding.checks.relative(name + "wavelength, held", "mm", plate[3], found.wavelength, unbounded);
    finding.checks.relative(name + "compression, held", "%", plate[4], found.compression, unbounded);
  }
  return finding;
}

}  // namespace frontalis
