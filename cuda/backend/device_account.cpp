#include "cuda/backend/device_account.hpp"

#include "cuda/backend/device_archive.hpp"

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

void DeviceBook::assign(const DeviceBook& from, cudaStream_t stream)
{
  damping.assign(from.damping, stream);
  constraint.assign(from.constraint, stream);
  beside.assign(from.beside, stream);
  friction.assign(from.friction, stream);
  load.assign(from.load, stream);
  fibre_work.assign(from.fibre_work, stream);
  memory.assign(from.memory, stream);
}

void DeviceBook::archive(ByteArchive& archive)
{
  for (auto* const list : { &damping, &constraint, &beside, &friction, &load, &fibre_work })
    to_host(*list, archive);
  to_host(memory, archive);
}

DeviceAccount::DeviceAccount(const Model& model, DeviceModel& device)
{
  book_.damping = DeviceArray<double>(device.nodes());
  book_.constraint = DeviceArray<double>(device.nodes());
  book_.beside = DeviceArray<double>(3 * device.nodes());
  book_.friction = DeviceArray<double>(device.friction_works());
  for (int axis = 0; axis < 3; ++axis)
  {
    before_[axis] = DeviceArray<float>(device.nodes());
    free_[axis] = DeviceArray<float>(device.nodes());
  }
  std::vector<std::uint32_t> loaded;
  for (const auto node : device.loads().nodes())
    loaded.push_back(device.device_node()[node]);
  loaded_ = DeviceArray<std::uint32_t>(loaded);
  book_.load = DeviceArray<double>(loaded.size());
  std::vector<FibreVoxel> voxels;
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    const auto first = static_cast<std::uint32_t>(model.fibre_begin[e]);
    const auto count = static_cast<std::uint32_t>(model.fibre_begin[e + 1]) - first;
    if (count == 0)
      continue;
    FibreVoxel voxel{ {}, first, count };
    for (int b = 0; b < 8; ++b)
      voxel.node[b] = device.device_node()[model.voxel_nodes[e][b]];
    voxels.push_back(voxel);
  }
  fibre_voxels_ = DeviceArray<FibreVoxel>(voxels);
  book_.fibre_work = DeviceArray<double>(voxels.size());
  book_.memory = DeviceArray<float2>(model.fibre_muscle.size());
}

FibreVoxels DeviceAccount::fibres() const
{
  return { fibre_voxels_.data(), static_cast<std::uint32_t>(fibre_voxels_.size()), book_.memory.data(),
           book_.fibre_work.data() };
}

void DeviceAccount::describe(StepArguments& g) const
{
  for (int axis = 0; axis < 3; ++axis)
  {
    g.velocity_before[axis] = before_[axis].data();
    g.velocity_free[axis] = free_[axis].data();
  }
  g.friction_work = book_.friction.data();
}

void DeviceAccount::open(const StepArguments& g, const float4* u, cudaStream_t stream)
{
  for (const auto* values : { &book_.damping, &book_.constraint, &book_.beside, &book_.friction, &book_.load })
    if (values->size() > 0)
      require(cudaMemsetAsync(values->data(), 0, values->bytes(), stream), "clearing an account");
  // nodes that are not stepped keep zeros
  for (int axis = 0; axis < 3; ++axis)
    for (const auto* values : { &before_[axis], &free_[axis] })
      require(cudaMemsetAsync(values->data(), 0, values->bytes(), stream), "clearing an account");
  if (book_.memory.size() > 0)
    require(cudaMemsetAsync(book_.memory.data(), 0, book_.memory.bytes(), stream), "clearing an account");
  require(launch_fibre_work(g, fibres(), u, 0, true, stream), "looking at fibres");
}

void DeviceAccount::look(const StepArguments& g, const float4* u, int step, cudaStream_t stream)
{
  require(launch_fibre_work(g, fibres(), u, step, false, stream), "work of fibres");
}

void DeviceAccount::before_step(const StepArguments& g, int step, cudaStream_t stream)
{
  look(g, g.u[g.first], step, stream);
}

void DeviceAccount::after_step(const StepArguments& g, double damping, int step, cudaStream_t stream)
{
  const NodeAccount account{ static_cast<std::uint32_t>(book_.damping.size()),
                             book_.damping.data(),
                             book_.constraint.data(),
                             book_.beside.data(),
                             static_cast<std::uint32_t>(loaded_.size()),
                             loaded_.data(),
                             book_.load.data() };
  require(launch_node_account(g, account, damping, step, stream), "work on nodes");
}

void DeviceAccount::list_arrays(Effect of_fibres, ArrayList& list) const
{
  for (const auto* const values : { &book_.damping, &book_.constraint, &book_.beside, &book_.friction, &book_.load })
    list.add(Effect::elasticity, "account of energies", values->bytes());
  for (int axis = 0; axis < 3; ++axis)
    list.add(Effect::elasticity, "account of energies", before_[axis].bytes() + free_[axis].bytes());
  list.add(Effect::elasticity, "account of energies", loaded_.bytes());
  list.add(of_fibres, "work of fibres", book_.fibre_work.bytes() + book_.memory.bytes() + fibre_voxels_.bytes());
}

Work DeviceAccount::work() const
{
  Work work;
  work.muscle = sum(book_.fibre_work);
  work.load = sum(book_.load);
  work.constraint = sum(book_.constraint);
  work.friction = sum(book_.friction);
  work.damping = sum(book_.damping);
  return work;
}

}  // namespace cuda
}  // namespace frontalis
