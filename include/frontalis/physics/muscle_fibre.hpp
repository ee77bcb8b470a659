#pragma once

#include "frontalis/physics/number.hpp"

namespace frontalis
{
namespace physics
{

/// Constants of the tension-length relation (Blemker, Pinsky & Delp 2005, J. Biomech. 38:657), optimal fibre stretch 1.
constexpr double fibre_optimal_stretch = 1.0;
constexpr double fibre_linear_stretch = 1.4;  ///< passive fibre stress is linear above this stretch
constexpr double fibre_p1 = 0.05;
constexpr double fibre_p2 = 6.6;

/// Active tension of a fibre, 0..1, at normalised length l = stretch / optimal stretch.
template <class T>
FRONTALIS_LAW T active_tension(T l)
{
  using N = Number<T>;
  const T rising = N::of(9) * (l - N::of(0.4)) * (l - N::of(0.4));
  const T plateau = N::of(1) - N::of(4) * (N::of(1) - l) * (N::of(1) - l);
  const T falling = N::of(9) * (l - N::of(1.6)) * (l - N::of(1.6));
  T f = N::select(l <= N::of(0.6), rising, plateau);
  f = N::select(l > N::of(1.4), falling, f);
  f = N::select(l <= N::of(0.4), N::of(0), f);
  return N::select(l >= N::of(1.6), N::of(0), f);
}

/// Passive tension of a fibre divided by the stress reference: 0 in compression, linear with continuous slope above
/// 1.4.
template <class T>
FRONTALIS_LAW T passive_tension(T l)
{
  using N = Number<T>;
  const double end = fibre_linear_stretch / fibre_optimal_stretch;
  const T e = N::exp(N::of(fibre_p2) * (N::min(N::max(l, N::of(1)), N::of(end)) - N::of(1)));
  const T curve = N::of(fibre_p1) * (e - N::of(1));
  return curve + N::of(fibre_p1 * fibre_p2) * e * N::max(l - N::of(end), N::of(0));
}

/// Second Piola-Kirchhoff stress S along a fibre [Pa]; its tensor is S a0 (x) a0. with_length: 1 applies the
/// tension-length relation: the nominal stress, the force per area at rest, is N = stress_reference (passive +
/// activation active) with the tensions at the fibre's stretch, and S = N / stretch. 0 gives the constant S =
/// activation stress_reference. Both depend on the stretch alone, so that a fibre at constant activation has a
/// potential. At constant volume the Cauchy stress is N stretch, as published. With that Cauchy stress at any volume, N
/// would be proportional to J, and a fibre would do work in cycles of volume and stretch, from which motions grow.
/// with_passive: 1 adds the passive part. Passive = false omits that part at compile time.
template <class T, bool Passive = true>
FRONTALIS_LAW T fibre_stress(T stretch_squared, T stress_reference, T activation, T with_length, T with_passive)
{
  using N = Number<T>;
  const T stretch = N::sqrt(N::max(stretch_squared, N::of(1e-6)));
  const T l = stretch * N::of(1.0 / fibre_optimal_stretch);
  const T to_second_piola = N::of(1.0 / fibre_optimal_stretch) / stretch;
  const T active = activation * (with_length * (active_tension(l) * to_second_piola - N::of(1)) + N::of(1));
  const T passive = Passive ? with_passive * passive_tension(l) * to_second_piola : N::of(0);
  return stress_reference * (active + passive);
}

/// Largest slopes of the nominal fibre stress with respect to stretch, divided by the stress reference, at full
/// activation. The active part is steepest at l = 0.6 (slope 18 * 0.2) and the passive part above l = 1.4 (slope p1 p2
/// e^(0.4 p2)). The time step must allow for the active slope, or for the sum of both if the fibres have a passive
/// part. Across the fibre its stiffness is N / stretch, which is less.
constexpr double active_slope_bound = 3.6;
constexpr double passive_slope_bound = 4.63;

}  // namespace physics
}  // namespace frontalis
