#include "cli/movie.hpp"

#include "cli/command.hpp"

#include "frontalis/error.hpp"
#include "frontalis/render/png.hpp"
#include "frontalis/study/table.hpp"

#include <fmt/core.h>

#include <sys/wait.h>

#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <map>

namespace frontalis
{
namespace
{

constexpr const char* frame_names = R"(frame_[0-9]{4,}\.png)";

// Quotes a text as one word of a shell command.
std::string shell_word(const std::string& text)
{
  std::string out = "'";
  for (const char c : text)
    out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace

void add_view_options(CLI::App& command, CLI::Option* pictures, PortraitView& view)
{
  const std::map<std::string, double> azimuths(PortraitView::azimuths().begin(), PortraitView::azimuths().end());
  command
      .add_option_function<std::string>(
          "--view", [&view, azimuths](const std::string& name) { view.azimuth = azimuths.at(name); },
          "from where pictures show the face (oblique); in 'front' the subject's left is at the right")
      ->check(CLI::IsMember(azimuths))
      ->needs(pictures);
  command.add_option("--picture-height", view.height, fmt::format("height of pictures in pixels ({})", view.height))
      ->check(CLI::Range(64, 4096))
      ->needs(pictures);
}

void add_movie_options(CLI::App& command, MovieOptions& options)
{
  CLI::Option* const movie =
      command.add_option("--movie", options.path,
                         "FILE.gif, drawn without a display and joined by ImageMagick, or a folder for frame_NNNN.png");
  add_view_options(command, movie, options.view);
}

Movie::Movie(const MovieOptions& options, double frame_rate, const Model& model)
    : path_(options.path), folder_(path_), frame_rate_(frame_rate), model_(model), view_(options.view)
{
  if (std::filesystem::path(path_).extension() == ".gif")
  {
    // GIF counts hundredths of a second per frame.
    if (const double hundredths = 100 / frame_rate; std::abs(hundredths - std::round(hundredths)) > 1e-6)
      throw Error(
          fmt::format("--movie {}: a GIF cannot have {:g} frames per second; give a --frame-rate that divides "
                      "100, such as 20, 25 or 50, or a folder for the frames",
                      path_, frame_rate));
    if (std::system("command -v convert >/dev/null 2>&1") != 0)
      throw Error(
          "--movie " + path_ +
          ": ImageMagick's program convert is missing (Debian's package imagemagick); a folder takes the frames");
    folder_ += ".frames";
  }
  else if (std::filesystem::path(path_).has_extension() && !std::filesystem::is_directory(path_))
    throw Error("--movie " + path_ + ": only NAME.gif or a folder is written; a folder's name has no extension");
  make_folder(folder_);
  remove_files(folder_, frame_names);
}

void Movie::add(const SkinState& skin, const Controls& controls)
{
  if (!portrait_)
    portrait_.emplace(model_, skin, view_);
  write_text(fmt::format("{}/frame_{:04}.png", folder_, frames_++),
             png_of(portrait_->draw(skin, controls).data(), view_.width(), view_.height, 3));
}

void Movie::finish()
{
  if (folder_ == path_)
    return;
  // All frames have one palette without dithering, and colours that differ by at most 2 % count as equal, so that each
  // frame stores only what has moved.
  const std::string partial = path_ + ".partial";
  const std::string command =
      fmt::format("convert -delay {} -loop 0 {}/frame_*.png +dither -colors 128 +map -fuzz 2% -layers optimize gif:{}",
                  std::lround(100 / frame_rate_), shell_word(folder_), shell_word(partial));
  const int status = std::system(command.c_str());
  std::error_code fault;
  if (status == 0)
    std::filesystem::rename(partial, path_, fault);
  if (status != 0 || fault)
  {
    std::error_code ignored;
    std::filesystem::remove(partial, ignored);
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGINT)
      throw Interrupted();
    throw Error(path_ + ": cannot be written by: " + command + "; its frames are in " + folder_);
  }
  remove_files(folder_, frame_names);
  std::error_code not_empty;
  std::filesystem::remove(folder_, not_empty);
}

}  // namespace frontalis
