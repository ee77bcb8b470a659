#include "frontalis/ros/demo_player.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{

DemoPlayer::DemoPlayer(const Model& model)
{
  for (const auto& muscle : model.muscles)
    muscles_.push_back(muscle.name);
  std::vector<float> target(muscles_.size(), 0);
  const auto add = [&](double time)
  {
    first_round_.time.push_back(time);
    first_round_.activation.push_back(target);
  };
  for (const auto& entry : model.demo)
  {
    if (!(entry.seconds > 0))
      continue;
    add(period_);
    target.assign(muscles_.size(), 0);
    if (entry.expression >= 0)
      for (const auto& [muscle, activation] : model.expressions.at(entry.expression).activation)
        target.at(muscle) = activation;
    add(period_ + std::min(entry.ramp, entry.seconds));
    period_ += entry.seconds;
  }
  // the first round starts relaxed, later ones from the expression of the last phase
  later_rounds_ = first_round_;
  if (!empty())
    later_rounds_.activation.front() = target;
}

std::map<std::string, double> DemoPlayer::activation(double time) const
{
  std::map<std::string, double> out;
  if (empty())
    return out;
  const double since = std::max(0.0, time);
  const double round = std::floor(since / period_);
  const std::vector<float> value = (round < 1 ? first_round_ : later_rounds_).at(since - round * period_);
  for (std::size_t muscle = 0; muscle < muscles_.size(); ++muscle)
    out[muscles_[muscle]] = std::clamp(value[muscle], 0.0f, 1.0f);
  return out;
}

}  // namespace frontalis
