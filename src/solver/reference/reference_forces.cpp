#include "frontalis/physics/assumed_strain.hpp"
#include "frontalis/physics/time_step.hpp"
#include "solver/reference/reference_solver.hpp"
#include "solver/stepping/step_bound.hpp"
#include "solver/energy/voxel_monitor.hpp"
#include "solver/reference/voxel_stress.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{

// N_b = (1 + xi xi_b)(1 + eta eta_b)(1 + zeta zeta_b) / 8, dxi/dX = 2/h
void ReferenceSolver::shape_derivatives(const double (&at)[3], Derivatives& out) const
{
  for (int b = 0; b < 8; ++b)
    for (int j = 0; j < 3; ++j)
    {
      double product = 2 / model_->spacing[j] / 8;
      for (int axis = 0; axis < 3; ++axis)
      {
        const double sign = b & (1 << axis) ? 1 : -1;
        product *= axis == j ? sign : 1 + at[axis] * sign;
      }
      out[b][j] = product;
    }
}

physics::Kinematics<double> ReferenceSolver::kinematics(std::size_t e, const Derivatives& derivative,
                                                        const Components& u) const
{
  const auto& nodes = model_->voxel_nodes[e];
  Kinematics k{};
  auto& F = k.F.a;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
    {
      F[i][j] = i == j ? 1 : 0;
      for (int b = 0; b < 8; ++b)
        F[i][j] += u[i][nodes[b]] * derivative[b][j];
    }
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
    {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      k.cofactor.a[i][j] = F[i1][j1] * F[i2][j2] - F[i1][j2] * F[i2][j1];
      k.I1 += F[i][j] * F[i][j];
    }
  k.J = F[0][0] * k.cofactor.a[0][0] + F[0][1] * k.cofactor.a[0][1] + F[0][2] * k.cofactor.a[0][2];
  k.dilatation = k.J - 1;
  return k;
}

physics::Matrix3<double> ReferenceSolver::elastic(std::size_t e, double kappa, const Kinematics& k) const
{
  return elastic_stress(voxels_[e], kappa, k);
}

void ReferenceSolver::add_fibres(std::size_t e, const Kinematics& k, const std::vector<float>& activation, Stress& P)
{
  for (auto entry = model_->fibre_begin[e]; entry < model_->fibre_begin[e + 1]; ++entry)
  {
    const FibreState fibre = add_fibre_stress(*model_, entry, k, activation, effects(), P);
    if (!accounting_)
      continue;
    auto& last = fibre_memory_[entry];
    const double now = fibre.stress * voxels_[e].tissue_volume;
    account_->muscle[model_->voxels[e][2]] -= 0.25 * (last[1] + now) * (fibre.stretch_squared - last[0]);
    last = { { fibre.stretch_squared, now } };
  }
}

void ReferenceSolver::add_stress(std::size_t e, const Stress& P, const Derivatives& derivative, double volume)
{
  for (int i = 0; i < 3; ++i)
    for (int b = 0; b < 8; ++b)
      for (int j = 0; j < 3; ++j)
        f_[i][model_->voxel_nodes[e][b]] += volume * P.a[i][j] * derivative[b][j];
}

void ReferenceSolver::add_hourglass(std::size_t e, const Components& u, const Kinematics& k)
{
  // transformed displacements of the hourglass modes, and the forces conjugate to them
  static constexpr int mode_of_shape[4] = { 3, 5, 6, 7 };
  const auto& nodes = model_->voxel_nodes[e];
  double mode[3][8] = {};
  for (int i = 0; i < 3; ++i)
    for (int m = 0; m < 4; ++m)
      for (int b = 0; b < 8; ++b)
        mode[i][mode_of_shape[m]] += hourglass_shape_[m][b] * u[i][nodes[b]];
  Stress Q{};
  if (discretisation_.assumed_strain)
    physics::hourglass_forces(voxels_[e].stabilisation, voxels_[e].hourglass, discretisation_.hourglass_weight.data(),
                              k.F, mode, Q);
  else
    for (auto& component : mode)
      for (const int m : mode_of_shape)
        component[m] *= voxels_[e].hourglass;
  add_stress(e, Q, centre_, 1);
  for (int i = 0; i < 3; ++i)
    for (int b = 0; b < 8; ++b)
      for (int m = 0; m < 4; ++m)
        f_[i][nodes[b]] += hourglass_shape_[m][b] * mode[i][mode_of_shape[m]];
}

void ReferenceSolver::look(std::size_t e, const Kinematics& k)
{
  stiffness_[e] = physics::larger_or_none(stiffness_[e], stiffness_now(discretisation_, voxels_[e], k));
}

void ReferenceSolver::add_element(std::size_t e, const Components& u, const std::vector<float>& activation)
{
  const VoxelProperties& voxel = voxels_[e];
  const Kinematics k = kinematics(e, centre_, u);
  Stress P{};
  if (discretisation_.selective_reduced)
  {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        P.a[i][j] = voxel.kappa * (k.J - 1) * k.cofactor.a[i][j];
    for (const auto& derivative : gauss_)
    {
      const Kinematics at_point = kinematics(e, derivative, u);
      add_stress(e, elastic(e, 0, at_point), derivative, voxel.tissue_volume / 8);
      look(e, at_point);
    }
  }
  else
  {
    P = elastic(e, voxel.kappa, k);
    add_hourglass(e, u, k);
    look(e, k);
  }
  add_fibres(e, k, activation, P);
  if (relaxes())
    for (const auto& H : relaxed_[e])
      take_relaxed(k, H, P);
  add_stress(e, P, centre_, voxel.tissue_volume);
}

void ReferenceSolver::forces(const Components& u, const std::vector<float>& activation)
{
  for (auto& component : f_)
    std::fill(component.begin(), component.end(), 0);
  std::fill(stiffness_.begin(), stiffness_.end(), 0);
  for (std::size_t e = 0; e < model_->voxels.size(); ++e)
    add_element(e, u, activation);
}

void ReferenceSolver::relax(double elapsed, const Components& u_before)
{
  for (std::size_t e = 0; e < relaxed_.size(); ++e)
  {
    const Kinematics k = kinematics(e, centre_, u_);
    const auto S = second_piola(k, elastic(e, 0, k));
    const auto before = relaxed_[e];
    for (std::size_t term = 0; term < 2; ++term)
      physics::relax(voxels_[e].viscous_share[term], std::exp(-elapsed * voxels_[e].viscous_rate[term]), S,
                     relaxed_[e][term]);
    if (!account_)
      continue;
    const Kinematics k_before = kinematics(e, centre_, u_before);
    double change = 0, now = 0;
    for (std::size_t term = 0; term < 2; ++term)
    {
      now += along_strain(k, relaxed_[e][term]);
      change += physics::relaxation_work(k_before, k, before[term], relaxed_[e][term]);
    }
    const auto plane = static_cast<std::size_t>(model_->voxels[e][2]);
    if (e == 0 || model_->voxels[e - 1][2] != model_->voxels[e][2])
      account_->viscous[2 * plane + 1] = 0;
    account_->viscous[2 * plane] += change * voxels_[e].tissue_volume;
    account_->viscous[2 * plane + 1] += now * voxels_[e].tissue_volume;
  }
}

}  // namespace frontalis
