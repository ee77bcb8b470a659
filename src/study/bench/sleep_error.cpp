#include "frontalis/study/sleep_error.hpp"

#include "frontalis/runner/named_controls.hpp"
#include "frontalis/study/step_time.hpp"
#include "study/stability/stability_models.hpp"

#include <algorithm>

namespace frontalis
{
namespace
{

constexpr int frames = 150;
constexpr double seconds = 2.5, released = 1.2;
constexpr std::size_t others = 3;  // that should move as the first does

struct Sleeper
{
  std::unique_ptr<Solver> solver;
  double seconds = 0, error = 0;
  Vectors u;
};

Sleeper sleeper(const std::shared_ptr<const Model>& model, double tolerance)
{
  SolverSettings settings{ Backend::cpu, 1, 0 };
  settings.sleep = tolerance;
  return { make_solver(model, settings), 0, 0, {} };
}

// of what they are raised to
double share_at(double time, double ramp)
{
  const double up = ramp > 0 ? std::min(1.0, time / ramp) : 1;
  const double down = time < released ? 0 : ramp > 0 ? std::min(1.0, (time - released) / ramp) : 1;
  return std::max(0.0, up - down);
}

}  // namespace

std::vector<SleepError> measure_sleep(const std::shared_ptr<const Model>& model, const std::vector<double>& tolerances,
                                      const SleepHistory& history, const std::function<bool(double)>& go_on)
{
  std::vector<float> highest(model->muscles.size(), 0);
  set_activations(*model, history.raised, highest);
  Model wide = *model;
  wide.precision = Precision::double_precision;
  std::vector<Sleeper> all;
  all.push_back(sleeper(model, 0));
  all.push_back(sleeper(std::make_shared<const Model>(std::move(wide)), 0));
  for (const double share : { 0.999, 0.998 })
  {
    all.push_back(sleeper(model, 0));
    all.back().solver->slow_down(share);
  }
  for (const double tolerance : tolerances)
    all.push_back(sleeper(model, tolerance));
  for (int frame = 1; frame <= frames && go_on(static_cast<double>(frame) / frames); ++frame)
  {
    std::map<std::string, double> now = history.raised;
    for (auto& muscle : now)
      muscle.second *= share_at(frame * seconds / frames, history.ramp);
    for (Sleeper& one : all)
    {
      Controls controls = one.solver->controls();
      set_activations(*model, now, controls.activation);
      const double before = processor_seconds();
      one.solver->advance(seconds / frames, controls);
      one.seconds += processor_seconds() - before;
      one.solver->displacements(one.u);
      one.error = std::max(one.error, farthest(one.u, all[0].u));
    }
  }
  double apart = 0;
  for (std::size_t s = 1; s <= others; ++s)
    apart = std::max(apart, all[s].error);
  std::vector<SleepError> errors;
  for (std::size_t s = 0; s < tolerances.size(); ++s)
  {
    const Sleeper& one = all[1 + others + s];
    errors.push_back({ tolerances[s], one.seconds, all[0].seconds, one.error, apart });
  }
  return errors;
}

}  // namespace frontalis
