#pragma once

#include "solver/stepping/step_backend.hpp"

#include <functional>

namespace frontalis
{

/// Finds the damping with which a motion comes to rest fastest, and the remaining distance from rest (Underwood 1983).
/// Damping is proportional to mass and critical for the lowest frequency of the motion. The frequency is found as the
/// Rayleigh quotient of changes of displacements, over windows that last until the change exceeds rounding errors.
class DynamicRelaxation
{
public:
  using Forces = std::function<void(NodalVectors& out)>;
  struct Settings
  {
    double tolerance;    ///< remaining motion divided by displacement, in mass-weighted norms
    double damping;      ///< initial damping, until a frequency has been found [1/s]
    int longest_window;  ///< in calls of observe()
  };

  /// Starts at a time [s], with displacements u and internal forces f. `mass` [kg] per node must outlive this object.
  DynamicRelaxation(const Settings& settings, const std::vector<double>& mass, double time, NodalVectors u,
                    NodalVectors f);

  /// Evaluates the motion at displacements u, which are moved from. `forces` computes the internal forces at u if they
  /// are needed. `last`: whether the motion ends here. Damping stays below `most_damping` [1/s].
  void observe(double time, NodalVectors& u, const Forces& forces, double most_damping, bool last);

  double damping() const { return damping_; }
  const Equilibrium& result() const { return result_; }

private:
  double distance(const NodalVectors& a, const NodalVectors& b) const;
  double rayleigh_quotient(const NodalVectors& u_now, const NodalVectors& f_now, double change) const;

  Settings settings_;
  const std::vector<double>& mass_;
  double begin_, window_begin_;  // [s]
  NodalVectors u_, f_, f_now_;   // displacements and forces at the start of the window; forces at its end
  int observations_ = 0;         // calls of observe() in this window
  double damping_;
  double lowest_ = 0;     // lowest squared frequency found [1/s2]
  double fastest_ = 0;    // highest speed so far
  int good_windows_ = 0;  // consecutive windows within the tolerance
  Equilibrium result_;
};

}  // namespace frontalis
