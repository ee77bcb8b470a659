// a stiff film on a soft base: when it wrinkles, and how wide

#include "frontalis/study/linear_statics.hpp"
#include "verification_cases.hpp"

#include <cmath>

namespace frontalis
{
namespace
{

constexpr double poisson = 0.49, base_young = 1e4;

// stretch across the layers that leaves them free of stress there, at a stretch along them in plane strain
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

// compression at which a cell of half a wavelength, `half` voxels, loses its stability; film of `film` voxels,
// `contrast` times as stiff as the base
double critical_compression(double contrast, int film, int half)
{
  VoxelBox box;
  box.size = { { half, 1, film + 2 * half } };
  box.materials = { neo_hookean(base_young, poisson), neo_hookean(contrast * base_young, poisson) };
  box.material = [=](const auto& voxel) { return voxel[2] >= 2 * half ? 1 : 0; };
  Model model = voxel_model(box);
  model.hourglass = HourglassControl::assumed_strain;
  const double width = half * box.spacing[0];
  prescribe(model, nodes_where(model, [](const auto&) { return true; }), { { false, true, false } });
  prescribe(model, nodes_where(model, [&](const auto& p) { return p[0] == 0 || p[0] > 0.999 * width; }),
            { { true, false, false } });
  prescribe(model, nodes_where(model, [](const auto& p) { return p[2] == 0; }), { { true, false, true } });
  double low = 0, high = 0.2;
  for (int i = 0; i < 11; ++i)
  {
    const double compression = 0.5 * (low + high);
    const LinearStatics tangent(model, { { 1 - compression, 0, 0, 0, 1, 0, 0, 0, free_stretch(1 - compression) } });
    (tangent.positive_definite() ? low : high) = compression;
  }
  return 0.5 * (low + high);
}

struct Wrinkles
{
  double wavelength = 0;   ///< over the film's thickness
  double compression = 0;  ///< [%]
};

// plate theory
Wrinkles expected_wrinkles(double contrast)
{
  return { 2 * std::acos(-1.0) * std::cbrt(contrast / 3), 25 * std::pow(3 / contrast, 2.0 / 3) };
}

// the wavelength that needs least compression, of those around the expected one; the curve gets all of them
Wrinkles find_wrinkles(double contrast, int film, Plot::Curve& curve)
{
  const int expected = static_cast<int>(std::lround(expected_wrinkles(contrast).wavelength / 2));
  std::size_t least = 0;
  for (int half = (expected - 4) * film; half <= (expected + 4) * film; half += film)
  {
    curve.x.push_back(2.0 * half / film);
    curve.y.push_back(100 * critical_compression(contrast, film, half));
    if (curve.y.back() < curve.y[least])
      least = curve.y.size() - 1;
  }
  if (least == 0 || least + 1 == curve.y.size())
    return { curve.x[least], curve.y[least] };
  // the least of a parabola through the three lowest points
  const double left = curve.y[least - 1], middle = curve.y[least], right = curve.y[least + 1];
  const double shift = 0.5 * (left - right) / (left - 2 * middle + right);
  return { curve.x[least] + shift * (curve.x[1] - curve.x[0]), middle - 0.25 * (left - right) * shift };
}

}  // namespace

Finding verify_wrinkling(const VerificationSettings&)
{
  Finding finding;
  finding.title = "Wrinkling of a stiff film on a soft base";
  finding.text =
      "Both neo-Hookean, ν = 0.49, the film 100 times stiffer, compressed in plane strain. Plate theory "
      "(Allen; Cao & Hutchinson 2012) for a wave number k and film thickness h: compression (kh)²/12 + Ēs/(2Ēf "
      "kh), least at wavelength 2πh (Ēf/3Ēs)^(1/3) = 20.2 h with ¼(3Ēs/Ēf)^(2/3) = 2.41 %. Here the compressed "
      "state is homogeneous, so the tangent of the solver's forces is assembled about it, and the compression "
      "is sought at which it stops being positive definite, for cells of half a wavelength, base one "
      "wavelength deep. The same for the published stratum corneum on its dermis (48 MPa, 0.02 mm on 0.0814 MPa), "
      "whose "
      "figures by plate theory are 0.731 mm and 0.74 %, in voxels as thick as the film.";
  constexpr double contrast = 100;
  const double pi = std::acos(-1.0);
  Plot plot;
  plot.title = "Compression at which a film wrinkles";
  plot.x_label = "wavelength over film thickness [1]";
  plot.y_label = "compression [%]";
  plot.curves.push_back({ "plate theory", {}, {}, Plot::Style::line });
  for (double wavelength = 10; wavelength < 30; wavelength += 0.5)
  {
    const double kh = 2 * pi / wavelength;
    plot.curves[0].x.push_back(wavelength);
    plot.curves[0].y.push_back(100 * (kh * kh / 12 + 1 / (2 * contrast * kh)));
  }
  const Wrinkles expected = expected_wrinkles(contrast);
  for (const int film : { 1, 2 })
  {
    Plot::Curve curve{
      "film of " + std::to_string(film) + (film == 1 ? " voxel" : " voxels"), {}, {}, Plot::Style::points
    };
    const Wrinkles found = find_wrinkles(contrast, film, curve);
    finding.checks.push_back(
        relative_check("wavelength over h, " + curve.name, "1", expected.wavelength, found.wavelength, 0.1));
    finding.checks.push_back(
        relative_check("critical compression, " + curve.name, "%", expected.compression, found.compression, 0.1));
    plot.curves.push_back(curve);
  }
  // 48 MPa and 0.02 mm on 0.0814 MPa, in voxels of 0.02 mm
  constexpr double skin_contrast = 48 / 0.0814, thickness = 0.02;
  Plot::Curve skin;
  const Wrinkles of_skin = find_wrinkles(skin_contrast, 1, skin);
  finding.checks.push_back(
      relative_check("corneum on dermis: wavelength", "mm", 0.731, thickness * of_skin.wavelength, 0.1));
  finding.checks.push_back(
      relative_check("corneum on dermis: critical compression", "%", 0.74, of_skin.compression, 0.1));
  finding.plots.emplace_back("wrinkling", plot);
  finding.remarks =
      "Which wrinkles voxels can show: a wavelength takes about 8 voxels, and the film at least one. In a whole face "
      "only a shell can carry the stratum corneum, voxels of a millimetre do not. Corneum and dermis as one plate "
      "on the hypodermis wrinkle at 8 to 16 mm and 6 to 13 %, depending on the depth over bone: these are the "
      "wrinkles that a scene with millimetre voxels can show.";
  return finding;
}

}  // namespace frontalis
