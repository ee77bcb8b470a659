#pragma once

#include "frontalis/render/face_appearance.hpp"

#include <string>
#include <utility>
#include <vector>

namespace frontalis
{

/// Draws skins of one model without a display, as seen from far away and a little from the subject's left.
class Portrait
{
public:
  /// `rest`: the skin at rest. All skins are in the face frame. The model must outlive this object.
  Portrait(const Model& model, const SkinState& rest);

  static constexpr int width = 300, height = 380;  ///< [pixels]
  /// Red, green and blue of each pixel, row by row from the top.
  std::vector<std::uint8_t> draw(const SkinState& skin, const Controls& controls) const;

private:
  FaceAppearance appearance_;
  PinholeCamera camera_;
};

/// Writes a sheet of portraits, each with a title, to PATH.png by gnuplot.
void write_contact_sheet(const std::vector<std::pair<std::string, std::vector<std::uint8_t>>>& portraits, int columns,
                         const std::string& path);

}  // namespace frontalis
