#pragma once

#include "solver/cpu/cpu_kernel.hpp"
#include "solver/stepping/nodal_loads.hpp"
#include "solver/stepping/stepping_solver.hpp"
#include "solver/cpu/thread_team.hpp"
#include "solver/cpu/voxel_rows.hpp"

#include <memory>
#include <string>
#include <vector>

namespace frontalis
{

/// SIMD, all cores, in float or double. Threads own slabs of node planes and compute the voxel plane below their slab
/// again, so that every node's force is added up in the same order whatever the number of threads.
template <class Real>
class CpuSolver : public SteppingSolver
{
public:
  CpuSolver(std::shared_ptr<const Model> model, const SolverSettings& settings, const std::string& remark);

  void skin(SkinState& out) override;
  void displacements(Vectors& out) const override { interleave(u_, out); }
  void set_displacements(const Vectors& in) override;
  void set_velocities(const Vectors& in) override;
  void internal_forces(Vectors& out) override { forces(u_, out); }
  std::string description() const override;

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
  Monitor measure() override;

private:
  using Components = std::array<std::vector<Real>, 3>;
  using Arguments = CpuKernelArguments<Real>;

  static std::array<const Real*, 3> constant(const Components& c)
  {
    return { { c[0].data(), c[1].data(), c[2].data() } };
  }
  void interleave(const Components& in, Vectors& out) const;
  void separate(const Vectors& in, Components& out) const;
  void share_planes(const std::vector<std::int32_t>& plane_tiles);
  Arguments arguments(double dt, const float* activation);
  void kick(Arguments& g, double seconds) const;
  void forces(const Components& at, Vectors& out);
  void relax(double elapsed);
  void choose_passive();
  bool relaxes() const { return !relaxed_.empty() && runs(Effect::viscosity); }
  void add_loads(std::int32_t first, std::int32_t last, const Arguments& g);
  void account(int thread, const Arguments& g);

  struct Kept;

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
  std::array<std::vector<double>, 3> wide_;  // displacements for the monitor; empty until it is asked for
  Components moved_;                         // displacements that are not the state's; likewise
};

}  // namespace frontalis
