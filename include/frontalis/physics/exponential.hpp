#pragma once

#include "frontalis/physics/number.hpp"

namespace frontalis::physics
{

/// Above this argument, exponentials in material laws continue along their tangent, so that they stay stiff but finite
/// in single precision.
constexpr double exponent_limit = 20;

/// e^x up to exponent_limit and its tangent beyond: a finite function with a continuous slope.
template <class T>
FRONTALIS_LAW T bounded_exponential(T x)
{
  using N = Number<T>;
  return N::exp(N::min(x, N::of(exponent_limit))) * (N::of(1) + N::max(x - N::of(exponent_limit), N::of(0)));
}

/// Derivative of bounded_exponential.
template <class T>
FRONTALIS_LAW T bounded_exponential_slope(T x)
{
  return Number<T>::exp(Number<T>::min(x, Number<T>::of(exponent_limit)));
}

}  // namespace frontalis::physics
