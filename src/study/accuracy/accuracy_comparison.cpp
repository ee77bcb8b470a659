// Compares variants with the reference or a closed form, finds the Pareto front, and chooses a setting from it.

#include "study/accuracy/accuracy_bench.hpp"

#include "frontalis/error.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

// Below this ratio of error to displacement, incomplete settling and rounding dominate, so that no order is observed.
constexpr double exactly_represented = 1e-3;
constexpr double least_motion = 1e-9;  // [m]; with less, errors relative to the motion mean nothing

const AccuracyRow& last_of_front(const AccuracyFindings& findings)
{
  if (findings.front.empty())
    throw Error("no setting could be measured; the table says why");
  return findings.rows[findings.front.back()];
}

}  // namespace

AccuracyRow row_of(const MeasuredVariant& measured, const AccuracyPlan& plan, const VariantMotion& reference,
                   const SkinAverage* average)
{
  AccuracyRow row;
  row.name = measured.name;
  row.setting = measured.setting;
  row.fault = measured.motion.fault;
  row.voxels = measured.motion.voxels > 0 ? measured.motion.voxels : NAN;
  if (!row.fault.empty())
    return row;
  try
  {
    const VariantMotion found = plan.exact ? settled_part(measured.motion) : measured.motion;
    const VariantMotion truth = plan.exact ? exact_motion(found, plan.exact) : reference;
    const auto errors = skin_errors(found, truth);
    row.error = worst(errors);
    row.settled = errors.back();
    row.landmark = landmark_error(found, truth);
    if (average != nullptr)
      row.averaged = average->error(found).rms;
  }
  catch (const Error& error)
  {
    row.fault = error.what();
    return row;
  }
  static_cast<VariantCost&>(row) = measured.cost;
  row.energy = measured.motion.energy;
  row.steps = measured.motion.steps;
  row.cost = row.steps * row.step + plan.frame_rate * row.skin;
  return row;
}

void estimate_reference_error(const AccuracyPlan& plan, const VariantBench& bench, const SkinAverage& average,
                              AccuracyFindings& findings)
{
  // Solutions with the reference's setting at each voxel edge, from coarse to fine.
  std::vector<const MeasuredVariant*> levels;
  for (const double edge : plan.edges)
    if (const MeasuredVariant* known = bench.find(reference_setting(plan.standard, edge));
        known != nullptr && known->motion.fault.empty())
      levels.push_back(known);
  if (levels.size() < 2)
    throw Error("only the reference, with voxels of " + millimetres(plan.edges.back()) +
                ", gave a motion; its error cannot be estimated without that of a larger voxel edge");
  const auto level = [&](std::size_t back) { return levels[levels.size() - back]; };
  const auto edge = [&](std::size_t back) { return level(back)->setting.profile.voxel[0]; };
  const auto difference = [&](std::size_t back)
  { return worst(skin_errors(level(back + 1)->motion, level(back)->motion)).rms; };
  if (levels.size() > 2)
    findings.order = observed_order({ { edge(3), edge(2), edge(1) } }, difference(2), difference(1));
  findings.reference_error = richardson(edge(2), edge(1), difference(1), findings.order);
  findings.motion = motion_size(level(1)->motion);
  if (findings.motion < least_motion)
    throw Error("the skin does not move in this motion; choose another by --expression");
  std::string plain, averaged;
  for (std::size_t back = levels.size() - 1; back > 0; --back)
  {
    const VariantMotion &coarse = level(back + 1)->motion, &fine = level(back)->motion;
    const std::string comma = plain.empty() ? "" : ", ";
    plain += comma + readable(1e3 * difference(back), 3);
    averaged += comma + readable(1e3 * worst(skin_errors(average.of(coarse), average.of(fine))).rms, 3);
  }
  findings.notes.push_back(
      fmt::format("With the reference's settings, each finer voxel edge changes the skin by {} mm "
                  "RMS, the averaged skin by {} mm.",
                  plain, averaged));
}

void note_orders(const AccuracyPlan& plan, const VariantBench& bench, AccuracyFindings& findings)
{
  const auto& done = bench.done();
  const auto sound = std::find_if(done.begin(), done.end(), [](const auto& v) { return v.motion.fault.empty(); });
  if (sound == done.end())
    throw Error("no setting could be measured: " + done.front().motion.fault);
  findings.motion = motion_size(exact_motion(sound->motion, plan.exact));
  for (const bool refined : { false, true })
  {
    std::vector<double> edges, errors;
    for (const double edge : plan.edges)
    {
      AccuracySetting setting = refined ? reference_setting(plan.standard, edge) : plan.standard;
      setting.profile.voxel.fill(edge);
      const MeasuredVariant* const known = bench.find(setting);
      if (known == nullptr || !known->motion.fault.empty())
        continue;
      edges.push_back(edge);
      errors.push_back(row_of(*known, plan, {}, nullptr).error.rms);
    }
    if (errors.size() < 2)
      continue;
    const std::string form = refined ? "Assumed strain" : "The standard setting's form";
    const double most = *std::max_element(errors.begin(), errors.end());
    if (most < exactly_represented * findings.motion)
      findings.notes.push_back(
          fmt::format("{}: the error is at most {:.2g} µm at any edge and comes from settling and rounding: "
                      "voxels represent this deformation exactly.",
                      form, 1e6 * most));
    else
      findings.notes.push_back(
          fmt::format("{}: the error falls with the voxel edge to the power {:.3g}.", form, slope(edges, errors)));
  }
}

// Whether a row was measured and can be a scene's profile.
static bool is_choice(const AccuracyRow& row, const Backend& backend)
{
  return row.fault.empty() && row.setting.time_scaling == 1 && row.setting.backend == backend && row.cost > 0 &&
         row.error.rms >= 0;
}

std::vector<std::size_t> pareto_front(const std::vector<AccuracyRow>& rows, const AccuracySetting& standard,
                                      double floor)
{
  std::vector<std::size_t> order;
  for (std::size_t r = 0; r < rows.size(); ++r)
    if (is_choice(rows[r], standard.backend))
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
  // A costlier setting comes to the front only if it is much more accurate, so that cheaper ones may not be there.
  const AccuracyRow* cheapest = nullptr;
  for (const AccuracyRow& row : findings.rows)
    if (is_choice(row, best.setting.backend) && row.error.rms <= tolerance &&
        (cheapest == nullptr || row.cost < cheapest->cost))
      cheapest = &row;
  if (cheapest != nullptr)
    return *cheapest;
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
