#include "frontalis/physics/element/relaxation.hpp"
#include "solver/model_voxel.hpp"
#include "solver/reference/reference_solver.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

// A voxel with access to its viscous stresses, which the solver stores.
struct ViscousVoxel : ModelVoxel
{
  std::array<physics::Symmetric3<double>, 2>& stresses;

  static int viscous_terms() { return 2; }
  physics::ViscousTerm<double> viscous_term(int n) const
  {
    return { properties.viscous_share[n], properties.viscous_rate[n] };
  }
  physics::Symmetric3<double> relaxed(int n) const { return stresses[n]; }
  void keep_relaxed(int n, const physics::Symmetric3<double>& H) const
  {
    // Other backends also store tensor 2, the sum of tensors 0 and 1. The reference backend does not need it.
    if (n < 2)
      stresses[n] = H;
  }
};

}  // namespace

// N_b = (1 + xi xi_b)(1 + eta eta_b)(1 + zeta zeta_b) / 8, with dxi/dX = 2/h.
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

void ReferenceSolver::note_fibres(const ModelVoxel& voxel, const Kinematics& k)
{
  for (auto entry = model_->fibre_begin[voxel.index]; entry < model_->fibre_begin[voxel.index + 1]; ++entry)
  {
    const auto now = physics::fibre_state(voxel.fibre(entry), k);
    auto& last = fibre_memory_[entry];
    account_->muscle[model_->voxels[voxel.index][2]] += physics::fibre_work(last[1], last[0], now.stress, now.squared);
    last = { { now.squared, now.stress } };
  }
}

void ReferenceSolver::add_stress(std::size_t e, const Stress& P, const Derivatives& derivative, double share)
{
  for (int i = 0; i < 3; ++i)
    for (int b = 0; b < 8; ++b)
      for (int j = 0; j < 3; ++j)
        f_[i][model_->voxel_nodes[e][b]] += share * P.a[i][j] * derivative[b][j];
}

void ReferenceSolver::add_hourglass(std::size_t e, const Components& u, const Kinematics& k, const Derivatives& centre)
{
  // Indices of the hourglass modes among the transformed displacements.
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
  add_stress(e, Q, centre, 1);
  for (int i = 0; i < 3; ++i)
    for (int b = 0; b < 8; ++b)
      for (int m = 0; m < 4; ++m)
        f_[i][nodes[b]] += hourglass_shape_[m][b] * mode[i][mode_of_shape[m]];
}

void ReferenceSolver::add_element(std::size_t e, const Components& u, const std::vector<float>& activation)
{
  const ModelVoxel voxel{ *model_, discretisation_, voxels_[e], e, &activation, effects() };
  Derivatives centre;
  shape_derivatives({ voxels_[e].centre.x, voxels_[e].centre.y, voxels_[e].centre.z }, centre);
  const Kinematics k = kinematics(e, centre, u);
  Stress P;
  if (discretisation_.selective_reduced)
  {
    P = physics::volumetric_stress(voxel.material(), k);
    for (const auto& derivative : gauss_)
    {
      const Kinematics at_point = kinematics(e, derivative, u);
      add_stress(e, physics::isochoric_stress(voxel, at_point), derivative, 0.125);
      stiffness_[e] = physics::larger_or_none(stiffness_[e], voxel.stiffness_now(at_point));
    }
  }
  else
  {
    P = physics::elastic_stress(voxel, voxel.material(), k);
    add_hourglass(e, u, k, centre);
    stiffness_[e] = voxel.stiffness_now(k);
  }
  physics::add_fibres(voxel, k, P);
  if (accounting_)
    note_fibres(voxel, k);
  if (relaxed_.relax())
    for (const auto& H : relaxed_.values[e])
      take_relaxed(k, H, P);
  add_stress(e, P, centre, 1);
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
  for (std::size_t e = 0; e < relaxed_.values.size(); ++e)
  {
    Derivatives centre;
    shape_derivatives({ voxels_[e].centre.x, voxels_[e].centre.y, voxels_[e].centre.z }, centre);
    const Kinematics k = kinematics(e, centre, u_), k_before = kinematics(e, centre, u_before);
    double change = 0, now = 0;
    const ViscousVoxel voxel{ { *model_, discretisation_, voxels_[e], e }, relaxed_.values[e] };
    physics::relax_voxel(voxel, elapsed, k,
                         [&](const auto& before, const auto& after)
                         {
                           change += physics::relaxation_work(k_before, k, before, after);
                           now += along_strain(k, after);
                         });
    if (!account_)
      continue;
    const auto plane = static_cast<std::size_t>(model_->voxels[e][2]);
    if (e == 0 || model_->voxels[e - 1][2] != model_->voxels[e][2])
      account_->viscous[2 * plane + 1] = 0;
    account_->viscous[2 * plane] += change;
    account_->viscous[2 * plane + 1] += now;
  }
}

}  // namespace frontalis
