#pragma once

#include "bake/vector.hpp"
#include "frontalis/scene/scene.hpp"

#include <fmt/format.h>

namespace frontalis
{

template <class... Values>
Error failure(fmt::format_string<Values...> text, Values&&... values)
{
  return Error(fmt::format(text, std::forward<Values>(values)...));
}

/// Beginning of a message about a named element of the scene: "face.yaml:12: volume 'tissue'".
template <class Part>
std::string place_in_scene(const Scene& scene, const char* kind, const Part& part)
{
  return fmt::format("{}:{}: {} '{}'", scene.file, part.line, kind, part.name);
}

/// Index of the entry called `name`. Throws Error if there is none, with a message that begins with `place`.
template <class Named>
int index_of(const std::vector<Named>& list, const std::string& name, const std::string& place, const char* kind)
{
  const auto found = std::find_if(list.begin(), list.end(), [&](const Named& entry) { return entry.name == name; });
  if (found == list.end())
    throw failure("{}: there is no {} '{}'", place, kind, name);
  return static_cast<int>(found - list.begin());
}

/// Name of a length unit given in metres.
inline const char* unit_text(double unit)
{
  return unit == 1 ? "m" : unit == 1e-2 ? "cm" : unit == 1e-6 ? "um" : unit == 0.0254 ? "in" : "mm";
}

/// Text of a length [m] in the scene's length unit: "12.3 mm".
inline std::string length_text(double length, double unit)
{
  return fmt::format("{:.3g} {}", length / unit, unit_text(unit));
}

/// Text of a position [m] in the scene's length unit: "(12.3, -180, 1540.2) mm".
inline std::string place_text(const Vector3d& place, double unit)
{
  const Vector3d p = place / unit;
  return fmt::format("({:.6g}, {:.6g}, {:.6g}) {}", p[0], p[1], p[2], unit_text(unit));
}

/// A count with its noun: "1 edge", "2 edges".
inline std::string count_text(std::size_t count, const char* one, const char* many)
{
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

/// Text of the corners of a box [m] in the scene's length unit: "(0, -3.2, 1500) to (60, 20, 1580) mm".
inline std::string box_text(const Box& box, double unit)
{
  const Vector3d a = box.min() / unit, b = box.max() / unit;
  return fmt::format("({:.4g}, {:.4g}, {:.4g}) to ({:.4g}, {:.4g}, {:.4g}) {}", a[0], a[1], a[2], b[0], b[1], b[2],
                     unit_text(unit));
}

/// Suggests the length unit with which something that spans `extent` [m] in `unit` [m] would have the size of a face or
/// of a part of a face: "with 'unit: cm' it would span 70 mm, with 'unit: in' 178 mm, as a face does". Empty if it has
/// such a size or would have it in no unit.
inline std::string unit_advice(double extent, double unit)
{
  const auto as_a_face = [](double size) { return size > 0.02 && size < 0.6; };
  if (as_a_face(extent))
    return {};
  std::string text;
  for (const double other : { 1e-3, 1.0, 1e-2, 1e-6, 0.0254 })
    if (const double size = extent / unit * other; as_a_face(size))
      text += fmt::format("{} 'unit: {}' {}{}", text.empty() ? "with" : ", with", unit_text(other),
                          text.empty() ? "it would span " : "", length_text(size, 1e-3));
  return text.empty() ? text : text + ", as a face does";
}

}  // namespace frontalis
