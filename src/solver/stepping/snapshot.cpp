#include "solver/stepping/stepping_solver.hpp"

namespace frontalis
{

struct SteppingSolver::Motion : Snapshot
{
  const SteppingSolver* owner = nullptr;
  Course course;
  std::int64_t steps = 0;
  EffectSet effects;
  std::unique_ptr<Fields> fields;

  void archive(ByteArchive& archive)
  {
    course.archive(archive);
    archive(steps)(effects);
    fields->archive(archive);
  }
};

void SteppingSolver::save(std::unique_ptr<Snapshot>& to)
{
  auto* motion = dynamic_cast<Motion*>(to.get());
  if (motion == nullptr || motion->owner != this)
  {
    to = std::make_unique<Motion>();
    motion = static_cast<Motion*>(to.get());
    motion->owner = this;
  }
  motion->course = *this;
  motion->steps = profile_.steps;
  motion->effects = effects_;
  save_fields(motion->fields);
}

void SteppingSolver::restore(const Snapshot& snapshot)
{
  const auto* const motion = dynamic_cast<const Motion*>(&snapshot);
  if (motion == nullptr || motion->owner != this)
    throw Error("a snapshot of another solver: allowed are those that this one saved");
  static_cast<Course&>(*this) = motion->course;
  // steps are counted as they are taken, those given up too
  assembled_at_step_ += profile_.steps - motion->steps;
  restore_fields(*motion->fields);
  // effects stay as they are now
  if (motion->effects == effects_)
    return;
  const auto differs = [&](Effect effect) { return motion->effects.has(effect) != runs(effect); };
  for (const Effect effect : every_effect())
    if (differs(effect))
      effect_switched(effect);
  // as switch_effect() does
  if (differs(Effect::contraction) || differs(Effect::fibre_stiffness))
    displacements_were_set();
  else
    velocities_were_set();
}

// what it is a motion of comes first
std::string SteppingSolver::pack()
{
  std::unique_ptr<Snapshot> snapshot;
  save(snapshot);
  ByteArchive archive;
  std::string whose = owner();
  archive(whose);
  static_cast<Motion&>(*snapshot).archive(archive);
  return archive.bytes();
}

void SteppingSolver::unpack(const std::string& bytes)
{
  std::unique_ptr<Snapshot> snapshot;
  save(snapshot);
  ByteArchive archive(bytes);
  std::string whose;
  try
  {
    archive(whose);
    if (whose == owner())
      static_cast<Motion&>(*snapshot).archive(archive);
    if (whose == owner() && !archive.ended())
      throw Error("more than a motion");
  }
  catch (const Error& error)
  {
    throw Error(std::string("bytes of a motion: ") + error.what());
  }
  if (whose != owner())
    throw Error("a motion of " + whose + ": allowed is one of " + owner());
  restore(*snapshot);
}

std::string SteppingSolver::owner() const
{
  return description() + " of generation " + std::to_string(motion_generation) + ", " +
         std::to_string(model_->voxels.size()) + " voxels, " + std::to_string(model_->nodes.size()) + " nodes" +
         (wants_ledger_ ? ", with a ledger" : "");
}

void SteppingSolver::slow_down(double share)
{
  if (!(share > 0 && share <= 1))
    throw Error("time step to be taken " + std::to_string(share) + " times: allowed are shares above 0 up to 1");
  slow_share_ = share;
}

}  // namespace frontalis
