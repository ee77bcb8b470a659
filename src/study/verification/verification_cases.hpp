#pragma once

#include "frontalis/study/statics.hpp"
#include "frontalis/study/verification.hpp"

namespace frontalis
{

// The cases that need no scene; verification.cpp lists them.
using VerificationFunction = void(const Backend& backend, Finding& finding);
VerificationFunction verify_rigid_motion, verify_affine_motion, verify_energy_gradient, verify_uniaxial_stretch,
    verify_orthotropic_skin, verify_simple_shear, verify_active_bar, verify_published_bar, verify_cantilever,
    verify_vibration, verify_convergence, verify_cook, verify_staircase, verify_wrinkling, verify_viscosity,
    verify_hertz, verify_contact_pressure, verify_contact_impact, verify_contact_wrench, verify_contact_incline,
    verify_self_contact, verify_energy_balance, verify_precision, verify_heart_beam, verify_heart_ellipsoid,
    verify_calculix;
/// Cases that start from a scene.
void verify_attachment(const Backend& backend, const BakeScene& bake, Finding& finding);
void verify_fitted_layers(const Backend& backend, const BakeScene& bake, Finding& finding);
void verify_free_sides(const Backend& backend, const BakeScene& bake, Finding& finding);
void verify_shell(const Backend& backend, const BakeScene& bake, Finding& finding);
void verify_pinched_shell(const Backend& backend, const BakeScene& bake, Finding& finding);
void verify_wrinkle(const Backend& backend, const BakeScene& bake, Finding& finding);

inline constexpr HourglassControl hourglass_forms[] = { HourglassControl::scalar, HourglassControl::assumed_strain };
inline std::string name_of(HourglassControl form)
{
  return form == HourglassControl::scalar ? "scalar" : "assumed strain";
}

/// Wrinkles of a stiff film on a deep soft base, both with Poisson's ratio 0.49, in plane strain.
struct FilmWrinkles
{
  double wavelength = 0;   ///< wavelength divided by the film's thickness
  double compression = 0;  ///< critical compression [%]
};
/// Wrinkles by plate theory (Cao & Hutchinson 2012). `contrast`: Young's modulus of the film divided by that of the
/// base.
FilmWrinkles expected_wrinkles(double contrast);
/// If a base is stretched by `along` in its plane, returns the stretch normal to the plane at which the normal stress
/// is zero. Poisson's ratio is 0.49, in plane strain.
double free_stretch(double along);

/// A solver that works in the calling thread.
inline std::unique_ptr<Solver> solver_of(const Model& model, const Backend& backend)
{
  return make_solver(std::make_shared<const Model>(model), { backend, 1, 0 });
}

/// A plot with a logarithmic x axis, for voxel edges or numbers of voxels, and the legend below.
Plot convergence_plot(const std::string& title, const std::string& x_label, const std::string& y_label,
                      const std::vector<double>& x_ticks, const std::array<double, 2>& x_range, bool y_log = true);

}  // namespace frontalis
