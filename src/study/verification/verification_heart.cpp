// Cardiac mechanics benchmark, problems 1 and 3: Land et al. 2015, Proc. R. Soc. A 471:20150641.

#include "frontalis/physics/materials/all.hpp"
#include "frontalis/physics/number.hpp"
#include "study/verification/verification_cases.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

Material heart(double kappa)
{
  Material material;
  material.name = "heart";
  material.law = law_of<physics::Guccione>;
  material.density = 1000;
  // The parameters are c, kappa [Pa], bf, bt, bfs, and the direction of the fibre in the beam.
  material.parameters = { { 2e3, kappa, 8, 2, 4, 1, 0, 0 } };
  return material;
}

// Final height [mm] of the upper edge of the beam's end, with n voxels through the beam's height.
double beam(int n, double kappa, const Backend& backend)
{
  Model model = voxel_model({ { 10 * n, n, n } }, 1e-3 / n, heart(kappa));
  model.hourglass = HourglassControl::assumed_strain;
  hold(model, [](const auto& p) { return p[0] == 0; });
  // The normals point down.
  add_pressure(model, 4, grid_mesh(n, 10 * n, [](double s, double t) { return Point{ { 1e-2 * t, 1e-3 * s, 0 } }; }));
  const auto end = nodes_where(model, [](const auto& p) { return p[0] > 9.99e-3 && p[2] > 0.99e-3; });
  return 1 + 1e3 * mean_displacement(find_equilibrium(model, { backend, 0.14, 1e-3 }).displacements, end)[2];
}

// Direction of the fibre at a position in the wall, relative to the centre of the ellipsoids [m].
std::array<float, 3> wall_fibre(double x, double y, double z)
{
  const double radius = std::hypot(x, y);
  const auto inside = [&](double t) { return 1 - std::hypot(radius / (7e-3 + 3e-3 * t), z / (17e-3 + 3e-3 * t)); };
  const double t = std::clamp(zero_between(-0.5, 1.5, inside, 50), 0.0, 1.0);
  const double shorter = 7e-3 + 3e-3 * t, longer = 17e-3 + 3e-3 * t;
  const double u = -std::atan2(radius / shorter, z / longer), v = std::atan2(-y, -x);
  const double angle = (90 - 180 * t) * physics::pi / 180;
  const double along[3] = { shorter * std::cos(u) * std::cos(v), shorter * std::cos(u) * std::sin(v),
                            -longer * std::sin(u) };
  const double around[3] = { std::sin(v), -std::cos(v), 0 };
  const double length = std::hypot(along[0], along[1], along[2]);
  std::array<float, 3> fibre;
  for (std::size_t i = 0; i < 3; ++i)
    fibre[i] = static_cast<float>(std::sin(angle) * along[i] / length + std::cos(angle) * around[i]);
  return fibre;
}

struct Apex
{
  double inner, outer;  // distances of the inner and outer apex from the ellipsoids' centre [mm]
};

// Apices of the inflated and contracted ellipsoid, with voxels of edge h [m].
Apex ellipsoid(double h, double kappa, const Backend& backend)
{
  const Point centre{ { 10e-3, 10e-3, 20e-3 } };
  const auto count = [&](double length) { return static_cast<std::int32_t>(std::lround(length / h)); };
  VoxelBox box{ { { count(20e-3), count(20e-3), count(25e-3) } }, { { h, h, h } }, { heart(kappa) } };
  box.fill =
      sampled_fill(box.spacing,
                   [&](const auto& p)
                   {
                     const double radius = std::hypot(p[0] - centre[0], p[1] - centre[1]), z = p[2] - centre[2];
                     return std::hypot(radius / 7e-3, z / 17e-3) > 1 && std::hypot(radius / 10e-3, z / 20e-3) < 1;
                   });
  Model model = voxel_model(box);
  model.hourglass = HourglassControl::assumed_strain;
  const auto fibre = [&](std::size_t e)
  {
    const auto& v = model.voxels[e];
    return wall_fibre((v[0] + 0.5) * h - centre[0], (v[1] + 0.5) * h - centre[1], (v[2] + 0.5) * h - centre[2]);
  };
  add_muscle(model, Muscle{ "wall", 60e3, false, false }, fibre);
  for (const auto& f : model.fibre_direction)
    model.material_directions.push_back({ { f[0], f[1], f[2], 0, 0, 0 } });
  hold(model, [&](const auto& p) { return p[2] > 25e-3 - 0.1 * h; });
  const int rows = static_cast<int>(std::lround(30e-3 / h));
  const double edge = std::acos(5.0 / 17);
  // The rows run from the apex upwards; the normals point into the cavity.
  add_pressure(model, 15e3,
               grid_mesh(rows, 2 * rows,
                         [&](double s, double t) -> Point
                         {
                           const double u = physics::pi - s * (physics::pi - edge), v = 2 * physics::pi * t;
                           return { { centre[0] + 7e-3 * std::sin(u) * std::cos(v),
                                      centre[1] + 7e-3 * std::sin(u) * std::sin(v), centre[2] + 17e-3 * std::cos(u) } };
                         }));
  model.landmarks = { "inner apex", "outer apex" };
  model.landmark_positions = { { { 10e-3, 10e-3, 3e-3 } }, { { 10e-3, 10e-3, 0 } } };
  model.landmark_binding = bind_points(model, model.landmark_positions);
  SkinState skin;
  find_equilibrium(model, { backend, 0.02, 1e-3, 1, 2 }).solver->skin(skin);
  return { 1e3 * (centre[2] - skin.landmarks[0][2]), 1e3 * (centre[2] - skin.landmarks[1][2]) };
}

}  // namespace

void verify_heart_beam(const Backend& backend, Finding& finding)
{
  Plot plot{ "Heart benchmark, problem 1: height of the beam's end", "voxel edge [mm]", "height [mm]" };
  plot.x_range = { 0, 0.55 };
  plot.y_range = { 3.8, 4.3 };
  plot.curves = { { "voxels" }, { "published code", { 0, 0.55 }, { 4.1549, 4.1549 }, Plot::Style::dashed } };
  for (const int n : { 2, 4, 6 })
  {
    const double z = beam(n, 2e5, backend);
    plot.curves[0].add(1.0 / n, z);
    finding.checks.relative(fmt::format("end of the beam, {} voxels", n), "mm", 4.1549, z, n > 2 ? 0.03 : std::nan(""));
  }
  finding.checks.relative("end of the beam, 2 voxels, bulk modulus 500 c", "mm", 4.1549, beam(2, 1e6, backend),
                          std::nan(""));
  finding.plots.emplace_back("heart_beam", plot);
}

void verify_heart_ellipsoid(const Backend& backend, Finding& finding)
{
  Plot plot{ "Heart benchmark, problem 3: apices after contraction", "voxel edge [mm]",
             "distance from the centre [mm]" };
  plot.key = "below";
  plot.x_range = { 0, 1.05 };
  plot.y_range = { 11, 18 };
  plot.curves = { { "outer apex, voxels" },
                  { "inner apex, voxels" },
                  { "outer apex, published", { 0, 1.05 }, { 15.5, 15.5 }, Plot::Style::dashed },
                  { "inner apex, published", { 0, 1.05 }, { 12.5, 12.5 }, Plot::Style::dashed } };
  for (const double h : { 1e-3, 0.5e-3 })
  {
    const Apex apex = ellipsoid(h, 2e6, backend);
    const std::string at = " apex, edge " + readable(1e3 * h) + " mm";
    const double bound = h < 0.6e-3 ? 0.05 : std::nan("");
    finding.checks.relative("inner" + at, "mm", 12.5, apex.inner, bound);
    finding.checks.relative("outer" + at, "mm", 15.5, apex.outer, bound);
    plot.curves[0].add(1e3 * h, apex.outer);
    plot.curves[1].add(1e3 * h, apex.inner);
  }
  finding.plots.emplace_back("heart_ellipsoid", plot);
}

}  // namespace frontalis
