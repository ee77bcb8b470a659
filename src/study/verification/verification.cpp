#include "frontalis/study/verification.hpp"

#include "study/verification/verification_cases.hpp"

#include <cmath>
#include <cstdio>

namespace frontalis
{
namespace
{

Check check_of(std::string name, std::string unit, double expected, double found, double bound, bool relative)
{
  Check check{ std::move(name), std::move(unit), expected, found, std::abs(found - expected), bound, relative };
  if (relative)
    check.error /= std::abs(expected);
  return check;
}

}  // namespace

Check relative_check(std::string name, std::string unit, double expected, double found, double bound)
{
  return check_of(std::move(name), std::move(unit), expected, found, bound, true);
}

Check absolute_check(std::string name, std::string unit, double expected, double found, double bound)
{
  return check_of(std::move(name), std::move(unit), expected, found, bound, false);
}

std::vector<VerificationCase> verification_cases()
{
  return { { "rigid_motion", true, verify_rigid_motion },
           { "affine_motion", true, verify_affine_motion },
           { "energy_gradient", true, verify_energy_gradient },
           { "uniaxial_stretch", true, verify_uniaxial_stretch },
           { "simple_shear", true, verify_simple_shear },
           { "active_bar", true, verify_active_bar },
           { "published_bar", true, verify_published_bar },
           { "cantilever", true, verify_cantilever },
           { "vibration", true, verify_vibration },
           { "convergence", true, verify_convergence },
           { "cook_membrane", true, verify_cook },
           { "staircase", false, verify_staircase },
           { "wrinkling", true, verify_wrinkling },
           { "viscosity", true, verify_viscosity },
           { "energy_balance", true, verify_energy_balance },
           { "precision", false, verify_precision },
           { "heart_beam", false, verify_heart_beam },
           { "heart_ellipsoid", false, verify_heart_ellipsoid },
           { "calculix", false, verify_calculix } };
}

std::string check_line(const std::string& name, const Check& check)
{
  const auto share = [&](double value) -> std::string
  {
    if (std::isnan(value))
      return "-";
    return check.relative ? readable(100 * value, 3) + " %" : readable(value, 3);
  };
  const char* const verdict = std::isnan(check.bound) ? "shown" : check.passed() ? "pass" : "FAIL";
  char line[400];
  std::snprintf(line, sizeof line, "%-17s %-44s %12s %12s %-6s %10s %8s  %s", name.c_str(), check.name.c_str(),
                readable(check.expected).c_str(), readable(check.found).c_str(), check.unit.c_str(),
                share(check.error).c_str(), share(check.bound).c_str(), verdict);
  return line;
}

double slope(const std::vector<double>& x, const std::vector<double>& y)
{
  double mx = 0, my = 0, xx = 0, xy = 0;
  const auto n = static_cast<double>(x.size());
  for (std::size_t i = 0; i < x.size(); ++i)
  {
    mx += std::log(x[i]) / n;
    my += std::log(y[i]) / n;
  }
  for (std::size_t i = 0; i < x.size(); ++i)
  {
    xx += (std::log(x[i]) - mx) * (std::log(x[i]) - mx);
    xy += (std::log(x[i]) - mx) * (std::log(y[i]) - my);
  }
  return xy / xx;
}

}  // namespace frontalis
