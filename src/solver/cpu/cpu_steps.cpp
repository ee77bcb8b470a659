#include "solver/cpu/cpu_solver.hpp"
#include "solver/cpu/flush_denormals.hpp"

#include "frontalis/physics/time_step.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>

namespace frontalis
{
namespace
{

// Time for which the calling thread ran on a core [s].
double thread_time()
{
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace

template <class Real>
void CpuSolver<Real>::kick(Arguments& g, double seconds) const
{
  g.kick = static_cast<Real>(seconds);
  static_cast<physics::Kick<Real>&>(g) = conditions_.template kick<Real>(seconds);
}

template <class Real>
CpuKernelArguments<Real> CpuSolver<Real>::arguments(double dt, const float* activation)
{
  Arguments g{};
  const auto& h = model_->spacing;
  for (int axis = 0; axis < 3; ++axis)
  {
    g.u[axis] = u_[axis].data();
    g.next[axis] = next_[axis].data();
    g.v[axis] = v_[axis].data();
    g.rounding[axis] = rounding_[axis].empty() ? nullptr : rounding_[axis].data();
    g.scale[axis] = static_cast<Real>(0.25 / h[axis]);
    g.hourglass_weight[axis] = static_cast<Real>(discretisation_.hourglass_weight[axis]);
    g.stretch_weight[axis] = static_cast<Real>(discretisation_.stretch_weight[axis]);
  }
  g.stretch_half_sum = static_cast<Real>(discretisation_.stretch_half_sum);
  g.inverse_mass = inverse_mass_.data();
  g.mobility = mobility_.data();
  g.tiles = rows_.tiles.data();
  g.plane_tiles = rows_.plane_tiles.data();
  g.stiffness = rows_.stiffness.data();
  g.stabilisation = rows_.stabilisation.empty() ? nullptr : rows_.stabilisation.data();
  g.plane_nodes = rows_.plane_nodes.data();
  g.planes = rows_.planes;
  g.selective_reduced = discretisation_.selective_reduced;
  g.fibres = runs(Effect::contraction) || runs(Effect::fibre_stiffness) ? rows_.fibres.data() : nullptr;
  g.fibre_muscle = rows_.fibre_muscle.data();
  g.laws = rows_.laws.data();
  g.viscous = rows_.viscous.data();
  g.cut = rows_.cut.data();
  g.relaxed = relaxed_.values.data();
  g.viscous_terms = runs(Effect::viscosity) ? discretisation_.viscous_terms : 0;
  g.activation = activation;
  g.with_length = with_length_.data();
  g.with_passive = with_passive_.data();
  if (account_)
  {
    g.fibre_memory = fibre_memory_.data();
    g.muscle_work = account_->muscle.data();
    g.viscous_work = account_->viscous.data();
  }
  g.dt = static_cast<Real>(dt);
  kick(g, dt);
  g.buffer_stride = buffer_stride_;
  return g;
}

template <class Real>
void CpuSolver<Real>::on_all_threads(const std::function<void(const NodeShare&)>& task)
{
  team_.run(
      [&](int t)
      {
        const FlushDenormals flush;
        const std::int32_t first = slab_[t], end = slab_[t + 1];
        task({ t, team_.size(), first, end, rows_.plane_nodes[first], rows_.plane_nodes[end] });
      });
}

template <class Real>
void CpuSolver<Real>::find_forces(const NodeShare& share, const Components& u)
{
  Arguments g = arguments(0, conditions_.activation.data());
  g.fibre_memory = nullptr;
  for (int axis = 0; axis < 3; ++axis)
    g.u[axis] = u[axis].data();
  kernel_(g, share.first_plane, share.end_plane, buffers_[share.thread].data(), KernelTask::forces);
}

template <class Real>
Work CpuSolver<Real>::work(bool open)
{
  if (open)
    account_->open();
  // If the account is being opened, fibres store only their stress and stretch; otherwise also their work in the latest
  // step.
  Arguments g = arguments(0, conditions_.activation.data());
  if (open)
    g.muscle_work = nullptr;
  const auto run_on_all = [&](const Arguments& arguments, KernelTask task)
  {
    on_all_threads([&](const NodeShare& share)
                   { kernel_(arguments, share.first_plane, share.end_plane, buffers_[share.thread].data(), task); });
  };
  run_on_all(g, KernelTask::forces);
  if (!open && relaxed_.relax())
    run_on_all(arguments(0, nullptr), KernelTask::relax);
  return account_->work();
}

template <class Real>
PlanMeasures CpuSolver<Real>::run(const StepPlan& plan)
{
  const std::size_t muscles = model_->muscles.size();
  std::vector<float> activation(plan.steps * muscles, 0);
  std::vector<ConstraintStep> constraint_steps;
  for (int step = 0; step < plan.steps; ++step)
  {
    plan.activation(step, activation.data() + step * muscles);
    constraint_steps.push_back(plan.constraint_step(step));
  }
  const std::vector<NodePart<Real>*> parts = this->active_parts();
  const bool prepared = std::any_of(parts.begin(), parts.end(), [](const auto* part) { return part->prepares(); });
  const bool pushed = std::any_of(parts.begin(), parts.end(), [](const auto* part) { return part->pushes(); });
  const bool grouped = std::any_of(parts.begin(), parts.end(), [](const auto* part) { return part->groups(); });
  if (team_size_.working() != team_.size())
  {
    team_.resize(team_size_.working());
    share_planes();
  }
  std::vector<PlanMeasures> seen(team_.size());
  std::vector<double> ran(team_.size());
  const auto start = std::chrono::steady_clock::now();
  Arguments first = arguments(plan.dt, nullptr);
  kick(first, plan.first_kick);
  on_all_threads(
      [&](const NodeShare& share)
      {
        const double started = thread_time();
        Arguments g = first;
        Real* const buffer = buffers_[share.thread].data();
        for (int step = 0; step < plan.steps; ++step)
        {
          if (step == 1)
            kick(g, plan.dt);
          g.activation = activation.data() + step * muscles;
          if (account_)
            account_->before(share.first_node, share.end_node, g.v);
          for (NodePart<Real>* const part : parts)
            part->prepare_step(share, g.u);
          if (prepared)
            team_.barrier();
          for (NodePart<Real>* const part : parts)
            part->before_step(share, g.u, constraint_steps[step]);
          if (pushed)
            team_.barrier();
          const auto task =
              plan.bound_every_step || step + 1 == plan.steps ? KernelTask::step_and_bound : KernelTask::step;
          double& most = seen[share.thread].frequency_squared;
          most = physics::larger_or_none(
              most, static_cast<double>(kernel_(g, share.first_plane, share.end_plane, buffer, task)));
          for (NodePart<Real>* const part : parts)
            part->add_forces(share, { g.gain, g.dt, inverse_mass_.data(), g.next, g.v });
          if (account_)
            account_->unconstrained(share.first_node, share.end_node, g.v);
          for (NodePart<Real>* const part : parts)
            part->constrain(share, g.next, g.v, g.u, constraint_steps[step]);
          if (grouped)
          {
            team_.barrier();
            for (NodePart<Real>* const part : parts)
              part->constrain_groups(share, g.next, g.v, constraint_steps[step]);
            team_.barrier();
          }
          for (NodePart<Real>* const part : parts)
            part->after_step(share, g.u, g.next);
          if (account_)
            account_->after(share.first_plane, share.end_plane, g.u, g.next, g.v, conditions_.damping, double(g.dt),
                            double(g.kick));
          for (NodePart<Real>* const part : parts)
            if (account_)
              part->account(share, *account_, g.v, double(g.kick));
          team_.barrier();
          for (int axis = 0; axis < 3; ++axis)
          {
            Real* const old = const_cast<Real*>(g.u[axis]);
            g.u[axis] = g.next[axis];
            g.next[axis] = old;
          }
          if (relaxed_.relax() && plan.relaxation[step] > 0)
          {
            g.viscous_elapsed = static_cast<Real>(plan.relaxation[step]);
            kernel_(g, share.first_plane, share.end_plane, buffer, KernelTask::relax);
            team_.barrier();
          }
        }
        seen[share.thread].speed = std::sqrt(static_cast<double>(this->fastest_squared(share)));
        ran[share.thread] = thread_time() - started;
      });
  team_size_.add(plan.steps, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), ran);
  if (plan.steps % 2 == 1)
    u_.swap(next_);
  PlanMeasures all;
  for (const PlanMeasures& of : seen)
    all = { physics::larger_or_none(all.frequency_squared, of.frequency_squared),
            physics::larger_or_none(all.speed, of.speed) };
  return all;
}

template class CpuSolver<float>;
template class CpuSolver<double>;

}  // namespace frontalis
