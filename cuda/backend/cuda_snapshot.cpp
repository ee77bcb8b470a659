#include "cuda/backend/highest_frequency.hpp"
#include "cuda/backend/device_archive.hpp"

namespace frontalis
{
namespace cuda
{

// The bounds that the latest plans saw limit the steps of later plans, so they are part of the motion.
struct CudaSolver::Kept : SteppingSolver::Fields
{
  cudaStream_t stream = nullptr;  // on which it is filled
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

void CudaSolver::save_fields(std::unique_ptr<Fields>& to) const
{
  if (!to)
    to = std::make_unique<Kept>();
  Kept& kept = static_cast<Kept&>(*to);
  kept.stream = stream_;
  kept.u.assign(u_[present_], stream_);
  for (int axis = 0; axis < 3; ++axis)
    kept.v[axis].assign(v_[axis], stream_);
  device_.save(kept.contacts, stream_);
  device_.viscosity().save(kept.viscosity, stream_);
  if (account_)
    kept.book.assign(account_->book(), stream_);
  if (plans_ > 0)
    require(cudaMemcpyAsync(kept.seen.data(), slots_[(plans_ - 1) % plan_slots].controls.data(), sizeof(std::uint32_t),
                            cudaMemcpyDeviceToDevice, stream_),
            "copying the frequency bound");
  kept.has_mode = mode_ != nullptr;
  if (mode_)
  {
    kept.mode.assign(mode_->mode, stream_);
    kept.mode_largest = mode_->largest;
    kept.mode_length = mode_->length;
  }
  kept.plans = plans_;
  kept.still_moved = still_moved_;
}

void CudaSolver::restore_fields(const Fields& from)
{
  const Kept& kept = static_cast<const Kept&>(from);
  u_[present_].assign(kept.u, stream_);
  for (int axis = 0; axis < 3; ++axis)
    v_[axis].assign(kept.v[axis], stream_);
  device_.restore(kept.contacts, stream_);
  device_.viscosity().restore(kept.viscosity, stream_);
  if (account_)
    account_->restore(kept.book, stream_);
  if (!kept.has_mode)
    mode_.reset();
  else
  {
    if (!mode_)
      mode_.reset(new Mode(device_.nodes()));
    mode_->mode.assign(kept.mode, stream_);
    mode_->largest = kept.mode_largest;
    mode_->length = kept.mode_length;
  }
  plans_ = kept.plans;
  still_moved_ = kept.still_moved;
  synchronise();
  if (plans_ > 0)
    require(cudaMemcpy(slots_[(plans_ - 1) % plan_slots].seen.data(), kept.seen.data(), sizeof(std::uint32_t),
                       cudaMemcpyDeviceToHost),
            "copying the frequency bound");
}

}  // namespace cuda
}  // namespace frontalis
