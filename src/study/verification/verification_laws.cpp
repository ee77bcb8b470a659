// forces of the element and the laws: what must hold to the last digit

#include "frontalis/physics/materials/lookup.hpp"
#include "frontalis/study/equilibrium.hpp"
#include "study/verification/verification_cases.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace frontalis
{
namespace
{

constexpr double young = 34e3, poisson = 0.49, edge = 1e-3;

using Gradient = std::array<double, 9>;  // row by row

Model small_block(const Material& material, std::int32_t n, HourglassControl hourglass = HourglassControl::scalar)
{
  VoxelBox box;
  box.size = { { n, n, n } };
  box.spacing = { { edge, edge, edge } };
  box.materials = { material };
  Model model = voxel_model(box);
  model.hourglass = hourglass;
  return model;
}

Vectors affine(const Model& model, const Gradient& F, const std::array<double, 3>& shift = { { 0, 0, 0 } })
{
  Vectors u(model.nodes.size(), shift);
  for (std::size_t n = 0; n < u.size(); ++n)
  {
    const auto p = rest_position(model, n);
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        u[n][i] += (F[3 * i + j] - (i == j ? 1 : 0)) * p[j];
  }
  return u;
}

double largest(const Vectors& vectors)
{
  double value = 0;
  for (const auto& v : vectors)
    for (const double c : v)
      value = std::max(value, std::abs(c));
  return value;
}

// first Piola-Kirchhoff stress [Pa] of a homogeneously deformed block, from the forces on three of its faces
Gradient piola_stress(const Model& model, Solver& solver)
{
  Gradient P{};
  for (int j = 0; j < 3; ++j)
  {
    const double area = model.size[(j + 1) % 3] * model.size[(j + 2) % 3] * edge * edge;
    const auto force =
        internal_force(solver, nodes_where(model, [&](const auto& p) { return p[j] > (model.size[j] - 0.5) * edge; }));
    for (int i = 0; i < 3; ++i)
      P[3 * i + j] = force[i] / area;
  }
  return P;
}

std::vector<std::pair<std::string, Material>> every_law()
{
  std::vector<std::pair<std::string, Material>> laws{ { "neo-Hookean", neo_hookean(young, poisson) } };
  for (const Law law : physics::every_law)
    if (law != Law::neo_hookean)
    {
      Material material = laws.front().second;
      material.law = law;
      material.parameters = physics::example_of(law);
      material.parameters[physics::bulk_modulus_slot] = bulk_modulus(young, poisson);
      laws.emplace_back(physics::description_of(law).title, material);
    }
  return laws;
}

std::string name_of(HourglassControl form) { return form == HourglassControl::scalar ? "scalar" : "assumed strain"; }

}  // namespace

Finding verify_rigid_motion(const VerificationSettings& settings)
{
  Finding finding;
  finding.title = "Rigid motion";
  finding.text =
      "A block of 3³ voxels is turned by 1.2 rad about (1, 2, 3) and moved by 2 mm. No force may arise; the "
      "largest is given over E h². In single precision the rounding of the displacements alone strains an "
      "element by 10⁻⁷, which the bulk modulus, 17 E, turns into 10⁻⁶.";
  // Rodrigues' formula
  const double length = std::sqrt(14.0), a[3] = { 1 / length, 2 / length, 3 / length };
  const double c = std::cos(1.2), s = std::sin(1.2);
  const double cross[9] = { 0, -a[2], a[1], a[2], 0, -a[0], -a[1], a[0], 0 };
  Gradient R;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      R[3 * i + j] = c * (i == j) + s * cross[3 * i + j] + (1 - c) * a[i] * a[j];
  for (const auto& [backend, bound] : { std::pair{ Backend("reference"), 1e-12 }, { settings.backend, 2e-5 } })
    for (const auto form : { HourglassControl::scalar, HourglassControl::assumed_strain })
    {
      const auto model = std::make_shared<const Model>(small_block(neo_hookean(young, poisson), 3, form));
      const auto solver = make_solver(model, { backend, 1, 0 });
      solver->set_displacements(affine(*model, R, { { 2e-3, 0, 0 } }));
      Vectors forces;
      solver->internal_forces(forces);
      finding.checks.push_back(absolute_check("force over E h², " + backend + ", " + name_of(form), "1", 0,
                                              largest(forces) / (young * edge * edge), bound));
    }
  return finding;
}

Finding verify_affine_motion(const VerificationSettings& settings)
{
  Finding finding;
  finding.title = "Affine motion";
  finding.text =
      "Nodes displaced by one linear map strain every element alike: no force inside, and the stress that the "
      "forces on the faces amount to is the law's (neo-Hookean, computed from its formula).";
  const Gradient F{ { 1.3, 0.2, -0.1, 0.05, 0.85, 0.15, 0.1, -0.2, 0.95 } };
  double mode[3][8] = {};
  const double one[3] = { 1, 1, 1 };
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      mode[i][physics::gradient_mode(j)] = F[3 * i + j] - (i == j);
  const auto k = physics::kinematics(mode[0], mode[1], mode[2], one);
  const auto law =
      physics::stress(physics::NeoHookean<double>{ shear_modulus(young, poisson), bulk_modulus(young, poisson) }, k);
  for (const auto& [backend, bound] : { std::pair{ Backend("reference"), 1e-11 }, { settings.backend, 2e-5 } })
  {
    const auto model =
        std::make_shared<const Model>(small_block(neo_hookean(young, poisson), 4, HourglassControl::assumed_strain));
    const auto solver = make_solver(model, { backend, 1, 0 });
    solver->set_displacements(affine(*model, F));
    Vectors forces;
    solver->internal_forces(forces);
    double inside = 0, error = 0;
    for (std::size_t n = 0; n < forces.size(); ++n)
      if (const auto& node = model->nodes[n];
          *std::min_element(node.begin(), node.end()) > 0 && *std::max_element(node.begin(), node.end()) < 4)
        inside = std::max(inside, largest({ forces[n] }));
    const Gradient P = piola_stress(*model, *solver);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        error = std::max(error,
                         std::abs(P[3 * i + j] - law.on_gradient * k.F.a[i][j] - law.on_cofactor * k.cofactor.a[i][j]));
    const std::string of = ", " + backend;
    finding.checks.push_back(
        absolute_check("force inside over E h²" + of, "1", 0, inside / (young * edge * edge), bound));
    finding.checks.push_back(absolute_check("error of stress over E" + of, "1", 0, error / young, bound));
  }
  return finding;
}

Finding verify_energy_gradient(const VerificationSettings& settings)
{
  Finding finding;
  finding.title = "Forces are the gradient of the energy";
  finding.text =
      "Nodes of a 2 × 2 × 2 block are displaced at random by up to 0.3 voxels, so that some voxels are nearly "
      "crushed; each nodal force is compared with the central difference of the energy (elastic and hourglass, "
      "in double). Given is the largest error over the largest force.";
  std::mt19937 random(3);
  std::uniform_real_distribution<double> value(-0.3 * edge, 0.3 * edge);
  for (const auto& [law, material] : every_law())
    for (const auto form : { HourglassControl::scalar, HourglassControl::assumed_strain })
    {
      if (form == HourglassControl::assumed_strain && material.law != Law::neo_hookean)
        continue;
      const auto model = std::make_shared<const Model>(small_block(material, 2, form));
      const auto energies = make_solver(model, { "reference", 1, 0 });
      Vectors u(model->nodes.size());
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
      for (const auto& [backend, bound] : { std::pair{ Backend("reference"), 1e-6 }, { settings.backend, 2e-5 } })
      {
        const auto solver = make_solver(model, { backend, 1, 0 });
        solver->set_displacements(u);
        Vectors forces;
        solver->internal_forces(forces);
        Vectors errors(u.size());
        for (std::size_t n = 0; n < u.size(); ++n)
          for (int axis = 0; axis < 3; ++axis)
            errors[n][axis] = forces[n][axis] - slopes[n][axis];
        std::string name = law + ", " + backend;
        if (form == HourglassControl::assumed_strain)
          name += ", " + name_of(form);
        finding.checks.push_back(absolute_check(name, "1", 0, largest(errors) / largest(slopes), bound));
      }
    }
  return finding;
}

Finding verify_uniaxial_stretch(const VerificationSettings& settings)
{
  Finding finding;
  finding.title = "Uniaxial stretch";
  finding.text =
      "A neo-Hookean block, ν = 0.49, is drawn or pressed along x with its sides free, and comes to rest. "
      "Expected: the closed form ψ = μ/2 (J^(−2/3) I₁ − 3) + κ/2 (J − 1)² with the lateral stretch solved for "
      "numerically.";
  const double expected[7][4] = { { 0.5, -3.480201, 1.405832, 0.988182 }, { 0.7, -1.333561, 1.191455, 0.993695 },
                                  { 0.9, -0.332530, 1.053031, 0.997987 }, { 1.1, 0.271538, 0.954416, 1.002001 },
                                  { 1.3, 0.701838, 0.879723, 1.006086 },  { 1.5, 1.043711, 0.820731, 1.010399 },
                                  { 2.0, 1.718609, 0.715038, 1.022560 } };
  Plot plot;
  plot.title = "Uniaxial stretch of a neo-Hookean block";
  plot.x_label = "stretch [1]";
  plot.y_label = "P11 over shear modulus [1]";
  plot.key = "bottom right";
  plot.curves = { { "closed form", {}, {}, Plot::Style::line }, { "solver", {}, {}, Plot::Style::points } };
  for (const auto& row : expected)
  {
    Model model = small_block(neo_hookean(young, poisson), 2);
    const double length = 2 * edge;
    for (int axis = 0; axis < 3; ++axis)
      prescribe(model, nodes_where(model, [&](const auto& p) { return p[axis] == 0; }),
                { { axis == 0, axis == 1, axis == 2 } });
    const auto end = nodes_where(model, [&](const auto& p) { return p[0] > 1.5 * edge; });
    const auto side = nodes_where(model, [&](const auto& p) { return p[1] > 1.5 * edge; });
    prescribe(model, end, { { true, false, false } }, { { (row[0] - 1) * length, 0, 0 } });
    EquilibriumSettings relax;
    relax.backend = settings.backend;
    relax.period = 3e-3;
    relax.tolerance = 1e-6;
    RestState rest = find_equilibrium(model, relax);
    const double stress = internal_force(*rest.solver, end)[0] / (length * length) / shear_modulus(young, poisson);
    const double lateral = 1 + mean_displacement(rest.displacements, side)[1] / length;
    const std::string at = " at stretch " + readable(row[0]);
    finding.checks.push_back(relative_check("P11/μ" + at, "1", row[1], stress, 2e-4));
    finding.checks.push_back(relative_check("lateral stretch" + at, "1", row[2], lateral, 2e-5));
    finding.checks.push_back(relative_check("J" + at, "1", row[3], row[0] * lateral * lateral, 4e-5));
    for (std::size_t c = 0; c < 2; ++c)
      plot.curves[c].x.push_back(row[0]);
    plot.curves[0].y.push_back(row[1]);
    plot.curves[1].y.push_back(stress);
  }
  finding.plots.emplace_back("uniaxial_stretch", plot);
  return finding;
}

Finding verify_simple_shear(const VerificationSettings& settings)
{
  Finding finding;
  finding.title = "Simple shear";
  finding.text =
      "F = 1 + γ e₁ ⊗ e₂. Expected Cauchy stress of the neo-Hookean solid: σ₁₂ = μγ, σ₁₁ = ⅔μγ², σ₂₂ = σ₃₃ = −⅓μγ².";
  const double mu = shear_modulus(young, poisson);
  for (const double gamma : { 0.2, 0.8 })
  {
    const auto model = std::make_shared<const Model>(small_block(neo_hookean(young, poisson), 2));
    const auto solver = make_solver(model, { settings.backend, 1, 0 });
    const Gradient F{ { 1, gamma, 0, 0, 1, 0, 0, 0, 1 } };
    solver->set_displacements(affine(*model, F));
    const Gradient P = piola_stress(*model, *solver);
    // J = 1: sigma = P F^T
    const auto sigma = [&](int i, int j)
    {
      double sum = 0;
      for (int k = 0; k < 3; ++k)
        sum += P[3 * i + k] * F[3 * j + k];
      return sum / mu;
    };
    const std::string at = " at γ = " + readable(gamma);
    const double square = gamma * gamma;
    finding.checks.push_back(relative_check("σ12/μ" + at, "1", gamma, sigma(0, 1), 1e-4));
    finding.checks.push_back(absolute_check("σ11/μ" + at, "1", 2 * square / 3, sigma(0, 0), 1e-4));
    finding.checks.push_back(absolute_check("σ22/μ" + at, "1", -square / 3, sigma(1, 1), 1e-4));
    finding.checks.push_back(absolute_check("σ33/μ" + at, "1", -square / 3, sigma(2, 2), 1e-4));
  }
  return finding;
}

}  // namespace frontalis
