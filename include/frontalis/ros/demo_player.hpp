#pragma once

#include "frontalis/runner/named_controls.hpp"

#include <map>
#include <string>
#include <vector>

namespace frontalis
{

/// The model's demo as a function of simulated time, repeated in rounds without end. Each phase ramps linearly from the
/// expression of the phase before to its own and then holds it. The first round starts relaxed. A ramp that is longer
/// than its phase is shortened to the phase.
class DemoPlayer
{
public:
  explicit DemoPlayer(const Model& model);

  /// Whether the model has no demo.
  bool empty() const { return !(period_ > 0); }
  /// Duration of one round [s].
  double period() const { return period_; }
  /// The activation of every muscle, 0..1, at a simulated time [s]. Times below 0 count as 0.
  std::map<std::string, double> activation(double time) const;

private:
  std::vector<std::string> muscles_;
  ActivationCurve first_round_, later_rounds_;
  double period_ = 0;
};

}  // namespace frontalis
