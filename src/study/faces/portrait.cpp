#include "frontalis/study/portrait.hpp"

#include "frontalis/model/body_shape.hpp"
#include "frontalis/physics/number.hpp"
#include "frontalis/study/plot.hpp"
#include "frontalis/study/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>

namespace frontalis
{
namespace
{

constexpr int samples = 2;       // number of samples per pixel along each axis
constexpr double distance = 5;   // distance of the camera, so large that the projection is nearly parallel [m]
constexpr double margin = 1.08;  // size of the picture divided by that of the skin at rest

}  // namespace

const std::vector<std::pair<std::string, double>>& PortraitView::azimuths()
{
  static const std::vector<std::pair<std::string, double>> all{
    { "front", 0 }, { "oblique", PortraitView().azimuth }, { "left", physics::pi / 2 }, { "right", -physics::pi / 2 }
  };
  return all;
}

Portrait::Portrait(const Model& model, const SkinState& rest, const PortraitView& view)
    : view_(view), appearance_(model, rest)
{
  const double forward = std::cos(view.azimuth), left = std::sin(view.azimuth);  // towards the camera
  // corners of the picture, to the right and upwards [m]: it holds the skin, and the rest of the head without the neck
  std::array<double, 2> low{ 1, 1 }, high{ -1, -1 };
  const auto hold = [&](double x, double y, double z)
  {
    const double across = y * forward - x * left;
    low = { std::min(low[0], across), std::min(low[1], z) };
    high = { std::max(high[0], across), std::max(high[1], z) };
  };
  for (const auto& v : rest.vertices)
    hold(v[0], v[1], v[2]);
  for (const BodyShape& shape : body_shapes(model))
    if (shape.only_shown)
      for (const auto& v : shape.surface->vertices)
      {
        const auto [x, y, z] = model.to_face(v);
        hold(x, y, std::max(z, low[1]));
      }
  const double aside = 0.5 * (low[0] + high[0]);
  const std::array<double, 3> middle{ -aside * left, aside * forward, 0.5 * (low[1] + high[1]) - 4e-3 };
  const double pixel = margin * std::max((high[0] - low[0]) / view.width(), (high[1] - low[1]) / view.height);
  camera_ = camera_with(view.width(), view.height, 2 * std::atan(0.5 * view.width() * pixel / distance));
  camera_.to_camera = look_at({ middle[0] + distance * forward, middle[1] + distance * left, middle[2] }, middle);
}

std::vector<std::uint8_t> Portrait::draw(const SkinState& skin, const Controls& controls) const
{
  const Images images = Renderer(appearance_.scene(skin, controls), camera_).images({}, samples);
  std::vector<std::uint8_t> picture(3 * images.colour.size());
  std::memcpy(picture.data(), images.colour.data(), picture.size());
  return picture;
}

void write_contact_sheet(const std::vector<std::pair<std::string, std::vector<std::uint8_t>>>& portraits,
                         const PortraitView& view, int columns, const std::string& path)
{
  const int width = view.width(), height = view.height;
  constexpr int title = 22;  // height of a title [pixels]
  const int count = static_cast<int>(portraits.size());
  columns = std::min(columns, count);
  const int rows = (count + columns - 1) / columns;
  const int wide = columns * width, high = rows * (height + title);
  std::string pixels(std::size_t(wide) * std::size_t(high) * 3, '\xff'), labels;
  for (int p = 0; p < count; ++p)
  {
    const int left = p % columns * width, top = p / columns * (height + title);
    for (int row = 0; row < height; ++row)
      std::copy_n(portraits[p].second.begin() + std::ptrdiff_t{ row } * width * 3, width * 3,
                  pixels.begin() + ((std::ptrdiff_t{ top } + title + row) * wide + left) * 3);
    labels += fmt::format("set label '{}' at {},{} center font ',12' front\n", portraits[p].first, left + width / 2,
                          high - top - title / 2);
  }
  const std::string raw = path + ".rgb";
  write_text(raw, pixels);
  run_gnuplot(fmt::format("set terminal pngcairo noenhanced size {0},{1} font 'sans,12' background '#ffffff'\n"
                          "set output {2}\nset margins 0,0,0,0\nunset border\nunset tics\nunset key\n"
                          "set xrange [-0.5:{0}-0.5]\nset yrange [-0.5:{1}-0.5]\n{3}"
                          "plot {4} binary array=({0},{1}) flipy format='%uchar' using 1:2:3 with rgbimage\n",
                          wide, high, gnuplot_string(path + ".png"), labels, gnuplot_string(raw)),
              path);
  std::filesystem::remove(raw);
}

}  // namespace frontalis
