#include "bake/shapes/forehead_muscles.hpp"

#include "bake/shapes/sheet_mesh.hpp"

#include <cmath>
#include <functional>

namespace frontalis
{
namespace
{

/// Middle surface of a flat muscle: arc length and height of its point (a, b), both from 0 to 1, and its depth as a
/// proportion of the soft tissue. a runs to the subject's left, b upwards or along the fibres.
struct Sheet
{
  std::function<std::array<double, 2>(double, double)> place;
  std::function<double(double, double)> depth;
  double thickness = 0;  ///< [m]
  double length_a = 0, length_b = 0;
};

TriangleMesh thicken(const ForeheadMap& map, const Sheet& sheet, double edge)
{
  const auto count = [&](double length)
  { return 2 * std::max(1, static_cast<std::int32_t>(std::ceil(0.5 * length / edge))); };
  const std::int32_t n = count(sheet.length_a), m = count(sheet.length_b),
                     l = std::max(1, static_cast<std::int32_t>(std::ceil(sheet.thickness / edge)));
  const auto at = [&](std::int32_t i, std::int32_t j, std::int32_t k) -> Vector3d
  {
    const double a = static_cast<double>(i) / n, b = static_cast<double>(j) / m;
    const auto [s, z] = sheet.place(a, b);
    const double offset = (static_cast<double>(k) / l - 0.5) * sheet.thickness / map.thickness(z);
    return map.at(s, z, sheet.depth(a, b) + offset);
  };
  TriangleMesh mesh;
  add_sheet(mesh, n, m, [&](std::int32_t i, std::int32_t j) { return at(i, j, 0); });
  add_sheet(mesh, n, m, [&](std::int32_t i, std::int32_t j) { return at(n - i, j, l); });
  add_sheet(mesh, n, l, [&](std::int32_t i, std::int32_t k) { return at(n - i, 0, k); });
  add_sheet(mesh, n, l, [&](std::int32_t i, std::int32_t k) { return at(i, m, k); });
  add_sheet(mesh, m, l, [&](std::int32_t j, std::int32_t k) { return at(0, j, k); });
  add_sheet(mesh, m, l, [&](std::int32_t j, std::int32_t k) { return at(n, m - j, k); });
  return mesh;
}

double mix(double a, double b, double t) { return a + (b - a) * t; }

/// Inner edge of the frontalis: a few millimetres from the midline at the brow, diverging upwards.
double frontalis_inner(double share) { return mix(3e-3, 12e-3, share * share); }

constexpr double frontalis_width = 38e-3;

/// From the skin of the brow, where it is superficial, up to the galea at two thirds of the height.
Sheet frontalis(const ForeheadMap& map, double side)
{
  const ForeheadDimensions& d = map.dimensions();
  Sheet sheet;
  sheet.place = [&d, side](double a, double b)
  {
    const double inner = frontalis_inner(b);
    const double s = side > 0 ? inner + a * frontalis_width : -inner - (1 - a) * frontalis_width;
    // the insertion follows the brow: lower at its lateral end
    const double out = (std::abs(s) - inner) / frontalis_width;
    const double low = d.brow_height - 2e-3 - 3e-3 * out * out;
    return std::array<double, 2>{ s, mix(low, d.brow_height + 2.0 / 3 * d.height - 6e-3 * out * out, b) };
  };
  sheet.depth = [](double, double b) { return mix(0.38, 0.55, std::min(1.0, b / 0.35)); };
  sheet.thickness = d.muscle_thickness;
  sheet.length_a = frontalis_width;
  sheet.length_b = 2.0 / 3 * d.height;
  return sheet;
}

/// From the bone at the medial end of the brow obliquely upwards and outwards to the skin over the middle of the brow.
Sheet corrugator(const ForeheadMap& map, double side)
{
  const ForeheadDimensions& d = map.dimensions();
  Sheet sheet;
  const double angle = 20 * pi / 180;
  const double length = 35e-3;
  sheet.place = [&d, side, angle, length](double a, double b)
  {
    // along: 0 at the origin (medial), 1 at the insertion (lateral); the muscle fans out
    const double along = side > 0 ? a : 1 - a;
    const double across = (b - 0.5) * mix(8e-3, 12e-3, along);
    const double s = 4e-3 + along * length * std::cos(angle) - across * std::sin(angle);
    const double z = 0.75 * d.brow_height + along * length * std::sin(angle) + across * std::cos(angle);
    return std::array<double, 2>{ side * s, z };
  };
  sheet.depth = [side](double a, double) { return mix(0.9, 0.3, side > 0 ? a : 1 - a); };
  sheet.thickness = d.muscle_thickness;
  sheet.length_a = length;
  sheet.length_b = 12e-3;
  return sheet;
}

/// From the nasal bone up in the midline to the skin between the brows.
Sheet procerus(const ForeheadMap& map)
{
  const ForeheadDimensions& d = map.dimensions();
  Sheet sheet;
  sheet.place = [](double a, double b) {
    return std::array<double, 2>{ mix(-5e-3, 5e-3, a), mix(-1.5e-3, 23.5e-3, b) };
  };
  sheet.depth = [](double, double b) { return mix(0.85, 0.3, b); };
  sheet.thickness = d.muscle_thickness;
  sheet.length_a = 10e-3;
  sheet.length_b = 25e-3;
  return sheet;
}

/// Tendon sheet from the upper edge of the frontales, and the gap between them, to the hairline.
Sheet galea(const ForeheadMap& map)
{
  const ForeheadDimensions& d = map.dimensions();
  Sheet sheet;
  sheet.place = [&map, &d](double a, double b)
  {
    const double half = std::min(52e-3, map.half_width());
    const double s = mix(-half, half, a);
    const double arc = std::abs(s);
    // down between the frontales as far as they leave room, else to their upper edge
    const double top = d.brow_height + 2.0 / 3 * d.height - 3e-3;
    const double gap = std::max(0.0, 1 - arc / 12e-3);
    const double outer = std::max(0.0, (arc - 12e-3) / frontalis_width);
    const double low = top - 0.4 * d.height * gap * gap * (3 - 2 * gap) - 6e-3 * std::min(1.0, outer * outer);
    // beyond the upper edge of the tissue, so that no slit is left there
    return std::array<double, 2>{ s, mix(low, map.upper_edge(s) + 1e-3, b) };
  };
  sheet.depth = [](double, double) { return 0.55; };
  sheet.thickness = d.galea_thickness;
  sheet.length_a = 104e-3;
  sheet.length_b = 0.75 * d.height;
  return sheet;
}

}  // namespace

TriangleMesh make_forehead_muscle(const ForeheadMap& map, const std::string& part, double edge)
{
  if (part == "frontalis_left")
    return thicken(map, frontalis(map, 1), edge);
  if (part == "frontalis_right")
    return thicken(map, frontalis(map, -1), edge);
  if (part == "corrugator_left")
    return thicken(map, corrugator(map, 1), edge);
  if (part == "corrugator_right")
    return thicken(map, corrugator(map, -1), edge);
  if (part == "procerus")
    return thicken(map, procerus(map), edge);
  return thicken(map, galea(map), edge);
}

}  // namespace frontalis
