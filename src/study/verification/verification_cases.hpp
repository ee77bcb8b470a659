#pragma once

#include "frontalis/study/verification.hpp"
#include "frontalis/study/voxel_model.hpp"

namespace frontalis
{

// one function per case; verification.cpp lists them
Finding verify_rigid_motion(const VerificationSettings& settings);
Finding verify_affine_motion(const VerificationSettings& settings);
Finding verify_energy_gradient(const VerificationSettings& settings);
Finding verify_uniaxial_stretch(const VerificationSettings& settings);
Finding verify_simple_shear(const VerificationSettings& settings);
Finding verify_active_bar(const VerificationSettings& settings);
Finding verify_published_bar(const VerificationSettings& settings);
Finding verify_cantilever(const VerificationSettings& settings);
Finding verify_vibration(const VerificationSettings& settings);
Finding verify_convergence(const VerificationSettings& settings);
Finding verify_cook(const VerificationSettings& settings);
Finding verify_staircase(const VerificationSettings& settings);
Finding verify_wrinkling(const VerificationSettings& settings);
Finding verify_viscosity(const VerificationSettings& settings);
Finding verify_hertz(const VerificationSettings& settings);
Finding verify_energy_balance(const VerificationSettings& settings);
Finding verify_precision(const VerificationSettings& settings);
Finding verify_heart_beam(const VerificationSettings& settings);
Finding verify_calculix(const VerificationSettings& settings);
Finding verify_heart_ellipsoid(const VerificationSettings& settings);

inline constexpr HourglassControl hourglass_forms[] = { HourglassControl::scalar, HourglassControl::assumed_strain };
inline std::string name_of(HourglassControl form)
{
  return form == HourglassControl::scalar ? "scalar" : "assumed strain";
}

/// Holds the nodes that fulfil a condition on their position at rest [m].
void clamp(Model& model, const std::function<bool(const std::array<double, 3>&)>& condition);

/// A plot with logarithmic axes and its legend below.
Plot convergence_plot(const std::string& title, const std::string& x_label, const std::string& y_label,
                      const std::vector<double>& x_ticks, const std::array<double, 2>& x_range);

}  // namespace frontalis
