// cardiac mechanics benchmark, problems 1 and 3: Land et al. 2015, Proc. R. Soc. A 471:20150641

#include "frontalis/physics/materials/all.hpp"
#include "frontalis/study/equilibrium.hpp"
#include "study/verification/shape_model.hpp"
#include "study/verification/verification_cases.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

const double pi = std::acos(-1.0);

Material heart(double kappa)
{
  Material material;
  material.name = "heart";
  material.law = law_of<physics::Guccione>;
  material.density = 1000;
  material.parameters = { { 2e3, kappa, 8, 2, 4, 1, 0, 0 } };
  return material;
}

void add_pressure(Model& model, double pressure, const TriangleMesh& mesh)
{
  Load load;
  load.name = "pressure";
  load.kind = Load::Kind::pressure;
  load.value[0] = pressure;
  load.mesh = mesh;
  load.binding = bind_points(model, mesh.vertices);
  model.loads.push_back(load);
}

// position along z [mm] that the end's upper edge of the beam comes to; n voxels through its height
double beam(int n, double kappa, Backend backend)
{
  VoxelBox box;
  box.size = { { 10 * n, n, n } };
  box.spacing.fill(1e-3 / n);
  box.materials = { heart(kappa) };
  Model model = voxel_model(box);
  model.hourglass = HourglassControl::assumed_strain;
  for (const auto node : nodes_where(model, [](const auto& p) { return p[0] == 0; }))
    model.rigid.push_back({ node, -1 });
  // normals downwards
  add_pressure(model, 4,
               grid_mesh(n, 10 * n,
                         [](double s, double t) -> std::array<double, 3> {
                           return { { 1e-2 * t, 1e-3 * s, 0 } };
                         }));
  EquilibriumSettings relax;
  relax.backend = backend;
  relax.period = 0.14;
  relax.tolerance = 1e-3;
  const auto end = nodes_where(model, [](const auto& p) { return p[0] > 9.99e-3 && p[2] > 0.99e-3; });
  return 1 + 1e3 * mean_displacement(find_equilibrium(model, relax).displacements, end)[2];
}

// direction of the fibre at a point of the wall [m from the centre of the ellipsoids]
std::array<float, 3> wall_fibre(double x, double y, double z)
{
  const double radius = std::hypot(x, y);
  double low = -0.5, high = 1.5;
  for (int i = 0; i < 50; ++i)
  {
    const double t = 0.5 * (low + high);
    const bool outside = std::hypot(radius / (7e-3 + 3e-3 * t), z / (17e-3 + 3e-3 * t)) > 1;
    (outside ? low : high) = t;
  }
  const double t = std::min(std::max(low, 0.0), 1.0), shorter = 7e-3 + 3e-3 * t, longer = 17e-3 + 3e-3 * t;
  const double u = -std::atan2(radius / shorter, z / longer), v = std::atan2(-y, -x);
  const double angle = (90 - 180 * t) * pi / 180;
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
  double inner, outer;  // distance from the ellipsoids' centre [mm]
};

// the contracted ellipsoid, voxel edge h [m]
Apex ellipsoid(double h, double kappa, Backend backend)
{
  const std::array<double, 3> centre{ { 10e-3, 10e-3, 20e-3 } };
  VoxelBox box;
  box.spacing.fill(h);
  box.size = { { static_cast<std::int32_t>(std::lround(20e-3 / h)), static_cast<std::int32_t>(std::lround(20e-3 / h)),
                 static_cast<std::int32_t>(std::lround(25e-3 / h)) } };
  box.materials = { heart(kappa) };
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
  for (const auto node : nodes_where(model, [&](const auto& p) { return p[2] > 25e-3 - 0.1 * h; }))
    model.rigid.push_back({ node, -1 });
  const int rows = static_cast<int>(std::lround(30e-3 / h));
  const double edge = std::acos(5.0 / 17);
  // from the apex up; normals into the cavity
  add_pressure(model, 15e3,
               grid_mesh(rows, 2 * rows,
                         [&](double s, double t) -> std::array<double, 3>
                         {
                           const double u = pi - s * (pi - edge), v = 2 * pi * t;
                           return { { centre[0] + 7e-3 * std::sin(u) * std::cos(v),
                                      centre[1] + 7e-3 * std::sin(u) * std::sin(v), centre[2] + 17e-3 * std::cos(u) } };
                         }));
  model.landmarks = { "inner apex", "outer apex" };
  model.landmark_positions = { { { 10e-3, 10e-3, 3e-3 } }, { { 10e-3, 10e-3, 0 } } };
  model.landmark_binding = bind_points(model, model.landmark_positions);
  EquilibriumSettings relax;
  relax.backend = backend;
  relax.period = 0.02;
  relax.ramp = 2;
  relax.tolerance = 1e-3;
  relax.activation = 1;
  SkinState skin;
  find_equilibrium(model, relax).solver->skin(skin);
  return { 1e3 * (centre[2] - skin.landmarks[0][2]), 1e3 * (centre[2] - skin.landmarks[1][2]) };
}

}  // namespace

Finding verify_heart_beam(const VerificationSettings& settings)
{
  Finding finding;
  finding.title = "Heart benchmark, problem 1: a beam bends under pressure";
  finding.text =
      "Land et al. 2015 (Proc. R. Soc. A 471:20150641): a beam of 10 × 1 × 1 mm of Guccione's law, c = 2 kPa, "
      "b_f = 8, b_t = 2, b_fs = 4, fibres along it, incompressible, clamped at one end, with 4 Pa on its lower "
      "side that follow it. Height of the end's upper edge. Expected: 4.1549 mm, the output in the "
      "documentation of the FEniCS code *pulse* (finsberg/pulse, problem 1). Bulk modulus here 100 c.";
  Plot plot;
  plot.title = "Heart benchmark, problem 1: height of the beam's end";
  plot.x_label = "voxel edge [mm]";
  plot.y_label = "height [mm]";
  plot.x_from = 0;
  plot.x_to = 0.55;
  plot.y_from = 3.8;
  plot.y_to = 4.3;
  plot.curves = { { "voxels", {}, {}, Plot::Style::line_and_points },
                  { "published code", { 0, 0.55 }, { 4.1549, 4.1549 }, Plot::Style::dashed } };
  for (const int n : { 2, 4, 6 })
  {
    const double z = beam(n, 2e5, settings.backend);
    plot.curves[0].x.push_back(1.0 / n);
    plot.curves[0].y.push_back(z);
    finding.checks.push_back(relative_check("end of the beam, " + std::to_string(n) + " voxels", "mm", 4.1549, z,
                                            n > 2 ? 0.03 : std::nan("")));
  }
  finding.checks.push_back(relative_check("end of the beam, 2 voxels, bulk modulus 500 c", "mm", 4.1549,
                                          beam(2, 1e6, settings.backend), std::nan("")));
  finding.plots.emplace_back("heart_beam", plot);
  finding.remarks = "Five times the bulk modulus takes about 1 % off the height.";
  return finding;
}

Finding verify_heart_ellipsoid(const VerificationSettings& settings)
{
  Finding finding;
  finding.title = "Heart benchmark, problem 3: an ellipsoid is inflated and contracts";
  finding.text =
      "Land et al. 2015: the wall between ellipsoids with semi-axes 7, 7, 17 and 10, 10, 20 mm, cut off 5 mm "
      "above their centre and held there; Guccione's law as in problem 1, fibres that turn from −90° at the "
      "inner surface to 90° at the outer one, 15 kPa inside and an active stress of 60 kPa, S = Tₐ f₀ ⊗ f₀. "
      "Distance of the two apices from the centre. Expected: about 12.5 and 15.5 mm, as read from the paper's "
      "figures (so quoted in issue 39 of finsberg/pulse); that code's documentation has 11.855 and 15.490 mm "
      "for its coarse mesh. Bulk modulus 1000 c; each voxel has its own fibre direction, for the muscle and "
      "for the law.";
  Plot plot;
  plot.title = "Heart benchmark, problem 3: apices after contraction";
  plot.x_label = "voxel edge [mm]";
  plot.y_label = "distance from the centre [mm]";
  plot.key = "below";
  plot.x_from = 0;
  plot.x_to = 1.05;
  plot.y_from = 11;
  plot.y_to = 18;
  plot.curves = { { "outer apex, voxels", {}, {}, Plot::Style::line_and_points },
                  { "inner apex, voxels", {}, {}, Plot::Style::line_and_points },
                  { "outer apex, published", { 0, 1.05 }, { 15.5, 15.5 }, Plot::Style::dashed },
                  { "inner apex, published", { 0, 1.05 }, { 12.5, 12.5 }, Plot::Style::dashed } };
  for (const double h : { 1e-3, 0.5e-3 })
  {
    const Apex apex = ellipsoid(h, 2e6, settings.backend);
    const std::string at = " apex, edge " + readable(1e3 * h) + " mm";
    const double bound = h < 0.6e-3 ? 0.05 : std::nan("");
    finding.checks.push_back(relative_check("inner" + at, "mm", 12.5, apex.inner, bound));
    finding.checks.push_back(relative_check("outer" + at, "mm", 15.5, apex.outer, bound));
    for (const std::size_t curve : { 0, 1 })
    {
      plot.curves[curve].x.push_back(1e3 * h);
      plot.curves[curve].y.push_back(curve == 0 ? apex.outer : apex.inner);
    }
  }
  finding.plots.emplace_back("heart_ellipsoid", plot);
  finding.remarks =
      "The wall is 3 mm thick: 3 and 6 voxels. Contraction shortens the ellipsoid by about 4.5 mm, so 0.3 mm "
      "at the apex are 6 % of its motion. What is missing at coarse voxels is what a staircase costs: fibres "
      "turn by 60° from one voxel to the next through a wall of three, and the apex, where the wall's "
      "curvature is greatest, is a step of a few voxels.";
  return finding;
}

}  // namespace frontalis
