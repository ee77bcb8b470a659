#include "solver/reference/reference_solver.hpp"

#include "solver/skin/bound_points.hpp"
#include "frontalis/solver/backend.hpp"
#include "frontalis/physics/time_step.hpp"
#include "solver/stepping/step_bound.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{

ReferenceSolver::ReferenceSolver(std::shared_ptr<const Model> model, const SolverSettings& settings)
    : SteppingSolver(std::move(model), settings), restricted_(*model_), loads_(*model_, discretisation_)
{
  voxels_.resize(model_->voxels.size());
  stiffness_.resize(voxels_.size());
  mix_voxels();
  shape_derivatives({ 0, 0, 0 }, centre_);
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
  if (wants_ledger_)
  {
    account_ = std::make_unique<EnergyAccount<double>>(*model_, discretisation_);
    fibre_memory_.resize(model_->fibre_muscle.size());
  }
  rest();
}

void ReferenceSolver::mix_voxels()
{
  for (std::size_t e = 0; e < voxels_.size(); ++e)
    discretisation_.voxel(e, voxels_[e]);
}

void ReferenceSolver::effect_switched(Effect effect)
{
  mix_voxels();
  if (effect == Effect::viscosity)
    std::fill(relaxed_.begin(), relaxed_.end(), std::array<physics::Symmetric3<double>, 2>{});
  if (effect == Effect::sliding || effect == Effect::friction)
    restricted_.run(effects());
  loads_.run(effects());
}

void ReferenceSolver::list_allocations(AllocationList& list) const
{
  list.add(Effect::elasticity, "voxels", voxels_);
  list.add(Effect::elasticity, "stiffness now", stiffness_);
  for (const auto* field : { &u_, &v_, &f_ })
    for (const auto& component : *field)
      list.add(Effect::elasticity, "motion and forces", component);
  list.add(Effect::viscosity, "relaxed stresses", relaxed_);
  list.add(effect_of_fibres(), "work of fibres", fibre_memory_);
  restricted_.list_allocations(list);
  loads_.list_allocations(list);
  if (account_)
    account_->list_allocations(list);
}

void ReferenceSolver::skin(SkinState& out) { skin_state(*model_, u_pointers().data(), out); }

void ReferenceSolver::rest()
{
  for (auto* field : { &u_, &v_, &f_ })
    for (auto& component : *field)
      component.assign(model_->nodes.size(), 0);
  relaxed_.assign(discretisation_.viscous_terms > 0 ? model_->voxels.size() : 0, {});
  restricted_.reset();
}

struct ReferenceSolver::Kept : Fields
{
  Components u, v;
  RestrictedNodes<double>::Contacts contacts;
  std::vector<std::array<physics::Symmetric3<double>, 2>> relaxed;
  EnergyAccount<double>::Book book;
  std::vector<std::array<double, 2>> fibre_memory;

  void archive(ByteArchive& archive) override
  {
    archive(u)(v)(relaxed)(fibre_memory);
    contacts.archive(archive);
    book.archive(archive);
  }
};

void ReferenceSolver::save_fields(std::unique_ptr<Fields>& to) const
{
  if (!to)
    to = std::make_unique<Kept>();
  Kept& kept = static_cast<Kept&>(*to);
  kept.u = u_;
  kept.v = v_;
  kept.contacts = restricted_.contacts();
  kept.relaxed = relaxed_;
  kept.fibre_memory = fibre_memory_;
  if (account_)
    kept.book = account_->book();
}

void ReferenceSolver::restore_fields(const Fields& from)
{
  const Kept& kept = static_cast<const Kept&>(from);
  u_ = kept.u;
  v_ = kept.v;
  restricted_.restore(kept.contacts);
  relaxed_ = kept.relaxed;
  fibre_memory_ = kept.fibre_memory;
  if (account_)
    account_->restore(kept.book);
}

void ReferenceSolver::interleave(const Components& in, Vectors& out) const
{
  out.resize(model_->nodes.size());
  for (std::size_t n = 0; n < out.size(); ++n)
    out[n] = { { in[0][n], in[1][n], in[2][n] } };
}

void ReferenceSolver::set_displacements(const Vectors& in)
{
  rest();
  for (std::size_t n = 0; n < in.size(); ++n)
    for (int axis = 0; axis < 3; ++axis)
      u_[axis][n] = in[n][axis];
  displacements_were_set();
}

void ReferenceSolver::set_velocities(const Vectors& in)
{
  for (std::size_t n = 0; n < in.size(); ++n)
    for (int axis = 0; axis < 3; ++axis)
      v_[axis][n] = in[n][axis];
  velocities_were_set();
}

void ReferenceSolver::forces_at_components(const Components& u, Vectors& out)
{
  accounting_ = false;
  forces(u, felt_activation());
  interleave(f_, out);
}

void ReferenceSolver::forces_at(const Vectors& at, Vectors& out)
{
  Components moved = u_;
  for (std::size_t n = 0; n < at.size(); ++n)
    for (int axis = 0; axis < 3; ++axis)
      moved[axis][n] = at[n][axis];
  forces_at_components(moved, out);
}

void ReferenceSolver::external_forces(Vectors& out)
{
  out.assign(model_->nodes.size(), {});
  loads_.update(time(), u_pointers().data());
  for (std::size_t l = 0; l < loads_.nodes().size(); ++l)
    out[loads_.nodes()[l]] = loads_.forces()[l];
}

void ReferenceSolver::open_account()
{
  account_->open();
  accounting_ = true;
  forces(u_, felt_activation());
  std::fill(account_->muscle.begin(), account_->muscle.end(), 0.0);
}

Work ReferenceSolver::work()
{
  // what fibres did in the latest step
  accounting_ = true;
  forces(u_, felt_activation());
  if (relaxes())
    relax(0, u_);
  return account_->work();
}

double ReferenceSolver::run(const StepPlan& plan)
{
  std::vector<float> activation(model_->muscles.size(), 0);
  double* const u[3] = { u_[0].data(), u_[1].data(), u_[2].data() };
  double* const v[3] = { v_[0].data(), v_[1].data(), v_[2].data() };
  const auto count = static_cast<std::int32_t>(model_->nodes.size());
  const std::vector<double> elapsed = relaxations(plan);
  double worst = 0;
  for (int step = 0; step < plan.steps; ++step)
  {
    const double kick = step == 0 ? plan.first_kick : plan.dt, keep = this->keep(kick), gain = this->gain(kick);
    if (runs(Effect::contraction))
      plan.activation(step, activation.data());
    accounting_ = account_ != nullptr;
    forces(u_, activation);
    loads_.update(plan.time + step * plan.dt, u_pointers().data());
    for (std::size_t l = 0; l < loads_.nodes().size(); ++l)
      for (int axis = 0; axis < 3; ++axis)
        f_[axis][loads_.nodes()[l]] -= loads_.forces()[l][axis];
    const Components before = u_;
    if (plan.closely || step + 1 == plan.steps)
      worst = physics::larger_or_none(worst, step_bound(discretisation_, *model_, stiffness_).frequency_squared);
    if (account_)
      account_->before(0, count, v);
    for (int axis = 0; axis < 3; ++axis)
      for (std::size_t n = 0; n < model_->nodes.size(); ++n)
      {
        const double acceleration = gravity_[axis] - f_[axis][n] / discretisation_.node_mass[n];
        v_[axis][n] = keep * v_[axis][n] + gain * acceleration;
        u_[axis][n] += plan.dt * v_[axis][n];
      }
    const double* const old[3] = { before[0].data(), before[1].data(), before[2].data() };
    if (account_)
      account_->unconstrained(0, count, v);
    restricted_.apply(0, count, u, v, old, plan.constraint_step(step));
    if (account_)
    {
      account_->after(0, model_->size[2] + 1, old, u, v, damping_, plan.dt, kick);
      for (std::int32_t k = 0; k <= model_->size[2]; ++k)
        account_->friction(k, restricted_, v);
      for (std::size_t l = 0; l < loads_.nodes().size(); ++l)
        account_->load(model_->nodes[loads_.nodes()[l]][2], loads_.nodes()[l], loads_.surface_forces()[l], v, kick);
    }
    if (relaxes() && elapsed[step] > 0)
      relax(elapsed[step], before);
  }
  return worst;
}

namespace
{

std::unique_ptr<Solver> make_reference_solver(std::shared_ptr<const Model> model, const SolverSettings& settings,
                                              const std::string& /*remark*/)
{
  auto solver = std::make_unique<ReferenceSolver>(std::move(model), settings);
  if (settings.ledger)
    solver->reset();
  return solver;
}

}  // namespace

BackendDescription reference_backend() { return { "reference", make_reference_solver }; }

}  // namespace frontalis
