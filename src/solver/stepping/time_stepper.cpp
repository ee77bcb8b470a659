#include "solver/stepping/time_stepper.hpp"

#include "solver/contact/past_rim.hpp"

#include "frontalis/solver/damping.hpp"
#include "frontalis/solver/rigid_motion.hpp"
#include "solver/stepping/dynamic_relaxation.hpp"
#include "solver/stepping/muscle_response.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

namespace frontalis
{
namespace
{

// Viscous stresses relax at the end of each plan, and whenever this fraction of the shortest time constant has passed.
constexpr double relaxation_interval = 0.005;
constexpr double fully_relaxed = 1e9;  // a time longer than any time constant [s]
// Plans are short while a muscle's activation is farther than this from its target, because tissue then stiffens fast.
constexpr float response_left = 0.1F;
constexpr double plan_of_muscles = 4e-3;  // [s]
constexpr double swinging = 0.1;          // time for which tissue swings after a change of poses or activations [s]
// During dynamic relaxation, a window ends after this number of steps even if no motion is found.
constexpr int steps_per_window = 2048;

// Adds the wall seconds from its construction to its destruction to a sum.
class Stopwatch
{
public:
  explicit Stopwatch(double& sum) : sum_(sum), start_(std::chrono::steady_clock::now()) {}
  ~Stopwatch() { sum_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

private:
  double& sum_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace

TimeStepper::TimeStepper(std::shared_ptr<const Model> model, const SolverSettings& settings,
                         const MakeBackend& make_backend)
    : model_((check_model(*model), std::move(model))),
      discretisation_(*model_),
      effects_(*model_),
      controller_(discretisation_.frequency_squared_max, model_->time_step_estimate, model_->time_step_share,
                  settings.time_step),
      mass_in_motion_(*model_, discretisation_),
      motion_(at_rest()),
      damping_(model_->damping)
{
  conditions_.damping = damping_;
  renew_conditions();
  backend_ = make_backend({ *model_, discretisation_, conditions_, settings });
  traits_ = backend_->traits();
  if (settings.ledger)
    ledger_ = std::make_unique<EnergyLedgerKeeper>(*model_, discretisation_, conditions_, *backend_);
  open_ledger();
}

TimeStepper::Motion TimeStepper::at_rest() const
{
  const std::vector<float> relaxed(model_->muscles.size(), 0);
  const std::vector<RigidTransform> in_place(model_->bones.size());
  const double critical_step = 2 / std::sqrt(discretisation_.frequency_squared_max);
  return { BoneMotionLimits(*model_, critical_step), { relaxed, in_place }, relaxed, {} };
}

void TimeStepper::renew_conditions()
{
  conditions_.running = effects_.running();
  conditions_.gravity = effects_.gravity();
  conditions_.activation = effects_.felt(motion_.activation);
  conditions_.bone = motion_.controls.bone;
}

void TimeStepper::reset()
{
  const std::vector<AddedMass> before = std::exchange(motion_, at_rest()).added;
  replace_masses(before);
  backend_->set(NodalField::displacements, {});
  controller_.reset();
  profile_ = {};
  renew_conditions();
  open_ledger();
}

void TimeStepper::set_displacements(const NodalVectors& in)
{
  backend_->set(NodalField::displacements, in);
  controller_.velocities_set(0);
  displacements_were_set();
}

void TimeStepper::set_velocities(const NodalVectors& in)
{
  backend_->set(NodalField::velocities, in);
  double fastest = 0;
  for (const auto& v : in)
    fastest = std::max(fastest, std::hypot(v[0], v[1], v[2]));
  controller_.velocities_set(fastest / shortest_edge());
  open_ledger();
}

void TimeStepper::displacements_were_set()
{
  const double critical = backend_->monitor().critical_time_step;
  motion_.latest_step = 0;
  controller_.displacements_set(4 / (critical * critical));
  open_ledger();
}

void TimeStepper::check(double seconds, const Controls& target) const
{
  if (!(seconds >= 0) || !std::isfinite(seconds))
    throw Error(fmt::format("advance by {:g} s: allowed are finite durations from 0", seconds));
  if (target.activation.size() != model_->muscles.size() || target.bone.size() != model_->bones.size())
    throw Error(fmt::format("controls for {} muscles and {} bones; the model has {} and {}", target.activation.size(),
                            target.bone.size(), model_->muscles.size(), model_->bones.size()));
  for (std::size_t m = 0; m < target.activation.size(); ++m)
    if (!(target.activation[m] >= 0 && target.activation[m] <= 1))
      throw Error(
          fmt::format("activation of {} is {:g}; allowed is 0 to 1", model_->muscles[m].name, target.activation[m]));
  for (std::size_t b = 0; b < target.bone.size(); ++b)
    if (!is_rigid_motion(target.bone[b]))
      throw Error("pose of bone " + model_->bones[b] + " is not a finite rigid motion");
  if (motion_.diverged)
    throw Error("the motion has diverged earlier: reset the solver first");
}

double TimeStepper::shortest_edge() const { return *std::min_element(model_->spacing.begin(), model_->spacing.end()); }

bool TimeStepper::advance(double seconds, const Controls& asked, const std::function<bool()>& go_on)
{
  check(seconds, asked);
  const Stopwatch stopwatch(profile_.stepping);
  const double begin = motion_.time, end = begin + seconds;
  const Controls from = motion_.controls;
  const Controls target{ asked.activation, motion_.bones.reached(from.bone, asked.bone, seconds) };
  const double longest = longest_step();
  if (motion_.bones.jumps(from.bone, target.bone, seconds, time_step()))
    controller_.bone_jumped();
  if (seconds > 0)
    motion_.bones.moved(from.bone, seconds);
  while (motion_.time < end)
  {
    if (model_->time_step_estimate == TimeStepEstimate::assembled)
      renew_assembled_estimate(target);
    const auto choice =
        controller_.choose(end - motion_.time, longest, longest_plan(target, end - motion_.time), traits_);
    const double reached = choice.reaches_end ? end : motion_.time + choice.steps * choice.dt;
    const Controls next = choice.reaches_end ? target : interpolate(from, target, (reached - begin) / seconds);
    const StepPlan plan = plan_to(next, choice);
    const PlanMeasures measured = backend_->run(plan);
    motion_.time = reached;
    motion_.latest_step = plan.dt;
    motion_.controls = next;
    profile_.steps += plan.steps;
    motion_.diverged = !std::isfinite(measured.frequency_squared) || !std::isfinite(measured.speed);
    if (motion_.diverged)
      throw Diverged(fmt::format("the motion diverged at {:g} s: displacements are no longer finite", motion_.time));
    controller_.observe(measured.frequency_squared, measured.speed / shortest_edge(), plan.steps);
    if (go_on && motion_.time < end && !go_on())
      return false;
  }
  motion_.controls = target;
  return true;
}

double TimeStepper::longest_step() const
{
  double longest = std::numeric_limits<double>::infinity();
  for (const auto& stiffness : discretisation_.added)
    longest = std::min(longest, model_->time_step_share * stiffness->longest_step());
  return longest;
}

double TimeStepper::longest_plan(const Controls& target, double seconds) const
{
  double longest = motion_.bones.longest_plan(motion_.controls.bone, target.bone, seconds);
  for (std::size_t m = 0; m < target.activation.size(); ++m)
    if (std::abs(target.activation[m] - motion_.activation[m]) > response_left)
      longest = std::min(longest, plan_of_muscles);
  return longest;
}

void TimeStepper::renew_assembled_estimate(const Controls& asked)
{
  const auto search = [this](const std::vector<float>& activation) { return search_frequency(activation); };
  std::vector<float> most = motion_.activation;
  for (std::size_t m = 0; m < most.size(); ++m)
    most[m] = std::max({ most[m], motion_.controls.activation[m], asked.activation[m] });
  const bool moving = asked.bone != motion_.controls.bone;
  if (moving || most != motion_.activation)
    motion_.changed = motion_.time;
  // Tissue that swings on distorts voxels. If these got mass, others are as close to the limit.
  const bool swings = !motion_.added.empty() && motion_.time - motion_.changed < swinging;
  const auto renewal = controller_.renew_assembled(most, moving || swings, search);
  const double found = controller_.state().assembled.latest();
  if (renewal.searched)
    backend_->measure_growth(found > 0 && std::isfinite(found) ? found : std::numeric_limits<double>::infinity(),
                             renewal.confirmed);
}

// Makes a plan that ends with the controls `next`, and advances the muscles' activations to its end.
StepPlan TimeStepper::plan_to(const Controls& next, const TimeStepController::Choice& choice)
{
  StepPlan plan;
  plan.steps = choice.steps;
  plan.dt = choice.dt;
  // A backend may need another launch for a kick of its own. Rounding errors shall not cost one.
  const double longer = motion_.latest_step > 0 ? motion_.latest_step / plan.dt - 1 : 0;
  plan.first_kick = std::abs(longer) > 1e-9 ? plan.dt * (1 + 0.5 * longer) : plan.dt;
  plan.time = motion_.time;
  const std::vector<float> before = motion_.activation;
  respond(*model_, motion_.controls.activation, next.activation, plan.steps * plan.dt, motion_.activation);
  plan.begin = { effects_.felt(before), motion_.controls.bone };
  plan.end = { effects_.felt(motion_.activation), next.bone };
  conditions_.activation = plan.end.activation;
  conditions_.bone = plan.end.bone;
  const bool switched = controller_.muscles_switched(before, motion_.activation);
  plan.bound_every_step = choice.bound_every_step || switched;
  plan.bound_awaited = choice.bound_awaited || switched;
  plan.alarming = controller_.alarming();
  plan.relaxation.assign(plan.steps, 0);
  double elapsed = 0;
  for (int step = 0; step < plan.steps && effects_.running().has(Effect::viscosity); ++step)
  {
    elapsed += plan.dt;
    if (step + 1 < plan.steps && elapsed < relaxation_interval * discretisation_.viscous_time_min)
      continue;
    plan.relaxation[step] = settling_ ? fully_relaxed : elapsed;
    elapsed = 0;
  }
  return plan;
}

void TimeStepper::internal_forces(NodalVectors& out)
{
  backend_->internal_forces(out);
  NodalVectors pushing(out.size());
  EnergyLedger unused = empty_ledger();
  backend_->add_energies(false, pushing, unused);
  for (std::size_t n = 0; n < out.size(); ++n)
    for (std::size_t axis = 0; axis < 3; ++axis)
      out[n][axis] -= pushing[n][axis];
}

Equilibrium TimeStepper::settle(const Controls& target, double tolerance, double seconds,
                                const std::function<bool(const Equilibrium&)>& go_on)
{
  if (!(tolerance > 0) || !std::isfinite(tolerance))
    throw Error(fmt::format("equilibrium within {:g}: allowed are tolerances above 0", tolerance));
  check(seconds, target);
  // An equilibrium has no history: viscous stresses count as relaxed during the lifetime of this object.
  struct Settling
  {
    explicit Settling(TimeStepper& s) : stepper(s) { stepper.settling_ = true; }
    ~Settling()
    {
      stepper.conditions_.damping = stepper.damping_;
      stepper.settling_ = false;
      stepper.open_ledger();
    }
    TimeStepper& stepper;
  } const settling(*this);
  motion_.activation = motion_.controls.activation = target.activation;  // muscles respond at once
  renew_conditions();

  const double begin = motion_.time;
  Equilibrium now;
  const auto goes_on = [&] { return !go_on || go_on(now); };
  while (motion_.controls.bone != target.bone && motion_.time - begin < seconds)
    if (!advance(traits_.steps_per_observation * time_step(), target, goes_on) || !goes_on())
      return now;

  NodalVectors u, f;
  displacements(u);
  internal_forces(f);
  const int longest_window = std::max(1, steps_per_window / traits_.steps_per_observation);
  DynamicRelaxation relaxation({ tolerance, model_->damping, longest_window }, discretisation_.node_mass, begin, u, f);
  const auto forces = [this](NodalVectors& out) { internal_forces(out); };
  now = relaxation.result();
  while (!now.reached && motion_.time - begin < seconds)
  {
    const double part = std::min(traits_.steps_per_observation * time_step(), seconds - (motion_.time - begin));
    if (!advance(part, target, goes_on))
      break;
    displacements(u);
    relaxation.observe(motion_.time, u, forces, 1 / time_step(), motion_.time - begin >= seconds);
    now = relaxation.result();
    conditions_.damping = relaxation.damping();
    if (!goes_on())
      break;
  }
  return now;
}

void TimeStepper::set_damping(double damping)
{
  if (!(damping >= 0) || !std::isfinite(damping))
    throw Error(fmt::format("damping {:g} 1/s: allowed are finite numbers from 0", damping));
  conditions_.damping = damping_ = damping;
}

void set_damping(Solver& solver, double damping) { dynamic_cast<TimeStepper&>(solver).set_damping(damping); }

std::vector<Allocation> TimeStepper::allocations() const
{
  ArrayList list;
  if (skin_values_)
    skin_values_->list_arrays(list);
  discretisation_.list_arrays(list);
  if (ledger_)
    ledger_->list_arrays(list);
  backend_->list_arrays(list);
  return list.take_allocations();
}

void TimeStepper::skin_field(SkinField field, std::vector<float>& out)
{
  const Stopwatch stopwatch(profile_.skin);
  if (const EffectPresence fields = presence_of(*model_, Effect::output_fields); !fields.present)
    throw Error("the model has no output_fields: " + fields.why);
  if (!skin_values_)
    skin_values_ = std::make_unique<SkinValues>(*model_, discretisation_);
  NodalVectors u;
  displacements(u);
  skin_values_->compute(field, u, conditions_.activation, effects_.running(), out);
}

Monitor TimeStepper::monitor()
{
  const Stopwatch stopwatch(profile_.monitor);
  Monitor result = backend_->monitor();
  result.critical_time_step = controller_.critical_step_at(4 / (result.critical_time_step * result.critical_time_step));
  result.step_share = motion_.latest_step / result.critical_time_step;
  result.lost_points = backend_->lost_points();
  result.bodies = backend_->body_energy();
  result.added_mass = mass_in_motion_.proportion(motion_.added);
  if (result.finite && slides())
  {
    NodalVectors u;
    displacements(u);
    find_nodes_past_rim(*model_, u, motion_.controls.bone, result);
  }
  return result;
}

void TimeStepper::open_ledger()
{
  const Stopwatch stopwatch(profile_.monitor);
  if (ledger_ && !settling_)
    ledger_->open(motion_.time, ledger_step());
}

EnergyLedger TimeStepper::ledger()
{
  if (!ledger_)
    throw Error("no energy ledger is kept: set SolverSettings::ledger");
  const Stopwatch stopwatch(profile_.monitor);
  return ledger_->balance(motion_.time, ledger_step());
}

double TimeStepper::ledger_step() const { return motion_.latest_step > 0 ? motion_.latest_step : time_step(); }

}  // namespace frontalis
