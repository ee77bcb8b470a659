#include "frontalis/study/portrait.hpp"

#include "frontalis/model/body_shape.hpp"
#include "frontalis/runner/named_controls.hpp"
#include "frontalis/study/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

namespace frontalis
{
namespace
{

using Vector = std::array<double, 3>;

constexpr int finer = 2;          // samples per pixel along each axis
constexpr double azimuth = 0.28;  // [rad] of the view, from straight ahead to the subject's left
constexpr double eye_radius = 12e-3, iris = 0.49, pupil = 0.19;  // [m], and radii over that of the eyeball
constexpr double brow_width = 3.2e-3;
const Vector skin_colour{ 0.87, 0.66, 0.55 }, lip_colour{ 0.74, 0.39, 0.37 }, brow_colour{ 0.27, 0.18, 0.13 },
    inside_colour{ 0.25, 0.09, 0.08 }, body_colour{ 0.93, 0.91, 0.84 };

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector blend(const Vector& a, const Vector& b, double share)
{
  return { a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]), a[2] + share * (b[2] - a[2]) };
}
Vector unit(const Vector& v)
{
  const double length = std::sqrt(dot(v, v));
  return length > 0 ? Vector{ v[0] / length, v[1] / length, v[2] / length } : v;
}

// axes of the picture in the face frame: right, down and towards the viewer
const Vector right{ -std::sin(azimuth), std::cos(azimuth), 0 }, down{ 0, 0, -1 },
    towards{ std::cos(azimuth), std::sin(azimuth), 0 };

Vector shaded(const Vector& colour, const Vector& normal)
{
  static const Vector key = unit({ 1, -0.7, 0.9 }), fill = unit({ 0.7, 1, 0.1 });
  const double facing = dot(normal, key);
  const double light = 0.24 + 0.66 * std::max(facing, 0.0) + 0.2 * std::max(dot(normal, fill), 0.0);
  const double shine = 0.12 * std::pow(std::max(dot(normal, unit(blend(key, towards, 0.5))), 0.0), 24);
  Vector out{};
  for (std::size_t c = 0; c < 3; ++c)
    out[c] = colour[c] * light + shine;
  return out;
}

const std::array<float, 3>* find(const Model& model, const SkinState& skin, const std::string& landmark)
{
  const auto found = std::find(model.landmarks.begin(), model.landmarks.end(), landmark);
  return found == model.landmarks.end() ? nullptr : &skin.landmarks[found - model.landmarks.begin()];
}

// distance from a polyline, seen from the front [m]
double distance_from_line(const std::array<float, 3>& p, const std::vector<const std::array<float, 3>*>& line)
{
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < line.size(); ++i)
  {
    if (line[i] == nullptr || line[i + 1] == nullptr)
      return least;
    const auto &a = *line[i], &b = *line[i + 1];
    const double along[2] = { double(b[1]) - a[1], double(b[2]) - a[2] },
                 from[2] = { double(p[1]) - a[1], double(p[2]) - a[2] };
    const double t =
        std::clamp((along[0] * from[0] + along[1] * from[1]) / (along[0] * along[0] + along[1] * along[1]), 0.0, 1.0);
    least = std::min(least, std::hypot(from[0] - t * along[0], from[1] - t * along[1]));
  }
  return least;
}

}  // namespace

struct Portrait::Canvas
{
  std::vector<Vector> colour = std::vector<Vector>(std::size_t{ finer } * width * finer * height, { 1, 1, 1 });
  std::vector<double> depth = std::vector<double>(colour.size(), -std::numeric_limits<double>::infinity());

  void put(int column, int row, double at, const Vector& what)
  {
    const std::size_t place = std::size_t(row) * finer * width + std::size_t(column);
    if (column < 0 || row < 0 || column >= finer * width || row >= finer * height || at <= depth[place])
      return;
    depth[place] = at;
    colour[place] = what;
  }
};

Portrait::Portrait(const Model& model, const SkinState& rest) : model_(model)
{
  std::array<double, 2> low{ 1, 1 }, high{ -1, -1 };
  for (const auto& v : rest.vertices)
    for (std::size_t axis = 0; axis < 2; ++axis)
    {
      low[axis] = std::min(low[axis], double(v[axis + 1]));
      high[axis] = std::max(high[axis], double(v[axis + 1]));
    }
  middle_ = { 0, 0, 0.5 * (low[1] + high[1]) - 4e-3 };
  pixel_ = 1.08 * std::max((high[0] - low[0]) / (finer * width), (high[1] - low[1]) / (finer * height));
  const auto *upper = find(model, rest, "upper_lip"), *lower = find(model, rest, "lower_lip"),
             *corner = find(model, rest, "mouth_corner_left"), *chin = find(model, rest, "chin");
  const bool mouth = upper && lower && corner && chin;
  if (mouth)
  {
    mouth_radius_ = double((*corner)[2]) - (*chin)[2];
    mouth_ = { double((*corner)[0]) - mouth_radius_ - 6e-3, 0, (*corner)[2] };
  }
  colours_.assign(rest.vertices.size(), skin_colour);
  for (std::size_t v = 0; v < colours_.size(); ++v)
  {
    const auto& p = rest.vertices[v];
    if (mouth && p[0] > (*corner)[0] - 2e-3 && std::abs(p[1]) < (*corner)[1])
    {
      const double bow = 1 - std::pow(p[1] / (*corner)[1], 2), from_corner = double(p[2]) - (*corner)[2];
      const double reach = bow * ((from_corner > 0 ? (*upper)[2] : (*lower)[2]) - double((*corner)[2]));
      const double inside = (std::abs(reach) - std::abs(from_corner)) / 1.5e-3;
      colours_[v] = blend(skin_colour, lip_colour, std::clamp(inside + 0.5, 0.0, 1.0));
    }
    for (const std::string side : { "_left", "_right" })
    {
      const double away =
          distance_from_line(p, { find(model, rest, "brow_medial" + side), find(model, rest, "brow_mid" + side),
                                  find(model, rest, "brow" + side) });
      colours_[v] = blend(colours_[v], brow_colour, 0.85 * std::clamp(1.5 * (1 - away / brow_width), 0.0, 1.0));
    }
  }
}

void Portrait::draw_mesh(Canvas& canvas, const std::vector<std::array<float, 3>>& vertices,
                         const std::vector<std::array<std::int32_t, 3>>& triangles,
                         const std::vector<Vector>& colours) const
{
  std::vector<Vector> seen(vertices.size()), normal(vertices.size());
  for (std::size_t v = 0; v < vertices.size(); ++v)
  {
    const Vector from{ vertices[v][0] - middle_[0], vertices[v][1] - middle_[1], vertices[v][2] - middle_[2] };
    seen[v] = { dot(from, right) / pixel_ + 0.5 * finer * width, dot(from, down) / pixel_ + 0.5 * finer * height,
                dot(from, towards) };
  }
  for (const auto& t : triangles)
  {
    Vector a{}, b{};
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      a[axis] = double(vertices[t[1]][axis]) - vertices[t[0]][axis];
      b[axis] = double(vertices[t[2]][axis]) - vertices[t[0]][axis];
    }
    const Vector area{ a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0] };
    for (const std::int32_t corner : t)
      for (std::size_t axis = 0; axis < 3; ++axis)
        normal[corner][axis] += area[axis];
  }
  for (const auto& t : triangles)
  {
    const Vector &a = seen[t[0]], &b = seen[t[1]], &c = seen[t[2]];
    const double twice = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    if (std::abs(twice) < 1e-9)
      continue;
    const auto range = [&](std::size_t axis)
    {
      return std::pair{ static_cast<int>(std::ceil(std::min({ a[axis], b[axis], c[axis] }))),
                        static_cast<int>(std::floor(std::max({ a[axis], b[axis], c[axis] }))) };
    };
    const auto [first_row, last_row] = range(1);
    const auto [first_column, last_column] = range(0);
    for (int row = first_row; row <= last_row; ++row)
      for (int column = first_column; column <= last_column; ++column)
      {
        const double v = ((column - a[0]) * (c[1] - a[1]) - (row - a[1]) * (c[0] - a[0])) / twice;
        const double w = ((b[0] - a[0]) * (row - a[1]) - (b[1] - a[1]) * (column - a[0])) / twice;
        if (v < 0 || w < 0 || v + w > 1)
          continue;
        const double u = 1 - v - w;
        Vector facing{}, colour{};
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
          facing[axis] = u * normal[t[0]][axis] + v * normal[t[1]][axis] + w * normal[t[2]][axis];
          colour[axis] = u * colours[t[0]][axis] + v * colours[t[1]][axis] + w * colours[t[2]][axis];
        }
        facing = unit(facing);
        const bool front = dot(facing, towards) > 0;
        canvas.put(column, row, u * a[2] + v * b[2] + w * c[2], front ? shaded(colour, facing) : inside_colour);
      }
  }
}

void Portrait::draw_ball(Canvas& canvas, const Vector& centre, double radius, const RigidTransform* eye) const
{
  const Vector from{ centre[0] - middle_[0], centre[1] - middle_[1], centre[2] - middle_[2] };
  const double column = dot(from, right) / pixel_ + 0.5 * finer * width,
               row = dot(from, down) / pixel_ + 0.5 * finer * height;
  const int reach = static_cast<int>(std::ceil(radius / pixel_));
  for (int y = -reach; y <= reach; ++y)
    for (int x = -reach; x <= reach; ++x)
    {
      const int at_x = static_cast<int>(std::lround(column)) + x, at_y = static_cast<int>(std::lround(row)) + y;
      const double u = (at_x - column) * pixel_ / radius, v = (at_y - row) * pixel_ / radius, w = 1 - u * u - v * v;
      if (w < 0)
        continue;
      Vector normal{};
      for (std::size_t axis = 0; axis < 3; ++axis)
        normal[axis] = u * right[axis] + v * down[axis] + std::sqrt(w) * towards[axis];
      Vector colour = inside_colour;
      if (eye != nullptr)
      {
        const double from_axis = std::acos(std::clamp(dot(normal, eye->turned(Vector{ 1, 0, 0 })), -1.0, 1.0));
        colour = from_axis < std::asin(pupil)  ? Vector{ 0.03, 0.03, 0.03 }
                 : from_axis < std::asin(iris) ? Vector{ 0.34, 0.25, 0.17 }
                                               : Vector{ 0.92, 0.9, 0.87 };
        colour = shaded(colour, normal);
      }
      canvas.put(at_x, at_y, dot(from, towards) + radius * std::sqrt(w), colour);
    }
}

std::vector<std::uint8_t> Portrait::draw(const SkinState& skin, const Controls& controls) const
{
  Canvas canvas;
  draw_mesh(canvas, skin.vertices, model_.skin.triangles, colours_);
  if (mouth_radius_ > 0)
    draw_ball(canvas, mouth_, mouth_radius_, nullptr);
  std::vector<bool> drawn(model_.bones.size(), false);
  for (const Model::Expression& unit : model_.action_units)
    for (const Model::BonePose& pose : unit.bones)
      if (model_.bones[pose.bone].compare(0, 3, "eye") == 0 && !drawn[pose.bone])
      {
        const RigidTransform motion = motion_in_face(model_, controls.bone[pose.bone]);
        draw_ball(canvas, motion(pose.centre), eye_radius, &motion);
        // what is seen of the socket at the corners of the eye
        draw_ball(canvas, { pose.centre[0] - 6e-3, pose.centre[1], pose.centre[2] }, 15e-3, nullptr);
        drawn[pose.bone] = true;
      }
  const std::vector<BodyShape> bodies = body_shapes(model_);
  for (std::size_t b = 0; b < bodies.size() && b < model_.contacts.size(); ++b)
  {
    const std::int32_t bone = model_.contacts[b].bone;
    if (bodies[b].surface == nullptr || (bone >= 0 && drawn[bone]))
      continue;
    std::vector<std::array<float, 3>> vertices;
    vertices.reserve(bodies[b].surface->vertices.size());
    for (const auto& p : bodies[b].surface->vertices)
    {
      const Vector now = model_.to_face(bone < 0 ? p : controls.bone[bone](p));
      vertices.push_back({ static_cast<float>(now[0]), static_cast<float>(now[1]), static_cast<float>(now[2]) });
    }
    draw_mesh(canvas, vertices, bodies[b].surface->triangles, std::vector<Vector>(vertices.size(), body_colour));
  }
  std::vector<std::uint8_t> picture(std::size_t{ width } * height * 3);
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column)
      for (std::size_t c = 0; c < 3; ++c)
      {
        double sum = 0;
        for (int y = 0; y < finer; ++y)
          for (int x = 0; x < finer; ++x)
            sum += std::clamp(
                canvas.colour[std::size_t(finer * row + y) * finer * width + std::size_t(finer * column + x)][c], 0.0,
                1.0);
        picture[(std::size_t(row) * width + std::size_t(column)) * 3 + c] =
            static_cast<std::uint8_t>(std::lround(255 * sum / (finer * finer)));
      }
  return picture;
}

void write_contact_sheet(const std::vector<std::pair<std::string, std::vector<std::uint8_t>>>& portraits, int columns,
                         const std::string& path)
{
  constexpr int title = 22;  // [pixels]
  const int count = static_cast<int>(portraits.size());
  columns = std::min(columns, count);
  const int rows = (count + columns - 1) / columns;
  const int wide = columns * Portrait::width, high = rows * (Portrait::height + title);
  std::string pixels(std::size_t(wide) * std::size_t(high) * 3, '\xff'), labels;
  for (int p = 0; p < count; ++p)
  {
    const int left = p % columns * Portrait::width, top = p / columns * (Portrait::height + title);
    for (int row = 0; row < Portrait::height; ++row)
      std::copy_n(portraits[p].second.begin() + std::ptrdiff_t{ row } * Portrait::width * 3, Portrait::width * 3,
                  pixels.begin() + ((std::ptrdiff_t{ top } + title + row) * wide + left) * 3);
    labels += fmt::format("set label '{}' at {},{} center font ',12' front\n", portraits[p].first,
                          left + Portrait::width / 2, high - top - title / 2);
  }
  const std::string raw = path + ".rgb";
  std::ofstream(raw, std::ios::binary) << pixels;
  run_gnuplot(fmt::format("set terminal pngcairo noenhanced size {0},{1} font 'sans,12' background '#ffffff'\n"
                          "set output '{2}.png'\nset margins 0,0,0,0\nunset border\nunset tics\nunset key\n"
                          "set xrange [0:{0}]\nset yrange [0:{1}]\n{3}"
                          "plot '{4}' binary array=({0},{1}) flipy format='%uchar' using 1:2:3 with rgbimage pixels\n",
                          wide, high, path, labels, raw),
              path);
  std::filesystem::remove(raw);
}

}  // namespace frontalis
