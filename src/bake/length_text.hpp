#pragma once

#include "bake/vector.hpp"

#include <cstdio>
#include <string>

namespace frontalis
{

/// Name of a length unit given in metres.
inline std::string unit_text(double unit)
{
  if (unit == 1)
    return "m";
  if (unit == 1e-2)
    return "cm";
  if (unit == 1e-6)
    return "um";
  return unit == 0.0254 ? "in" : "mm";
}

/// A length [m] in the scene's unit, "12.3 mm".
inline std::string length_text(double length, double unit)
{
  char text[64];
  std::snprintf(text, sizeof(text), "%.3g %s", length / unit, unit_text(unit).c_str());
  return text;
}

/// A place [m] in the scene's unit, as the mesh files have it: "(12.3, -180, 1540.2) mm".
inline std::string place_text(const Vector3& place, double unit)
{
  char text[128];
  std::snprintf(text, sizeof(text), "(%.6g, %.6g, %.6g) %s", place[0] / unit, place[1] / unit, place[2] / unit,
                unit_text(unit).c_str());
  return text;
}

}  // namespace frontalis
