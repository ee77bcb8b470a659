// contraction of free bars

#include "frontalis/study/equilibrium.hpp"
#include "study/verification/verification_cases.hpp"

#include <cmath>

namespace frontalis
{
namespace
{

// stretch along x of a free bar of 4 x 2 x 2 voxels at rest
double contracted(const Material& material, const Muscle& muscle, float activation,
                  const VerificationSettings& settings)
{
  Model model = voxel_model({ { 4, 2, 2 } }, 1e-3, material);
  add_muscle(model, muscle, [](std::size_t) { return std::array<float, 3>{ { 1, 0, 0 } }; });
  hold_mirror_planes(model);
  const auto end = nodes_where(model, [](const auto& p) { return p[0] > 3.5e-3; });
  EquilibriumSettings relax{ settings.backend, 16e-3 / std::sqrt(3 * material.parameters[0] / material.density) };
  relax.activation = activation;
  relax.tolerance = 1e-5;
  return 1 + mean_displacement(find_equilibrium(model, relax).displacements, end)[0] / 4e-3;
}

}  // namespace

Finding verify_active_bar(const VerificationSettings& settings)
{
  Finding finding;
  const double mu = 1e4;
  Material material;
  material.density = 1000;
  material.parameters = { { mu, 2000 * mu } };
  const double expected[4][2] = { { 0.1, 0.96873 }, { 0.5, 0.87358 }, { 1, 0.79370 }, { 2, 0.69336 } };
  for (const auto& row : expected)
  {
    const Muscle muscle{ "bar", row[0] * mu, false, false };
    finding.checks.relative("stretch at Ta/μ = " + readable(row[0]), "1", row[1],
                            contracted(material, muscle, 1, settings), 5e-4);
  }
  return finding;
}

Finding verify_published_bar(const VerificationSettings& settings)
{
  Finding finding;
  for (const auto& [stress, stretch] : { std::pair{ 0.3e6, 0.75 }, { 5e6, 0.52 } })
    finding.checks.absolute("stretch with " + readable(stress / 1e6) + " MPa", "1", stretch,
                            contracted(neo_hookean(0.5e6, 0.49), Muscle{ "bar", stress, false, true }, 0.75F, settings),
                            5e-3);
  return finding;
}

}  // namespace frontalis
