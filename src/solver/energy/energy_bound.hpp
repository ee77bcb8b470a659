#pragma once

#include "frontalis/model/model.hpp"
#include "frontalis/solver/solver.hpp"

#include <vector>

namespace frontalis
{

/// An upper bound of the energy that a motion can have. Guard documents the formula.
class EnergyBound
{
public:
  explicit EnergyBound(const Model& model);

  /// A part of the motion, and the inputs that may have driven it.
  struct Interval
  {
    double energy = 0;              ///< energy at the start of the interval, with that of pushed bodies [J]
    double begin = 0, end = 0;      ///< [s]
    std::vector<float> activation;  ///< largest activation of each muscle
    std::vector<double> bone_way;   ///< length of each bone's path [m]
    double largest_internal = 0;    ///< largest internal energy before the interval [J]
  };
  double most(const Interval& interval) const;  ///< upper bound of the energy at the end of the interval [J]
  double floor() const { return floor_; }       ///< energy of a strain of 1e-4 everywhere [J]

private:
  // The voxels at a bone or at prescribed nodes. `stiffness`: eight times the sum of their stiffness bounds [N/m].
  struct Driven
  {
    std::int32_t index;  // index of the bone or load
    double stiffness;
  };

  const Model& model_;
  // Roots of sums of f^2 / (2 m) [sqrt(J)/s]: of gravity and ramped loads, and of each activated load, with the index
  // of its activation.
  double push_ = 0;
  std::vector<std::pair<std::int32_t, double>> activated_push_;
  double floor_ = 0;
  double stored_ = 0;  // energy that effects store at rest [J]
  bool viscous_ = false;
  std::vector<double> fibres_;  // one per muscle: tension times volume [J]
  std::vector<Driven> bones_, prescribed_;
};

}  // namespace frontalis
