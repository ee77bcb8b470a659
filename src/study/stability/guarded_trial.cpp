#include "study/stability/guarded_trial.hpp"

#include "frontalis/error.hpp"
#include "study/stability/stability_file.hpp"
#include "study/stability/stability_models.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace frontalis
{

GuardedTrial::GuardedTrial(const StabilitySettings& settings, Trial& trial, std::shared_ptr<const Model> model,
                           bool ledger, const GuardSettings& guard)
    : settings_(settings), trial_(trial), model_(std::move(model)), wants_ledger_(ledger)
{
  settings.model(*model_);
  // with few voxels threads would wait for each other longer than they work
  const int threads = model_->voxels.size() < 2000 ? 1 : 0;
  SolverSettings own{ settings.backend, threads, 0 };
  own.ledger = ledger;
  solver_ = make_solver(model_, own);
  guard_ = std::make_unique<Guard>(*solver_, model_, guard);
  trial_.voxels = std::max(trial_.voxels, static_cast<std::int64_t>(model_->voxels.size()));
}

GuardedTrial::~GuardedTrial()
{
  trial_.steps += solver_->profile().steps;
  trial_.rollbacks += guard_->counts().rollbacks;
}

Controls GuardedTrial::controls(float activation, const RigidTransform& pose) const
{
  return { std::vector<float>(model_->muscles.size(), activation),
           std::vector<RigidTransform>(model_->bones.size(), pose) };
}

void GuardedTrial::advance(double seconds, const Controls& target, int looks)
{
  for (int i = 0; i < looks; ++i)
  {
    // each part takes its share of the way from the present controls
    guard_->advance(seconds / looks, interpolate(solver_->controls(), target, 1.0 / (looks - i)));
    record();
    settings_.watch((i + 1.0) / looks);
  }
}

void GuardedTrial::play_and_release(const std::vector<Phase>& phases, const std::string& of, const CaseFile& file,
                                    const std::string& picture, const std::string& title)
{
  for (const Phase& phase : phases)
    advance(phase.seconds, phase.target, phase.looks);
  plot(picture, title);
  advance(file.seconds("in_the_end"), controls(), 20);
  check_balance(file, of);
  trial_.checks.absolute("left in the end, " + of, "mm", 0, 1e3 * farthest(displacements()), file.bound("left", "mm"));
}

void GuardedTrial::settle(const Controls& target, double tolerance, double seconds)
{
  const Equilibrium end = guard_->settle(target, tolerance, seconds,
                                         [&](const Equilibrium& now)
                                         {
                                           settings_.watch(now.seconds / seconds);
                                           return true;
                                         });
  if (!end.reached)
    throw Error(fmt::format("no equilibrium within {:g} s: {:.3g} of the displacement is left", seconds, end.residual));
  record();
}

void GuardedTrial::hold_or_stop(const std::function<void()>& play)
{
  try
  {
    play();
  }
  catch (const Unstable& stop)
  {
    trial_.stopped = stop.what();
    const Monitor last = solver_->monitor();
    trial_.checks.absolute("stopped in a state that is not finite", "", 0, last.finite ? 0 : 1, 0);
    trial_.checks.absolute("report names no voxel", "", 0, stop.report.voxel < 0 || stop.report.advice.empty() ? 1 : 0,
                           0);
  }
}

void GuardedTrial::set(const Vectors& displacements, const Vectors& velocities)
{
  solver_->set_displacements(displacements);
  if (!velocities.empty())
    solver_->set_velocities(velocities);
  guard_->restart();
  record();
}

Vectors GuardedTrial::displacements() const
{
  Vectors u;
  solver_->displacements(u);
  return u;
}

void GuardedTrial::record()
{
  monitor_ = solver_->monitor();
  if (!monitor_.finite)
    throw Error(fmt::format("energies are no longer finite at {:g} s", solver_->time()));
  trial_.worst_jacobian = std::min(trial_.worst_jacobian, monitor_.worst_jacobian);
  if (!wants_ledger_)
    return;
  ledger_ = solver_->ledger();
  if (!std::isfinite(ledger_.imbalance()))
    throw Error(fmt::format("the energy ledger is no longer finite at {:g} s", solver_->time()));
  worst_imbalance_ = std::max(worst_imbalance_, std::abs(ledger_.imbalance()));
  largest_ = std::max(largest_, ledger_.largest);
  most_hourglass_ = std::max(most_hourglass_, ledger_.hourglass);
  moments_.push_back({ solver_->time(), ledger_.kinetic, ledger_.internal + ledger_.hourglass, ledger_.imbalance(),
                       monitor_.worst_jacobian });
}

void GuardedTrial::check_balance(const CaseFile& file, const std::string& of, const std::string& picture,
                                 const std::string& title)
{
  const double error = worst_imbalance_ / largest_;
  trial_.energy_error = std::fmax(trial_.energy_error, error);
  trial_.hourglass_share = std::fmax(trial_.hourglass_share, most_hourglass_ / largest_);
  trial_.checks.absolute("energy unexplained, " + of, "%", 0, 100 * error, file.bound("energy", "%"));
  if (!picture.empty())
    plot(picture, title);
}

void GuardedTrial::plot(const std::string& file, const std::string& title)
{
  Plot plot{ title, "time [s]", "energies over the largest, smallest J [1]" };
  plot.key = "below";
  plot.curves = { { "kinetic energy", {}, {}, Plot::Style::line },
                  { "stored energy", {}, {}, Plot::Style::line },
                  { "unexplained", {}, {}, Plot::Style::line },
                  { "smallest J", {}, {}, Plot::Style::dashed } };
  for (const Moment& m : moments_)
  {
    const std::array<double, 4> y{ { m.kinetic / largest_, m.stored / largest_, m.unexplained / largest_,
                                     m.jacobian } };
    for (std::size_t c = 0; c < y.size(); ++c)
      plot.curves[c].add(m.time, y[c]);
  }
  trial_.plots.emplace_back(file, plot);
}

}  // namespace frontalis
