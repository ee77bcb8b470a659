#pragma once

#include "frontalis/study/portrait.hpp"

#include <CLI/CLI.hpp>

#include <optional>
#include <string>

namespace frontalis
{

struct MovieOptions
{
  std::string path;  ///< empty: no movie
  PortraitView view;
};

/// Declares --movie, --view and --picture-height.
void add_movie_options(CLI::App& command, MovieOptions& options);
/// Declares --view and --picture-height, which are refused without the option `pictures`.
void add_view_options(CLI::App& command, CLI::Option* pictures, PortraitView& view);

/// Draws the frames of a motion, without a display, and joins them to an animated GIF.
class Movie
{
public:
  /// `options.path`: a file that ends in .gif, or a folder that receives frame_NNNN.png. The model must outlive this
  /// object. Throws Error if the folder of the frames cannot be made, or ImageMagick, which joins them, is missing.
  Movie(const MovieOptions& options, double frame_rate, const Model& model);

  /// Draws an image of the skin, which is in the coordinates of the face frame. The first call must show the face at
  /// rest.
  void add(const SkinState& skin, const Controls& controls);
  /// If `path` is a GIF, joins the frames to it and removes their folder. Throws Error if that fails.
  void finish();

private:
  std::string path_, folder_;
  double frame_rate_;
  const Model& model_;
  PortraitView view_;
  std::optional<Portrait> portrait_{};
  int frames_ = 0;
};

}  // namespace frontalis
