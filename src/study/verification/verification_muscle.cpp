// bars that contract

#include "frontalis/study/equilibrium.hpp"
#include "study/verification/verification_cases.hpp"

#include <cmath>

namespace frontalis
{
namespace
{

// stretch along x that a free bar of 4 x 2 x 2 voxels comes to rest at
double contracted(const Material& material, const Muscle& muscle, float activation,
                  const VerificationSettings& settings)
{
  VoxelBox box;
  box.size = { { 4, 2, 2 } };
  box.materials = { material };
  Model model = voxel_model(box);
  add_muscle(model, muscle, [](std::size_t) { return std::array<float, 3>{ { 1, 0, 0 } }; });
  for (int axis = 0; axis < 3; ++axis)
    prescribe(model, nodes_where(model, [&](const auto& p) { return p[axis] == 0; }),
              { { axis == 0, axis == 1, axis == 2 } });
  const auto end = nodes_where(model, [](const auto& p) { return p[0] > 3.5e-3; });
  EquilibriumSettings relax;
  relax.backend = settings.backend;
  relax.period = 16e-3 / std::sqrt(3 * material.parameters[0] / material.density);
  relax.activation = activation;
  relax.tolerance = 1e-5;
  return 1 + mean_displacement(find_equilibrium(model, relax).displacements, end)[0] / 4e-3;
}

}  // namespace

Finding verify_active_bar(const VerificationSettings& settings)
{
  Finding finding;
  finding.title = "Active incompressible bar";
  finding.text =
      "A free bar with S = Tₐ f₀ ⊗ f₀ along it (a muscle without tension–length relation). Incompressible: λ = "
      "(1 + Tₐ/μ)^(−1/3). The bulk modulus here is 2000 μ.";
  const double mu = 1e4;
  Material material;
  material.density = 1000;
  material.parameters = { { mu, 2000 * mu } };
  const double expected[4][2] = { { 0.1, 0.96873 }, { 0.5, 0.87358 }, { 1, 0.79370 }, { 2, 0.69336 } };
  for (const auto& row : expected)
  {
    const Muscle muscle{ "bar", row[0] * mu, false, false };
    finding.checks.push_back(relative_check("stretch at Ta/μ = " + readable(row[0]), "1", row[1],
                                            contracted(material, muscle, 1, settings), 5e-4));
  }
  return finding;
}

Finding verify_published_bar(const VerificationSettings& settings)
{
  Finding finding;
  finding.title = "Published muscle";
  finding.text =
      "A free bar of the published muscle material (0.5 MPa, ν = 0.49) with the tension–length relation, at "
      "activation 0.75. With a stress reference of 0.3 MPa it is to end at λ = 0.75, with the published 5 MPa "
      "at 0.52: two digits are known, so the bound is half of the last.";
  for (const auto& [stress, stretch] : { std::pair{ 0.3e6, 0.75 }, { 5e6, 0.52 } })
    finding.checks.push_back(absolute_check(
        "stretch with " + readable(stress / 1e6) + " MPa", "1", stretch,
        contracted(neo_hookean(0.5e6, 0.49), Muscle{ "bar", stress, false, true }, 0.75F, settings), 5e-3));
  return finding;
}

}  // namespace frontalis
