#include "bake/shapes/head/head.hpp"
#include "bake/shapes/muscle_net.hpp"

namespace frontalis
{
namespace
{

// A muscle stays at least this far below the skin, where there is room: the thickness of the dermis.
constexpr double least_cover = 1.3e-3;  // [m]

/// Width of a muscle across its fibres at the share u of the way along them.
double width_at(const MuscleSheet& sheet, double u)
{
  constexpr int parts = 8;
  double width = 0;
  for (int i = 0; i < parts; ++i)
    width += (sheet.at(u, (i + 1.0) / parts) - sheet.at(u, static_cast<double>(i) / parts)).norm();
  return width;
}

}  // namespace

ControlNet Head::left_net(const HeadTemplate::Muscle& muscle) const
{
  std::vector<std::vector<Vector3>> lines;
  lines.reserve(muscle.curves.size());
  for (const auto& curve : muscle.curves)
    lines.push_back(curve.points);
  const MuscleSheet sheet(std::move(lines), muscle.ring);
  // Fibres run from end to end, so that a muscle is thicker where they converge: else its narrow end would be stretched
  // by the rest of it. The thickness stays within 0.5 to 2 times the given one.
  constexpr int stations = 8;
  double mean_width = 0;
  for (int i = 0; i <= stations; ++i)
    mean_width += width_at(sheet, static_cast<double>(i) / stations) / (stations + 1);
  const auto convergence = [&](double u)
  { return muscle.ring ? 1 : std::min(2.0, std::max(0.5, mean_width / width_at(sheet, u))); };
  const auto sides = [&](double u, double s) -> std::array<Vector3d, 2>
  {
    const Below place = below(sheet.at(u, s));
    const double room = place.thickness;
    std::vector<double> depths;
    depths.reserve(muscle.curves.size());
    for (const auto& curve : muscle.curves)
      depths.push_back(curve.below < 0 ? curve.depth * room : curve.below + deeper(place.skin, curve.below));
    const double depth = sheet.between(depths, u, s);
    // A muscle with a depth of its own (Curve::below) may pass below a bone.
    const auto last = static_cast<double>(muscle.curves.size() - 1);
    const double t = sheet.position(u, s);
    const auto lies_free = [&](double curve)
    { return muscle.curves[static_cast<std::size_t>(std::min(curve, last))].below >= 0; };
    const bool free = lies_free(std::floor(t)) || lies_free(std::ceil(t));
    const double relative = sheet.relative_thickness(u, s) * (free ? 1 : convergence(u));
    const double thickness = muscle.thickness * relative;
    const double half = 0.5 * (free ? thickness : std::min(thickness, 0.8 * room));
    const double lowest = free ? depth : std::max(0.55 * room, room - half - 0.1e-3);
    const double highest = std::min(lowest, std::min(least_cover, 0.3 * room) + half);
    const double middle = std::min(lowest, std::max(highest, depth));
    return { place.skin - (middle + half) * place.normal, place.skin - (middle - half) * place.normal };
  };
  return sheet.net(sides);
}

}  // namespace frontalis
