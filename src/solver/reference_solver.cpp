#include "bound_points.hpp"
#include "frontalis/physics/assumed_strain.hpp"
#include "frontalis/physics/hourglass.hpp"
#include "frontalis/physics/muscle_fibre.hpp"
#include "frontalis/physics/neo_hookean.hpp"
#include "frontalis/physics/time_step.hpp"
#include "material_laws.hpp"
#include "nodal_loads.hpp"
#include "stepping_solver.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

using Vectors = std::vector<std::array<double, 3>>;

/// Double, plain loops, kinematics by textbook shape-function derivatives (not by the Walsh-Hadamard form, so that a
/// wrong transform is found): the oracle of the other backends.
class ReferenceSolver : public SteppingSolver
{
public:
  ReferenceSolver(std::shared_ptr<const Model> model, const SolverSettings& settings);

  void skin(SkinState& out) override { skin_state(*model_, u_pointers().data(), out); }
  void displacements(Vectors& out) const override { interleave(u_, out); }
  void set_displacements(const Vectors& in) override;
  void set_velocities(const Vectors& in) override;
  void internal_forces(Vectors& out) override;
  std::string description() const override { return "reference (double, 1 thread)"; }

protected:
  double run(const StepPlan& plan) override;
  void rest() override;
  void velocities(Vectors& out) const override { interleave(v_, out); }

private:
  using Components = std::array<std::vector<double>, 3>;

  std::array<const double*, 3> u_pointers() const { return { { u_[0].data(), u_[1].data(), u_[2].data() } }; }
  void interleave(const Components& in, Vectors& out) const;
  void add_element(std::size_t e, const std::vector<float>& activation);
  void forces(const std::vector<float>& activation);

  Components u_, v_, f_;
  double shape_derivative_[8][3];  // dN_b/dX_j at the centre [1/m]
  double hourglass_shape_[4][8];   // +-1 patterns xy, xz, yz, xyz
  RestrictedNodes<double> restricted_;
  NodalLoads loads_;
  double frequency_squared_ = 0;
};

ReferenceSolver::ReferenceSolver(std::shared_ptr<const Model> model, const SolverSettings& settings)
    : SteppingSolver(std::move(model), settings), restricted_(*model_), loads_(*model_)
{
  for (int b = 0; b < 8; ++b)
  {
    const double xi[3] = { b & 1 ? 1.0 : -1.0, b & 2 ? 1.0 : -1.0, b & 4 ? 1.0 : -1.0 };
    // N_b = (1 + xi xi_b)(1 + eta eta_b)(1 + zeta zeta_b) / 8, dxi/dX = 2/h
    for (int j = 0; j < 3; ++j)
      shape_derivative_[b][j] = xi[j] / 8 * 2 / model_->spacing[j];
    hourglass_shape_[0][b] = xi[0] * xi[1];
    hourglass_shape_[1][b] = xi[0] * xi[2];
    hourglass_shape_[2][b] = xi[1] * xi[2];
    hourglass_shape_[3][b] = xi[0] * xi[1] * xi[2];
  }
  rest();
}

void ReferenceSolver::rest()
{
  for (auto* field : { &u_, &v_, &f_ })
    for (auto& component : *field)
      component.assign(model_->nodes.size(), 0);
  restricted_.reset();
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
  renew_time_step();
}

void ReferenceSolver::set_velocities(const Vectors& in)
{
  for (std::size_t n = 0; n < in.size(); ++n)
    for (int axis = 0; axis < 3; ++axis)
      v_[axis][n] = in[n][axis];
}

void ReferenceSolver::add_element(std::size_t e, const std::vector<float>& activation)
{
  const auto& nodes = model_->voxel_nodes[e];
  physics::Kinematics<double> k{};
  auto& F = k.F.a;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
    {
      F[i][j] = i == j ? 1 : 0;
      for (int b = 0; b < 8; ++b)
        F[i][j] += u_[i][nodes[b]] * shape_derivative_[b][j];
    }
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
    {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      k.cofactor.a[i][j] = F[i1][j1] * F[i2][j2] - F[i1][j2] * F[i2][j1];
      k.I1 += F[i][j] * F[i][j];
    }
  k.J = F[0][0] * k.cofactor.a[0][0] + F[0][1] * k.cofactor.a[0][1] + F[0][2] * k.cofactor.a[0][2];

  const auto isotropic =
      physics::stress(physics::NeoHookean<double>{ discretisation_.mu[e], discretisation_.kappa[e] }, k);
  double P[3][3];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      P[i][j] = isotropic.on_gradient * F[i][j] + isotropic.on_cofactor * k.cofactor.a[i][j];

  double law_frequency = 0;
  for (auto l = discretisation_.law_begin[e]; l < discretisation_.law_begin[e + 1]; ++l)
  {
    const auto& part = discretisation_.laws[l];
    physics::Matrix3<double> own{};
    add_law_stress(part.law, part.parameters.data(), part.weight, k, own);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        P[i][j] += own.a[i][j];
    const double shortest = *std::min_element(model_->spacing.begin(), model_->spacing.end());
    const double more = law_stiffness(part.law, part.parameters.data(), k) - part.stiffness_at_rest;
    law_frequency += 8 * part.weight / (discretisation_.density[e] * shortest * shortest) * std::max(more, 0.0);
  }

  for (auto entry = model_->fibre_begin[e]; entry < model_->fibre_begin[e + 1]; ++entry)
  {
    const Muscle& muscle = model_->muscles[model_->fibre_muscle[entry]];
    const auto& a = model_->fibre_direction[entry];
    double along[3];  // F a0
    double squared = 0;
    for (int i = 0; i < 3; ++i)
    {
      along[i] = F[i][0] * a[0] + F[i][1] * a[1] + F[i][2] * a[2];
      squared += along[i] * along[i];
    }
    const double S =
        model_->fibre_weight[entry] *
        physics::fibre_stress<double>(squared, k.J, muscle.stress_reference, activation[model_->fibre_muscle[entry]],
                                      muscle.tension_length ? 1 : 0, muscle.passive ? 1 : 0);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        P[i][j] += S * along[i] * a[j];
  }

  // transformed displacements of the hourglass modes, and the forces conjugate to them
  static constexpr int mode_of_shape[4] = { 3, 5, 6, 7 };
  double mode[3][8] = {};
  for (int i = 0; i < 3; ++i)
    for (int m = 0; m < 4; ++m)
      for (int b = 0; b < 8; ++b)
        mode[i][mode_of_shape[m]] += hourglass_shape_[m][b] * u_[i][nodes[b]];
  physics::Matrix3<double> Q{};
  if (!discretisation_.assumed_strain[0].empty())
    physics::hourglass_forces(stabilisation(discretisation_, e), discretisation_.hourglass[e],
                              discretisation_.hourglass_weight.data(), k.F, mode, Q);
  else
    for (auto& component : mode)
      for (const int m : mode_of_shape)
        component[m] *= discretisation_.hourglass[e];

  for (int i = 0; i < 3; ++i)
    for (int b = 0; b < 8; ++b)
    {
      double force = 0;
      for (int j = 0; j < 3; ++j)
        force += (discretisation_.tissue_volume[e] * P[i][j] + Q.a[i][j]) * shape_derivative_[b][j];
      for (int m = 0; m < 4; ++m)
        force += hourglass_shape_[m][b] * mode[i][mode_of_shape[m]];
      f_[i][nodes[b]] += force;
    }

  const double d[3] = { std::pow(model_->spacing[0], -2), std::pow(model_->spacing[1], -2),
                        std::pow(model_->spacing[2], -2) };
  const double weight[3] = { d[0] / (d[0] + d[1] + d[2]), d[1] / (d[0] + d[1] + d[2]), d[2] / (d[0] + d[1] + d[2]) };
  const double growth =
      physics::stiffening(physics::NeoHookean<double>{ discretisation_.mu[e], discretisation_.kappa[e] }, k, weight);
  const double squared = discretisation_.frequency_squared[e] * std::max(growth, 1.0) + law_frequency;
  if (!(squared <= frequency_squared_))
    frequency_squared_ = std::isfinite(growth) ? squared : growth;
}

void ReferenceSolver::forces(const std::vector<float>& activation)
{
  for (auto& component : f_)
    std::fill(component.begin(), component.end(), 0);
  frequency_squared_ = 0;
  for (std::size_t e = 0; e < model_->voxels.size(); ++e)
    add_element(e, activation);
}

void ReferenceSolver::internal_forces(Vectors& out)
{
  forces(controls().activation);
  interleave(f_, out);
}

double ReferenceSolver::run(const StepPlan& plan)
{
  std::vector<float> activation(model_->muscles.size());
  const double keep = this->keep(plan.dt), gain = this->gain(plan.dt);
  double* const u[3] = { u_[0].data(), u_[1].data(), u_[2].data() };
  double* const v[3] = { v_[0].data(), v_[1].data(), v_[2].data() };
  for (int step = 0; step < plan.steps; ++step)
  {
    plan.activation(step, activation.data());
    forces(activation);
    loads_.update(plan.time + step * plan.dt, u_pointers().data());
    for (std::size_t l = 0; l < loads_.nodes().size(); ++l)
      for (int axis = 0; axis < 3; ++axis)
        f_[axis][loads_.nodes()[l]] -= loads_.forces()[l][axis];
    const Components before = u_;
    for (int axis = 0; axis < 3; ++axis)
      for (std::size_t n = 0; n < model_->nodes.size(); ++n)
      {
        const double acceleration = model_->gravity[axis] - f_[axis][n] / discretisation_.node_mass[n];
        v_[axis][n] = keep * v_[axis][n] + gain * acceleration;
        u_[axis][n] += plan.dt * v_[axis][n];
      }
    const double* const old[3] = { before[0].data(), before[1].data(), before[2].data() };
    restricted_.apply(0, static_cast<std::int32_t>(model_->nodes.size()), u, v, old, plan.drive(step));
  }
  return frequency_squared_;
}

}  // namespace

std::unique_ptr<Solver> make_reference_solver(std::shared_ptr<const Model> model, const SolverSettings& settings)
{
  return std::make_unique<ReferenceSolver>(std::move(model), settings);
}

}  // namespace frontalis
