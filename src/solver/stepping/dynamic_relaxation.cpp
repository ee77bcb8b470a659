#include "solver/stepping/dynamic_relaxation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace frontalis
{
namespace
{

constexpr double clear_change = 1e-4;  // relative change of displacements that clearly exceeds rounding errors
// The frequency is estimated only at speeds above this fraction of the highest speed so far, because at lower speeds
// rounding errors mask it.
constexpr double slow_share = 0.05;
constexpr double getting_going = 4;  // phase [rad] that the slowest motion must pass before its residual is meaningful
constexpr int enough_windows = 4;    // number of consecutive windows that must be within the tolerance

}  // namespace

DynamicRelaxation::DynamicRelaxation(const Settings& settings, const std::vector<double>& mass, double time,
                                     NodalVectors u, NodalVectors f)
    : settings_(settings),
      mass_(mass),
      begin_(time),
      window_begin_(time),
      u_(std::move(u)),
      f_(std::move(f)),
      damping_(settings.damping)
{
  result_.residual = 1;
}

void DynamicRelaxation::observe(double time, NodalVectors& u, const Forces& forces, double most_damping, bool last)
{
  const double change = distance(u_, u), moved = distance({}, u);
  result_.seconds = time - begin_;
  if (change < clear_change * moved && ++observations_ < settings_.longest_window && !last)
    return;
  observations_ = 0;
  const double speed = change / (time - std::exchange(window_begin_, time));
  forces(f_now_);
  fastest_ = std::max(fastest_, speed);
  const double squared = speed > slow_share * fastest_ ? rayleigh_quotient(u, f_now_, change) : 0;
  u_.swap(u);
  f_.swap(f_now_);
  // Damping is critical for the slowest motion found. With more damping, that motion would take longer to come to rest.
  if (squared > 0)
  {
    lowest_ = lowest_ > 0 ? std::min(lowest_, squared) : squared;
    damping_ = std::min(2 * std::sqrt(lowest_), most_damping);
  }
  // The remaining motion decays at the rate lowest_ / damping_ [1/s].
  if (lowest_ > 0)
    result_.residual = speed * damping_ / lowest_ / moved;
  else if (change == 0)
    result_.residual = 0;
  const bool begins = lowest_ > 0 && result_.seconds * std::sqrt(lowest_) < getting_going;
  good_windows_ = result_.residual <= settings_.tolerance && !begins ? good_windows_ + 1 : 0;
  result_.reached = good_windows_ == enough_windows;
}

// Root of the sum of m |a - b|^2. `a` may be empty and then stands for zeros.
double DynamicRelaxation::distance(const NodalVectors& a, const NodalVectors& b) const
{
  double sum = 0;
  for (std::size_t n = 0; n < b.size(); ++n)
    for (int axis = 0; axis < 3; ++axis)
    {
      const double apart = (a.empty() ? 0 : a[n][axis]) - b[n][axis];
      sum += mass_[n] * apart * apart;
    }
  return std::sqrt(sum);
}

// Squared frequency [1/s2] of the motion since the start of the window.
double DynamicRelaxation::rayleigh_quotient(const NodalVectors& u_now, const NodalVectors& f_now, double change) const
{
  double stiffness = 0;
  for (std::size_t n = 0; n < u_.size(); ++n)
    for (int axis = 0; axis < 3; ++axis)
      stiffness += (u_now[n][axis] - u_[n][axis]) * (f_now[n][axis] - f_[n][axis]);
  return change > 0 ? std::max(stiffness / (change * change), 0.0) : 0;
}

}  // namespace frontalis
