// the Pareto front, and the choice of a setting from it

#include "study/accuracy/accuracy_front.hpp"

#include "frontalis/error.hpp"
#include "frontalis/study/table.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace frontalis
{
namespace
{

const AccuracyRow& last_of_front(const AccuracyFindings& findings)
{
  if (findings.front.empty())
    throw Error("no setting could be measured; the table says why");
  return findings.rows[findings.front.back()];
}

}  // namespace

std::vector<std::size_t> pareto_front(const std::vector<AccuracyRow>& rows, const AccuracySetting& standard,
                                      double floor)
{
  std::vector<std::size_t> order;
  for (std::size_t r = 0; r < rows.size(); ++r)
    if (rows[r].fault.empty() && rows[r].is_profile(standard) && rows[r].cost > 0 && rows[r].error.rms >= 0)
      order.push_back(r);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return rows[a].cost < rows[b].cost; });
  std::vector<std::size_t> front;
  for (const std::size_t r : order)
    if (front.empty() || std::max(rows[r].error.rms, floor) < 0.95 * std::max(rows[front.back()].error.rms, floor))
      front.push_back(r);
  return front;
}

const AccuracyRow& cheapest_within(const AccuracyFindings& findings, double tolerance)
{
  const AccuracyRow& best = last_of_front(findings);
  if (tolerance < findings.reference_error)
    throw Error(
        fmt::format("a tolerance of {} is below the error of the reference itself, {}: nothing is claimed below it; "
                    "take a finer reference",
                    millimetres(tolerance), millimetres(findings.reference_error)));
  for (const std::size_t r : findings.front)
    if (findings.rows[r].error.rms <= tolerance)
      return findings.rows[r];
  throw Error(
      fmt::format("no setting that was measured has an error of at most {}; the most accurate, {}, has {} at "
                  "{:.3g} s per simulated second",
                  millimetres(tolerance), best.name, millimetres(best.error.rms), best.cost));
}

const AccuracyRow& most_accurate_within(const AccuracyFindings& findings, double seconds)
{
  last_of_front(findings);
  const AccuracyRow& cheapest = findings.rows[findings.front.front()];
  const AccuracyRow* best = nullptr;
  for (const std::size_t r : findings.front)
    if (findings.rows[r].cost <= seconds)
      best = &findings.rows[r];
  if (best == nullptr)
    throw Error(
        fmt::format("no setting that was measured takes at most {:.3g} s per simulated second; the cheapest, {}, "
                    "takes {:.3g} s with an error of {}",
                    seconds, cheapest.name, cheapest.cost, millimetres(cheapest.error.rms)));
  return *best;
}

}  // namespace frontalis
