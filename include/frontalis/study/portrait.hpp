#pragma once

#include "frontalis/solver/solver.hpp"

#include <array>
#include <string>
#include <vector>

namespace frontalis
{

/// Draws skins of one model without a display: in parallel projection, shaded, with lips and brows tinted by the places
/// of landmarks at rest, eyeballs where the model has bones called eye_..., and bodies that tissue touches.
class Portrait
{
public:
  /// `rest`: the skin at rest, in the face frame, as all skins.
  Portrait(const Model& model, const SkinState& rest);

  static constexpr int width = 300, height = 380;  ///< [pixels]
  /// Red, green and blue of each pixel, row by row from the top.
  std::vector<std::uint8_t> draw(const SkinState& skin, const Controls& controls) const;

private:
  struct Canvas;
  using Vector = std::array<double, 3>;
  void draw_mesh(Canvas& canvas, const std::vector<std::array<float, 3>>& vertices,
                 const std::vector<std::array<std::int32_t, 3>>& triangles, const std::vector<Vector>& colours) const;
  void draw_ball(Canvas& canvas, const Vector& centre, double radius, const RigidTransform* eye) const;

  const Model& model_;
  std::vector<Vector> colours_;  // of the skin's vertices
  Vector middle_{};              // of the picture, and of the dark space behind the lips [m]
  Vector mouth_{};
  double mouth_radius_ = 0, pixel_ = 0;  // [m]
};

/// Writes a sheet of portraits with a title each to PATH.png, by gnuplot.
void write_contact_sheet(const std::vector<std::pair<std::string, std::vector<std::uint8_t>>>& portraits, int columns,
                         const std::string& path);

}  // namespace frontalis
