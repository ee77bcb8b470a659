#include "frontalis/error.hpp"
#include "frontalis/solver/rigid_motion.hpp"
#include "study/stability/stability_cases.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace frontalis
{

double CaseRun::count(const std::string& key) const
{
  const double few = number(key), many = number(key + "_in_full");
  return settings.long_runs ? many : few;
}

void CaseRun::check(const std::string& what, const std::string& unit, double expected, double found,
                    const std::string& key)
{
  trial.checks.absolute(what, unit, expected, found, number("bounds." + key, unit == "1" ? "" : unit));
}

void CaseRun::check_relative(const std::string& what, const std::string& unit, double expected, double found,
                             const std::string& key)
{
  trial.checks.relative(what, unit, expected, found, 0.01 * number("bounds." + key, "%"));
}

GuardedTrial::GuardedTrial(CaseRun& run, std::shared_ptr<const Model> model, bool ledger, const GuardSettings& guard)
    : run_(run), model_(std::move(model)), wants_ledger_(ledger)
{
  run.settings.model(*model_);
  // With few voxels, several threads would spend more time waiting for each other than working.
  const int threads = model_->voxels.size() < 2000 ? 1 : 0;
  SolverSettings own{ run.settings.backend, threads, 0 };
  own.ledger = ledger;
  solver_ = make_solver(model_, own);
  guard_ = std::make_unique<Guard>(*solver_, model_, guard);
  run.trial.voxels = std::max(run.trial.voxels, static_cast<std::int64_t>(model_->voxels.size()));
}

GuardedTrial::~GuardedTrial()
{
  run_.trial.steps += solver_->profile().steps;
  run_.trial.rollbacks += guard_->counts().rollbacks;
}

Controls GuardedTrial::controls(float activation, const RigidTransform& pose) const
{
  return { std::vector<float>(model_->muscles.size(), activation),
           std::vector<RigidTransform>(model_->bones.size(), pose) };
}

void GuardedTrial::advance(const Phase& phase)
{
  for (int i = 0; i < phase.parts; ++i)
  {
    // Controls change linearly in time: a part covers 1 / (number of parts left) of the remaining change.
    guard_->advance(phase.seconds / phase.parts,
                    interpolate(solver_->controls(), phase.target, 1.0 / (phase.parts - i)),
                    [&]
                    {
                      run_.settings.watch(double(i) / phase.parts);
                      return true;
                    });
    record();
    run_.settings.watch((i + 1.0) / phase.parts);
  }
}

void GuardedTrial::play_and_release(const std::vector<Phase>& phases, const std::string& of, const std::string& picture,
                                    const std::string& title)
{
  for (const Phase& phase : phases)
    advance(phase);
  plot(picture, title);
  advance({ run_.seconds("in_the_end"), controls(), 20 });
  check_balance(of);
  run_.check("remaining displacement, " + of, "mm", 0, 1e3 * farthest(displacements()), "left");
}

void GuardedTrial::settle(const Controls& target, double factor)
{
  const double seconds = factor * run_.seconds("longest_settling");
  const Equilibrium end = guard_->settle(target, 1e-4, seconds,
                                         [&](const Equilibrium& now)
                                         {
                                           run_.settings.watch(now.seconds / seconds);
                                           return true;
                                         });
  if (!end.reached)
    throw Error(fmt::format("no equilibrium within {:g} s: {:.3g} of the displacement is left", seconds, end.residual));
  record();
}

void GuardedTrial::hold_or_stop(const std::function<void()>& play, const std::string& of)
{
  try
  {
    play();
  }
  catch (const Unstable& stop)
  {
    Trial& trial = run_.trial;
    trial.stopped += (trial.stopped.empty() ? "" : " ") + (of.empty() ? "" : of + ": ") + stop.what();
    const bool names_voxel = stop.report.voxel >= 0 && !stop.report.advice.empty();
    const std::string where = of.empty() ? "" : ", " + of;
    trial.checks.absolute("stopped in a state that is not finite" + where, "", 0, solver_->monitor().finite ? 0 : 1, 0);
    trial.checks.absolute("report names no voxel" + where, "", 0, names_voxel ? 0 : 1, 0);
  }
}

void GuardedTrial::start_over()
{
  run_.trial.steps += solver_->profile().steps;
  solver_->reset();
  guard_->restart();
  worst_imbalance_ = most_hourglass_ = largest_ = 0;
  moments_.clear();
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
  run_.trial.worst_jacobian = std::min(run_.trial.worst_jacobian, monitor_.worst_jacobian);
  if (!wants_ledger_)
    return;
  ledger_ = solver_->ledger();
  if (!std::isfinite(ledger_.imbalance()))
    throw Error(fmt::format("the energy ledger is no longer finite at {:g} s", solver_->time()));
  worst_imbalance_ = std::max(worst_imbalance_, std::abs(ledger_.imbalance()));
  largest_ = std::max(largest_, ledger_.largest);
  most_hourglass_ = std::max(most_hourglass_, ledger_["hourglass"]);
  moments_.push_back({ solver_->time(), ledger_["kinetic"], ledger_["internal"] + ledger_["hourglass"],
                       ledger_.imbalance(), monitor_.worst_jacobian });
}

void GuardedTrial::check_balance(const std::string& of, const std::string& picture, const std::string& title)
{
  const double error = worst_imbalance_ / largest_;
  run_.trial.energy_error = std::fmax(run_.trial.energy_error, error);
  run_.trial.hourglass_share = std::fmax(run_.trial.hourglass_share, most_hourglass_ / largest_);
  run_.check("energy unexplained, " + of, "%", 0, 100 * error, "energy");
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
    plot.curves[0].add(m.time, m.kinetic / largest_);
    plot.curves[1].add(m.time, m.stored / largest_);
    plot.curves[2].add(m.time, m.unexplained / largest_);
    plot.curves[3].add(m.time, m.jacobian);
  }
  run_.trial.plots.emplace_back(file, plot);
}

Material soft_tissue(double poisson) { return neo_hookean(34e3, poisson); }

Model damped_block(const CaseFile& file)
{
  Model model = voxel_model(file.size(), 1e-3, soft_tissue());
  model.damping = file.number("damping", "1/s");
  return model;
}

void hold_face(Model& model, int axis, bool upper, const std::string& bone)
{
  const double h = model.spacing[axis], at = upper ? model.size[axis] * h : 0;
  hold(
      model, [=](const Point& p) { return std::abs(p[axis] - at) < 0.5 * h; }, bone);
}

void hold_ends(Model& model, int axis, const std::string& bone)
{
  hold_face(model, axis, false);
  hold_face(model, axis, true, bone);
}

double farthest(const Vectors& a, const Vectors& b)
{
  double largest = 0;
  for (std::size_t n = 0; n < a.size(); ++n)
  {
    const Point from = b.empty() ? Point{} : b[n];
    largest = std::max(largest, std::hypot(a[n][0] - from[0], a[n][1] - from[1], a[n][2] - from[2]));
  }
  return largest;
}

RigidTransform turned_about(const Point& rotation, const Point& point)
{
  RigidTransform turn = rigid_motion(rotation, point);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      turn.translation[i] -= turn.rotation[3 * i + j] * point[j];
  return turn;
}

RigidTransform shifted(const Point& shift) { return { RigidTransform().rotation, shift }; }

}  // namespace frontalis
