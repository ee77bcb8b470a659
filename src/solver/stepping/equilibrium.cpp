#include "frontalis/error.hpp"
#include "solver/stepping/stepping_solver.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
void SteppingSolver::forces_at(const Vectors&, Vectors&)
{
  throw Error("backend " + description() + " cannot find forces at other displacements");
}

// Rayleigh quotient of a change of displacements: the frequency squared [1/s2] of the motion
double SteppingSolver::rayleigh_quotient(const Vectors& u, const Vectors& f, const Vectors& u_now,
                                         const Vectors& f_now) const
{
  double stiffness = 0;
  for (std::size_t n = 0; n < u.size(); ++n)
    for (int axis = 0; axis < 3; ++axis)
      stiffness += (u_now[n][axis] - u[n][axis]) * (f_now[n][axis] - f[n][axis]);
  const double change = distance(u, u_now);
  return change > 0 ? std::max(stiffness / (change * change), 0.0) : 0;
}

// between two states, weighted by mass: root of the sum of m |a - b|^2
double SteppingSolver::distance(const Vectors& a, const Vectors& b) const
{
  double sum = 0;
  for (std::size_t n = 0; n < a.size(); ++n)
    for (int axis = 0; axis < 3; ++axis)
      sum += discretisation_.node_mass[n] * (a[n][axis] - b[n][axis]) * (a[n][axis] - b[n][axis]);
  return std::sqrt(sum);
}

Equilibrium SteppingSolver::settle(const Controls& target, double tolerance, double seconds,
                                   const std::function<bool(const Equilibrium&)>& go_on)
{
  if (!(tolerance > 0) || !std::isfinite(tolerance))
    throw Error("equilibrium within " + std::to_string(tolerance) + ": allowed are tolerances above 0");
  check(seconds, target);
  // settled motion has no history: muscles have responded, viscous stresses relaxed
  struct Settling
  {
    explicit Settling(SteppingSolver& s) : solver(s) { solver.settling_ = true; }
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

  // windows last until the change is a share of the displacement that rounding errors in float cannot make
  constexpr double clear = 1e-4;
  const int longest = std::max(1, 2048 / steps_a_look());  // looks
  Equilibrium result;
  result.residual = 1;
  const double begin = time_;
  double lowest = 0, fastest = 0;
  Vectors u, f, u_now, f_now;
  const Vectors rest(model_->nodes.size());
  displacements(u);
  internal_forces(f);
  double opened = time_;
  int looks = 0;
  for (int good = 0; good < 4 && time_ - begin < seconds;)
  {
    advance(std::min(steps_a_look() * safe_time_step(), seconds - (time_ - begin)), target);
    displacements(u_now);
    const double change = distance(u, u_now), moved = distance(rest, u_now);
    result.seconds = time_ - begin;
    if (change < clear * moved && ++looks < longest && result.seconds < seconds)
    {
      if (go_on && !go_on(result))
        break;
      continue;
    }
    looks = 0;
    const double window = time_ - opened;
    opened = time_;
    internal_forces(f_now);
    // the motion tells its frequency while it is fast; later rounding errors drown it
    const double speed = change / window;
    fastest = std::max(fastest, speed);
    const double squared = speed > 0.05 * fastest ? rayleigh_quotient(u, f, u_now, f_now) : 0;
    u.swap(u_now);
    f.swap(f_now);
    // critical for the slowest motion seen, and not more: what is faster must not slow it down
    if (squared > 0)
    {
      lowest = lowest > 0 ? std::min(lowest, squared) : squared;
      damping_ = std::min(2 * std::sqrt(lowest), 1 / safe_time_step());
    }
    // it creeps by lowest / damping of what is left a second; at the begin nothing has got going yet
    if (lowest > 0)
      result.residual = speed * damping_ / lowest / moved;
    else if (change == 0)
      result.residual = 0;
    const bool under_way = lowest > 0 && result.seconds * std::sqrt(lowest) < 4;
    good = result.residual <= tolerance && !under_way ? good + 1 : 0;
    result.reached = good == 4;
    if (go_on && !go_on(result))
      break;
  }
  result.seconds = time_ - begin;
  return result;
}

}  // namespace frontalis
