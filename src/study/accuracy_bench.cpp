#include "accuracy_bench.hpp"

#include "frontalis/error.hpp"
#include "frontalis/scene/content_hash.hpp"

#include <chrono>

namespace frontalis
{
namespace
{

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

}  // namespace

VariantBench::VariantBench(const AccuracyPlan& plan, const ModelMaker& maker, const AccuracyProgress& progress)
    : plan_(plan), maker_(maker), progress_(progress), store_(plan.folder + "/variants"), begin_(now())
{
  look_at_standard();
}

std::string VariantBench::key_of(const AccuracySetting& setting, Backend backend) const
{
  std::string text = "frontalis " FRONTALIS_VERSION "\n" + maker_.content(setting) + name_of(backend);
  for (const float activation : plan_.history.activation)
    text += " " + std::to_string(activation);
  return content_hash(text + " " + std::to_string(plan_.history.ramp) + " " + std::to_string(plan_.history.hold));
}

// any for what has the reference's form: a folder may come from a faster machine
std::vector<Backend> VariantBench::backends_of(const AccuracySetting& setting) const
{
  std::vector<Backend> backends{ setting.backend };
  if (name_of(setting, reference_setting(plan_.standard, setting.profile.voxel[0])) == "standard")
    backends.insert(backends.end(), { Backend::cuda, Backend::cpu });
  return backends;
}

std::optional<VariantMotion> VariantBench::kept_motion(const AccuracySetting& setting, Backend& played_by) const
{
  for (const Backend backend : backends_of(setting))
    if (std::optional<VariantMotion> motion = store_.motion(key_of(setting, backend)))
    {
      played_by = backend;
      return motion;
    }
  return std::nullopt;
}

bool VariantBench::is_kept(const AccuracySetting& setting) const
{
  for (const Backend backend : backends_of(setting))
    if (store_.has_motion(key_of(setting, backend)))
      return true;
  return false;
}

bool VariantBench::is_reference(const AccuracySetting& setting) const
{
  return reference_ && name_of(setting, *reference_) == "standard";
}

double VariantBench::predicted(const AccuracySetting& setting) const
{
  return is_kept(setting) ? 0 : overhead_ + rate_ * relative_time(setting);
}

bool VariantBench::fits(const AccuracySetting& setting)
{
  const bool fit = plan_.budget <= 0 || is_kept(setting) || now() - begin_ + predicted(setting) <= plan_.budget;
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
  std::optional<VariantCost> cost = store_.cost(key);
  // the reference's time says nothing and takes long
  const bool time_it = !is_reference(setting) && (!cost || cost->machine != machine_.at(setting.backend) ||
                                                  cost->spread > 0.2 || cost->processors < 0.8);
  if (!motion || (time_it && motion->fault.empty()))
  {
    const double begin = now(), before = heap_bytes();
    std::shared_ptr<const Model> model;
    try
    {
      model = std::make_shared<const Model>(maker_.bake(setting));
    }
    catch (const Error& error)
    {
      motion.emplace().fault = std::string("no model: ") + error.what();
    }
    const double build = now() - begin, bytes = heap_bytes() - before;
    if (!motion)
    {
      // a ledger says nothing of the reference, and a GPU takes twice as long with one
      motion =
          play_variant(model, setting, plan_.history, plan_.threads, !is_reference(setting),
                       { store_.checkpoint(key), [&](const VariantCheckpoint& c) { store_.keep(key, c); } }, go_on);
      if (!motion)
        throw StudyInterrupted();
      store_.keep(key, *motion);
      const double wall = now() - begin, relative = relative_time(setting);
      overhead_ = overhead_ > 0 ? std::min(overhead_, wall) : wall;
      if (wall > 4 * overhead_ || rate_ == 0 || wall < rate_ * relative)
        rate_ = wall / relative;
    }
    if (motion->fault.empty() && !is_reference(setting))
    {
      cost = time_variant(model, setting, plan_.history, plan_.threads, plan_.quick ? 0.3 : 1);
      cost->memory += bytes;
      cost->build = build;
      store_.keep(key, *cost);
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
  for (const Backend backend : available_backends())
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
