#pragma once

#include "frontalis/physics/number.hpp"

namespace frontalis
{
namespace physics
{

/// Scalar hourglass stiffness k [N/m] on the transformed displacements (force = k * mode). A mode u_x ~ x y with the
/// amplitude c at the corners gets the energy of pure bending, 1/2 k (8c)^2 = 2/3 E V c^2 / h^2, hence
///   k = E V / (48 h^2).
/// A scalar stiffness is objective: it does not depend on the element's rotation. h is the longest edge, so that no
/// direction is too stiff in bending.
template <class T>
FRONTALIS_LAW T hourglass_stiffness(T young, T volume, T longest_edge)
{
  return young * volume / (Number<T>::of(48) * longest_edge * longest_edge);
}

/// Young's modulus [Pa] of an isotropic solid.
template <class T>
FRONTALIS_LAW T young_modulus(T mu, T kappa)
{
  return Number<T>::of(9) * kappa * mu / (Number<T>::of(3) * kappa + mu);
}

/// True for the modes that one-point quadrature leaves without stiffness.
FRONTALIS_LAW constexpr bool is_hourglass_mode(int mode) { return mode == 3 || mode == 5 || mode == 6 || mode == 7; }

}  // namespace physics
}  // namespace frontalis
