#include "frontalis/error.hpp"
#include "stepping_solver.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

using Vectors = SteppingSolver::Vectors;

double length(const Vectors& x)
{
  double sum = 0;
  for (const auto& p : x)
    sum += p[0] * p[0] + p[1] * p[1] + p[2] * p[2];
  return std::sqrt(sum);
}

}  // namespace

void SteppingSolver::forces_at(const Vectors&, Vectors&)
{
  throw Error("backend " + description() + " cannot find forces at other displacements");
}

Equilibrium SteppingSolver::settle(const Controls& target, double tolerance, double seconds)
{
  if (!(tolerance > 0) || !std::isfinite(tolerance))
    throw Error("equilibrium within " + std::to_string(tolerance) + ": allowed are tolerances above 0");
  check(seconds, target);
  // settled motion has no history: muscles have responded, viscous stresses relaxed, nothing is damped but at peaks
  struct Settling
  {
    explicit Settling(SteppingSolver& s) : solver(s)
    {
      solver.damping_ = 0;
      solver.settling_ = true;
    }
    ~Settling()
    {
      solver.damping_ = solver.model_->damping;
      solver.settling_ = false;
      solver.velocities_were_set();
    }
    SteppingSolver& solver;
  } const settling(*this);
  activation_ = target.activation;
  controls_.activation = target.activation;

  Equilibrium result;
  const double begin = time_;
  Vectors v, still(model_->nodes.size()), forces;
  double previous = 0, scale = 0;
  while (!result.reached && time_ - begin < seconds)
  {
    advance(std::min(steps_a_plan() * safe_time_step(), seconds - (time_ - begin)), target);
    velocities(v);
    double kinetic = 0;
    for (std::size_t n = 0; n < v.size(); ++n)
      kinetic += discretisation_.node_mass[n] * (v[n][0] * v[n][0] + v[n][1] * v[n][1] + v[n][2] * v[n][2]);
    const bool peak = kinetic < previous;
    previous = peak ? 0 : kinetic;
    if (!peak && kinetic > 0)
      continue;
    // one step from standstill shows the unbalanced force on each node that is free to move
    set_velocities(still);
    const double dt = safe_time_step();
    advance(dt, target);
    velocities(v);
    for (std::size_t n = 0; n < v.size(); ++n)
      for (double& x : v[n])
        x *= discretisation_.node_mass[n] / gain(dt);
    internal_forces(forces);
    const double unbalanced = length(v);
    scale = std::max({ scale, unbalanced, length(forces) });
    result.residual = scale > 0 ? unbalanced / scale : 0;
    result.reached = result.residual <= tolerance;
  }
  result.seconds = time_ - begin;
  return result;
}

}  // namespace frontalis
