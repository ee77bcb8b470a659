#include "cuda/bench/shell_model.hpp"

#include "frontalis/model/sample_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace frontalis
{
namespace
{

using Point = physics::Vec3<double>;

// Semi-axes of the outer ellipsoid (up, lateral, outwards), and the part of the ellipsoid that is used [m].
constexpr double axes[3] = { 130e-3, 78e-3, 92e-3 };
constexpr double height = 48e-3;                          // the part extends from -height to height
constexpr double half_width = 66e-3;                      // lateral
constexpr double sheet_from = 3.0e-3, sheet_to = 4.2e-3;  // depth of the muscles' sheet

double thickness(double up) { return 5.5e-3 + 1.2e-3 * std::exp(-std::pow((up + height) / 20e-3, 2)); }

// Depth below the outer surface, to first order [m].
double depth(const Point& p)
{
  const double q = std::sqrt(std::pow(p.x / axes[0], 2) + std::pow(p.y / axes[1], 2) + std::pow(p.z / axes[2], 2));
  const double gx = p.x / (axes[0] * axes[0]), gy = p.y / (axes[1] * axes[1]), gz = p.z / (axes[2] * axes[2]);
  return (1 - q) * q / std::sqrt(gx * gx + gy * gy + gz * gz);
}

double overlap(double from, double to, double middle, double width)
{
  return std::clamp((std::min(to, middle + width / 2) - std::max(from, middle - width / 2)) / width, 0.0, 1.0);
}

double half_depth(double up, double lateral, double below)
{
  // Finds z of the point at that depth by bisection.
  double low = 10e-3, high = axes[2];
  for (int i = 0; i < 50; ++i)
  {
    const double z = 0.5 * (low + high);
    (depth({ up, lateral, z }) > below ? low : high) = z;
  }
  return 0.5 * (low + high);
}

// A sheet as a grid of triangles that face outwards, at a depth that may vary with height.
template <class Depth>
TriangleMesh sheet(double margin, double spacing, const Depth& at)
{
  TriangleMesh mesh;
  const int rows = static_cast<int>(std::ceil(2 * (height + margin) / spacing));
  const int columns = static_cast<int>(std::ceil(2 * (half_width + margin) / spacing));
  for (int i = 0; i <= rows; ++i)
    for (int j = 0; j <= columns; ++j)
    {
      const double up = -height - margin + 2 * (height + margin) * i / rows;
      const double lateral = -half_width - margin + 2 * (half_width + margin) * j / columns;
      mesh.vertices.push_back({ { up, lateral, half_depth(up, lateral, at(up)) } });
    }
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j)
    {
      const std::int32_t a = i * (columns + 1) + j, b = a + columns + 1;
      mesh.triangles.push_back({ { a, b, a + 1 } });
      mesh.triangles.push_back({ { b, b + 1, a + 1 } });
    }
  return mesh;
}

struct MuscleShape
{
  const char* name;
  double up, lateral;            // centre
  double half_up, half_lateral;  // extent
  double direction[2];           // up, lateral
};

constexpr MuscleShape muscle_shapes[] = {
  { "frontalis_left", -5e-3, 22e-3, 30e-3, 18e-3, { 1.0, 0.15 } },
  { "frontalis_right", -5e-3, -22e-3, 30e-3, 18e-3, { 1.0, -0.15 } },
  { "corrugator_left", -36e-3, 18e-3, 7e-3, 16e-3, { 0.35, 0.94 } },
  { "corrugator_right", -36e-3, -18e-3, 7e-3, 16e-3, { 0.35, -0.94 } },
  { "procerus", -38e-3, 0, 10e-3, 7e-3, { 1.0, 0.0 } },
};

Material material(const char* name, double young, double density)
{
  const double nu = 0.49;
  Material m;
  m.name = name;
  m.density = density;
  m.parameters[0] = young / (2 * (1 + nu));
  m.parameters[1] = young / (3 * (1 - 2 * nu));
  return m;
}

struct ShellBuilder
{
  const ShellSettings& s;
  Model model;
  Point origin{};  // origin of the local frame in the frame of the ellipsoid

  explicit ShellBuilder(const ShellSettings& settings) : s(settings)
  {
    const double h = s.voxel;
    model.spacing = { { h, h, h } };
    model.materials = { material("dermis", 81.4e3, s.density), material("hypodermis", 34e3, s.density),
                        material("muscle", 0.5e6, s.density), material("tendon", s.tendon ? 24e6 : 0.5e6, s.density) };
    for (const auto& shape : muscle_shapes)
    {
      Muscle muscle;
      muscle.name = shape.name;
      muscle.stress_reference = s.stress_reference;
      model.muscles.push_back(muscle);
    }
    model.damping = s.damping;
    const double lowest = half_depth(height, half_width, 8e-3) - 2 * h;
    origin = { -height, -half_width, std::floor(lowest / h) * h };
    model.size = { { static_cast<std::int32_t>(std::ceil(2 * height / h)),
                     static_cast<std::int32_t>(std::ceil(2 * half_width / h)),
                     static_cast<std::int32_t>(std::ceil((axes[2] - origin.z) / h)) } };
  }

  Point at(double i, double j, double k) const { return origin + s.voxel * Point{ i, j, k }; }

  void add_voxel(std::int32_t i, std::int32_t j, std::int32_t k)
  {
    const Point p = at(i + 0.5, j + 0.5, k + 0.5);
    const double d = depth(p);
    if (!(d > 0 && d < thickness(p.x)))
      return;
    model.voxels.push_back({ { i, j, k } });
    model.fill.push_back(1);
    const double in_sheet = overlap(sheet_from, sheet_to, d, s.voxel);
    double muscle = 0;
    for (std::size_t m = 0; m < model.muscles.size(); ++m)
    {
      const MuscleShape& shape = muscle_shapes[m];
      if (in_sheet <= 0 || std::abs(p.x - shape.up) > shape.half_up ||
          std::abs(p.y - shape.lateral) > shape.half_lateral)
        continue;
      // Removes the direction's component along the normal, so that it is along the sheet.
      Point normal{ p.x / (axes[0] * axes[0]), p.y / (axes[1] * axes[1]), p.z / (axes[2] * axes[2]) };
      normal = (1 / norm(normal)) * normal;
      Point a{ shape.direction[0], shape.direction[1], 0 };
      a = a - dot(a, normal) * normal;
      a = (1 / norm(a)) * a;
      model.fibre_muscle.push_back(static_cast<std::int16_t>(m));
      model.fibre_weight.push_back(static_cast<float>(in_sheet));
      model.fibre_direction.push_back(
          { { static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z) } });
      muscle = in_sheet;
    }
    const double tendon = muscle > 0 || p.x < 25e-3 ? 0 : in_sheet;
    const double dermis = std::min(overlap(0, 1.8e-3, d, s.voxel), 1 - muscle - tendon);
    const double parts[4] = { dermis, 1 - dermis - muscle - tendon, muscle, tendon };
    for (std::int16_t m = 0; m < 4; ++m)
      if (parts[m] > 1e-6)
      {
        model.mixture_material.push_back(m);
        model.mixture_proportion.push_back(static_cast<float>(parts[m]));
      }
    model.mixture_begin.push_back(static_cast<std::int32_t>(model.mixture_material.size()));
    model.fibre_begin.push_back(static_cast<std::int32_t>(model.fibre_muscle.size()));
  }

  void add_voxels()
  {
    model.mixture_begin.push_back(0);
    model.fibre_begin.push_back(0);
    for (std::int32_t k = 0; k < model.size[2]; ++k)
      for (std::int32_t j = 0; j < model.size[1]; ++j)
        for (std::int32_t i = 0; i < model.size[0]; ++i)
          add_voxel(i, j, k);
    build_nodes(model);
  }

  void to_local(TriangleMesh& mesh) const
  {
    for (auto& v : mesh.vertices)
      v = { { v[0] - origin.x, v[1] - origin.y, v[2] - origin.z } };
  }

  void add_constraints()
  {
    std::vector<std::int32_t> sliding;
    for (std::size_t n = 0; n < model.nodes.size(); ++n)
    {
      const auto& c = model.nodes[n];
      const Point p = at(c[0], c[1], c[2]);
      if (depth(p) < thickness(p.x) - 0.5 * s.voxel)
        continue;
      const auto node = static_cast<std::int32_t>(n);
      if (p.x > height - 6e-3 || std::abs(p.y) > half_width - 8e-3)
        model.rigid.push_back({ node, -1 });
      else
        sliding.push_back(node);
    }
    const auto above_bone = [this](const std::array<double, 3>& at_rest)
    {
      const Point p = origin + Point{ at_rest[0], at_rest[1], at_rest[2] };
      return thickness(p.x) + 1e-3 - depth(p);
    };
    slide_on(model, "bone", above_bone, sliding);
  }

  // Binds points to the nearest voxel straight below them.
  void bind(const std::vector<std::array<double, 3>>& points, Binding& binding) const
  {
    std::vector<std::int32_t> top(static_cast<std::size_t>(model.size[0]) * model.size[1], -1);
    for (std::size_t e = 0; e < model.voxels.size(); ++e)
      top[static_cast<std::size_t>(model.voxels[e][1]) * model.size[0] + model.voxels[e][0]] =
          static_cast<std::int32_t>(e);
    for (const auto& p : points)
    {
      std::int32_t cell[2];
      for (int axis = 0; axis < 2; ++axis)
        cell[axis] = std::clamp(static_cast<std::int32_t>(p[axis] / s.voxel), 0, model.size[axis] - 1);
      const auto voxel = top[static_cast<std::size_t>(cell[1]) * model.size[0] + cell[0]];
      binding.voxel.push_back(voxel);
      const auto& corner = model.voxels[voxel];
      std::array<float, 3> c{};
      for (int axis = 0; axis < 3; ++axis)
        c[axis] = static_cast<float>(p[axis] / s.voxel - corner[axis]);
      binding.coordinates.push_back(c);
    }
  }

  void add_skin()
  {
    model.skin = sheet(-2e-3, 1e-3, [](double) { return 0.0; });
    to_local(model.skin);
    bind(model.skin.vertices, model.skin_binding);
    for (const double side : { 1.0, -1.0 })
    {
      model.landmarks.push_back(side > 0 ? "brow_left" : "brow_right");
      const double up = -38e-3, lateral = side * 25e-3;
      model.landmark_positions.push_back(
          { { up - origin.x, lateral - origin.y, half_depth(up, lateral, 0) - origin.z } });
    }
    bind(model.landmark_positions, model.landmark_binding);
  }
};

}  // namespace

Model shell_model(const ShellSettings& settings)
{
  ShellBuilder builder(settings);
  builder.add_voxels();
  builder.add_constraints();
  builder.add_skin();
  return std::move(builder.model);
}

}  // namespace frontalis
