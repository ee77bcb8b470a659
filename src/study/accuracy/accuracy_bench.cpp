#include "study/accuracy/accuracy_bench.hpp"

#include "frontalis/error.hpp"
#include "frontalis/content_hash.hpp"
#include "frontalis/study/step_time.hpp"
#include "frontalis/study/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace frontalis
{
namespace
{

// Wall time of a history with settling, divided by that of the history alone. This is a rough estimate.
constexpr double with_settling = 1.5;

// A file consists of this signature, a hash of its content, and the content as bytes.
const std::string signature = fmt::format("frontalis accuracy 2, motions of generation {}\n", motion_generation);

template <class T>
constexpr const char* extension = ".motion";
template <>
constexpr const char* extension<VariantCost> = ".cost";
template <>
constexpr const char* extension<VariantCheckpoint> = ".checkpoint";

// Reads a result. Returns nothing if the file is missing, incomplete or of another generation of motions.
template <class T>
std::optional<T> read(const std::string& key)
{
  std::ifstream file(key + extension<T>, std::ios::binary);
  const std::string whole{ std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>() };
  const std::size_t begin = signature.size(), hash = 16;
  if (whole.compare(0, begin, signature) != 0 || whole.size() < begin + hash)
    return std::nullopt;
  std::string content = whole.substr(begin + hash);
  if (whole.compare(begin, hash, content_hash(content)) != 0)
    return std::nullopt;
  ByteArchive in(std::move(content));
  T value;
  value.archive(in);
  return in.ended() ? std::optional<T>(std::move(value)) : std::nullopt;
}

// Stores a result. A finished motion makes its checkpoint obsolete.
template <class T>
void keep(const std::string& key, T value)
{
  ByteArchive out;
  value.archive(out);
  write_text(key + extension<T>, signature + content_hash(out.bytes()) + out.bytes());
  if (std::is_same_v<T, VariantMotion>)
    std::filesystem::remove(key + extension<VariantCheckpoint>);
}

}  // namespace

void VariantMotion::archive(ByteArchive& archive)
{
  archive(fault);
  std::size_t count = phases.size();
  archive(count);
  phases.resize(count);
  for (SkinPhase& phase : phases)
    archive(phase.vertices)(phase.landmarks);
  archive(area)(steps)(energy)(residual)(voxels);
}

void VariantCost::archive(ByteArchive& archive) { archive(machine)(step)(spread)(processors)(skin)(memory)(build); }

void VariantCheckpoint::archive(ByteArchive& archive)
{
  motion.archive(archive);
  archive(slices)(solver);
}

VariantBench::VariantBench(const AccuracyPlan& plan, const ModelMaker& maker, const AccuracyProgress& progress)
    : plan_(plan), maker_(maker), progress_(progress), begin_(wall_seconds()), timing_(plan.quick ? 1 : 3)
{
  make_folder(plan.folder + "/variants");
  AccuracySetting setting = plan.standard;
  setting.profile.mass_scaling = {};
  setting.profile.time_step = "element";
  const auto model = std::make_shared<const Model>(maker.bake(setting));
  for (const Backend& backend : available_backends())
  {
    const auto solver = make_solver(model, { backend, plan.threads });
    machine_[backend] = machine_of(*solver, plan.threads);
    if (backend == plan.standard.backend)
      critical_ = solver->time_step();
  }
}

std::string VariantBench::key_of(const AccuracySetting& setting, const Backend& backend) const
{
  std::string text = "frontalis " FRONTALIS_VERSION "\n" + maker_.content(setting) + backend;
  for (const float activation : plan_.history.activation)
    text += fmt::format(" {:.6f}", activation);
  for (const RigidTransform& bone : plan_.history.bone)
    text += fmt::format(" {:.6g} {:.6g}", fmt::join(bone.rotation, " "), fmt::join(bone.translation, " "));
  return plan_.folder + "/variants/" +
         content_hash(fmt::format("{} {:.6f} {:.6f}", text, plan_.history.ramp, plan_.history.hold));
}

// The backend of a stored motion. For single precision, motions of other backends are accepted too, so that a faster
// machine may have filled the folder, for instance one with a GPU, which always computes in single precision.
std::optional<Backend> VariantBench::kept_backend(const AccuracySetting& setting) const
{
  std::vector<Backend> backends{ setting.backend };
  if (setting.backend == plan_.standard.backend && setting.profile.precision == "single")
    backends.insert(backends.end(), { Backend("cuda"), Backend("cpu") });
  for (const Backend& backend : backends)
    if (std::filesystem::exists(key_of(setting, backend) + extension<VariantMotion>))
      return backend;
  return std::nullopt;
}

bool VariantBench::is_reference(const AccuracySetting& setting) const
{
  return reference_ && name_of(setting, *reference_) == "standard";
}

// Whether a setting needs no further timing. The reference is never timed, because it is slow and nobody would choose
// it.
bool VariantBench::is_timed(const AccuracySetting& setting, const std::optional<VariantCost>& cost) const
{
  return is_reference(setting) || (cost && cost->machine == machine_.at(setting.backend) && !cost->is_noisy());
}

// Updates the estimates for later variants with the wall seconds that this variant took.
void VariantBench::learn(const AccuracySetting& setting, double wall)
{
  const double relative = relative_time(setting);
  overhead_ = overhead_ > 0 ? std::min(overhead_, wall) : wall;
  if (wall > 4 * overhead_ || rate_ == 0 || wall < rate_ * relative)
    rate_ = wall / relative;
}

double VariantBench::predicted(const AccuracySetting& setting) const
{
  if (!kept_backend(setting))
    return overhead_ + rate_ * relative_time(setting);
  return is_timed(setting, read<VariantCost>(key_of(setting))) ? 0 : timing_;
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
  pending_.erase(std::remove_if(pending_.begin(), pending_.end(), [&](const auto& s) { return key_of(s) == key; }),
                 pending_.end());
  MeasuredVariant measured{ name.empty() ? name_of(setting, plan_.standard) : name, setting, setting.backend, {}, {} };
  double left = 0;
  for (const AccuracySetting& later : pending_)
    left += predicted(later);
  const auto go_on = [&](double done) { return progress_(measured.name, done, left); };
  if (!go_on(0))
    throw StudyInterrupted();

  measured.played_by = kept_backend(setting).value_or(setting.backend);
  std::optional<VariantMotion> motion = read<VariantMotion>(key_of(setting, measured.played_by));
  std::optional<VariantCost> cost = read<VariantCost>(key);
  const bool kept = motion.has_value();
  if (!kept)  // kept_backend() does not notice an incomplete file
    measured.played_by = setting.backend;
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
      // The reference has no energy ledger, because its balance is not reported and a ledger would double its time on a
      // GPU.
      motion = play_variant(model, setting, plan_.history, plan_.threads, !is_reference(setting),
                            { read<VariantCheckpoint>(key), [&](const VariantCheckpoint& c) { keep(key, c); } }, go_on);
      if (!motion)
        throw StudyInterrupted();
      keep(key, *motion);
      learn(setting, wall_seconds() - begin);
    }
    if (motion->fault.empty() && !is_reference(setting))
      try
      {
        cost = time_variant(model, setting, plan_.history, plan_.threads, plan_.quick ? 0.3 : 1);
        // The solver of another setting describes itself in other words.
        cost->machine = machine_.at(setting.backend);
        cost->memory += bytes;
        cost->build = build;
        keep(key, *cost);
        if (kept)
        {
          timing_ = wall_seconds() - begin;
          learn(setting,
                build + with_settling * motion->steps * cost->step * (plan_.history.ramp + plan_.history.hold));
        }
      }
      // Timing switches the activations on at once, which is harder on a model than their growth in the motion.
      catch (const Diverged& error)
      {
        motion->fault = std::string("unstable when switched on at once: ") + error.what();
      }
  }
  measured.motion = *std::move(motion);
  measured.cost = cost.value_or(VariantCost());
  done_.push_back(std::move(measured));
  return index_[key] = done_.size() - 1;
}

}  // namespace frontalis
