// a stiff film on a soft base: when it wrinkles, and how wide

#include "frontalis/study/linear_statics.hpp"
#include "verification_cases.hpp"

#include <cmath>

namespace frontalis
{
namespace
{

constexpr double contrast = 100, poisson = 0.49, base_young = 1e4;

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

// compression at which a cell of half a wavelength, `half` voxels, loses its stability; film of `film` voxels
double critical_compression(int film, int half)
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
      "wavelength deep.";
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
  const double wavelength = 2 * pi * std::cbrt(contrast / 3), compression = 25 * std::pow(3 / contrast, 2.0 / 3);
  for (const int film : { 1, 2 })
  {
    Plot::Curve curve{
      "film of " + std::to_string(film) + (film == 1 ? " voxel" : " voxels"), {}, {}, Plot::Style::points
    };
    std::size_t least = 0;
    for (int half = 6 * film; half <= 14 * film; half += film)
    {
      curve.x.push_back(2.0 * half / film);
      curve.y.push_back(100 * critical_compression(film, half));
      if (curve.y.back() < curve.y[least])
        least = curve.y.size() - 1;
    }
    // the least of a parabola through the three lowest points
    const double left = curve.y[least - 1], middle = curve.y[least], right = curve.y[least + 1];
    const double shift = 0.5 * (left - right) / (left - 2 * middle + right);
    const double found = curve.x[least] + shift * (curve.x[1] - curve.x[0]);
    const double lowest = middle - 0.25 * (left - right) * shift;
    finding.checks.push_back(relative_check("wavelength over h, " + curve.name, "1", wavelength, found, 0.1));
    finding.checks.push_back(relative_check("critical compression, " + curve.name, "%", compression, lowest, 0.1));
    plot.curves.push_back(curve);
  }
  finding.plots.emplace_back("wrinkling", plot);
  finding.remarks =
      "Which wrinkles voxels can show: a wavelength takes about 8 voxels, and the film at least one. The "
      "published stratum corneum on its dermis (48 MPa, 0.02 mm on 0.0814 MPa) would wrinkle at 0.73 mm and "
      "0.74 %: only a shell can carry it, and voxels of a millimetre do not. Corneum and dermis as one plate "
      "on the hypodermis wrinkle at 8 to 16 mm and 6 to 13 %, depending on the depth over bone: these are the "
      "wrinkles that a scene with millimetre voxels can show.";
  return finding;
}

}  // namespace frontalis
