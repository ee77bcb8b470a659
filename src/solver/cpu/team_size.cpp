#include "solver/cpu/team_size.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace frontalis
{
namespace
{

constexpr double period = 0.05;  // [s] of work over which rates are compared
constexpr double most_pause = 8, least_pause = 1;
constexpr double free_share = 0.85;  // A thread that runs for less of its time shares its core.
constexpr double least_gain = 1.05;  // by which another number of threads must be faster

}  // namespace

void TeamSize::add(int steps, double seconds, const std::vector<double>& ran)
{
  if (most_ == 1)
    return;
  ran_.resize(ran.size(), 0);
  for (std::size_t thread = 0; thread < ran.size(); ++thread)
    ran_[thread] += ran[thread];
  steps_ += steps;
  seconds_ += seconds;
  if (seconds_ < period)
    return;
  end_period();
  steps_ = 0;
  seconds_ = 0;
  ran_.clear();
}

void TeamSize::plan_trial(int threads)
{
  const int number = std::max(1, threads);
  const auto is_known = [&](const Trial& trial) { return trial.threads == number; };
  if (std::none_of(trials_.begin(), trials_.end(), is_known) &&
      std::find(planned_.begin(), planned_.end(), number) == planned_.end())
    planned_.push_back(number);
}

void TeamSize::end_period()
{
  now_ += seconds_;
  const auto held =
      static_cast<int>(std::count_if(ran_.begin(), ran_.end(), [&](double s) { return s < free_share * seconds_; }));
  if (trials_.empty() && (now_ < next_search_ || (held == 0 && working_ == most_)))
    return;
  trials_.push_back({ working_, steps_ / seconds_ });
  // If all are held, as by a limit of processor time, as many may be enough as ran at a time on average.
  const auto ran = std::lround(std::accumulate(ran_.begin(), ran_.end(), 0.0) / seconds_);
  if (held > 0)
    plan_trial(held < working_ ? working_ - held : std::min(working_ - 1, static_cast<int>(ran)));
  if (trials_.size() == 1)
    plan_trial(most_);
  if (!planned_.empty())
  {
    working_ = planned_.back();
    planned_.pop_back();
    return;
  }
  const auto fastest =
      std::max_element(trials_.begin(), trials_.end(), [](const Trial& a, const Trial& b) { return a.rate < b.rate; });
  const Trial& before = trials_.front();
  const bool is_better = fastest->rate > least_gain * before.rate;
  working_ = is_better ? fastest->threads : before.threads;
  pause_ = is_better ? least_pause : std::min(most_pause, 2 * pause_);
  next_search_ = now_ + pause_;
  trials_.clear();
}

}  // namespace frontalis
