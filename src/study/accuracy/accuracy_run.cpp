// Simulates one variant and measures the cost of its steps.

#include "study/accuracy/accuracy_run.hpp"

#include "frontalis/error.hpp"
#include "frontalis/runner/face_frame.hpp"
#include "frontalis/solver/guard.hpp"
#include "frontalis/solver/rigid_motion.hpp"
#include "frontalis/study/step_time.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <thread>

#include <malloc.h>

namespace frontalis
{
namespace
{

constexpr int repetitions = 9;                  // number of timings of a published skin
constexpr double seconds_per_checkpoint = 60;   // least wall time between checkpoints [s]
constexpr double share_of_checkpoints = 0.025;  // largest fraction of wall time for checkpoints

int thread_count(int threads)
{
  return threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

Controls controls_at(const Solver& solver, const ActivationHistory& history, double time)
{
  Controls controls = solver.controls();
  controls.activation = history.activation;
  const auto share = static_cast<float>(history.ramp > 0 ? std::min(time / history.ramp, 1.0) : 1);
  for (float& a : controls.activation)
    a *= share;
  for (std::size_t bone = 0; bone < history.bone.size(); ++bone)
    controls.bone[bone] = interpolate(RigidTransform(), history.bone[bone], double(share));
  return controls;
}

SkinPhase read_skin(Solver& solver, const Model& model)
{
  SkinState skin;
  solver.skin(skin);
  if (!is_finite(skin) || !solver.monitor().finite)
    throw Diverged("the skin is no longer finite");
  to_face_frame(model, skin);
  return { std::move(skin.vertices), std::move(skin.landmarks) };
}

// Longest edge of the model's box [m]. A larger displacement of the skin counts as divergence.
double largest_size(const Model& model)
{
  return std::max(
      { model.size[0] * model.spacing[0], model.size[1] * model.spacing[1], model.size[2] * model.spacing[2] });
}

}  // namespace

std::string machine_of(const Solver& solver, int threads)
{
  std::ifstream info("/proc/cpuinfo");
  std::string processor = "unknown processor";
  for (std::string line; std::getline(info, line);)
    if (line.rfind("model name", 0) == 0)
    {
      processor = line.substr(line.find(':') + 2);
      break;
    }
  return solver.description() + ", " + processor + ", " + std::to_string(thread_count(threads)) + " threads";
}

double heap_bytes()
{
  const auto info = mallinfo2();  // covers all arenas of the heap
  return static_cast<double>(info.uordblks) + static_cast<double>(info.hblkhd);
}

std::optional<VariantMotion> play_variant(const std::shared_ptr<const Model>& model, const AccuracySetting& setting,
                                          const ActivationHistory& history, int threads, bool wants_ledger,
                                          const Checkpoints& checkpoints, const GoOn& go_on)
{
  VariantCheckpoint state;
  VariantMotion& motion = state.motion;
  motion.voxels = static_cast<double>(model->voxels.size());
  const std::vector<double> area = vertex_areas(model->skin);
  motion.area.assign(area.begin(), area.end());
  try
  {
    SolverSettings settings{ setting.backend, threads };
    settings.ledger = wants_ledger;
    const auto solver = make_solver(model, settings);
    const auto add_phase = [&]
    {
      motion.phases.push_back(read_skin(*solver, *model));
      if (motion_size(motion) > largest_size(*model))
        throw Diverged("the skin has moved farther than the size of the model");
    };
    try
    {
      if (checkpoints.last)
        solver->unpack(checkpoints.last->solver);
      state = checkpoints.last.value_or(state);
    }
    catch (const Error&)
    {
      // The checkpoint belongs to another solver, so that the motion starts from rest.
    }
    if (motion.phases.empty())
      add_phase();
    const double steps_before = motion.steps;
    double next_checkpoint = wall_seconds() + seconds_per_checkpoint;
    const auto keep = [&]
    {
      const double begin = wall_seconds();
      state.solver = solver->pack();
      checkpoints.keep(state);
      const double end = wall_seconds();
      next_checkpoint = end + std::max(seconds_per_checkpoint, (end - begin) / share_of_checkpoints);
    };
    // Large models have more slices, because an interruption takes effect at the end of a slice.
    const std::int64_t slices_per_phase = 10 * (1 + static_cast<std::int64_t>(model->voxels.size()) / 200000);
    const double length = history.ramp + history.hold;
    const std::array<double, 4> ends{ 0, 0.5 * history.ramp, history.ramp, length };
    const auto time_of = [&](std::int64_t slices)
    {
      const auto phase = static_cast<std::size_t>(slices / slices_per_phase);
      const double share = static_cast<double>(slices % slices_per_phase) / static_cast<double>(slices_per_phase);
      return share > 0 ? ends[phase] + (ends[phase + 1] - ends[phase]) * share : ends[phase];
    };
    while (state.slices < 3 * slices_per_phase)
    {
      const double time = time_of(state.slices), next = time_of(state.slices + 1);
      const double seconds = (next - time) / model->time_scaling;
      // Half a slice cannot be kept. Therefore a slice is interrupted only if it takes far more steps than expected.
      const double patience = static_cast<double>(solver->profile().steps) + 10 * seconds / solver->time_step();
      const auto slice_goes_on = [&]
      { return static_cast<double>(solver->profile().steps) < patience || go_on(0.8 * time / length); };
      if (next > time && !solver->advance(seconds, controls_at(*solver, history, next), slice_goes_on))
        return std::nullopt;
      ++state.slices;
      motion.steps = steps_before + static_cast<double>(solver->profile().steps);
      if (state.slices % slices_per_phase == 0)
        add_phase();
      const bool interrupted = !go_on(0.8 * next / length);
      if (interrupted || wall_seconds() > next_checkpoint)
        keep();
      if (interrupted)
        return std::nullopt;
    }
    // Settling has no checkpoints. If it is interrupted, it starts again from here.
    state.solver = solver->pack();
    const VariantCheckpoint played = state;
    motion.steps /= length;
    const EnergyLedger ledger = wants_ledger ? solver->ledger() : EnergyLedger();
    motion.energy = ledger.largest > 0 ? std::abs(ledger.imbalance()) / ledger.largest : wants_ledger ? 0 : NAN;

    // The model counts as settled when its skin no longer moves, even if nodes inside still move.
    VariantMotion last;
    last.area = motion.area;
    last.phases = { motion.phases[0], motion.phases.back() };
    double last_check = 0;  // simulated seconds of settling
    bool interrupted = false;
    const double settling = 2 * length / model->time_scaling;
    // The guard may return to an earlier state. Settling then starts again, and `seconds` decreases.
    Guard guard(*solver, model);
    const Equilibrium found = guard.settle(controls_at(*solver, history, length), 1e-4, settling,
                                           [&](const Equilibrium& equilibrium)
                                           {
                                             interrupted = !go_on(0.8 + 0.2 * equilibrium.seconds / settling);
                                             last_check = std::min(last_check, equilibrium.seconds);
                                             if (equilibrium.seconds - last_check < 0.1 * settling)
                                               return !interrupted;
                                             last_check = equilibrium.seconds;
                                             VariantMotion present = last;
                                             present.phases[1] = read_skin(*solver, *model);
                                             const double moved = skin_errors(present, last)[1].rms;
                                             last = std::move(present);
                                             return !interrupted && moved > 5e-4 * motion_size(last);
                                           });
    if (interrupted)
    {
      checkpoints.keep(played);
      return std::nullopt;
    }
    motion.residual = found.residual;
    add_phase();
  }
  // Other errors do not depend on the setting and must not be stored as its faults.
  catch (const Diverged& error)
  {
    motion.fault = std::string("unstable: ") + error.what();
  }
  catch (const Unstable& error)
  {
    motion.fault = std::string("unstable: ") + error.what();
  }
  return motion;
}

VariantCost time_variant(const std::shared_ptr<const Model>& model, const AccuracySetting& setting,
                         const ActivationHistory& history, int threads, double seconds)
{
  VariantCost cost;
  const double heap = heap_bytes();
  const SolverSettings settings{ setting.backend, threads };
  const auto solver = make_solver(model, settings);
  cost.machine = machine_of(*solver, threads);
  Controls controls = solver->controls();
  controls.activation = history.activation;
  if (!history.bone.empty())
    controls.bone = history.bone;
  // Processor time excludes the time of other programs, but is meaningful only for a single thread.
  const bool alone = works_alone(settings);
  const double used = processor_seconds(), begin = wall_seconds();
  // The last argument lets the solvers reach their controls: while activations grow, frequent estimates of the time
  // step would distort the cost per step.
  const auto turns = time_in_turn({ { solver.get(), controls } }, seconds, alone, 8 * seconds);
  const bool shared = setting.backend == "cpu" && !alone;
  cost.processors = shared ? (processor_seconds() - used) / (wall_seconds() - begin) / thread_count(threads) : 1;
  cost.memory = heap_bytes() - heap;
  std::vector<double> skins;
  SkinState skin;
  for (int repetition = 0; repetition < repetitions; ++repetition)
  {
    const double start = wall_seconds();
    solver->skin(skin);
    skins.push_back(wall_seconds() - start);
  }
  const Spread step = spread_of(turns, 0);
  cost.step = step.median;
  cost.spread = 2 * step.half / step.median;
  cost.skin = spread_of(skins).median;
  return cost;
}

}  // namespace frontalis
