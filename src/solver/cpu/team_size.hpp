#pragma once

#include <vector>

namespace frontalis
{

/// Chooses how many threads of a team work. All threads meet several times in each time step. One that shares its core
/// with another program therefore delays all others, and the team can be faster without it. Other numbers are tried for
/// a short time while threads are kept from running, and from time to time while fewer than all work. Results do not
/// depend on the number.
class TeamSize
{
public:
  explicit TeamSize(int most) : most_(most), working_(most) {}

  int most() const { return most_; }
  int working() const { return working_; }

  /// Tells what the working threads did: time steps, in `seconds` of wall time, of which each thread ran `ran[thread]`.
  void add(int steps, double seconds, const std::vector<double>& ran);

private:
  struct Trial
  {
    int threads;
    double rate;  ///< [steps per second]
  };

  void end_period();
  void plan_trial(int threads);

  int most_, working_;
  int steps_ = 0;                     // of the present period, as the two below
  double seconds_ = 0;                // [s]
  std::vector<double> ran_;           // [s]
  double now_ = 0, next_search_ = 0;  // [s] of work since construction
  double pause_ = 1;                  // [s] between searches; longer while they find nothing better
  std::vector<Trial> trials_;         // of the present search, first that of the number with which it began
  std::vector<int> planned_;
};

}  // namespace frontalis
