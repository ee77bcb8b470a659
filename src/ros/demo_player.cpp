#include "frontalis/ros/demo_player.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{

DemoPlayer::DemoPlayer(std::shared_ptr<const Model> model) : model_(std::move(model))
{
  first_round_ = demo_curve(*model_, rest_controls(*model_));
  later_rounds_ = demo_curve(*model_, first_round_.controls.back());
  period_ = first_round_.time.back();
  const RigidTransform rest;
  for (std::size_t bone = 0; bone < model_->bones.size(); ++bone)
    if (std::any_of(first_round_.controls.begin(), first_round_.controls.end(),
                    [&](const Controls& knot) { return knot.bone[bone] != rest; }))
      moved_.push_back(bone);
}

bool DemoPlayer::moves(const std::string& bone) const
{
  return std::any_of(moved_.begin(), moved_.end(), [&](std::size_t moved) { return model_->bones[moved] == bone; });
}

Controls DemoPlayer::at(double time) const
{
  const double since = std::max(0.0, time), round = std::floor(since / period_);
  return (round < 1 ? first_round_ : later_rounds_).at(since - round * period_);
}

std::map<std::string, double> DemoPlayer::activation(double time) const
{
  std::map<std::string, double> out;
  if (empty())
    return out;
  const Controls now = at(time);
  for (std::size_t muscle = 0; muscle < now.activation.size(); ++muscle)
    out[model_->muscles[muscle].name] = std::clamp(now.activation[muscle], 0.0f, 1.0f);
  return out;
}

std::string DemoPlayer::expression(double time) const
{
  std::string name = empty() ? "" : "relax";
  if (empty())
    return name;
  const double since = std::max(0.0, time);
  double left = since - std::floor(since / period_) * period_;
  for (const Model::DemoPhase& phase : model_->demo)
  {
    if (phase.expression > -2)
      name = phase.expression < 0 ? "relax" : model_->expressions.at(phase.expression).name;
    left -= std::max(0.0, phase.seconds);
    if (left < 0)
      break;
  }
  return name;
}

std::map<std::string, RigidTransform> DemoPlayer::bones(double time) const
{
  std::map<std::string, RigidTransform> out;
  if (moved_.empty())
    return out;
  const Controls now = at(time);
  for (const std::size_t bone : moved_)
    out[model_->bones[bone]] = motion_in_face(*model_, now.bone[bone]);
  return out;
}

}  // namespace frontalis
