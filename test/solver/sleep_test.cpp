#include "backends.hpp"
#include "block_model.hpp"

#include "frontalis/error.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

using Vectors = std::vector<std::array<double, 3>>;

constexpr double tolerance = 20e-6, frame = 0.02;

// A layer of tissue on a bone, with a muscle along one end of it: what it does ends a few of its depths away.
Model layer_on_bone(std::int32_t length = 160)
{
  test::BlockSettings settings;
  settings.voxels = { { length, 3, 3 } };
  settings.poisson = 0.45;
  settings.density = 11000;
  settings.damping = 40;
  Model model = test::block_model(settings);
  model.bones = { "skull" };
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
    if (model.nodes[n][1] == 0)
      model.rigid.push_back({ static_cast<std::int32_t>(n), 0 });
  Muscle muscle;
  muscle.name = "end";
  muscle.stress_reference = 20e3;
  test::add_muscle(model, { { 1, 0, 0 } }, muscle);
  // in the first voxels, and nowhere else
  std::int32_t fibres = 0;
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
    model.fibre_begin[e + 1] = fibres += model.voxels[e][0] < 8 ? 1 : 0;
  model.fibre_muscle.resize(fibres);
  model.fibre_weight.resize(fibres);
  model.fibre_direction.resize(fibres);
  return model;
}

std::unique_ptr<Solver> solver_of(const Model& model, double sleep, int threads = 1, bool ledger = false,
                                  Backend backend = Backend::cpu)
{
  SolverSettings settings{ backend, threads, 0, ledger };
  settings.sleep = sleep;
  return make_solver(std::make_shared<const Model>(model), settings);
}

// activation of the muscle at the end of a frame: up, held for a while, half down, held, up in one frame
float activation(int at)
{
  const double t = at * frame;
  if (t < 0.1)
    return static_cast<float>(7.5 * t);
  if (t < 0.5)
    return 0.75f;
  if (t < 0.6)
    return static_cast<float>(0.75 - 4 * (t - 0.5));
  return t < 0.9 ? 0.35f : 0.6f;
}

void go(Solver& solver, int frame_index)
{
  Controls controls = solver.controls();
  controls.activation[0] = activation(frame_index);
  solver.advance(frame, controls);
}

Vectors displacements(const Solver& solver)
{
  Vectors u;
  solver.displacements(u);
  return u;
}

double farthest(const Vectors& a, const Vectors& b)
{
  double most = 0;
  for (std::size_t n = 0; n < a.size(); ++n)
    most = std::max(most, std::hypot(a[n][0] - b[n][0], a[n][1] - b[n][1], a[n][2] - b[n][2]));
  return most;
}

std::size_t bytes_of(const Solver& solver, const std::string& what)
{
  std::size_t bytes = 0;
  for (const Allocation& a : solver.allocations())
    bytes += a.what == what ? a.bytes : 0;
  return bytes;
}

TEST(Sleep, errors_stay_within_the_tolerance_while_it_falls_asleep_and_wakes)
{
  const Model model = layer_on_bone();
  const auto awake = solver_of(model, 0), sleeper = solver_of(model, tolerance);
  double worst = 0;
  std::size_t fewest = std::size_t(-1);
  for (int f = 1; f <= 60; ++f)
  {
    go(*awake, f);
    go(*sleeper, f);
    worst = std::max(worst, farthest(displacements(*awake), displacements(*sleeper)));
    // the far end sleeps on while the muscle's is awake
    if (const auto bytes = bytes_of(*sleeper, "tiles that are awake"); bytes > 0)
      fewest = std::min(fewest, bytes);
  }
  EXPECT_LT(worst, tolerance);
  EXPECT_GT(worst, 0);
  EXPECT_LT(fewest, 3 * bytes_of(*awake, "tiles") / 4) << "bytes";
}

// the farthest that a sleeper is from where it is awake, while the muscle goes up within a time and is held; and the
// least that is awake, as a share
std::pair<double, double> error_and_awake(const Model& model, double within, double ramp, double seconds)
{
  const auto awake = solver_of(model, 0), sleeper = solver_of(model, within);
  double worst = 0, least = 1;
  for (int f = 1; f * frame <= seconds; ++f)
  {
    Controls controls = awake->controls();
    controls.activation[0] = static_cast<float>(std::min(0.75, 0.75 * f * frame / ramp));
    awake->advance(frame, controls);
    sleeper->advance(frame, controls);
    worst = std::max(worst, farthest(displacements(*awake), displacements(*sleeper)));
    const auto bytes = [&](const char* what) { return static_cast<double>(bytes_of(*sleeper, what)); };
    if (bytes("tiles that are awake") > 0)
      least = std::min(least, bytes("tiles that are awake") / bytes("tiles"));
    else if (sleeper->monitor().kinetic == 0)
      least = 0;
  }
  return { worst, least };
}

// tissue that creeps at less than the speed at which it falls asleep went a third of a millimetre unseen
TEST(Sleep, what_creeps_is_followed)
{
  Model model = layer_on_bone(80);
  model.materials[0].viscous_share[0] = 0.6;
  model.materials[0].viscous_time[0] = 5;
  const double within = 3e-4;
  const auto [error, awake] = error_and_awake(model, within, 0.1, 4);
  EXPECT_LT(error, 0.5 * within);
  EXPECT_LT(awake, 0.5);
}

TEST(Sleep, what_is_ramped_slowly_is_followed)
{
  Model model = layer_on_bone();
  const double within = 1e-4;
  const auto [error, awake] = error_and_awake(model, within, 2, 2.2);
  EXPECT_LT(error, 0.5 * within);
  EXPECT_LT(awake, 0.9);
}

TEST(Sleep, all_of_it_rests_at_last_and_is_woken_by_muscles_and_bones)
{
  const auto awake = solver_of(layer_on_bone(), 0), sleeper = solver_of(layer_on_bone(), tolerance);
  for (int f = 1; f <= 25; ++f)
    for (const auto& solver : { awake.get(), sleeper.get() })
      go(*solver, f);
  EXPECT_EQ(sleeper->monitor().kinetic, 0);
  const Vectors before = displacements(*sleeper);
  go(*sleeper, 25);
  EXPECT_EQ(displacements(*sleeper), before);
  go(*awake, 25);
  Controls controls = sleeper->controls();
  controls.activation[0] = 0.5f;
  for (const auto& solver : { awake.get(), sleeper.get() })
    solver->advance(0.3, controls);
  EXPECT_GT(farthest(displacements(*sleeper), before), 10 * tolerance);
  EXPECT_LT(farthest(displacements(*sleeper), displacements(*awake)), tolerance);
  controls.bone[0].translation[2] = 1e-3;
  for (const auto& solver : { awake.get(), sleeper.get() })
    solver->advance(0.2, controls);
  EXPECT_LT(farthest(displacements(*sleeper), displacements(*awake)), tolerance);
}

TEST(Sleep, the_bits_are_the_same_with_any_number_of_threads_and_from_snapshots)
{
  const Model model = layer_on_bone();
  const auto one = solver_of(model, tolerance), two = solver_of(model, tolerance, 2),
             four = solver_of(model, tolerance, 4);
  std::unique_ptr<Snapshot> snapshot;
  std::string bytes;
  for (int f = 1; f <= 50; ++f)
  {
    if (f == 28)
    {
      two->save(snapshot);
      bytes = four->pack();
    }
    for (const auto& solver : { one.get(), two.get(), four.get() })
      go(*solver, f);
  }
  const Vectors end = displacements(*one);
  EXPECT_EQ(end, displacements(*two));
  EXPECT_EQ(end, displacements(*four));
  two->restore(*snapshot);
  const auto other = solver_of(model, tolerance, 4);
  other->unpack(bytes);
  for (int f = 28; f <= 50; ++f)
  {
    go(*two, f);
    go(*other, f);
  }
  EXPECT_EQ(end, displacements(*two));
  EXPECT_EQ(end, displacements(*other));
}

TEST(Sleep, a_reset_leaves_nothing_behind)
{
  const Model model = layer_on_bone();
  const auto used = solver_of(model, tolerance), fresh = solver_of(model, tolerance);
  for (int at = 1; at <= 20; ++at)
    go(*used, at);
  used->reset();
  for (int at = 1; at <= 20; ++at)
  {
    go(*used, at);
    go(*fresh, at);
    EXPECT_EQ(displacements(*used), displacements(*fresh)) << "frame " << at;
  }
}

TEST(Sleep, energy_that_is_dropped_is_booked)
{
  const auto solver = solver_of(layer_on_bone(), tolerance, 1, true);
  for (int f = 1; f <= 45; ++f)
  {
    go(*solver, f);
    const EnergyLedger ledger = solver->ledger();
    EXPECT_LT(std::abs(ledger.imbalance()), 0.01 * ledger.largest) << f;
  }
}

TEST(Sleep, it_is_off_by_default_and_then_holds_nothing)
{
  const auto plain = solver_of(layer_on_bone(), 0);
  go(*plain, 1);
  EXPECT_EQ(bytes_of(*plain, "what sleeps"), 0u);
  EXPECT_GT(bytes_of(*solver_of(layer_on_bone(), tolerance), "what sleeps"), 0u);
}

TEST(Sleep, other_backends_say_that_they_compute_all_and_bad_tolerances_are_refused)
{
  const auto reference = solver_of(layer_on_bone(), tolerance, 1, false, Backend::reference);
  EXPECT_EQ(reference->description(),
            "reference (double, 1 thread; all is computed: only the backend cpu lets tissue sleep)");
  EXPECT_NE(solver_of(layer_on_bone(), tolerance)->description().find("what is at rest sleeps, within 2e-05 m"),
            std::string::npos);
  for (const double bad : { -1e-6, std::nan("") })
    try
    {
      solver_of(layer_on_bone(), bad);
      FAIL() << bad;
    }
    catch (const Error& error)
    {
      EXPECT_NE(std::string(error.what()).find("allowed are finite lengths from 0"), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace frontalis
