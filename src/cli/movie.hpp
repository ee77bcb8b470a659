#pragma once

#include "frontalis/study/portrait.hpp"

#include <optional>
#include <string>

namespace frontalis
{

/// Draws the frames of a motion, without a display, and joins them to an animated GIF.
class Movie
{
public:
  /// `path`: a file that ends in .gif, or a folder that receives frame_NNNN.png. The model must outlive this object.
  /// Throws Error if the folder of the frames cannot be made, or ImageMagick, which joins them, is missing.
  Movie(std::string path, double frame_rate, const Model& model);

  /// Draws an image of the skin, which is in the coordinates of the face frame. The first call must show the face at
  /// rest.
  void add(const SkinState& skin, const Controls& controls);
  /// If `path` is a GIF, joins the frames to it and removes their folder. Throws Error if that fails.
  void finish();

private:
  std::string path_, folder_;
  double frame_rate_;
  const Model& model_;
  std::optional<Portrait> portrait_{};
  int frames_ = 0;
};

}  // namespace frontalis
