#include "solver/stepping/time_stepper.hpp"

#include <fmt/format.h>

#include <utility>

namespace frontalis
{

struct TimeStepper::MotionSnapshot : Snapshot
{
  explicit MotionSnapshot(const TimeStepper& of) : owner(&of), motion(of.motion_) {}

  const TimeStepper* owner;
  Motion motion;
  TimeStepController::State time_step;
  EnergyLedger ledger = empty_ledger();
  EffectSet running;
  std::unique_ptr<BackendState> backend;

  void archive(ByteArchive& archive)
  {
    motion.archive(archive);
    time_step.archive(archive);
    archive(ledger.initial);
    for (EnergyTerm& term : ledger.terms)
      archive(term.value);
    archive(ledger.largest)(running);
    backend->archive(archive);
  }
};

void TimeStepper::save(std::unique_ptr<Snapshot>& to)
{
  auto* saved = dynamic_cast<MotionSnapshot*>(to.get());
  if (saved == nullptr || saved->owner != this)
  {
    to = std::make_unique<MotionSnapshot>(*this);
    saved = static_cast<MotionSnapshot*>(to.get());
  }
  saved->motion = motion_;
  saved->time_step = controller_.state();
  if (ledger_)
    saved->ledger = ledger_->latest();
  saved->running = effects_.running();
  backend_->save(saved->backend);
}

void TimeStepper::restore(const Snapshot& snapshot)
{
  const auto* const saved = dynamic_cast<const MotionSnapshot*>(&snapshot);
  if (saved == nullptr || saved->owner != this)
    throw Error("a snapshot of another solver: allowed are those that this one saved");
  const std::vector<AddedMass> before = std::exchange(motion_, saved->motion).added;
  controller_.restore(saved->time_step);
  if (ledger_)
    ledger_->restore(saved->ledger);
  replace_masses(before);
  backend_->restore(*saved->backend);
  renew_conditions();
  // The running effects are not restored, so that the restored state must be adapted to them.
  std::vector<Effect> switched;
  for (const Effect effect : every_effect())
    if (saved->running.has(effect) != effects_.running().has(effect))
      switched.push_back(effect);
  if (!switched.empty())
    effects_switched(switched);
}

// The bytes begin with an identification of the model and the settings, which unpack() checks.
std::string TimeStepper::pack()
{
  std::unique_ptr<Snapshot> snapshot;
  save(snapshot);
  ByteArchive archive;
  std::string whose = owner();
  archive(whose);
  static_cast<MotionSnapshot&>(*snapshot).archive(archive);
  return archive.bytes();
}

void TimeStepper::unpack(const std::string& bytes)
{
  std::unique_ptr<Snapshot> snapshot;
  save(snapshot);
  try
  {
    ByteArchive archive(bytes);
    std::string whose;
    archive(whose);
    if (whose != owner())
      throw Error("they are of " + whose + "; allowed is one of " + owner());
    static_cast<MotionSnapshot&>(*snapshot).archive(archive);
    if (!archive.ended())
      throw Error("they do not end with the motion");
  }
  catch (const Error& error)
  {
    throw Error(std::string("bytes of a motion: ") + error.what());
  }
  restore(*snapshot);
}

std::string TimeStepper::owner() const
{
  return fmt::format("{} of generation {}, {} voxels, {} nodes{}", description(), motion_generation,
                     model_->voxels.size(), model_->nodes.size(), ledger_ ? ", with a ledger" : "");
}

}  // namespace frontalis
