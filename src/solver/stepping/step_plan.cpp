// how a motion is cut into steps

#include "frontalis/solver/rigid_motion.hpp"
#include "solver/stepping/stepping_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace frontalis
{
namespace
{

constexpr double bone_way_a_step = 0.1;  // of the shortest edge of a voxel

double shortest_edge(const Model& model)
{
  const auto& h = model.spacing;
  return std::min({ h[0], h[1], h[2] });
}

}  // namespace

void StepPlan::activation(int step, float* out) const
{
  const auto f = static_cast<float>(fraction(step));
  for (std::size_t m = 0; m < begin.activation.size(); ++m)
    out[m] = begin.activation[m] + f * (end.activation[m] - begin.activation[m]);
}

ConstraintStep StepPlan::constraint_step(int step) const
{
  ConstraintStep now{ time + (step + 1) * dt, dt, {}, {} };
  for (std::size_t b = 0; b < begin.bone.size(); ++b)
  {
    now.bone.push_back(interpolate(begin.bone[b], end.bone[b], fraction(step)));
    now.bone_before.push_back(interpolate(begin.bone[b], end.bone[b], fraction(step - 1)));
  }
  return now;
}

std::vector<double> SteppingSolver::relaxations(const StepPlan& plan) const
{
  std::vector<double> seconds(plan.steps, 0);
  double elapsed = 0;
  for (int step = 0; step < plan.steps; ++step)
  {
    elapsed += plan.dt;
    if (step + 1 < plan.steps && elapsed < viscous_interval())
      continue;
    seconds[step] = settling_ ? 1e9 : elapsed;
    elapsed = 0;
  }
  return seconds;
}

// longest step in which no bone moves by more than a share of a voxel: what hangs on one that is faster would be turned
// inside out before the time step follows it
double SteppingSolver::steady_step(const std::vector<RigidTransform>& to, double seconds) const
{
  double fastest = 0;
  for (std::size_t b = 0; b < to.size(); ++b)
    fastest = std::max(fastest, fastest_way(controls_.bone[b], to[b], far_corner(*model_)));
  return fastest > 0 ? bone_way_a_step * shortest_edge(*model_) * seconds / fastest
                     : std::numeric_limits<double>::infinity();
}

// by how much the velocity of a bone changes where its new motion begins, in the shortest edge of a voxel [1/s]: over a
// time in which ways are straight
double SteppingSolver::jerk_of_bones(const std::vector<RigidTransform>& to, double seconds) const
{
  const double time = (bone_seconds_ > 0 ? std::min(seconds, bone_seconds_) : seconds) / 64;
  double farthest = 0;
  for (std::size_t b = 0; b < to.size() && time > 0; ++b)
  {
    const RigidTransform& from = controls_.bone[b];
    const RigidTransform onwards =
        bone_seconds_ > 0 ? interpolate(bone_before_[b], from, 1 + time / bone_seconds_) : from;
    farthest =
        std::max(farthest, farthest_way(onwards, interpolate(from, to[b], time / seconds), far_corner(*model_)) / time);
  }
  return farthest / shortest_edge(*model_);
}

}  // namespace frontalis
