#include "study/accuracy/accuracy_bench.hpp"

#include "frontalis/error.hpp"
#include "frontalis/scene/content_hash.hpp"
#include "frontalis/study/step_time.hpp"

#include <fmt/core.h>

namespace frontalis
{
namespace
{

constexpr double with_settling = 1.5;  // wall time of history and settling over that of the history, for estimates

}  // namespace

VariantBench::VariantBench(const AccuracyPlan& plan, const ModelMaker& maker, const AccuracyProgress& progress)
    : plan_(plan),
      maker_(maker),
      progress_(progress),
      store_(plan.folder + "/variants"),
      begin_(wall_seconds()),
      timing_(plan.quick ? 1 : 3)
{
  look_at_standard();
}

std::string VariantBench::key_of(const AccuracySetting& setting, const Backend& backend) const
{
  std::string text = "frontalis " FRONTALIS_VERSION "\n" + maker_.content(setting) + backend;
  for (const float activation : plan_.history.activation)
    text += fmt::format(" {:.6f}", activation);
  return content_hash(fmt::format("{} {:.6f} {:.6f}", text, plan_.history.ramp, plan_.history.hold));
}

// Motions that another backend computed serve too, so that a folder may come from a faster machine. A GPU computes in
// single precision whatever the setting says, so that only settings in single precision have such motions.
std::vector<Backend> VariantBench::backends_of(const AccuracySetting& setting) const
{
  std::vector<Backend> backends{ setting.backend };
  if (setting.backend == plan_.standard.backend && setting.profile.precision == "single")
    backends.insert(backends.end(), { Backend("cuda"), Backend("cpu") });
  return backends;
}

std::optional<VariantMotion> VariantBench::kept_motion(const AccuracySetting& setting, Backend& played_by) const
{
  for (const Backend& backend : backends_of(setting))
    if (std::optional<VariantMotion> motion = store_.read<VariantMotion>(key_of(setting, backend)))
    {
      played_by = backend;
      return motion;
    }
  return std::nullopt;
}

bool VariantBench::is_kept(const AccuracySetting& setting) const
{
  for (const Backend& backend : backends_of(setting))
    if (store_.has_motion(key_of(setting, backend)))
      return true;
  return false;
}

bool VariantBench::is_reference(const AccuracySetting& setting) const
{
  return reference_ && name_of(setting, *reference_) == "standard";
}

// the reference is not timed: it is no setting to choose, and takes long
bool VariantBench::is_timed(const AccuracySetting& setting, const std::optional<VariantCost>& cost) const
{
  return is_reference(setting) || (cost && cost->machine == machine_.at(setting.backend) && !cost->is_noisy());
}

// takes the wall time of a variant into the estimate for further ones
void VariantBench::learn(const AccuracySetting& setting, double wall)
{
  const double relative = relative_time(setting);
  overhead_ = overhead_ > 0 ? std::min(overhead_, wall) : wall;
  if (wall > 4 * overhead_ || rate_ == 0 || wall < rate_ * relative)
    rate_ = wall / relative;
}

double VariantBench::predicted(const AccuracySetting& setting) const
{
  if (!is_kept(setting))
    return overhead_ + rate_ * relative_time(setting);
  return is_timed(setting, store_.read<VariantCost>(key_of(setting))) ? 0 : timing_;
}

bool VariantBench::fits(const AccuracySetting& setting)
{
  const bool fit =
      plan_.budget <= 0 || wall_seconds() - begin_ + predicted(setting) <= plan_.budget || predicted(setting) == 0;
  left_out_ += fit ? 0 : 1;
  return fit;
}

const MeasuredVariant* VariantBench::find(const AccuracySetting& setting) const
{
  const auto known = index_.find(key_of(setting));
  return known == index_.end() ? nullptr : &done_[known->second];
}

std::size_t VariantBench::measure(const AccuracySetting& setting, const std::string& name)
{
  const std::string key = key_of(setting);
  if (const auto known = index_.find(key); known != index_.end())
    return known->second;
  for (std::size_t p = 0; p < pending_.size(); ++p)
    if (key_of(pending_[p]) == key)
      pending_.erase(pending_.begin() + static_cast<std::ptrdiff_t>(p--));
  MeasuredVariant measured{ name.empty() ? name_of(setting, plan_.standard) : name, setting, setting.backend, {}, {} };
  double left = 0;
  for (const AccuracySetting& later : pending_)
    left += predicted(later);
  const auto go_on = [&](double done) { return progress_(measured.name, done, left); };
  if (!go_on(0))
    throw StudyInterrupted();

  std::optional<VariantMotion> motion = kept_motion(setting, measured.played_by);
  std::optional<VariantCost> cost = store_.read<VariantCost>(key);
  const bool kept = motion.has_value();
  if (!kept || (!is_timed(setting, cost) && motion->fault.empty()))
  {
    const double begin = wall_seconds(), before = heap_bytes();
    std::shared_ptr<const Model> model;
    try
    {
      model = std::make_shared<const Model>(maker_.bake(setting));
    }
    catch (const Error& error)
    {
      motion.emplace().fault = std::string("no model: ") + error.what();
    }
    const double build = wall_seconds() - begin, bytes = heap_bytes() - before;
    if (!motion)
    {
      // without a ledger for the reference, whose balance of energies is not reported: a GPU takes twice as long with
      // one
      motion = play_variant(
          model, setting, plan_.history, plan_.threads, !is_reference(setting),
          { store_.read<VariantCheckpoint>(key), [&](const VariantCheckpoint& c) { store_.keep(key, c); } }, go_on);
      if (!motion)
        throw StudyInterrupted();
      store_.keep(key, *motion);
      learn(setting, wall_seconds() - begin);
    }
    if (motion->fault.empty() && !is_reference(setting))
    {
      cost = time_variant(model, setting, plan_.history, plan_.threads, plan_.quick ? 0.3 : 1);
      cost->memory += bytes;
      cost->build = build;
      store_.keep(key, *cost);
      if (kept)
      {
        timing_ = wall_seconds() - begin;
        learn(setting, build + with_settling * motion->steps * cost->step * (plan_.history.ramp + plan_.history.hold));
      }
    }
  }
  measured.motion = *std::move(motion);
  measured.cost = cost.value_or(VariantCost());
  done_.push_back(std::move(measured));
  return index_[key] = done_.size() - 1;
}

void VariantBench::look_at_standard()
{
  AccuracySetting setting = plan_.standard;
  setting.profile.mass_scaling = {};
  setting.profile.time_step = "element";
  const auto model = std::make_shared<const Model>(maker_.bake(setting));
  for (const Backend& backend : available_backends())
  {
    SolverSettings settings;
    settings.backend = backend;
    settings.threads = plan_.threads;
    const auto solver = make_solver(model, settings);
    machine_[backend] = machine_of(*solver, plan_.threads);
    if (backend == plan_.standard.backend)
      critical_ = solver->time_step();
  }
}

}  // namespace frontalis
