#include "frontalis/ros/demo_player.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{

DemoPlayer::DemoPlayer(const Model& model)
{
  for (const auto& muscle : model.muscles)
    muscles_.push_back(muscle.name);
  for (const auto& entry : model.demo)
  {
    if (!(entry.seconds > 0))
      continue;
    Phase phase;
    phase.target.assign(muscles_.size(), 0.0);
    if (entry.expression >= 0)
      for (const auto& [muscle, activation] : model.expressions.at(entry.expression).activation)
        phase.target.at(muscle) = activation;
    phase.begin = period_;
    phase.ramp = std::min(entry.ramp, entry.seconds);
    period_ += entry.seconds;
    phases_.push_back(phase);
  }
}

std::map<std::string, double> DemoPlayer::activation(double time) const
{
  std::map<std::string, double> out;
  if (phases_.empty())
    return out;

  const double since = std::max(0.0, time);
  const double round = std::floor(since / period_);
  const double within = since - round * period_;
  std::size_t index = 0;
  while (index + 1 < phases_.size() && within >= phases_[index + 1].begin)
    ++index;

  // the very first phase starts relaxed, the first phase of later rounds from the expression of the last phase
  const Phase& phase = phases_[index];
  const Phase& last = phases_[index > 0 ? index - 1 : phases_.size() - 1];
  const bool from_rest = index == 0 && round < 1;
  const double done = phase.ramp > 0 ? std::min(1.0, (within - phase.begin) / phase.ramp) : 1.0;
  for (std::size_t muscle = 0; muscle < muscles_.size(); ++muscle)
  {
    const double start = from_rest ? 0.0 : last.target[muscle];
    out[muscles_[muscle]] = std::clamp(start + done * (phase.target[muscle] - start), 0.0, 1.0);
  }
  return out;
}

}  // namespace frontalis
