#pragma once

#include "frontalis/physics/viscosity.hpp"
#include "solver/stepping/nodal_loads.hpp"
#include "solver/stepping/stepping_solver.hpp"

namespace frontalis
{

struct ModelVoxel;

/// Double, plain loops, kinematics by textbook shape-function derivatives (not by the Walsh-Hadamard form, so that a
/// wrong transform is found): the oracle of the other backends.
class ReferenceSolver : public SteppingSolver
{
public:
  ReferenceSolver(std::shared_ptr<const Model> model, const SolverSettings& settings);

  void skin(SkinState& out) override;
  void displacements(Vectors& out) const override { interleave(u_, out); }
  void set_displacements(const Vectors& in) override;
  void set_velocities(const Vectors& in) override;
  void internal_forces(Vectors& out) override { forces_at_components(u_, out); }
  std::string description() const override { return "reference (double, 1 thread)"; }

protected:
  double run(const StepPlan& plan) override;
  void save_fields(std::unique_ptr<Fields>& to) const override;
  void restore_fields(const Fields& from) override;
  void rest() override;
  void effect_switched(Effect effect) override;
  void list_allocations(AllocationList& list) const override;
  void velocities(Vectors& out) const override { interleave(v_, out); }
  void forces_at(const Vectors& at, Vectors& out) override;
  void external_forces(Vectors& out) override;
  void open_account() override;
  Work work() override;

private:
  using Components = std::array<std::vector<double>, 3>;
  using Kinematics = physics::Kinematics<double>;
  using Stress = physics::Matrix3<double>;
  using Derivatives = double[8][3];

  std::array<const double*, 3> u_pointers() const { return { { u_[0].data(), u_[1].data(), u_[2].data() } }; }
  void interleave(const Components& in, Vectors& out) const;
  void shape_derivatives(const double (&at)[3], Derivatives& out) const;
  Kinematics kinematics(std::size_t e, const Derivatives& derivative, const Components& u) const;
  void note_fibres(const ModelVoxel& voxel, const Kinematics& k);
  void add_stress(std::size_t e, const Stress& P, const Derivatives& derivative, double share);
  void add_hourglass(std::size_t e, const Components& u, const Kinematics& k);
  void add_element(std::size_t e, const Components& u, const std::vector<float>& activation);
  void forces(const Components& u, const std::vector<float>& activation);
  void forces_at_components(const Components& u, Vectors& out);
  void mix_voxels();
  bool relaxes() const { return !relaxed_.empty() && runs(Effect::viscosity); }
  void relax(double elapsed, const Components& u_before);  // u_before: a step earlier

  struct Kept;

  std::vector<VoxelProperties> voxels_;
  Components u_, v_, f_;
  Derivatives centre_;            // dN_b/dX_j at the centre [1/m]
  Derivatives gauss_[8];          // the same at the Gauss points
  double hourglass_shape_[4][8];  // +-1 patterns xy, xz, yz, xyz
  RestrictedNodes<double> restricted_;
  NodalLoads loads_;
  std::vector<std::array<physics::Symmetric3<double>, 2>> relaxed_;  // of each voxel times its volume [N m]
  std::unique_ptr<EnergyAccount<double>> account_;
  bool accounting_ = false;                          // fibres note their work
  std::vector<std::array<double, 2>> fibre_memory_;  // stretch squared and stress times volume that were last
  std::vector<double> stiffness_;                    // bound of each voxel at the forces computed last [N/m]
};

}  // namespace frontalis
