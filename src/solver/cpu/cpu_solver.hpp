#pragma once

#include "solver/cpu/cpu_kernel.hpp"
#include "solver/cpu/team_size.hpp"
#include "solver/cpu/thread_team.hpp"
#include "solver/cpu/voxel_rows.hpp"
#include "solver/stepping/host_backend.hpp"

#include <memory>
#include <string>
#include <vector>

namespace frontalis
{

/// The CPU backend: SIMD on all cores, in single or double precision. Each thread owns a slab of node planes and also
/// computes the voxel plane below its slab, so that the force on a node is summed in the same order for any number of
/// threads.
template <class Real>
class CpuSolver : public HostBackend<Real, float>
{
public:
  /// `remark` is appended to the solver's description.
  CpuSolver(const BackendInput& input, const std::string& remark);

  BackendTraits traits() const override;
  void list_arrays(ArrayList& list) override;
  PlanMeasures run(const StepPlan& plan) override;
  void effects_switched() override;
  void masses_changed(const std::vector<std::int32_t>& nodes) override;
  Monitor monitor() override { return examine(0, false); }
  void measure_growth(double found, bool keeps) override { examine(found, keeps); }
  Work work(bool open) override;

private:
  using Base = HostBackend<Real, float>;
  using Base::account_, Base::conditions_, Base::discretisation_, Base::mobility_, Base::model_, Base::relaxed_,
      Base::runs, Base::u_, Base::v_;
  using typename Base::Components;
  using Arguments = CpuKernelArguments<Real>;

  void rest() override;
  void on_all_threads(const std::function<void(const NodeShare&)>& task) override;
  void barrier() override { team_.barrier(); }
  std::vector<std::int32_t> first_nodes() const override { return rows_.plane_nodes; }
  void find_forces(const NodeShare& share, const Components& u) override;
  const Components& found_forces() const override { return next_; }
  void share_planes();
  Arguments arguments(double dt, const float* activation);
  Monitor examine(double found, bool keeps);
  void kick(Arguments& g, double seconds) const;
  void choose_passive();

  VoxelRows rows_;
  std::vector<float> inverse_mass_, with_length_, with_passive_;
  Components next_, rounding_;
  std::vector<FibreMemory> fibre_memory_;
  std::int32_t buffer_stride_ = 0;
  CpuKernelChoice choice_;
  CpuKernel<Real> kernel_;
  ThreadTeam team_;
  TeamSize team_size_;
  std::string remark_;
  std::vector<std::int32_t> slab_;  // thread t owns node planes slab_[t] .. slab_[t + 1]
  std::vector<std::vector<Real>> buffers_;
  std::array<std::vector<double>, 3> wide_;  // displacements in double precision for the monitor; empty until first use
};

}  // namespace frontalis
