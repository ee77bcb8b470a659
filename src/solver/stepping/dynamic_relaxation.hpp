#pragma once

#include "solver/stepping/step_backend.hpp"

#include <functional>

namespace frontalis
{

/// Finds the damping with which a motion comes to rest fastest, and how far it still is from there (Underwood 1983).
/// Mass-proportional damping is critical for the lowest frequency that the motion shows: the Rayleigh quotient of its
/// change of displacements, over windows that last until that change is clear of rounding errors.
class DynamicRelaxation
{
public:
  using Forces = std::function<void(NodalVectors& out)>;
  struct Settings
  {
    double tolerance;    ///< of what is left of the motion over the displacement, norms weighted by mass
    double damping;      ///< until the motion has shown a frequency [1/s]
    int longest_window;  ///< looks
  };

  /// Begins at a time [s], with displacements u and internal forces f. `mass` [kg] per node must outlive it.
  DynamicRelaxation(const Settings& settings, const std::vector<double>& mass, double time, NodalVectors u,
                    NodalVectors f);

  /// The motion has come to displacements u, which are taken away; `forces` gives the internal forces there where they
  /// are needed. `last`: it ends here. Damping is not raised above `most_damping` [1/s].
  void look(double time, NodalVectors& u, const Forces& forces, double most_damping, bool last);

  double damping() const { return damping_; }
  const Equilibrium& result() const { return result_; }

private:
  double distance(const NodalVectors& a, const NodalVectors& b) const;
  double rayleigh_quotient(const NodalVectors& u_now, const NodalVectors& f_now, double change) const;

  Settings settings_;
  const std::vector<double>& mass_;
  double begin_, window_begin_;  // [s]
  NodalVectors u_, f_, f_now_;   // where the window began; where it ended
  int looks_ = 0;                // in this window
  double damping_;
  double lowest_ = 0;     // frequency squared that was seen [1/s2]
  double fastest_ = 0;    // speed that was seen
  int good_windows_ = 0;  // in a row
  Equilibrium result_;
};

}  // namespace frontalis
