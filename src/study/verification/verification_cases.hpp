#pragma once

#include "frontalis/study/verification.hpp"

namespace frontalis
{

// one function a case; verification.cpp lists them
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
Finding verify_energy_balance(const VerificationSettings& settings);
Finding verify_precision(const VerificationSettings& settings);
Finding verify_heart_beam(const VerificationSettings& settings);
Finding verify_calculix(const VerificationSettings& settings);
Finding verify_heart_ellipsoid(const VerificationSettings& settings);

/// Slope of log y against log x by least squares.
double slope(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace frontalis
