#pragma once

#include "frontalis/render/face_appearance.hpp"

#include <string>
#include <utility>
#include <vector>

namespace frontalis
{

/// From where a face is seen, and the size of its picture.
struct PortraitView
{
  double azimuth = 0.28;  ///< from straight ahead to the subject's left [rad]
  int height = 380;       ///< [pixels]

  int width() const { return height * 15 / 19; }  ///< [pixels]
  /// Names and azimuths of views: front, oblique (a little from the subject's left), left and right (the subject's).
  static const std::vector<std::pair<std::string, double>>& azimuths();
};

/// Draws skins of one model without a display, as seen from far away.
class Portrait
{
public:
  /// `rest`: the skin at rest. All skins are in the face frame. The model must outlive this object.
  Portrait(const Model& model, const SkinState& rest, const PortraitView& view = {});

  /// Red, green and blue of each pixel, row by row from the top.
  std::vector<std::uint8_t> draw(const SkinState& skin, const Controls& controls) const;

private:
  PortraitView view_;
  FaceAppearance appearance_;
  PinholeCamera camera_;
};

/// Writes a sheet of portraits of one view, each with a title, to PATH.png by gnuplot.
void write_contact_sheet(const std::vector<std::pair<std::string, std::vector<std::uint8_t>>>& portraits,
                         const PortraitView& view, int columns, const std::string& path);

}  // namespace frontalis
