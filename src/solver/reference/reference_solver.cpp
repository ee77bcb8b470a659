#include "solver/reference/reference_solver.hpp"

#include "frontalis/physics/time_step.hpp"
#include "frontalis/solver/backend.hpp"
#include "solver/energy/voxel_monitor.hpp"
#include "solver/stepping/effect_switches.hpp"
#include "solver/stepping/step_bound.hpp"
#include "solver/stepping/time_stepper.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{

ReferenceSolver::ReferenceSolver(const BackendInput& input) : HostBackend(input, 0, {})
{
  voxels_.resize(model_->voxels.size());
  stiffness_.resize(voxels_.size());
  mix_voxels();
  for (int point = 0; point < 8; ++point)
  {
    const double x = 1 / std::sqrt(3.0);
    shape_derivatives({ point & 1 ? x : -x, point & 2 ? x : -x, point & 4 ? x : -x }, gauss_[point]);
  }
  for (int b = 0; b < 8; ++b)
  {
    const double xi[3] = { b & 1 ? 1.0 : -1.0, b & 2 ? 1.0 : -1.0, b & 4 ? 1.0 : -1.0 };
    hourglass_shape_[0][b] = xi[0] * xi[1];
    hourglass_shape_[1][b] = xi[0] * xi[2];
    hourglass_shape_[2][b] = xi[1] * xi[2];
    hourglass_shape_[3][b] = xi[0] * xi[1] * xi[2];
  }
  for (auto& component : f_)
    component.assign(model_->nodes.size(), 0);
  relaxed_.values.resize(discretisation_.viscous_terms > 0 ? model_->voxels.size() : 0);
  fibre_memory_.resize(account_ ? model_->fibre_muscle.size() : 0);
}

BackendTraits ReferenceSolver::traits() const
{
  BackendTraits traits;
  traits.description = "reference (double, 1 thread)";
  return traits;
}

void ReferenceSolver::mix_voxels()
{
  for (std::size_t e = 0; e < voxels_.size(); ++e)
    discretisation_.voxel(e, voxels_[e]);
}

void ReferenceSolver::effects_switched()
{
  mix_voxels();
  HostBackend::effects_switched();
}

void ReferenceSolver::list_arrays(ArrayList& list)
{
  HostBackend::list_arrays(list);
  list.add("voxels", voxels_);
  list.add("stiffness now", stiffness_);
  for (const auto& component : f_)
    list.add("forces", component);
  list.add_state(effect_of_fibres(*model_), "work of fibres", fibre_memory_);
}

NodeShare ReferenceSolver::all_nodes() const
{
  return { 0, 1, 0, model_->size[2] + 1, 0, static_cast<std::int32_t>(model_->nodes.size()) };
}

void ReferenceSolver::find_forces(const NodeShare& /*share*/, const Components& u)
{
  accounting_ = false;
  forces(u, conditions_.activation);
}

Monitor ReferenceSolver::monitor()
{
  NodalVectors u, v;
  get(NodalField::displacements, u);
  get(NodalField::velocities, v);
  return monitor_voxels(*model_, discretisation_, u, v, mobility_);
}

void ReferenceSolver::measure_growth(double found, bool keeps)
{
  const NodeShare share = all_nodes();
  find_forces(share, u_);
  std::vector<double> sum(model_->nodes.size());
  const IndexRange nodes{ 0, share.end_node };
  bound_of_nodes(discretisation_, *model_, stiffness_.data(), { 0, static_cast<std::int32_t>(stiffness_.size()) },
                 nodes, mobility_, sum.data());
  limit_mobility(discretisation_, nodes, sum.data(), found, keeps, mobility_);
}

Work ReferenceSolver::work(bool open)
{
  if (open)
    account_->open();
  // With this flag, forces() records the work of fibres in the latest step.
  accounting_ = true;
  forces(u_, conditions_.activation);
  if (open)
    std::fill(account_->muscle.begin(), account_->muscle.end(), 0.0);
  else if (relaxed_.relax())
    relax(0, u_);
  return account_->work();
}

PlanMeasures ReferenceSolver::run(const StepPlan& plan)
{
  std::vector<float> activation(model_->muscles.size(), 0);
  double* const u[3] = { u_[0].data(), u_[1].data(), u_[2].data() };
  double* const v[3] = { v_[0].data(), v_[1].data(), v_[2].data() };
  double* const f[3] = { f_[0].data(), f_[1].data(), f_[2].data() };
  const NodeShare share = all_nodes();
  const std::vector<NodePart<double>*> parts = active_parts();
  double worst = 0;
  for (int step = 0; step < plan.steps; ++step)
  {
    const double kick = step == 0 ? plan.first_kick : plan.dt;
    const physics::Kick<double> factors = conditions_.kick<double>(kick);
    plan.activation(step, activation.data());
    accounting_ = account_ != nullptr;
    forces(u_, activation);
    const ConstraintStep constraint_step = plan.constraint_step(step);
    for (NodePart<double>* const part : parts)
      part->prepare_step(share, pointers(u_).data());
    for (NodePart<double>* const part : parts)
      part->before_step(share, pointers(u_).data(), constraint_step);
    for (NodePart<double>* const part : parts)
      part->add_forces(share, ForceSink<double>(f));
    const Components before = u_;
    if (plan.bound_every_step || step + 1 == plan.steps)
      worst =
          physics::larger_or_none(worst, step_bound(discretisation_, *model_, stiffness_, mobility_).frequency_squared);
    if (account_)
      account_->before(share.first_node, share.end_node, v);
    for (int axis = 0; axis < 3; ++axis)
      for (std::size_t n = 0; n < model_->nodes.size(); ++n)
      {
        v_[axis][n] =
            physics::kicked(factors, axis, v_[axis][n], factors.gain / discretisation_.node_mass[n], f_[axis][n]);
        u_[axis][n] += plan.dt * v_[axis][n];
      }
    const double* const old[3] = { before[0].data(), before[1].data(), before[2].data() };
    if (account_)
      account_->unconstrained(share.first_node, share.end_node, v);
    for (NodePart<double>* const part : parts)
      part->constrain(share, u, v, old, constraint_step);
    for (NodePart<double>* const part : parts)
      part->constrain_groups(share, u, v, constraint_step);
    for (NodePart<double>* const part : parts)
      part->after_step(share, old, u);
    if (account_)
      account_->after(share.first_plane, share.end_plane, old, u, v, conditions_.damping, plan.dt, kick);
    for (NodePart<double>* const part : parts)
      if (account_)
        part->account(share, *account_, v, kick);
    if (relaxed_.relax() && plan.relaxation[step] > 0)
      relax(plan.relaxation[step], before);
  }
  return { worst, std::sqrt(fastest_squared(share)) };
}

namespace
{

std::unique_ptr<Solver> make_reference_solver(std::shared_ptr<const Model> model, const SolverSettings& settings,
                                              const std::string& /*remark*/)
{
  return std::make_unique<TimeStepper>(
      std::move(model), settings, [](const BackendInput& input) { return std::make_unique<ReferenceSolver>(input); });
}

}  // namespace

BackendDescription reference_backend() { return { "reference", make_reference_solver }; }

}  // namespace frontalis
