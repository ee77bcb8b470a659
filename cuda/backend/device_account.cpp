#include "cuda/backend/device_account.hpp"

#include <numeric>

namespace frontalis
{
namespace cuda
{
namespace
{

double sum(const DeviceArray<double>& values)
{
  std::vector<double> host;
  values.download(host);
  return std::accumulate(host.begin(), host.end(), 0.0);
}

}  // namespace

DeviceAccount::DeviceAccount(const Model& model, DeviceModel& device)
{
  damping_ = DeviceArray<double>(device.nodes());
  constraint_ = DeviceArray<double>(device.nodes());
  beside_ = DeviceArray<double>(3 * device.nodes());
  friction_ = DeviceArray<double>(device.contacts().rubbing());
  for (int axis = 0; axis < 3; ++axis)
  {
    before_[axis] = DeviceArray<float>(device.nodes());
    free_[axis] = DeviceArray<float>(device.nodes());
  }
  std::vector<std::uint32_t> loaded;
  for (const auto node : device.loads().nodes())
    loaded.push_back(device.device_node()[node]);
  loaded_ = DeviceArray<std::uint32_t>(loaded);
  load_ = DeviceArray<double>(loaded.size());
  std::vector<FibreVoxel> voxels;
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    const auto first = static_cast<std::uint32_t>(model.fibre_begin[e]);
    const auto count = static_cast<std::uint32_t>(model.fibre_begin[e + 1]) - first;
    if (count == 0)
      continue;
    FibreVoxel voxel{ {}, first, count, device.palette_of_voxel()[e] };
    for (int b = 0; b < 8; ++b)
      voxel.node[b] = device.device_node()[model.voxel_nodes[e][b]];
    voxels.push_back(voxel);
  }
  fibre_voxels_ = DeviceArray<FibreVoxel>(voxels);
  fibre_work_ = DeviceArray<double>(voxels.size());
  memory_ = DeviceArray<float2>(model.fibre_muscle.size());
}

FibreVoxels DeviceAccount::fibres() const
{
  return { fibre_voxels_.data(), static_cast<std::uint32_t>(fibre_voxels_.size()), memory_.data(), fibre_work_.data() };
}

void DeviceAccount::describe(StepArguments& g) const
{
  for (int axis = 0; axis < 3; ++axis)
  {
    g.velocity_before[axis] = before_[axis].data();
    g.velocity_free[axis] = free_[axis].data();
  }
  g.friction_work = friction_.data();
}

void DeviceAccount::open(const StepArguments& g, const float4* u, cudaStream_t stream)
{
  for (const auto* values : { &damping_, &constraint_, &beside_, &friction_, &load_ })
    values->clear();
  // Nodes that never move are not stepped, so that their velocities must be 0 from the beginning.
  for (int axis = 0; axis < 3; ++axis)
    for (const auto* values : { &before_[axis], &free_[axis] })
      values->clear();
  memory_.clear();
  fibre_work_.clear();
  if (g.fibres != nullptr)
    require(launch_fibre_work(g, fibres(), u, 0, true, stream), "measuring fibres");
}

void DeviceAccount::measure(const StepArguments& g, const float4* u, int step, cudaStream_t stream)
{
  if (g.fibres != nullptr)  // else no effect of fibres runs
    require(launch_fibre_work(g, fibres(), u, step, false, stream), "work of fibres");
}

void DeviceAccount::before_step(const StepArguments& g, int step, cudaStream_t stream)
{
  measure(g, g.u[g.first], step, stream);
}

void DeviceAccount::after_step(const StepArguments& g, double damping, int step, cudaStream_t stream)
{
  const NodeAccount account{
    static_cast<std::uint32_t>(damping_.size()), damping_.data(), constraint_.data(), beside_.data(),
    static_cast<std::uint32_t>(loaded_.size()),  loaded_.data(),  load_.data()
  };
  require(launch_node_account(g, account, damping, step, stream), "work on nodes");
}

void DeviceAccount::list_arrays(Effect of_fibres, ArrayList& list)
{
  for (const auto* const values : { &damping_, &constraint_, &beside_, &friction_, &load_ })
    list_state(list, Effect::elasticity, "account of energies", *values);
  for (int axis = 0; axis < 3; ++axis)
    list.add(Effect::elasticity, "account of energies", before_[axis].bytes() + free_[axis].bytes());
  list.add(Effect::elasticity, "account of energies", loaded_.bytes());
  list_state(list, of_fibres, "work of fibres", fibre_work_);
  list_state(list, of_fibres, "work of fibres", memory_);
  list.add(of_fibres, "work of fibres", fibre_voxels_.bytes());
}

Work DeviceAccount::work() const
{
  Work work;
  work.muscle = sum(fibre_work_);
  work.load = sum(load_);
  work.constraint = sum(constraint_);
  work.friction = sum(friction_);
  work.damping = sum(damping_);
  return work;
}

}  // namespace cuda
}  // namespace frontalis
