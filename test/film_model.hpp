#pragma once

#include "frontalis/model/model.hpp"

#include <cstdint>

namespace frontalis
{
namespace test
{

constexpr double film_thickness = 0.1e-3;

/// A square skin, ten wavelengths wide, of irregular triangles with six edges per wavelength. Its film is stiffer than
/// its base by the factor `stiffness_ratio`. With `shear` triangles are sheared along x: 0.6 makes angles of 120
/// degrees.
inline Model film_model(double stiffness_ratio, double shear = 0)
{
  Model model;
  model.spacing = { { 1e-4, 1e-4, 1e-4 } };
  FilmLaw law;
  law.thickness = film_thickness;
  law.base_modulus = 1e5;
  law.modulus = stiffness_ratio * law.base_modulus;
  law.poisson = 0.49;
  model.film.laws = { law };
  const double edge = film_wavelength(law) / 6;
  constexpr std::int32_t n = 60;
  std::uint32_t state = 1;
  const auto shift = [&](std::int32_t i)
  {
    state = state * 1664525U + 1013904223U;
    return i == 0 || i == n ? 0 : 0.4 * ((state >> 8U) / 16777216.0 - 0.5);
  };
  for (std::int32_t j = 0; j <= n; ++j)
    for (std::int32_t i = 0; i <= n; ++i)
    {
      const double y = edge * (j + shift(j));
      model.skin.vertices.push_back({ { edge * (i + shift(i)) + shear * y, y, 0 } });
    }
  for (std::int32_t j = 0; j < n; ++j)
    for (std::int32_t i = 0; i < n; ++i)
    {
      const std::int32_t a = j * (n + 1) + i, b = a + 1, c = b + n, d = c + 1;
      model.skin.triangles.push_back({ { a, b, (i + j) % 2 == 0 ? c : d } });
      model.skin.triangles.push_back({ { (i + j) % 2 == 0 ? b : a, d, c } });
    }
  model.film.carried = model.skin.triangles;
  model.film.law.assign(model.skin.vertices.size(), 0);
  return model;
}

}  // namespace test
}  // namespace frontalis
