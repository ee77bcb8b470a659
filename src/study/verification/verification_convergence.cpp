// The order of convergence in the voxel edge, and the error of boundaries that are staircases of voxels.

#include "study/verification/verification_cases.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

// Relative root mean square error of displacements in a cube of n^3 voxels. Its surface is displaced by the gradient of
// a harmonic function, which solves Navier's equation for any Poisson's ratio.
double cube_error(int n, HourglassControl form)
{
  Model model = voxel_model({ { n, n, n } }, 1.0 / n, neo_hookean(1e5, 0.45));
  model.hourglass = form;
  const double a = 2, b = 1.5, c = std::hypot(a, b);
  const auto exact = [=](const Point& p) -> Point
  {
    const double x = a * p[0] + 0.3, y = b * p[1] + 0.5, z = c * (p[2] - 0.5);
    return { { -a * std::sin(x) * std::cos(y) * std::cosh(z), -b * std::cos(x) * std::sin(y) * std::cosh(z),
               c * std::cos(x) * std::cos(y) * std::sinh(z) } };
  };
  for (std::size_t node = 0; node < model.nodes.size(); ++node)
    if (const auto [least, most] = std::minmax_element(model.nodes[node].begin(), model.nodes[node].end());
        *least == 0 || *most == n)
      prescribe(model, { static_cast<std::int32_t>(node) }, { { true, true, true } },
                exact(rest_position(model, node)));
  const Vectors u = LinearStatics(model).solve(Vectors(model.nodes.size()));
  double error = 0, size = 0;
  for (std::size_t node = 0; node < u.size(); ++node)
  {
    const auto wanted = exact(rest_position(model, node));
    for (int axis = 0; axis < 3; ++axis)
    {
      error += (u[node][axis] - wanted[axis]) * (u[node][axis] - wanted[axis]);
      size += wanted[axis] * wanted[axis];
    }
  }
  return std::sqrt(error / size);
}

// Vertical displacement of the middle of the right side of Cook's membrane with voxels of edge h. Voxels with a fill
// below fill_min are left out; the others have stiffness in proportion to their fill, or full stiffness if `whole`.
double cook(double h, HourglassControl form, double fill_min, bool whole)
{
  VoxelBox box{ { { static_cast<std::int32_t>(48 / h), static_cast<std::int32_t>(60 / h), 1 } },
                { { h, h, h } },
                { neo_hookean(1, 1.0 / 3) } };
  const auto fill = sampled_fill(
      box.spacing, [](const auto& p) { return p[1] > 44 * p[0] / 48 && p[1] < 44 + 16 * p[0] / 48; }, 8, fill_min);
  box.fill = [=](const auto& voxel) { return whole && fill(voxel) > 0 ? 1 : fill(voxel); };
  Model model = voxel_model(box);
  model.hourglass = form;
  prescribe(model, nodes_where(model, [](const auto& p) { return p[0] == 0; }), { { true, true, false } });
  prescribe(model, nodes_where(model, [](const auto& p) { return p[2] == 0; }), { { false, false, true } });
  // The force is scaled to 1 per unit of thickness, because the voxel faces at the end differ in total area.
  Vectors forces = face_forces(model, 0, box.size[0], { { 0, 1, 0 } });
  double sum = 0;
  for (const auto& f : forces)
    sum += f[1];
  for (auto& f : forces)
    f[1] *= h / sum;
  return mean_displacement(
      LinearStatics(model).solve(forces),
      nodes_where(model, [=](const auto& p) { return p[0] > 48 - h / 2 && std::abs(p[1] - 52) < h / 2; }))[1];
}

struct SphereSurface
{
  double mean = 0, spread = 0;  // mean and standard deviation of the radial displacement, divided by Lame's solution
};

// Inner and outer surface of an eighth of a hollow sphere, with radii of 1 cm and 2 cm, under a small pressure inside.
std::array<SphereSurface, 2> hollow_sphere(int n, HourglassControl form, const Backend& backend)
{
  const double a = 1e-2, b = 2e-2, young = 1e4, poisson = 0.45, pressure = 20, pi = std::acos(-1.0);
  VoxelBox box{ { { n, n, n } }, { { b / n, b / n, b / n } }, { neo_hookean(young, poisson) } };
  box.fill = sampled_fill(box.spacing,
                          [=](const auto& p)
                          {
                            const double r = std::hypot(p[0], p[1], p[2]);
                            return r > a && r < b;
                          });
  Model model = voxel_model(box);
  model.hourglass = form;
  hold_mirror_planes(model);
  // The normals point to the centre, out of the tissue.
  const auto sphere = [&](double radius)
  {
    return grid_mesh(2 * n, 2 * n,
                     [=](double s, double t) -> Point
                     {
                       const double polar = 0.5 * pi * (1 - s), turn = 0.5 * pi * t;
                       return { { radius * std::sin(polar) * std::cos(turn), radius * std::sin(polar) * std::sin(turn),
                                  radius * std::cos(polar) } };
                     });
  };
  const TriangleMesh inside = sphere(a), outside = sphere(b);
  add_pressure(model, pressure, inside);
  model.skin.vertices = inside.vertices;
  model.skin.vertices.insert(model.skin.vertices.end(), outside.vertices.begin(), outside.vertices.end());
  model.skin.triangles = inside.triangles;
  model.skin_binding = bind_points(model, model.skin.vertices);
  // The tolerance is above the rounding errors of single precision, which are 1e-4 at such small strains.
  const EquilibriumSettings relax{ backend, 4 * b / std::sqrt(young / 3 / 1000), 5e-4 };
  // Half the difference between the solutions with pressure and with suction has no second-order terms.
  SkinState skin[2];
  for (const int side : { 0, 1 })
  {
    model.loads.back().value[0] = side == 0 ? pressure : -pressure;
    find_equilibrium(model, relax).solver->skin(skin[side]);
  }
  std::array<SphereSurface, 2> surfaces;
  const std::size_t half = model.skin.vertices.size() / 2;
  for (const std::size_t which : { 0, 1 })
  {
    const double r = which == 0 ? a : b;
    const double lame = pressure * a * a * a / (young * (b * b * b - a * a * a)) *
                        ((1 - 2 * poisson) * r + (1 + poisson) * b * b * b / (2 * r * r));
    double square = 0;
    for (std::size_t v = which * half; v < (which + 1) * half; ++v)
    {
      double radial = 0;
      for (int axis = 0; axis < 3; ++axis)
        radial += 0.5 * (skin[0].vertices[v][axis] - skin[1].vertices[v][axis]) * model.skin.vertices[v][axis] / r;
      surfaces[which].mean += radial / lame / static_cast<double>(half);
      square += radial * radial / (lame * lame) / static_cast<double>(half);
    }
    surfaces[which].spread = std::sqrt(std::max(square - surfaces[which].mean * surfaces[which].mean, 0.0));
  }
  return surfaces;
}

}  // namespace

void verify_convergence(const Backend&, Finding& finding)
{
  Plot plot = convergence_plot("Displacement error inside a cube", "voxel edge over the cube's [1]",
                               "relative error [1]", {}, {});
  plot.key = "bottom right";
  plot.curves = { { name_of(hourglass_forms[0]) }, { name_of(hourglass_forms[1]) } };
  Table table({ "voxels per edge", "scalar", "assumed strain" });
  for (const int n : { 3, 6, 12 })
  {
    for (const int form : { 0, 1 })
      plot.curves[form].add(1.0 / n, cube_error(n, hourglass_forms[form]));
    table.add({ static_cast<double>(n), plot.curves[0].y.back(), plot.curves[1].y.back() });
  }
  for (const Plot::Curve& curve : plot.curves)
    finding.checks.absolute("order, " + curve.name, "1", 2, slope(curve.x, curve.y), 0.25);
  const double start = plot.curves[1].y[0];
  plot.curves.push_back({ "second order", { 1.0 / 3, 1.0 / 12 }, { start, start / 16 }, Plot::Style::dashed });
  finding.tables.emplace_back("Relative error", table);
  finding.plots.emplace_back("convergence", plot);
}

void verify_cook(const Backend&, Finding& finding)
{
  struct Variant
  {
    const char* name;
    HourglassControl form;
    double fill_min;
    bool whole;
  };
  const Variant variants[] = { { "weighted, below 0.2 dropped, scalar", HourglassControl::scalar, 0.2, false },
                               { "weighted, below 0.2 dropped", HourglassControl::assumed_strain, 0.2, false },
                               { "weighted, none dropped", HourglassControl::assumed_strain, 0.01, false },
                               { "whole from a half on", HourglassControl::assumed_strain, 0.5, true } };
  Plot plot = convergence_plot("Cook's membrane: rise of the middle of its right side", "voxel edge [1]",
                               "relative error [1]", { 1, 2, 4 }, { { 0.9, 5 } });
  Table table({ "voxels", "edge 4", "edge 2", "edge 1" });
  for (const auto& variant : variants)
  {
    Plot::Curve curve{ variant.name };
    std::vector<Table::Cell> row{ variant.name };
    for (const double h : { 4.0, 2.0, 1.0 })
    {
      const double found = cook(h, variant.form, variant.fill_min, variant.whole);
      curve.add(h, std::abs(found / 23.96 - 1));
      row.emplace_back(found);
      if (h == 1)
        finding.checks.relative(variant.name, "1", 23.96, found, variant.fill_min == 0.2 ? 0.03 : std::nan(""));
    }
    table.add(row);
    plot.curves.push_back(curve);
  }
  plot.curves.push_back({ "first order", { 4, 1 }, { 0.08, 0.02 }, Plot::Style::dashed });
  finding.tables.emplace_back("Rise", table);
  finding.plots.emplace_back("cook_membrane", plot);
}

void verify_staircase(const Backend& backend, Finding& finding)
{
  Plot plot = convergence_plot("Hollow sphere under pressure: displacement of its inner surface",
                               "voxel edge over the wall's thickness [1]", "relative error [1]",
                               { 0.0625, 0.125, 0.25 }, { { 0.05, 0.3 } });
  plot.y_range = { 5e-4, 0.1 };
  Table table(
      { "form", "voxels through the wall", "inner surface", "inner scatter", "outer surface", "outer scatter" });
  for (const auto form : hourglass_forms)
  {
    const std::string name = name_of(form);
    Plot::Curve mean{ "mean, " + name }, spread{ "scatter, " + name };
    for (const int n : { 8, 16, 32 })
    {
      const auto [inner, outer] = hollow_sphere(n, form, backend);
      mean.add(2.0 / n, std::abs(inner.mean - 1));
      spread.add(2.0 / n, inner.spread);
      table.add({ name, n / 2.0, inner.mean, inner.spread, outer.mean, outer.spread });
      if (n == 32)
        finding.checks.relative("inner surface, 16 voxels, " + name, "1", 1, inner.mean, 0.03);
    }
    plot.curves.insert(plot.curves.end(), { mean, spread });
  }
  finding.tables.emplace_back("Radial displacement over Lamé's: mean and standard deviation over the surface", table);
  finding.plots.emplace_back("staircase", plot);
}

}  // namespace frontalis
