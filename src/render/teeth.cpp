#include "frontalis/render/face_appearance.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace frontalis
{
namespace
{

// A row of teeth, from the midline to one side: positions of the borders between teeth along the row, and heights of
// the cutting edges and of the gums' rim above the corners of the mouth [m]. They are estimates from the dimensions of
// teeth in textbooks: upper incisors reach 3.5 mm below the upper lip at rest, and the lower lip hides the lower ones.
struct Row
{
  std::array<double, 8> borders;
  double edge, rim;
};
constexpr Row upper_row{ { 0, 8.6e-3, 15.2e-3, 23e-3, 30e-3, 36.8e-3, 47e-3, 57e-3 }, -2.5e-3, 9.3e-3 };
constexpr Row lower_row{ { 0, 5.4e-3, 11.3e-3, 18.2e-3, 25.2e-3, 32.3e-3, 43.3e-3, 54e-3 }, -1.2e-3, -10.2e-3 };
constexpr double overjet = 3e-3;    // [m] by which the lower row is behind the surface on which the lower lip rests
constexpr double papilla = 1.8e-3;  // [m] by which the gums reach farther between two teeth
constexpr double groove = 0.6e-3;   // [m] beside the border of two teeth within which a tooth gets darker
constexpr float shade = 0.6F;       // brightness of the border itself
constexpr double arch_depth = 0.7;  // depth of the arch divided by half of its width
// Front teeth are thinner than the body: behind their edges, which have this thickness, it is cut off at a slope.
// Molars are flat.
constexpr double edge_thickness = 3e-3;  // [m]
constexpr double edge_slope = 1.2;
constexpr double deepest_cut = 6e-3;  // [m]
// A body may fill the arch. What lies farther inwards than teeth are wide is palate or floor of the mouth.
constexpr double incisor_width = 5e-3, molar_width = 10e-3;  // [m] from lip or cheek inwards

// Splits each edge of a mesh in two, so that colours of vertices can show details that are smaller than its triangles.
void halve(RenderMesh& mesh)
{
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> known;
  const auto middle = [&](std::int32_t a, std::int32_t b)
  {
    const auto [found, is_new] = known.try_emplace(std::minmax(a, b), static_cast<std::int32_t>(mesh.vertices.size()));
    if (is_new)
    {
      const auto p = mesh.vertices[static_cast<std::size_t>(a)], q = mesh.vertices[static_cast<std::size_t>(b)];
      mesh.vertices.push_back({ (p[0] + q[0]) / 2, (p[1] + q[1]) / 2, (p[2] + q[2]) / 2 });
    }
    return found->second;
  };
  std::vector<std::array<std::int32_t, 3>> finer;
  finer.reserve(4 * mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles)
  {
    const std::int32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    finer.insert(finer.end(), { { a, ab, ca }, { ab, b, bc }, { ca, bc, c }, { ab, bc, ca } });
  }
  mesh.triangles = std::move(finer);
}

// Makes vertices at the same place one vertex, and leaves out triangles that have lost their area by that.
void weld(RenderMesh& mesh)
{
  std::map<std::array<float, 3>, std::int32_t> known;
  std::vector<std::int32_t> number;
  RenderMesh out;
  number.reserve(mesh.vertices.size());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
  {
    const auto [found, is_new] = known.try_emplace(mesh.vertices[v], static_cast<std::int32_t>(out.vertices.size()));
    number.push_back(found->second);
    if (!is_new)
      continue;
    out.vertices.push_back(mesh.vertices[v]);
    out.colours.push_back(mesh.colours[v]);
    out.labels.push_back(mesh.labels[v]);
  }
  for (const auto& t : mesh.triangles)
  {
    const auto of = [&](std::size_t corner) { return number[static_cast<std::size_t>(t[corner])]; };
    if (of(0) != of(1) && of(1) != of(2) && of(2) != of(0))
      out.triangles.push_back({ of(0), of(1), of(2) });
  }
  mesh = std::move(out);
}

}  // namespace

RenderMesh painted_teeth(const TriangleMesh& surface, bool lower, double corner_height)
{
  RenderMesh mesh;
  mesh.triangles = surface.triangles;
  double half_width = 0, front = -1;
  mesh.vertices.reserve(surface.vertices.size());
  for (const auto& p : surface.vertices)
  {
    mesh.vertices.push_back({ static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]) });
    half_width = std::max(half_width, std::abs(p[1]));
    front = std::max(front, p[0]);
  }
  halve(mesh);
  const Row& row = lower ? lower_row : upper_row;
  const double up = lower ? -1 : 1, depth = arch_depth * half_width;
  mesh.colours.reserve(mesh.vertices.size());
  mesh.labels.reserve(mesh.vertices.size());
  for (auto& p : mesh.vertices)
  {
    // Arc length from the front of an elliptic arch, to first order in the difference of its semi-axes.
    const double angle = std::atan2(std::abs(p[1]) / half_width, (p[0] - front + depth) / depth);
    const double along = (half_width + depth) / 2 * angle + (half_width - depth) / 4 * std::sin(2 * angle);
    const auto next = std::upper_bound(row.borders.begin() + 1, row.borders.end() - 1, along);
    const double width = *next - *(next - 1), from_border = std::min(along - *(next - 1), *next - along);
    const double aside = std::clamp(1 - 2 * from_border / width, 0.0, 1.0);  // 0 in the middle of the tooth
    // The body ends with the teeth.
    const double inwards = half_width - std::hypot(p[1], (p[0] - front + depth) / arch_depth);
    const double cut = edge_slope * std::max(0.0, inwards - edge_thickness) * std::pow(std::cos(angle), 2);
    const double tooth_width = molar_width + (incisor_width - molar_width) * std::pow(std::cos(angle), 2);
    const double edge = up * row.edge + 0.6e-3 * std::pow(aside, 4) + std::min(deepest_cut, cut);
    const double height = std::max(edge, up * (p[2] - corner_height));
    p[2] = static_cast<float>(corner_height + up * height);
    if (lower)
      p[0] -= static_cast<float>(overjet);
    const bool is_gum = height > up * row.rim - papilla * aside * aside || inwards > tooth_width;
    const double light = is_gum ? 1 : shade + (1 - shade) * std::clamp(from_border / groove, 0.0, 1.0);
    std::array<float, 3> colour = is_gum ? gum_colour : teeth_colour;
    for (float& c : colour)
      c *= static_cast<float>(light);
    mesh.colours.push_back(colour);
    mesh.labels.push_back(body_label);
  }
  // What lay beyond the edges is now on them.
  weld(mesh);
  return mesh;
}

}  // namespace frontalis
