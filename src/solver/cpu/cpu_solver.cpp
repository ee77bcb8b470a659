#include "solver/cpu/cpu_solver.hpp"

#include "frontalis/physics/viscosity.hpp"
#include "frontalis/solver/backend.hpp"
#include "solver/stepping/effect_switches.hpp"
#include "solver/stepping/time_stepper.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <type_traits>

namespace frontalis
{
namespace
{

CpuKernel<float> pick(const CpuKernelChoice& choice, float) { return choice.single; }
CpuKernel<double> pick(const CpuKernelChoice& choice, double) { return choice.wide; }
PartKernels<float> parts(const CpuKernelChoice& choice, float) { return choice.parts; }
PartKernels<double> parts(const CpuKernelChoice&, double) { return {}; }

}  // namespace

template <class Real>
CpuSolver<Real>::CpuSolver(const BackendInput& input, const std::string& remark)
    : Base(input, 2 * Tile::width, parts(choose_cpu_kernel(), Real(0))),
      rows_(*model_, discretisation_),
      choice_(choose_cpu_kernel()),
      kernel_(pick(choice_, Real(0))),
      team_(input.settings.threads),
      team_size_(team_.size()),
      remark_(remark.empty() ? "" : "; " + remark)
{
  for (const double mass : discretisation_.node_mass)
    inverse_mass_.push_back(static_cast<float>(1 / mass));
  inverse_mass_.shrink_to_fit();
  for (const auto& muscle : model_->muscles)
    with_length_.push_back(muscle.tension_length ? 1.0f : 0.0f);
  choose_passive();
  std::int32_t largest = 0;
  for (std::int32_t k = 0; k < rows_.planes; ++k)
    largest = std::max(largest, rows_.plane_nodes[k + 1] - rows_.plane_nodes[k]);
  buffer_stride_ = largest + 2 * Tile::width;
  buffers_.assign(team_.size(), std::vector<Real>(8 * static_cast<std::size_t>(buffer_stride_)));
  share_planes();
  fibre_memory_.resize(account_ ? rows_.fibres.size() : 0);
  relaxed_.values.resize(rows_.viscous.size() * physics::relaxed_tensors(discretisation_.viscous_terms) * 6 *
                         Tile::width);
  next_ = u_;
  if (std::is_same<Real, float>::value && model_->precision == Precision::compensated)
    for (auto& component : rounding_)
      component.assign(model_->nodes.size(), 0);
}

template <class Real>
void CpuSolver<Real>::choose_passive()
{
  with_passive_.clear();
  for (const auto& muscle : model_->muscles)
    with_passive_.push_back(muscle.passive && runs(Effect::fibre_stiffness) ? 1.0f : 0.0f);
}

template <class Real>
void CpuSolver<Real>::effects_switched()
{
  choose_passive();
  rows_.renew_bounds(discretisation_);
  Base::effects_switched();
}

template <class Real>
void CpuSolver<Real>::masses_changed(const std::vector<std::int32_t>& nodes)
{
  Base::masses_changed(nodes);
  for (const std::int32_t n : nodes)
    inverse_mass_[n] = static_cast<float>(1 / discretisation_.node_mass[n]);
}

template <class Real>
void CpuSolver<Real>::list_arrays(ArrayList& list)
{
  Base::list_arrays(list);
  rows_.list_arrays(effect_of_fibres(*model_), list);
  list.add("inverse masses", inverse_mass_);
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    list.add("motion", next_[axis]);
    list.add_state("rounding errors", rounding_[axis]);
    list.add("what the monitor looks at", wide_[axis]);
  }
  for (const auto& buffer : buffers_)
    list.add("forces and stiffness of two planes", buffer);
  list.add_state(effect_of_fibres(*model_), "work of fibres", fibre_memory_);
}

// Divides the planes into slabs with about equal numbers of tiles.
template <class Real>
void CpuSolver<Real>::share_planes()
{
  const std::vector<std::int32_t>& plane_tiles = rows_.plane_tiles;
  const int threads = team_.size();
  const auto total = static_cast<std::int64_t>(plane_tiles.back());
  slab_.assign(1, 0);
  for (int t = 1; t < threads; ++t)
  {
    const auto end =
        std::lower_bound(plane_tiles.begin(), plane_tiles.end(), static_cast<std::int32_t>(total * t / threads));
    const auto plane = static_cast<std::int32_t>(end - plane_tiles.begin());
    slab_.push_back(std::clamp(plane, slab_.back(), rows_.planes));
  }
  slab_.push_back(rows_.planes);
}

template <class Real>
void CpuSolver<Real>::rest()
{
  Base::rest();
  for (auto* field : { &next_, &rounding_ })
    for (auto& component : *field)
      std::fill(component.begin(), component.end(), Real(0));
}

template <class Real>
BackendTraits CpuSolver<Real>::traits() const
{
  const char* const numbers = !std::is_same<Real, float>::value ? "double"
                              : rounding_[0].empty()            ? "float"
                                                                : "float, compensated";
  BackendTraits traits;
  traits.description = fmt::format("cpu ({}, {}, {} thread{}{})", numbers, choice_.name, team_size_.most(),
                                   team_size_.most() == 1 ? "" : "s", remark_);
  return traits;
}

template class CpuSolver<float>;
template class CpuSolver<double>;

namespace
{

std::unique_ptr<Solver> make_cpu_solver(std::shared_ptr<const Model> model, const SolverSettings& settings,
                                        const std::string& remark)
{
  const auto make_backend = [&](const BackendInput& input) -> std::unique_ptr<StepBackend>
  {
    if (input.model.precision == Precision::double_precision)
      return std::make_unique<CpuSolver<double>>(input, remark);
    return std::make_unique<CpuSolver<float>>(input, remark);
  };
  return std::make_unique<TimeStepper>(std::move(model), settings, make_backend);
}

}  // namespace

BackendDescription cpu_backend() { return { "cpu", make_cpu_solver }; }

}  // namespace frontalis
