#include "frontalis/ros/shading.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{

namespace
{

using Vector = std::array<float, 3>;

float dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vector unit(const Vector& a)
{
  const float length = std::sqrt(dot(a, a));
  return { { a[0] / length, a[1] / length, a[2] / length } };
}

/// Lambert's cosine, extended into the shadow by w to imitate light that scatters below the skin; 0: plain Lambert.
float wrapped(float cosine, float w) { return std::max(0.0f, (cosine + w) / (1 + w)); }

// directions in the face frame: x out of the face, y to its left, z up
const Vector key_light = unit({ { 0.52f, 0.40f, 0.76f } });
const Vector fill_light = unit({ { 0.55f, -0.80f, 0.05f } });
const Vector view = { { 1, 0, 0 } };
const Vector half_way = unit({ { key_light[0] + 1, key_light[1], key_light[2] } });

const Vector wrap = { { 0.30f, 0.16f, 0.10f } };  // extension of light into the shadow by scattering; red goes farthest
const Vector key_colour = { { 1.06f, 1.00f, 0.93f } };
const Vector fill_colour = { { 0.16f, 0.19f, 0.24f } };
const Vector sky_colour = { { 0.12f, 0.13f, 0.15f } };
constexpr float gamma = 2.2f;            // of displays
constexpr int smoothing_passes = 3;      // means over neighbours that hide the kinks of a bound skin at faces of voxels
constexpr float hollow_depth = 5.0e-3f;  // fraction of light that a hollow loses, per mean curvature [m]

/// The share of a display's full signal that shows a fraction of its light, from 0 to 1. The power of 1 / gamma takes
/// as long as all else of a colour; it comes from a table over the square root, of which it is nearly linear.
float display_value(float light)
{
  constexpr std::size_t parts = 256;
  static const auto table = []
  {
    std::array<float, parts + 2> values{};
    for (std::size_t i = 0; i < values.size(); ++i)
    {
      const float root = static_cast<float>(i) / static_cast<float>(parts);
      values[i] = std::pow(root * root, 1 / gamma);
    }
    return values;
  }();
  const float at = static_cast<float>(parts) * std::sqrt(light);
  const auto entry = static_cast<std::size_t>(at);
  return table[entry] + (at - static_cast<float>(entry)) * (table[entry + 1] - table[entry]);
}

}  // namespace

std::array<float, 3> false_colour(float value)
{
  static constexpr std::array<Vector, 4> knots{ { { { 0.10f, 0.14f, 0.50f } },
                                                  { { 0.10f, 0.52f, 0.46f } },
                                                  { { 0.85f, 0.74f, 0.16f } },
                                                  { { 0.75f, 0.10f, 0.07f } } } };
  // This order of the arguments turns a value that is no number into 0: such a value has no knot below it.
  const float at = 3 * std::min(1.0f, std::max(0.0f, value));
  const auto knot = std::min<std::size_t>(2, static_cast<std::size_t>(at));
  const float share = at - static_cast<float>(knot);
  Vector out{};
  for (std::size_t channel = 0; channel < 3; ++channel)
    out[channel] = (1 - share) * knots[knot][channel] + share * knots[knot + 1][channel];
  return out;
}

SkinShading::SkinShading(const TriangleMesh& mesh, const std::vector<Vector>& natural) : albedo_(natural)
{
  for (Vector& colour : albedo_)
    for (float& channel : colour)
      channel = std::pow(channel, gamma);
  std::vector<std::vector<std::int32_t>> neighbours(mesh.vertices.size());
  for (const auto& triangle : mesh.triangles)
    for (int corner = 0; corner < 3; ++corner)
    {
      auto& list = neighbours[triangle[corner]];
      list.push_back(triangle[(corner + 1) % 3]);
      list.push_back(triangle[(corner + 2) % 3]);
    }
  neighbour_begin_.push_back(0);
  for (auto& list : neighbours)
  {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    neighbours_.insert(neighbours_.end(), list.begin(), list.end());
    neighbour_begin_.push_back(static_cast<std::int32_t>(neighbours_.size()));
  }
}

std::vector<float> SkinShading::curvatures(const SkinState& skin) const
{
  std::vector<float> out(skin.vertices.size(), 0.0f);
  for (std::size_t vertex = 0; vertex < out.size(); ++vertex)
  {
    const Vector& position = skin.vertices[vertex];
    const auto begin = neighbour_begin_[vertex], end = neighbour_begin_[vertex + 1];
    for (auto entry = begin; entry < end; ++entry)
    {
      const Vector& other = skin.vertices[neighbours_[entry]];
      const Vector edge = { { other[0] - position[0], other[1] - position[1], other[2] - position[2] } };
      out[vertex] += 2 * dot(edge, skin.normals[vertex]) / std::max(dot(edge, edge), 1e-8f);
    }
    out[vertex] /= static_cast<float>(std::max(1, end - begin));
  }
  return out;
}

void SkinShading::colours(const SkinState& skin, const std::vector<float>& values,
                          std::vector<std::array<float, 3>>& out) const
{
  out.resize(skin.vertices.size());
  std::vector<float> curvature = curvatures(skin), rough;
  for (int pass = 0; pass < smoothing_passes; ++pass)
  {
    rough.swap(curvature);
    curvature.resize(rough.size());
    for (std::size_t vertex = 0; vertex < rough.size(); ++vertex)
    {
      float sum = rough[vertex];
      const auto begin = neighbour_begin_[vertex], end = neighbour_begin_[vertex + 1];
      for (auto entry = begin; entry < end; ++entry)
        sum += rough[neighbours_[entry]];
      curvature[vertex] = sum / static_cast<float>(1 + end - begin);
    }
  }
  for (std::size_t vertex = 0; vertex < skin.vertices.size(); ++vertex)
  {
    const Vector& normal = skin.normals[vertex];
    const float openness = std::clamp(1 - hollow_depth * curvature[vertex], 0.45f, 1.12f);

    const float key = dot(normal, key_light), fill = dot(normal, fill_light), sky = 0.5f + 0.5f * normal[2];
    const float shine = std::max(0.0f, dot(normal, half_way)), shine_2 = shine * shine, shine_4 = shine_2 * shine_2;
    const float highlight = 0.10f * shine_2 * shine_4 * shine_4 * shine_4 * shine_4 * shine_4;
    const float turned = 1 - std::clamp(dot(normal, view), 0.0f, 1.0f), rim = 0.10f * turned * turned * turned;
    const Vector surface = values.empty() ? albedo_[vertex] : false_colour(values[vertex]);
    for (int channel = 0; channel < 3; ++channel)
    {
      const float light = key_colour[channel] * wrapped(key, wrap[channel]) +
                          fill_colour[channel] * wrapped(fill, wrap[channel]) + sky_colour[channel] * sky;
      const float linear = openness * (surface[channel] * light + highlight + rim * sky_colour[channel]);
      // This order of the arguments makes 0 of a value that is no number.
      out[vertex][channel] = display_value(std::min(1.0f, std::max(0.0f, linear)));
    }
  }
}

std::vector<std::array<float, 3>> lit(const RenderMesh& mesh)
{
  SkinState state;
  state.normals = normals_of(mesh);
  state.vertices = mesh.vertices;
  TriangleMesh surface;
  surface.triangles = mesh.triangles;
  surface.vertices.resize(mesh.vertices.size());
  std::vector<std::array<float, 3>> out;
  SkinShading(surface, mesh.colours).colours(state, {}, out);
  return out;
}

}  // namespace frontalis
