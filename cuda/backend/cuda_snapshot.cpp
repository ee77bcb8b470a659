#include "cuda/backend/highest_frequency.hpp"
#include "cuda/backend/device_archive.hpp"

namespace frontalis
{
namespace cuda
{

// The frequency bounds that the latest plans reported limit the steps of later plans, so they belong to the state.
struct CudaSolver::State : BackendState
{
  cudaStream_t stream = nullptr;  // stream on which the copy is queued
  DeviceArray<float4> u;
  DeviceArray<float> v[3];
  DeviceModel::Contacts contacts;
  DeviceViscosity::Kept viscosity;
  DeviceBook book;
  DeviceArray<std::uint32_t> seen{ 1 };
  bool has_mode = false;
  DeviceArray<float4> mode;
  double mode_largest = 0, mode_length = 0;
  std::int64_t plans = 0;
  bool still_moved = false;

  void archive(ByteArchive& archive) override
  {
    require(cudaStreamSynchronize(stream), "waiting for a snapshot");
    to_host(u, archive);
    for (auto& component : v)
      to_host(component, archive);
    contacts.archive(archive);
    viscosity.archive(archive);
    book.archive(archive);
    to_host(seen, archive);
    archive(has_mode);
    to_host(mode, archive);
    archive(mode_largest)(mode_length)(plans)(still_moved);
  }
};

void CudaSolver::save(std::unique_ptr<BackendState>& to) const
{
  if (!to)
    to = std::make_unique<State>();
  State& state = static_cast<State&>(*to);
  state.stream = stream_;
  state.u.assign(u_[present_], stream_);
  for (int axis = 0; axis < 3; ++axis)
    state.v[axis].assign(v_[axis], stream_);
  device_.save(state.contacts, stream_);
  device_.viscosity().save(state.viscosity, stream_);
  if (account_)
    state.book.assign(account_->book(), stream_);
  if (plans_ > 0)
    require(cudaMemcpyAsync(state.seen.data(), slots_[(plans_ - 1) % plan_slots].controls.data(), sizeof(std::uint32_t),
                            cudaMemcpyDeviceToDevice, stream_),
            "copying the frequency bound");
  state.has_mode = mode_ != nullptr;
  if (mode_)
  {
    state.mode.assign(mode_->mode, stream_);
    state.mode_largest = mode_->largest;
    state.mode_length = mode_->length;
  }
  state.plans = plans_;
  state.still_moved = still_moved_;
}

void CudaSolver::restore(const BackendState& from)
{
  const State& state = static_cast<const State&>(from);
  u_[present_].assign(state.u, stream_);
  for (int axis = 0; axis < 3; ++axis)
    v_[axis].assign(state.v[axis], stream_);
  device_.restore(state.contacts, stream_);
  device_.viscosity().restore(state.viscosity, stream_);
  if (account_)
    account_->restore(state.book, stream_);
  if (!state.has_mode)
    mode_.reset();
  else
  {
    if (!mode_)
      mode_.reset(new Mode(device_.nodes()));
    mode_->mode.assign(state.mode, stream_);
    mode_->largest = state.mode_largest;
    mode_->length = state.mode_length;
  }
  plans_ = state.plans;
  still_moved_ = state.still_moved;
  synchronise();
  if (plans_ > 0)
    require(cudaMemcpy(slots_[(plans_ - 1) % plan_slots].seen.data(), state.seen.data(), sizeof(std::uint32_t),
                       cudaMemcpyDeviceToHost),
            "copying the frequency bound");
}

}  // namespace cuda
}  // namespace frontalis
