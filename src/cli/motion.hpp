#pragma once

#include "frontalis/solver/guard.hpp"

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace frontalis
{

/// Activations over time, linear between knots and constant after the last one.
struct ActivationCurve
{
  std::vector<double> time;  ///< ascending from 0 [s], on the clock of the activations
  std::vector<std::vector<float>> activation;

  std::vector<float> at(double seconds) const;
};

/// From rest to a target over a ramp.
ActivationCurve ramp_to(const std::vector<float>& target, double ramp);

/// Reads a table with a header `time,MUSCLE,MUSCLE,...` and one row per knot, times ascending. Up to the first row
/// activations grow linearly from 0. Throws Error with the file's line.
ActivationCurve read_activation_curve(const std::string& path, const Model& model);

/// Plays a curve on a solver, with or without a guard, and moves bones to their poses over the first `ramp` seconds.
class Motion
{
public:
  Motion(Solver& solver, Guard* guard, const Model& model, ActivationCurve curve, std::vector<RigidTransform> bones,
         double ramp, std::function<bool()> go_on)
      : solver_(solver),
        guard_(guard),
        scaling_(model.time_scaling),
        curve_(std::move(curve)),
        bones_(std::move(bones)),
        ramp_(ramp),
        go_on_(std::move(go_on))
  {
  }

  /// Advances to `time` on the clock of the activations. `go_on` is called every few thousand steps and ends the motion
  /// where it returns false.
  void advance_to(double time);
  double time() const { return time_; }  ///< that is reached

private:
  void advance(double end);
  void take_slice(double time);

  Solver& solver_;
  Guard* guard_;  // may be none
  double scaling_;
  ActivationCurve curve_;
  std::vector<RigidTransform> bones_;
  double ramp_;
  std::function<bool()> go_on_;
  double time_ = 0;
};

}  // namespace frontalis
