// the settings that no other beats, and the choice among them

#include "study/accuracy/accuracy_front.hpp"

#include "frontalis/error.hpp"
#include "frontalis/study/table.hpp"

#include <algorithm>

namespace frontalis
{
namespace
{

const AccuracyRow& last_of_front(const AccuracyFindings& findings)
{
  if (findings.front.empty())
    throw Error("no setting could be measured: the table says why");
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
    throw Error("a tolerance of " + millimetres(tolerance) + " is below the error of the reference itself, " +
                millimetres(findings.reference_error) + ": nothing is claimed below it; take a finer reference");
  for (const std::size_t r : findings.front)
    if (findings.rows[r].error.rms <= tolerance)
      return findings.rows[r];
  throw Error("no setting that was measured has an error of at most " + millimetres(tolerance) +
              "; the most accurate, " + best.name + ", has " + millimetres(best.error.rms) + " at " +
              readable(best.cost, 3) + " s a simulated second");
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
    throw Error("no setting that was measured takes at most " + readable(seconds, 3) +
                " s a simulated second; the cheapest, " + cheapest.name + ", takes " + readable(cheapest.cost, 3) +
                " s with an error of " + millimetres(cheapest.error.rms));
  return *best;
}

}  // namespace frontalis
