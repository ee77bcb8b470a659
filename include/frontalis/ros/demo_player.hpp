#pragma once

#include "frontalis/runner/named_controls.hpp"

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace frontalis
{

/// The model's demo (demo_curve()) as a function of simulated time, repeated in rounds without end. The first round
/// starts at rest.
class DemoPlayer
{
public:
  explicit DemoPlayer(std::shared_ptr<const Model> model);

  /// True if the model has no demo.
  bool empty() const { return !(period_ > 0); }
  bool moves(const std::string& bone) const;
  /// Duration of one round [s].
  double period() const { return period_; }
  /// The activation of every muscle, 0..1, at a simulated time [s]. Times below 0 count as 0.
  std::map<std::string, double> activation(double time) const;
  /// The expression at a simulated time [s], which may still be forming; "relax" at rest, empty if the model has no
  /// demo.
  std::string expression(double time) const;
  /// The motion in the face frame of each bone that the demo moves, at a simulated time [s].
  std::map<std::string, RigidTransform> bones(double time) const;

private:
  Controls at(double time) const;

  const std::shared_ptr<const Model> model_;
  std::vector<std::size_t> moved_;  ///< bones that the demo moves
  ControlCurve first_round_, later_rounds_;
  double period_ = 0;
};

}  // namespace frontalis
