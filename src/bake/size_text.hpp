#pragma once

#include "bake/messages.hpp"

namespace frontalis
{

/// Text of the corners of a box [m] in the scene's length unit: "(0, -3.2, 1500) to (60, 20, 1580) mm".
inline std::string box_text(const Box& box, double unit)
{
  const Vector3d a = box.min() / unit, b = box.max() / unit;
  return fmt::format("({:.4g}, {:.4g}, {:.4g}) to ({:.4g}, {:.4g}, {:.4g}) {}", a[0], a[1], a[2], b[0], b[1], b[2],
                     unit_text(unit));
}

/// Suggests the length unit with which something that spans `extent` [m] in `unit` [m] would have the size of a face or
/// of a part of a face: "with 'unit: m' it would span 180 mm, as a face does". Empty if it has such a size or would
/// have it in no unit.
inline std::string unit_advice(double extent, double unit)
{
  const auto as_a_face = [](double size) { return size > 0.02 && size < 0.6; };
  if (as_a_face(extent))
    return {};
  for (const double other : { 1e-3, 1.0, 1e-2, 1e-6, 0.0254 })
    if (const double size = extent / unit * other; as_a_face(size))
      return fmt::format("with 'unit: {}' it would span {}, as a face does", unit_text(other), length_text(size, 1e-3));
  return {};
}

}  // namespace frontalis
