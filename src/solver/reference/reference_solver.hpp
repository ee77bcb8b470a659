#pragma once

#include "frontalis/physics/viscosity.hpp"
#include "solver/stepping/host_backend.hpp"

namespace frontalis
{

struct ModelVoxel;

/// The reference for the other backends: double precision and plain loops. The kinematics come from textbook
/// derivatives of shape functions rather than from the Walsh-Hadamard transform, so that tests detect an error in the
/// transform.
class ReferenceSolver : public HostBackend<double, std::array<physics::Symmetric3<double>, 2>>
{
public:
  explicit ReferenceSolver(const BackendInput& input);

  BackendTraits traits() const override;
  void list_arrays(ArrayList& list) override;
  PlanMeasures run(const StepPlan& plan) override;
  void effects_switched() override;
  Monitor monitor() override;
  void measure_growth(double found, bool keeps) override;
  Work work(bool open) override;

private:
  using Kinematics = physics::Kinematics<double>;
  using Stress = physics::Matrix3<double>;
  using Derivatives = double[8][3];

  NodeShare all_nodes() const;
  void on_all_threads(const std::function<void(const NodeShare&)>& task) override { task(all_nodes()); }
  void barrier() override {}
  std::vector<std::int32_t> first_nodes() const override { return { 0, all_nodes().end_node }; }
  void find_forces(const NodeShare& share, const Components& u) override;
  const Components& found_forces() const override { return f_; }

  EffectSet effects() const { return conditions_.running; }
  void shape_derivatives(const double (&at)[3], Derivatives& out) const;
  Kinematics kinematics(std::size_t e, const Derivatives& derivative, const Components& u) const;
  void note_fibres(const ModelVoxel& voxel, const Kinematics& k);
  void add_stress(std::size_t e, const Stress& P, const Derivatives& derivative, double share);
  void add_hourglass(std::size_t e, const Components& u, const Kinematics& k, const Derivatives& centre);
  void add_element(std::size_t e, const Components& u, const std::vector<float>& activation);
  void forces(const Components& u, const std::vector<float>& activation);
  void mix_voxels();
  void relax(double elapsed, const Components& u_before);  // u_before: displacements one step earlier

  std::vector<VoxelProperties> voxels_;
  Components f_;
  Derivatives gauss_[8];                             // dN_b/dX_j at the Gauss points [1/m]
  double hourglass_shape_[4][8];                     // +-1 patterns xy, xz, yz, xyz
  bool accounting_ = false;                          // whether fibres record their work
  std::vector<std::array<double, 2>> fibre_memory_;  // latest squared stretch, and stress times volume
  std::vector<double> stiffness_;                    // bound of each voxel at the latest forces [N/m]
};

}  // namespace frontalis
