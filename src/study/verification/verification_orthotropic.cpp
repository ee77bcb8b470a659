// Skin whose fibres lie about lines of least tension, stretched along the lines, across them and in both directions.

#include "frontalis/physics/materials/all.hpp"
#include "frontalis/physics/number.hpp"
#include "study/verification/verification_cases.hpp"

#include <Eigen/Dense>
#include <fmt/format.h>

#include <cmath>

namespace frontalis
{
namespace
{

using Stretches = Eigen::Vector3d;

// Two families of fibres at `angle` to both sides of axis 1, in the plane of axes 1 and 2; moduli in Pa.
struct OrthotropicSkin
{
  double shear, k1, k2, dispersion, angle, bulk;

  // First Piola-Kirchhoff stresses along the axes [Pa] at stretches along the axes: derivatives of the energy mu/2 (I -
  // 3) + k1/k2 (exp(k2 E^2) - 1) + bulk/2 (J - 1)^2, with I and I4 over J^(2/3) and the fibres' strain E. Both families
  // have the same strain.
  Stretches stress(const Stretches& stretch) const
  {
    const double J = stretch.prod(), g = std::pow(J, -2.0 / 3);
    const Stretches share(std::cos(angle) * std::cos(angle), std::sin(angle) * std::sin(angle), 0);
    const Stretches squared = stretch.cwiseAbs2();
    const double first = squared.sum(), fourth = squared.dot(share), aligned = 1 - 3 * dispersion;
    const double strain = dispersion * (g * first - 3) + aligned * (g * fourth - 1);
    const double tension = strain > 0 ? 2 * k1 * strain * std::exp(k2 * strain * strain) : 0;
    const auto slope = [&](double invariant, const Stretches& weights) -> Stretches
    { return 2 * g * (stretch.cwiseProduct(weights) - invariant / 3 * stretch.cwiseInverse()); };
    const Stretches of_first = slope(first, Stretches::Ones()), of_fourth = slope(fourth, share);
    return 0.5 * shear * of_first + tension * (dispersion * of_first + aligned * of_fourth) +
           bulk * (J - 1) * J * stretch.cwiseInverse();
  }

  // All stretches if those that are `given` have the value `stretch` and the others are free of stress (Newton's
  // method).
  Stretches relaxed(double stretch, const std::array<bool, 3>& given) const
  {
    Stretches all = Stretches::Ones();
    for (int a = 0; a < 3; ++a)
      all[a] = given[a] ? stretch : 1;
    for (int iteration = 0; iteration < 50; ++iteration)
    {
      constexpr double step = 1e-7;
      Stretches right = -stress(all);
      Eigen::Matrix3d tangent;
      for (int a = 0; a < 3; ++a)
      {
        const Stretches change = step * Stretches::Unit(a);
        tangent.col(a) = (stress(all + change) - stress(all - change)) / (2 * step);
      }
      for (int a = 0; a < 3; ++a)
        if (given[a])
        {
          right[a] = 0;
          tangent.row(a) = Stretches::Unit(a).transpose();
        }
      all += tangent.partialPivLu().solve(right);
    }
    return all;
  }
};

}  // namespace

void verify_orthotropic_skin(const Backend& backend, Finding& finding)
{
  constexpr double edge = 1e-3, length = 2 * edge, poisson = 0.49;
  // At small strain 41 kPa along the lines and 21 kPa across them.
  OrthotropicSkin skin{ 7e3, 37e3, 1, 0.1, 36 * physics::pi / 180, 0 };
  Material material = neo_hookean(2 * skin.shear * (1 + poisson), poisson);
  skin.bulk = material.parameters[physics::bulk_modulus_slot];
  material.law = law_of<physics::HolzapfelGasserOgden>;
  material.parameters = { { skin.shear, skin.bulk, skin.k1, skin.k2, skin.dispersion } };
  const auto c = static_cast<float>(std::cos(skin.angle)), s = static_cast<float>(std::sin(skin.angle));
  for (const auto& [along, both] : { std::pair{ true, false }, { false, false }, { true, true }, { false, true } })
    for (const double stretch : { 0.8, 1.1, 1.3 })
    {
      Model model = voxel_model({ { 2, 2, 2 } }, edge, material);
      // The model's x is along the lines or across them; in the closed form it is axis `x`.
      const int x = along ? 0 : 1, y = 1 - x;
      const std::array<float, 6> at_x{ { c, s, 0, c, -s, 0 } }, at_y{ { s, c, 0, -s, c, 0 } };
      model.material_directions.assign(model.voxels.size(), along ? at_x : at_y);
      hold_mirror_planes(model);
      const auto end = [&](int axis)
      { return nodes_where(model, [&](const auto& p) { return p[axis] > 1.5 * edge; }); };
      const double shift = (stretch - 1) * length;
      prescribe(model, end(0), { { true, false, false } }, { { shift, 0, 0 } });
      if (both)
        prescribe(model, end(1), { { false, true, false } }, { { 0, shift, 0 } });
      const RestState rest = find_equilibrium(model, { backend, 3e-3, 1e-6 });

      std::array<bool, 3> given{ { both, both, false } };
      given[x] = true;
      const Stretches stretches = skin.relaxed(stretch, given);
      const std::string at = fmt::format(", stretched {} by {:g}",
                                         both    ? "both ways"
                                         : along ? "along"
                                                 : "across",
                                         stretch);
      finding.checks.relative(std::string("P11 ") + (along ? "along" : "across") + at, "Pa", skin.stress(stretches)[x],
                              internal_force(*rest.solver, end(0))[0] / (length * length), 5e-4);
      const auto thickness = [&](int axis)
      { return 1 + mean_displacement(rest.displacements, end(axis))[axis] / length; };
      if (!both)
        finding.checks.relative("width" + at, "1", stretches[y], thickness(1), 1e-4);
      finding.checks.relative("thickness" + at, "1", stretches[2], thickness(2), 1e-4);
    }
}

}  // namespace frontalis
