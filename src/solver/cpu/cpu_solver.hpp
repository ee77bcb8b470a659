#pragma once

#include "solver/cpu/cpu_kernel.hpp"
#include "solver/cpu/thread_team.hpp"
#include "solver/cpu/voxel_rows.hpp"
#include "solver/stepping/host_state.hpp"
#include "solver/stepping/nodal_loads.hpp"

#include <memory>
#include <string>
#include <vector>

namespace frontalis
{

/// The CPU backend: SIMD on all cores, in single or double precision. Threads own slabs of node planes. Each also
/// computes the voxel plane below its slab, so that the force on a node is summed in the same order for any number of
/// threads.
template <class Real>
class CpuSolver : public StepBackend
{
public:
  /// `remark` is appended to the solver's description.
  CpuSolver(const BackendInput& input, const std::string& remark);

  BackendTraits traits() const override;
  void list_allocations(AllocationList& list) const override;
  double run(const StepPlan& plan) override;
  void effect_switched(Effect effect) override;
  void get(NodalField field, NodalVectors& out) const override;
  void set(NodalField field, const NodalVectors& in) override;
  void save(std::unique_ptr<BackendState>& to) const override;
  void restore(const BackendState& from) override;
  void internal_forces(const NodalVectors* displacements, NodalVectors& out) override;
  Monitor monitor() override;
  Work work(bool open) override;
  void skin(SkinState& out) override;

private:
  using Components = std::array<std::vector<Real>, 3>;
  using Arguments = CpuKernelArguments<Real>;
  using State = HostState<Real, Components, Components, Components, std::vector<float>, std::vector<FibreMemory>>;

  static std::array<const Real*, 3> constant(const Components& c)
  {
    return { { c[0].data(), c[1].data(), c[2].data() } };
  }
  void rest();
  void share_planes(const std::vector<std::int32_t>& plane_tiles);
  Arguments arguments(double dt, const float* activation);
  void kick(Arguments& g, double seconds) const;
  void run_on_all(const Arguments& g, KernelTask task);
  void choose_passive();
  bool relaxes() const { return !relaxed_.empty() && runs(Effect::viscosity); }
  void add_loads(std::int32_t first, std::int32_t last, const Arguments& g);
  void account(int thread, const Arguments& g);

  VoxelRows rows_;
  std::vector<float> inverse_mass_, mobility_, with_length_, with_passive_, relaxed_;
  Components u_, next_, v_, rounding_;
  std::vector<FibreMemory> fibre_memory_;
  std::unique_ptr<EnergyAccount<Real>> account_;
  std::int32_t buffer_stride_ = 0;
  CpuKernelChoice choice_;
  CpuKernel<Real> kernel_;
  RestrictedNodes<Real> restricted_;
  NodalLoads loads_;
  ThreadTeam team_;
  std::string remark_;
  std::vector<std::int32_t> slab_;  // thread t owns node planes slab_[t] .. slab_[t + 1]
  std::vector<std::vector<Real>> buffers_;
  std::array<std::vector<double>, 3> wide_;  // displacements for the monitor; empty until first use
  Components moved_;                         // displacements other than the state's; empty until first use
};

}  // namespace frontalis
