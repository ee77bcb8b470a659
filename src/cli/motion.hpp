#pragma once

#include "frontalis/solver/guard.hpp"

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace frontalis
{

/// Activations over time: linear between knots, constant after the last.
struct ActivationCurve
{
  std::vector<double> time;  ///< ascending from 0 [s], on the clock on which activations are given
  std::vector<std::vector<float>> activation;

  std::vector<float> at(double seconds) const;
};

/// From rest to a target over a ramp.
ActivationCurve ramp_to(const std::vector<float>& target, double ramp);

/// Reads a table: a header `time,MUSCLE,MUSCLE,...`, then a row a knot, times ascending; before the first row muscles
/// go linearly from rest. Throws Error with the file's line.
ActivationCurve read_activation_curve(const std::string& path, const Model& model);

/// Plays a curve on a solver, watched by a guard or not, and takes bones to their place over the first `ramp` seconds.
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

  /// Advances to `time` on the activations' clock, from knot to knot; `go_on` is asked every few thousand steps, and
  /// where it says no, the motion ends there.
  void advance_to(double time);
  double time() const { return time_; }  ///< reached

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
