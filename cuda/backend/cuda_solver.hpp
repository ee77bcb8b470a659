#pragma once

#include "cuda/backend/device_account.hpp"
#include "cuda/backend/device_monitor.hpp"
#include "cuda/backend/device_model.hpp"
#include "solver/stepping/step_backend.hpp"

#include <memory>

namespace frontalis
{
namespace cuda
{

/// The input of one plan in page-locked memory, and what it measures: the bits of the frequency bound and of the
/// largest speed, single precision.
struct PlanSlot
{
  PinnedArray<char> staged;
  DeviceArray<char> controls;
  PinnedArray<std::uint32_t> seen;
  cudaEvent_t done = nullptr;
};

/// The backend for one NVIDIA GPU, in single precision. Steps are queued without waiting for their results; what a
/// plan measures limits the plan after the next. The host waits only for that and for results that are requested.
class CudaSolver : public StepBackend
{
public:
  /// `remark` is appended to the solver's description.
  CudaSolver(const BackendInput& input, const std::string& remark);
  ~CudaSolver() override;

  BackendTraits traits() const override;
  void list_arrays(ArrayList& list) override;
  PlanMeasures run(const StepPlan& plan) override;
  void effects_switched() override;
  void get(NodalField field, NodalVectors& out) const override;
  void set(NodalField field, const NodalVectors& in) override;
  void save(std::unique_ptr<BackendState>& to) override;
  void restore(const BackendState& from) override;
  void internal_forces(NodalVectors& out) override;
  double highest_frequency_squared() override;
  void measure_growth(double found, bool keeps) override;
  std::vector<FoundMode> modes_above(double frequency_squared) override;
  void masses_changed(const std::vector<std::int32_t>& nodes) override;
  Monitor monitor() override;
  Work work(bool open) override;
  void add_energies(bool open, NodalVectors& forces, EnergyLedger& ledger) override;
  std::vector<Reaction> reactions() const override;
  std::vector<RigidTransform> bodies() const override;
  std::int64_t lost_points() const override;
  double body_energy() const override;
  void skin(SkinState& out) override;

private:
  static constexpr int plan_slots = 3, plan_measures = 2, most_steps_per_plan = 128;

  StepArguments arguments(double dt, bool idle_parts = false) const;
  void kick(StepArguments& g, double seconds) const;
  void stage(const StepPlan& plan, const std::vector<float>& relaxation, PlanSlot& slot, StepArguments& g);
  void begin_steps(StepArguments& g, int begin, int end);
  void step(const StepArguments& g);
  DeviceMonitor& device_monitor();
  bool adds_stress() const;
  bool stays() const;
  void do_steps(const StepPlan& plan, StepArguments& g, int begin, int end);
  void rest();
  /// Computes the internal forces at displacements `at`. `springs`: contact and shells, even if switched off, are
  /// springs of their largest stiffness.
  void queue_forces(float4* at, const float* activation, float4* out, bool springs = false);
  void download(const DeviceArray<float4>& field, NodalVectors& out) const;
  /// Copies displacements to the device; an empty `in` stands for zeros.
  void upload_displacements(const NodalVectors& in, DeviceArray<float4>& to) const;
  /// Passes the latest step on to the host's account of the parts, unless a ledger has done so.
  void follow_without_account() const;
  void synchronise() const { require(cudaStreamSynchronize(stream_), "stepping"); }

  struct State;
  void copy_state(const State& state, bool back);
  struct FrequencySearch;
  struct SearchDeleter
  {
    void operator()(FrequencySearch* search) const;
  };
  /// Copies the present activations to the device.
  const float* present_activation();
  void prepare_search();
  void prepare_followers(const std::vector<double>& root);
  void list_shares(const std::vector<double>& mode, uint2* list);

  const std::string remark_;  // appended to the description
  DeviceModel device_;
  DeviceArray<float4> u_[2];
  DeviceArray<float> v_[3];
  DeviceSurface skin_, landmarks_;
  DeviceArray<float> skin_output_;  // vertices, normals, landmarks
  PinnedArray<float> skin_staged_;
  DeviceArray<float> activation_;     // for forces at rest, one per muscle
  DeviceArray<std::uint32_t> still_;  // device nodes that never move
  std::uint32_t steps_before_ = 0;    // steps queued since the solver was made
  cudaStream_t stream_ = nullptr;
  PlanSlot slots_[plan_slots];
  std::int64_t plans_ = 0;
  int present_ = 0;           // index of the buffer with the present displacements
  bool still_moved_ = false;  // whether displacements of nodes that never move were set from outside
  StepLaunch launch_{};
  std::unique_ptr<DeviceAccount> account_;
  std::unique_ptr<DeviceMonitor> monitor_;                  // made by device_monitor()
  std::unique_ptr<FrequencySearch, SearchDeleter> search_;  // made with the solver if steps follow the assembled model
};

}  // namespace cuda
}  // namespace frontalis
