// Runs a study of accuracy: the reference first, then each knob, then combinations of knobs.

#include "study/accuracy/accuracy_bench.hpp"

#include "frontalis/error.hpp"
#include "frontalis/study/table.hpp"
#include "frontalis/suggestion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace frontalis
{
namespace
{

constexpr double averaged_voxels = 1.5;  // standard deviation of the average, in voxels of the standard setting

bool is_too_fine(const AccuracySetting& setting, const AccuracyPlan& plan)
{
  return !plan.exact && setting.profile.voxel[0] < 1.01 * plan.edges.back();
}

class Study
{
public:
  Study(const AccuracyPlan& plan, const ModelMaker& maker, const AccuracyProgress& progress)
      : plan_(plan), bench_(plan_, maker, progress)
  {
  }

  AccuracyFindings run();

private:
  void choose_reference();
  void measure_knobs();
  void measure_combinations();
  void check_reference();

  AccuracyRow row(const MeasuredVariant& measured) const
  {
    return row_of(measured, plan_, motion_of(reference_), average_ ? &*average_ : nullptr);
  }
  AccuracySetting reference_at(double edge) const { return reference_setting(plan_.standard, edge); }
  // Number of voxel edges for variants. Without a closed form the last edge is for the reference only.
  std::size_t variant_levels() const { return plan_.edges.size() - (plan_.exact ? 0 : 1); }
  const VariantMotion& motion_of(std::size_t variant) const { return bench_.done()[variant].motion; }
  AccuracyPlan plan_;
  VariantBench bench_;
  std::size_t reference_ = 0;
  std::optional<SkinAverage> average_;  // empty if there is a closed form
  AccuracyFindings findings_;
};

// Measures the reference's setting from the largest to the smallest voxel edge. The wall times at earlier edges predict
// those at later ones, which are left out if the budget does not suffice.
void Study::choose_reference()
{
  auto& edges = plan_.edges;
  std::vector<AccuracySetting> levels(edges.size());
  std::transform(edges.begin(), edges.end(), levels.begin(), [&](double edge) { return reference_at(edge); });
  bench_.expect(levels);
  for (std::size_t level = 0; level < edges.size(); ++level)
  {
    if (level == variant_levels())
      bench_.set_reference(levels[level]);
    const double takes = bench_.predicted(levels[level]);
    const double share = plan_.budget > 0 && level > 1 ? takes / plan_.budget : 0;
    AccuracyPlan shorter = plan_;
    shorter.edges.resize(level);
    const bool is_needed = !plan_.exact && level > 2 && is_too_fine(plan_.standard, shorter);
    if (level > 2 && share > 0.4 && !is_needed)
    {
      findings_.notes.push_back(
          fmt::format("Voxels of {}{} were left out: they would take about {:.2g} s, too much of the budget.",
                      millimetres(edges[level]), level + 1 < edges.size() ? " and less" : "", takes));
      edges.resize(level);
      break;
    }
    if (share > 0.8)
      throw Error(
          fmt::format("a budget of {:.4g} s is too small for a comparison: the reference of {} alone takes about "
                      "{:.2g} s here; allow more, or begin with larger voxels",
                      plan_.budget, millimetres(edges[level]), takes));
    bench_.measure(levels[level]);
  }
  if (plan_.exact)
    return;
  findings_.reference = reference_at(edges.back());
  bench_.set_reference(findings_.reference);
  reference_ = bench_.measure(findings_.reference);
  if (const std::string& fault = motion_of(reference_).fault; !fault.empty())
    throw Error("the reference, with voxels of " + millimetres(edges.back()) +
                ", has no motion to compare with: " + fault);
  findings_.averaged_over = averaged_voxels * plan_.standard.profile.voxel[0];
  average_.emplace(motion_of(reference_), findings_.averaged_over);
}

void Study::measure_knobs()
{
  const std::size_t standard = bench_.measure(plan_.standard);
  std::vector<Sweep> sweeps = knob_sweeps(plan_, bench_.critical_time_step());
  const auto& knobs = plan_.knobs;  // empty: all
  const auto unwanted = [&](const Sweep& sweep)
  { return !knobs.empty() && std::find(knobs.begin(), knobs.end(), sweep.knob) == knobs.end(); };
  sweeps.erase(std::remove_if(sweeps.begin(), sweeps.end(), unwanted), sweeps.end());
  std::vector<AccuracySetting> all;
  for (const Sweep& sweep : sweeps)
    all.insert(all.end(), sweep.settings.begin(), sweep.settings.end());
  bench_.expect(all);
  for (const Sweep& sweep : sweeps)
  {
    KnobLine line{ sweep.knob, sweep.words, { standard } };
    for (const AccuracySetting& setting : sweep.settings)
    {
      const std::string& profile = setting.profile.name;
      if (is_too_fine(setting, plan_))
        findings_.notes.push_back("Profile '" + profile +
                                  "' was left out, since its voxels are as small as the reference's.");
      else if (bench_.fits(setting))
        line.rows.push_back(bench_.measure(setting, sweep.knob == "profiles" ? profile : ""));
    }
    std::sort(line.rows.begin(), line.rows.end());
    line.rows.erase(std::unique(line.rows.begin(), line.rows.end()), line.rows.end());
    if (sweep.knob != "profiles")
      findings_.knobs.push_back(line);
  }
}

// At each voxel edge, measures the combinations that were not clearly worse than another one at the previous edge.
void Study::measure_combinations()
{
  std::vector<bool> promising(combinations(plan_, plan_.edges[0], bench_.critical_time_step()).size(), true);
  for (std::size_t level = 0; level < variant_levels(); ++level)
  {
    const auto settings = combinations(plan_, plan_.edges[level], bench_.critical_time_step());
    std::vector<AccuracySetting> coming;
    for (std::size_t later = level; later < variant_levels(); ++later)
    {
      const auto all = combinations(plan_, plan_.edges[later], bench_.critical_time_step());
      for (std::size_t c = 0; c < all.size(); ++c)
        if (promising[c])
          coming.push_back(all[c]);
    }
    bench_.expect(coming);
    std::vector<std::pair<std::size_t, AccuracyRow>> rows;
    for (std::size_t c = 0; c < settings.size(); ++c)
      if (promising[c] && bench_.fits(settings[c]))
        rows.emplace_back(c, row(bench_.done()[bench_.measure(settings[c])]));
    for (const auto& [c, row] : rows)
      promising[c] = row.fault.empty() && std::none_of(rows.begin(), rows.end(),
                                                       [&row = row](const auto& other) {
                                                         return other.second.cost < 0.9 * row.cost &&
                                                                other.second.error.rms < 1.02 * row.error.rms;
                                                       });
  }
}

// Notes how much double precision and half the time step change the result at the coarsest edge.
void Study::check_reference()
{
  if (plan_.exact)
    return;
  AccuracySetting exact = reference_at(plan_.edges[0]), halved = exact;
  const std::size_t base = bench_.measure(exact);
  if (!motion_of(base).fault.empty())
    return;
  exact.profile.precision = "double";
  const bool elsewhere = exact.backend == "cuda";  // the GPU backend has no double precision
  if (elsewhere)
    exact.backend = "cpu";
  halved.profile.time_step_share *= 0.5;
  const char* const in_double = elsewhere ? "double precision on the CPU" : "double precision";
  for (const auto& [setting, words] : { std::pair(exact, in_double), std::pair(halved, "half the time step") })
  {
    if (!bench_.fits(setting))
      continue;
    const VariantMotion& other = motion_of(bench_.measure(setting));
    if (other.fault.empty())
      findings_.notes.push_back(
          fmt::format("The reference's settings with voxels of {}: {} changes the skin by {:.3g} µm.",
                      millimetres(plan_.edges[0]), words, 1e6 * worst(skin_errors(motion_of(base), other)).rms));
  }
}

AccuracyFindings Study::run()
{
  findings_.standard = plan_.standard;
  findings_.closed_form = static_cast<bool>(plan_.exact);
  if (!plan_.subject.empty())
    findings_.notes.push_back(plan_.subject);
  try
  {
    choose_reference();
    measure_knobs();
    check_reference();
    if (plan_.knobs.empty())
      measure_combinations();
  }
  catch (const StudyInterrupted&)
  {
    findings_.complete = false;
    return findings_;
  }
  findings_.machine = bench_.machine();
  if (bench_.left_out() > 0)
    findings_.notes.push_back(fmt::format("{} settings were left out, since the budget was spent.", bench_.left_out()));
  if (plan_.exact)
    note_orders(plan_, bench_, findings_);
  else
    estimate_reference_error(plan_, bench_, *average_, findings_);
  std::map<Backend, int> elsewhere;
  for (const MeasuredVariant& measured : bench_.done())
  {
    findings_.rows.push_back(row(measured));
    if (measured.played_by != measured.setting.backend)
      ++elsewhere[measured.played_by];
  }
  for (const auto& [backend, count] : elsewhere)
    findings_.notes.push_back(fmt::format(
        "Motions of {} settings were computed earlier by backend {} and read from the folder.", count, backend));
  if (!plan_.exact)
  {
    // The reference has no error against itself and is not a setting to choose.
    AccuracyRow& reference = findings_.rows[reference_];
    reference.name = "reference: " + reference.name;
    reference.error = reference.settled = {};
    reference.landmark = reference.averaged = NAN;
  }
  findings_.front = pareto_front(findings_.rows, plan_.standard, findings_.reference_error);
  return findings_;
}

}  // namespace

void AccuracyPlan::check() const
{
  const auto known = knob_names();
  for (const std::string& knob : knobs)
    if (std::find(known.begin(), known.end(), knob) == known.end())
      throw Error(fmt::format("no knob is called '{}'; the knobs are {}", knob, list_with_suggestion(knob, known)));
  if (edges.size() < 3 || !std::is_sorted(edges.rbegin(), edges.rend()) ||
      std::adjacent_find(edges.begin(), edges.end()) != edges.end())
    throw Error(
        "voxel edges: at least three are needed, each smaller than the one before; the last is the reference's");
  if (is_too_fine(standard, *this))
    throw Error("voxel edges: the smallest, the reference's, is " + millimetres(edges.back()) +
                "; it must be smaller than the standard setting's, " + millimetres(standard.profile.voxel[0]));
}

AccuracyFindings study_accuracy(const AccuracyPlan& plan, const ModelMaker& maker, const AccuracyProgress& progress)
{
  plan.check();
  return Study(plan, maker, progress).run();
}

}  // namespace frontalis
