#include "frontalis/solver/guard.hpp"

#include "solver/stepping/discretisation.hpp"
#include "solver/energy/energy_bound.hpp"
#include "frontalis/physics/mutation.hpp"
#include "frontalis/solver/rigid_motion.hpp"
#include "solver/contact/past_rim.hpp"
#include "solver/guard/instability_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace frontalis
{
namespace
{

// Allowed ratio of the latest step to the critical one. It exceeds 1, because the controller renews its bound only
// every few dozen steps, and because the bound is conservative.
constexpr double step_share_allowed = 1.1;
// Allowed change of the ledger's imbalance between two checks, as a fraction of the ledger's largest term. In stable
// random scenes the change is below 0.1 of that term (test/study/property_test.cpp).
constexpr double imbalance_allowed = 0.2;
// A voxel is reported as the origin of the instability if its J is below `crushed`, or if it is the stiffest one and
// the critical step has fallen below the fraction `stiffened` of the critical step of the last good state. Such a fall
// of the time step is a sign of an instability, so that a check is due at the end of that part.
constexpr double crushed = 0.2;
constexpr double stiffened = 0.5;
// Longest search for the origin of an instability, in intervals between checks. A part with cautious steps, which are
// about half as long, has twice as many of them.
constexpr int longest_search = 4;

bool always() { return true; }

}  // namespace

struct Guard::Implementation
{
  using GoOn = std::function<bool()>;

  /// A state that passed a check.
  struct Good
  {
    std::unique_ptr<Snapshot> snapshot;
    Monitor monitor;
    double time = 0;
    double imbalance = 0;  // [J]
    std::vector<RigidTransform> bone;
    std::vector<float> since;  // largest activation of each muscle since the previous good state
    double largest_internal = 0;
    bool there = false;  // false: no state is stored, and the snapshot is only memory for reuse
  };

  Solver& solver;
  std::shared_ptr<const Model> model;
  GuardSettings settings;
  EnergyBound bound;
  Good good, before;              // the latest good state, and the previous one
  std::vector<float> activation;  // largest activation of each muscle since `good`
  std::vector<double> bone_way;   // length of each bone's path since `good` [m]
  std::int64_t checked_at = 0;    // solver steps at the latest check
  double checked_step = 0;        // time step at the latest check [s]
  int good_checks = 0;            // number of checks without a finding since the latest rollback
  int tries = 0;
  bool settling = false;
  GuardCounts counts;

  double energy(const Monitor& m) const { return m.kinetic + m.internal + m.hourglass + m.bodies; }
  std::int64_t steps() const { return solver.profile().steps; }
  bool check_is_due() const
  {
    return steps() - checked_at >= settings.interval || (tries == 0 && solver.time_step() < stiffened * checked_step);
  }
  void keep(const Monitor& monitor, double imbalance);
  Instability judged(const Monitor& monitor, double imbalance, double largest) const;
  Instability check();
  bool go_back(Instability finding, const Controls& target, double end, const GoOn& go_on);
  std::int32_t voxel_at(std::int32_t node) const;
  InstabilityReport examined(Instability finding, const Controls& target, double end, const GoOn& go_on);
};

void Guard::Implementation::keep(const Monitor& monitor, double imbalance)
{
  std::swap(good, before);
  solver.save(good.snapshot);
  good.monitor = monitor;
  good.time = solver.time();
  good.imbalance = imbalance;
  good.bone = solver.controls().bone;
  good.since = activation;
  good.largest_internal = std::max(before.largest_internal, monitor.internal);
  good.there = true;
  activation = solver.activation();
  bone_way.assign(good.bone.size(), 0);
}

Instability Guard::Implementation::judged(const Monitor& m, double imbalance, double largest) const
{
  if (!m.finite)
    return Instability::not_finite;
  const auto voxels = static_cast<double>(model->voxels.size());
  const double inverted = std::max(settings.inverted_share * voxels, static_cast<double>(good.monitor.inverted));
  if (static_cast<double>(m.inverted) > inverted)
    return Instability::inverted;
  if (m.lost_node >= 0)
    return Instability::past_rim;
  if (m.lost_points > 0)
    return Instability::inside_body;
  const double most =
      bound.most({ energy(good.monitor), good.time, solver.time(), activation, bone_way, good.largest_internal });
  if (m.hourglass > most)
    return Instability::hourglass;
  if (energy(m) > most || std::abs(imbalance - good.imbalance) > imbalance_allowed * largest + bound.floor())
    return Instability::energy;
  return m.step_share > step_share_allowed ? Instability::time_step : Instability::none;
}

Instability Guard::Implementation::check()
{
  const auto start = std::chrono::steady_clock::now();
  ++counts.checks;
  checked_at = steps();
  checked_step = solver.time_step();
  const Monitor monitor = solver.monitor();
  EnergyLedger ledger;
  if (settings.ledger && monitor.finite && !settling)
    ledger = solver.ledger();
  const double imbalance = settling ? good.imbalance : ledger.imbalance();
  const Instability finding = mutation::blind_guard ? Instability::none : judged(monitor, imbalance, ledger.largest);
  if (finding == Instability::none)
  {
    keep(monitor, imbalance);
    ++good_checks;
  }
  counts.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return finding;
}

// Runs a part of a motion and its check. Returns the check's finding, or that the motion has diverged.
template <class Part>
Instability attempted(const Part& part)
{
  try
  {
    return part();
  }
  catch (const Diverged&)
  {
    if (mutation::blind_guard)
      throw;
    return Instability::not_finite;
  }
}

// The first retry starts at the latest good state. If a retry fails after it has passed a check, the next retry starts
// at the good state before that check, because the check may have overlooked the beginning of the fault. Returns false
// if `go_on` has ended the search for the origin of the instability, so that there is no report.
bool Guard::Implementation::go_back(Instability finding, const Controls& target, double end, const GoOn& go_on)
{
  if (tries > 0 && before.there)
  {
    for (std::size_t m = 0; m < activation.size(); ++m)
      activation[m] = std::max(activation[m], good.since[m]);
    std::swap(good, before);
  }
  if (tries == settings.tries)
  {
    const InstabilityReport report = examined(finding, target, end, go_on);
    solver.restore(*good.snapshot);
    solver.slow_down(1);
    tries = 0;
    checked_at = steps();
    if (!go_on())
      return false;
    throw Unstable(report);
  }
  ++tries;
  ++counts.rollbacks;
  counts.latest = finding;
  solver.restore(*good.snapshot);
  solver.slow_down(std::pow(settings.slower, tries));
  before.there = false;
  checked_at = steps();
  good_checks = 0;
  bone_way.assign(good.bone.size(), 0);
  return true;
}

std::int32_t Guard::Implementation::voxel_at(std::int32_t node) const
{
  const auto& all = model->voxel_nodes;
  const auto has = [&](const auto& corners)
  { return std::find(corners.begin(), corners.end(), node) != corners.end(); };
  return static_cast<std::int32_t>(std::find_if(all.begin(), all.end(), has) - all.begin());
}

// Finds where the motion goes wrong. NaN and infinity spread over many voxels within a few steps. The motion is
// therefore repeated step by step from the good state until the first voxel has them.
InstabilityReport Guard::Implementation::examined(Instability finding, const Controls& target, double end,
                                                  const GoOn& go_on)
{
  std::vector<bool> moved;
  for (std::size_t b = 0; b < target.bone.size(); ++b)
    moved.push_back(target.bone[b] != good.bone[b]);
  const double time = solver.time();
  Monitor worst = solver.monitor();
  if (!worst.finite)
  {
    solver.restore(*good.snapshot);
    worst = good.monitor;
    const std::int64_t last = steps() + static_cast<std::int64_t>(longest_search) * settings.interval;
    const auto searches = [&] { return steps() < last && go_on(); };
    while (searches())
    {
      const double left = end - solver.time();
      const double dt = std::min(solver.time_step(), left);
      bool diverged = !(left > 0);
      try
      {
        if (!diverged)
          solver.advance(dt, interpolate(solver.controls(), target, dt / left), searches);
      }
      catch (const Diverged&)
      {
        diverged = true;
      }
      const Monitor now = solver.monitor();
      const bool shows =
          worst.worst_jacobian < crushed || worst.critical_time_step < stiffened * good.monitor.critical_time_step;
      if (now.finite || !shows)
        worst = now;
      if (!now.finite || diverged)
        break;
    }
  }
  // Chooses the voxel that is crushed or not finite; if there is none, the stiffest voxel, because the most stretched
  // voxel is the stiffest.
  std::int32_t voxel =
      !(worst.worst_jacobian >= crushed) || worst.stiffest_voxel < 0 ? worst.worst_voxel : worst.stiffest_voxel;
  LostNode lost;
  if (finding == Instability::past_rim)
  {
    voxel = voxel_at(worst.lost_node);
    NodalVectors displacements;
    solver.displacements(displacements);
    lost = { worst.lost_node, distance_from_rest(*model, worst.lost_node, displacements, solver.controls().bone) };
  }
  return describe(*model, finding, time, std::max(voxel, 0), worst.worst_jacobian, activation, moved, lost);
}

Guard::Guard(Solver& solver, std::shared_ptr<const Model> model, const GuardSettings& settings)
{
  const Model& watched = *model;
  self_.reset(new Implementation{
      solver, std::move(model), settings, EnergyBound(watched), {}, {}, {}, {}, 0, 0, 0, 0, false, {} });
  const auto refuse = [](const char* what, double value, const char* allowed)
  { throw Error(fmt::format("guard's {} is {:g}; allowed is {}", what, value, allowed)); };
  if (settings.interval < 0)
    refuse("interval", settings.interval, "0 (the solver's) or more steps");
  if (!(settings.slower > 0 && settings.slower < 1))
    refuse("share of the time step", settings.slower, "above 0 and below 1");
  if (settings.recovery < 1)
    refuse("recovery", settings.recovery, "1 check or more");
  if (settings.tries < 0 || settings.tries > 20)
    refuse("number of tries", settings.tries, "0 to 20");
  if (!(settings.inverted_share >= 0 && settings.inverted_share <= 1))
    refuse("share of inverted voxels", settings.inverted_share, "0 to 1");
  if (settings.interval == 0)
    self_->settings.interval = solver.steps_per_check();
  restart();
}

Guard::~Guard() = default;

void Guard::restart()
{
  Implementation& g = *self_;
  const Monitor monitor = g.solver.monitor();
  const double imbalance = g.settings.ledger ? g.solver.ledger().imbalance() : 0;
  g.good.largest_internal = g.before.largest_internal = 0;
  g.keep(monitor, imbalance);
  g.before.there = false;
  g.tries = 0;
  g.solver.slow_down(1);
  g.checked_at = g.steps();
  g.checked_step = g.solver.time_step();
}

bool Guard::check(const std::function<bool()>& go_on)
{
  const Instability finding = self_->check();
  if (finding != Instability::none)
    self_->go_back(finding, self_->solver.controls(), self_->solver.time(), go_on ? go_on : always);
  return finding == Instability::none;
}

bool Guard::advance(double seconds, const Controls& target, const std::function<bool()>& go_on)
{
  Implementation& g = *self_;
  g.solver.check(seconds, target);
  const double end = g.solver.time() + seconds;
  bool ended = false;
  const auto goes_on = [&]
  {
    ended = ended || (go_on && !go_on());
    return !ended;
  };
  for (bool done = false; !done && !ended;)
  {
    const double left = end - g.solver.time();
    const double part = static_cast<double>(g.checked_at + g.settings.interval - g.steps()) * g.solver.time_step();
    done = part >= left;
    // If the time step falls within the part, its check is not put off to the end.
    const auto part_goes_on = [&] { return goes_on() && (g.steps() - g.checked_at) / 2 < g.settings.interval; };
    const auto go = [&]
    {
      const Controls to = done ? target : interpolate(g.solver.controls(), target, part / left);
      const std::vector<RigidTransform> from = g.solver.controls().bone;
      done = g.solver.advance(done ? left : part, to, part_goes_on) && done;
      for (std::size_t m = 0; m < to.activation.size(); ++m)
        g.activation[m] = std::max({ g.activation[m], to.activation[m], g.solver.activation()[m] });
      for (std::size_t b = 0; b < to.bone.size(); ++b)
        g.bone_way[b] += farthest_way(from[b], g.solver.controls().bone[b], far_corner(*g.model));
      if (!done)
        goes_on();
      return ended || g.check_is_due() ? g.check() : Instability::none;
    };
    const Instability finding = attempted(go);
    if (finding != Instability::none)
    {
      g.go_back(finding, target, end, goes_on);
      done = false;
    }
    else if (g.tries > 0 && g.good_checks >= g.settings.recovery)
    {
      g.tries = 0;
      g.solver.slow_down(1);
    }
  }
  return !ended;
}

bool Guard::advance_checked(double seconds, const Controls& target, const std::function<bool()>& go_on)
{
  const double end = self_->solver.time() + seconds;
  while (advance(end - self_->solver.time(), target, go_on))
    if (check(go_on))
      return true;
  return false;
}

Equilibrium Guard::settle(const Controls& target, double tolerance, double seconds,
                          const std::function<bool(const Equilibrium&)>& go_on)
{
  Implementation& g = *self_;
  g.solver.check(seconds, target);
  const double end = g.solver.time() + seconds;
  Equilibrium result;
  for (Instability finding = Instability::time_step; finding != Instability::none;)
  {
    // In settle(), muscles respond to the target without delay.
    for (std::size_t m = 0; m < target.activation.size(); ++m)
      g.activation[m] = std::max(g.activation[m], target.activation[m]);
    for (std::size_t b = 0; b < target.bone.size(); ++b)
      g.bone_way[b] += farthest_way(g.solver.controls().bone[b], target.bone[b], far_corner(*g.model));
    struct Settling
    {
      explicit Settling(bool& it) : on(it) { on = true; }
      ~Settling() { on = false; }
      bool& on;
    };
    const auto go = [&]
    {
      const Settling settling(g.settling);
      finding = Instability::none;
      result = g.solver.settle(target, tolerance, end - g.solver.time(),
                               [&](const Equilibrium& now)
                               {
                                 if (g.steps() - g.checked_at >= g.settings.interval)
                                   finding = g.check();
                                 return finding == Instability::none && (!go_on || go_on(now));
                               });
      return finding == Instability::none ? g.check() : finding;
    };
    finding = attempted(go);
    if (finding != Instability::none && !g.go_back(finding, target, end, [&] { return !go_on || go_on({}); }))
      break;
  }
  restart();
  return result;
}

const GuardCounts& Guard::counts() const { return self_->counts; }
const Monitor& Guard::latest() const { return self_->good.monitor; }

}  // namespace frontalis
