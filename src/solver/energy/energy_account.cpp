#include "solver/energy/energy_account.hpp"

#include "frontalis/physics/element/node_motion.hpp"

#include <algorithm>

namespace frontalis
{

template <class Real>
EnergyAccount<Real>::EnergyAccount(const Model& model, const Discretisation& discretisation)
    : mass_(discretisation.node_mass), plane_nodes_(static_cast<std::size_t>(model.size[2]) + 2, 0)
{
  for (const auto& node : model.nodes)
    ++plane_nodes_[node[2] + 1];
  for (std::size_t k = 1; k < plane_nodes_.size(); ++k)
    plane_nodes_[k] += plane_nodes_[k - 1];
  for (auto* field : { &before_, &free_ })
    for (auto& component : *field)
      component.assign(model.nodes.size(), 0);
  open();
}

template <class Real>
void EnergyAccount<Real>::open()
{
  const std::size_t count = plane_nodes_.size() - 1;
  planes_.assign(count, {});
  for (auto& component : beside_)
    component.assign(mass_.size(), 0);
  muscle.assign(count, 0);
  viscous.assign(2 * count, 0);
}

template <class Real>
void EnergyAccount<Real>::copy(std::int32_t first, std::int32_t last, const Real* const v[3], Field& to)
{
  for (int axis = 0; axis < 3; ++axis)
    std::copy(v[axis] + first, v[axis] + last, to[axis].begin() + first);
}

template <class Real>
void EnergyAccount<Real>::after(std::int32_t first, std::int32_t last, const Real* const u_before[3],
                                const Real* const u[3], const Real* const v[3], double damping, double dt, double kick)
{
  for (auto k = first; k < last; ++k)
    for (int axis = 0; axis < 3; ++axis)
    {
      const Real* const old = before_[axis].data();
      const Real* const free = free_[axis].data();
      physics::NodeWork sum{ 0, 0 };
      for (auto n = plane_nodes_[k]; n < plane_nodes_[k + 1]; ++n)
      {
        const double apart = double(u[axis][n]) - double(u_before[axis][n]) - dt * double(v[axis][n]);
        const auto work = physics::node_work(old[n], free[n], v[axis][n], apart, beside_[axis][n], damping, kick);
        sum.damping += mass_[n] * work.damping;
        sum.constraint += mass_[n] * work.constraint;
        beside_[axis][n] = apart;
      }
      planes_[k].damping += sum.damping;
      planes_[k].constraint += sum.constraint;
    }
}

template <class Real>
void EnergyAccount<Real>::load(std::int32_t plane, std::int32_t node, const std::array<double, 3>& force,
                               const Real* const v[3], double kick)
{
  for (int axis = 0; axis < 3; ++axis)
    planes_[plane].load += kick * force[axis] * 0.5 * (double(before_[axis][node]) + double(v[axis][node]));
}

template <class Real>
Work EnergyAccount<Real>::work() const
{
  Work sum;
  for (std::size_t k = 0; k < planes_.size(); ++k)
  {
    sum.load += planes_[k].load;
    sum.constraint += planes_[k].constraint;
    sum.friction += planes_[k].friction;
    sum.damping += planes_[k].damping;
    sum.muscle += muscle[k];
    sum.viscous += viscous[2 * k] - viscous[2 * k + 1];
  }
  return sum;
}

template <class Real>
void EnergyAccount<Real>::list_arrays(ArrayList& list)
{
  const char* const what = "account of energies";
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    list.add(what, before_[axis]);
    list.add(what, free_[axis]);
    list.add_state(what, beside_[axis]);
  }
  list.add_state(what, planes_);
  list.add_state(what, muscle);
  list.add_state(what, viscous);
}

template class EnergyAccount<float>;
template class EnergyAccount<double>;

}  // namespace frontalis
