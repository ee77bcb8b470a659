#pragma once

#include "bake/vector.hpp"

#include <vector>

namespace frontalis
{

/// A smooth function of position that has given values at given places: biharmonic radial basis functions and a
/// polynomial (Carr et al., SIGGRAPH 2001).
class RadialField
{
public:
  enum class Polynomial
  {
    constant,  ///< for a field that levels off far from the places
    linear     ///< for a field that goes on with its slope, such as a distance
  };
  /// Places may not coincide. With `smoothing` > 0 [m] the field is smoother and may miss the values a little.
  RadialField(std::vector<Vector3d> places, const std::vector<double>& values, Polynomial polynomial, double smoothing);

  double operator()(const Vector3d& p) const;

private:
  std::vector<Vector3d> places_;
  std::vector<double> weights_;
  Eigen::Vector4d linear_{ 0, 0, 0, 0 };  ///< value at the origin and gradient of the polynomial
};

}  // namespace frontalis
