// Forces of elements and stresses of laws, which must be exact except for rounding, and contraction of free bars.

#include "frontalis/physics/materials/lookup.hpp"
#include "frontalis/physics/time_step.hpp"
#include "study/verification/verification_cases.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace frontalis
{
namespace
{

constexpr double voxel_young = 34e3, voxel_poisson = 0.49, voxel_edge = 1e-3;  // young [Pa], edge [m]

using Gradient = std::array<double, 9>;  // 3 x 3, row-major

Model small_block(const Material& material, std::int32_t n, HourglassControl hourglass = HourglassControl::scalar)
{
  Model model = voxel_model({ { n, n, n } }, voxel_edge, material);
  model.hourglass = hourglass;
  return model;
}

double largest(const Vectors& vectors)
{
  double value = 0;
  for (const auto& v : vectors)
    for (const double c : v)
      value = physics::larger_or_none(value, std::abs(c));
  return value;
}

Vectors internal_forces(Solver& solver, const Vectors& displacements)
{
  Vectors forces;
  solver.set_displacements(displacements);
  solver.internal_forces(forces);
  return forces;
}

// First Piola-Kirchhoff stress [Pa] of a homogeneously deformed block, from the forces on three of its faces.
Gradient piola_stress(const Model& model, Solver& solver)
{
  Gradient P{};
  for (int j = 0; j < 3; ++j)
  {
    const double area = model.size[(j + 1) % 3] * model.size[(j + 2) % 3] * voxel_edge * voxel_edge;
    const auto force = internal_force(
        solver, nodes_where(model, [&](const auto& p) { return p[j] > (model.size[j] - 0.5) * voxel_edge; }));
    for (int i = 0; i < 3; ++i)
      P[3 * i + j] = force[i] / area;
  }
  return P;
}

std::vector<std::pair<std::string, Material>> every_law()
{
  std::vector<std::pair<std::string, Material>> laws{ { "neo-Hookean", neo_hookean(voxel_young, voxel_poisson) } };
  for (const Law law : physics::every_law)
    if (law != Law::neo_hookean)
    {
      Material material = laws.front().second;
      material.law = law;
      material.parameters = physics::example_of(law);
      material.parameters[physics::bulk_modulus_slot] = bulk_modulus(voxel_young, voxel_poisson);
      laws.emplace_back(physics::description_of(law).title, material);
    }
  return laws;
}

// Equilibrium stretch along x of a free bar of 4 x 2 x 2 voxels.
double contracted(const Material& material, const Muscle& muscle, float activation, const Backend& backend)
{
  Model model = voxel_model({ { 4, 2, 2 } }, voxel_edge, material);
  add_muscle(model, muscle, along_x);
  hold_mirror_planes(model);
  const auto end = nodes_where(model, [](const auto& p) { return p[0] > 3.5 * voxel_edge; });
  const double period = 16e-3 / std::sqrt(3 * material.parameters[0] / material.density);
  const RestState rest = find_equilibrium(model, { backend, period, 1e-5, activation });
  return 1 + mean_displacement(rest.displacements, end)[0] / 4e-3;
}

}  // namespace

void verify_rigid_motion(const Backend& other, Finding& finding)
{
  // Rotation by 1.2 rad about (1, 2, 3) by Rodrigues' formula.
  const double length = std::sqrt(14.0), a[3] = { 1 / length, 2 / length, 3 / length };
  const double c = std::cos(1.2), s = std::sin(1.2);
  const double cross[9] = { 0, -a[2], a[1], a[2], 0, -a[0], -a[1], a[0], 0 };
  Gradient R;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      R[3 * i + j] = c * (i == j) + s * cross[3 * i + j] + (1 - c) * a[i] * a[j];
  for (const auto& [backend, bound] : { std::pair<Backend, double>{ "reference", 1e-12 }, { other, 2e-5 } })
    for (const auto form : hourglass_forms)
    {
      const Model model = small_block(neo_hookean(voxel_young, voxel_poisson), 3, form);
      const Vectors forces =
          internal_forces(*solver_of(model, backend), affine_displacements(model, R, { { 2e-3, 0, 0 } }));
      finding.checks.absolute("force over E h², " + backend + ", " + name_of(form), "1", 0,
                              largest(forces) / (voxel_young * voxel_edge * voxel_edge), bound);
    }
}

void verify_affine_motion(const Backend& other, Finding& finding)
{
  const Gradient F{ { 1.3, 0.2, -0.1, 0.05, 0.85, 0.15, 0.1, -0.2, 0.95 } };
  double mode[3][8] = {};
  const double one[3] = { 1, 1, 1 };
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      mode[i][physics::gradient_mode(j)] = F[3 * i + j] - (i == j);
  const auto k = physics::kinematics(mode[0], mode[1], mode[2], one);
  const auto law = physics::stress(physics::NeoHookean<double>{ shear_modulus(voxel_young, voxel_poisson),
                                                                bulk_modulus(voxel_young, voxel_poisson), 0 },
                                   k);
  for (const auto& [backend, bound] : { std::pair<Backend, double>{ "reference", 1e-11 }, { other, 2e-5 } })
  {
    const Model model = small_block(neo_hookean(voxel_young, voxel_poisson), 4, HourglassControl::assumed_strain);
    const auto solver = solver_of(model, backend);
    const Vectors forces = internal_forces(*solver, affine_displacements(model, F));
    double inside = 0, error = 0;
    for (std::size_t n = 0; n < forces.size(); ++n)
      if (const auto [least, most] = std::minmax_element(model.nodes[n].begin(), model.nodes[n].end());
          *least > 0 && *most < 4)
        inside = physics::larger_or_none(inside, largest({ forces[n] }));
    const Gradient P = piola_stress(model, *solver);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        error = physics::larger_or_none(
            error, std::abs(P[3 * i + j] - law.on_gradient * k.F.a[i][j] - law.on_cofactor * k.cofactor.a[i][j]));
    finding.checks.absolute("force inside over E h², " + backend, "1", 0,
                            inside / (voxel_young * voxel_edge * voxel_edge), bound);
    finding.checks.absolute("error of stress over E, " + backend, "1", 0, error / voxel_young, bound);
  }
}

void verify_energy_gradient(const Backend& other, Finding& finding)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> value(-0.3 * voxel_edge, 0.3 * voxel_edge);
  for (const auto& [law, material] : every_law())
    for (const auto form : hourglass_forms)
    {
      if (form == HourglassControl::assumed_strain && material.law != Law::neo_hookean)
        continue;
      const Model model = small_block(material, 2, form);
      const auto energies = solver_of(model, "reference");
      Vectors u(model.nodes.size());
      for (auto& v : u)
        for (auto& c : v)
          c = value(random);
      Vectors slopes(u.size());
      const double step = 1e-8;
      for (std::size_t n = 0; n < u.size(); ++n)
        for (int axis = 0; axis < 3; ++axis)
          for (const double side : { -1.0, 1.0 })
          {
            Vectors moved = u;
            moved[n][axis] += side * step;
            energies->set_displacements(moved);
            const Monitor monitor = energies->monitor();
            slopes[n][axis] += side * (monitor.internal + monitor.hourglass) / (2 * step);
          }
      for (const auto& [backend, bound] : { std::pair<Backend, double>{ "reference", 1e-6 }, { other, 2e-5 } })
      {
        Vectors errors = internal_forces(*solver_of(model, backend), u);
        for (std::size_t n = 0; n < u.size(); ++n)
          for (int axis = 0; axis < 3; ++axis)
            errors[n][axis] -= slopes[n][axis];
        const std::string name = form == HourglassControl::assumed_strain ? ", " + name_of(form) : "";
        finding.checks.absolute(law + ", " + backend + name, "1", 0, largest(errors) / largest(slopes), bound);
      }
    }
}

void verify_uniaxial_stretch(const Backend& backend, Finding& finding)
{
  // Columns: stretch, P11/μ, lateral stretch, J.
  const double expected[7][4] = { { 0.5, -3.480201, 1.405832, 0.988182 }, { 0.7, -1.333561, 1.191455, 0.993695 },
                                  { 0.9, -0.332530, 1.053031, 0.997987 }, { 1.1, 0.271538, 0.954416, 1.002001 },
                                  { 1.3, 0.701838, 0.879723, 1.006086 },  { 1.5, 1.043711, 0.820731, 1.010399 },
                                  { 2.0, 1.718609, 0.715038, 1.022560 } };
  Plot plot{ "Uniaxial stretch of a neo-Hookean block", "stretch [1]", "P11 over shear modulus [1]" };
  plot.key = "bottom right";
  plot.curves = { { "closed form", {}, {}, Plot::Style::line }, { "solver", {}, {}, Plot::Style::points } };
  for (const auto& row : expected)
  {
    Model model = small_block(neo_hookean(voxel_young, voxel_poisson), 2);
    const double length = 2 * voxel_edge;
    hold_mirror_planes(model);
    const auto end = nodes_where(model, [&](const auto& p) { return p[0] > 1.5 * voxel_edge; });
    const auto side = nodes_where(model, [&](const auto& p) { return p[1] > 1.5 * voxel_edge; });
    prescribe(model, end, { { true, false, false } }, { { (row[0] - 1) * length, 0, 0 } });
    const RestState rest = find_equilibrium(model, { backend, 3e-3, 1e-6 });
    const double stress =
        internal_force(*rest.solver, end)[0] / (length * length) / shear_modulus(voxel_young, voxel_poisson);
    const double lateral = 1 + mean_displacement(rest.displacements, side)[1] / length;
    const std::string at = " at stretch " + readable(row[0]);
    finding.checks.relative("P11/μ" + at, "1", row[1], stress, 2e-4);
    finding.checks.relative("lateral stretch" + at, "1", row[2], lateral, 2e-5);
    finding.checks.relative("J" + at, "1", row[3], row[0] * lateral * lateral, 4e-5);
    plot.curves[0].add(row[0], row[1]);
    plot.curves[1].add(row[0], stress);
  }
  finding.plots.emplace_back("uniaxial_stretch", plot);
}

void verify_simple_shear(const Backend& backend, Finding& finding)
{
  for (const double gamma : { 0.2, 0.8 })
  {
    const Model model = small_block(neo_hookean(voxel_young, voxel_poisson), 2);
    const auto solver = solver_of(model, backend);
    const Gradient F{ { 1, gamma, 0, 0, 1, 0, 0, 0, 1 } };
    solver->set_displacements(affine_displacements(model, F));
    const Gradient P = piola_stress(model, *solver);
    // The Cauchy stress is sigma = P F^T, because J = 1.
    const auto sigma = [&](int i, int j)
    {
      return (P[3 * i] * F[3 * j] + P[3 * i + 1] * F[3 * j + 1] + P[3 * i + 2] * F[3 * j + 2]) /
             shear_modulus(voxel_young, voxel_poisson);
    };
    const std::string at = " at γ = " + readable(gamma);
    const double square = gamma * gamma;
    finding.checks.relative("σ12/μ" + at, "1", gamma, sigma(0, 1), 1e-4);
    finding.checks.absolute("σ11/μ" + at, "1", 2 * square / 3, sigma(0, 0), 1e-4);
    finding.checks.absolute("σ22/μ" + at, "1", -square / 3, sigma(1, 1), 1e-4);
    finding.checks.absolute("σ33/μ" + at, "1", -square / 3, sigma(2, 2), 1e-4);
  }
}

void verify_active_bar(const Backend& backend, Finding& finding)
{
  const double mu = 1e4;
  Material material;
  material.density = 1000;
  material.parameters = { { mu, 2000 * mu } };
  // Pairs of active stress Ta/μ and expected stretch.
  for (const auto& [stress, stretch] : { std::pair{ 0.1, 0.96873 }, { 0.5, 0.87358 }, { 1, 0.79370 }, { 2, 0.69336 } })
    finding.checks.relative("stretch at Ta/μ = " + readable(stress), "1", stretch,
                            contracted(material, Muscle{ "bar", stress * mu, false, false }, 1, backend), 5e-4);
}

void verify_published_bar(const Backend& backend, Finding& finding)
{
  for (const auto& [stress, stretch] : { std::pair{ 0.3e6, 0.75 }, { 5e6, 0.52 } })
    finding.checks.absolute("stretch with " + readable(stress / 1e6) + " MPa", "1", stretch,
                            contracted(neo_hookean(0.5e6, 0.49), Muscle{ "bar", stress, false, true }, 0.75F, backend),
                            5e-3);
}

}  // namespace frontalis
