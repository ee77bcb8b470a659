#include "cuda/backend/device_viscosity.hpp"

#include "frontalis/physics/viscosity.hpp"

namespace frontalis
{
namespace cuda
{

DeviceViscosity::DeviceViscosity(const Model& model, const Discretisation& discretisation,
                                 const std::vector<std::uint32_t>& device_node,
                                 const std::vector<std::uint32_t>& voxel_at, bool apart)
    : terms_(discretisation.viscous_terms)
{
  if (terms_ == 0)
    return;
  std::vector<std::uint32_t> index(model.voxels.size() + 1, 0), words(voxel_at.size(), 0);
  std::vector<float4> properties;
  VoxelProperties voxel;
  for (std::size_t place = 0; place < voxel_at.size(); ++place)
  {
    std::uint32_t& known = index[voxel_at[place]];
    if (voxel_at[place] == 0)
      continue;
    if (known > 0 && !apart)
    {
      words[place] = known;
      continue;
    }
    const std::uint32_t e = voxel_at[place] - 1;
    discretisation.voxel(e, voxel);
    if (!(voxel.viscous_share[0] > 0 || voxel.viscous_share[1] > 0))
      continue;
    counted_.push_back(known == 0 ? 1 : 0);
    voxel_.push_back(e);
    words[place] = known = static_cast<std::uint32_t>(voxel_.size());
    ViscousVoxel v{};
    for (int b = 0; b < 8; ++b)
      v.node[b] = device_node[model.voxel_nodes[e][b]];
    host_.push_back(v);
    properties.push_back({ static_cast<float>(voxel.viscous_share[0]), static_cast<float>(voxel.viscous_share[1]),
                           static_cast<float>(voxel.viscous_rate[0]), static_cast<float>(voxel.viscous_rate[1]) });
  }
  words_ = DeviceArray<std::uint32_t>(words);
  properties_ = DeviceArray<float4>(properties);
  relaxed_ = DeviceArray<float>(static_cast<std::size_t>(physics::relaxed_tensors(terms_)) * 6 * voxel_.size());
}

void DeviceViscosity::set_palette(const std::vector<std::uint32_t>& entry_of_voxel)
{
  for (std::size_t v = 0; v < host_.size(); ++v)
    host_[v].palette = entry_of_voxel[voxel_[v]];
  voxels_ = DeviceArray<ViscousVoxel>(host_);
  host_ = {};
  reset();
}

ViscousVoxels DeviceViscosity::view() const
{
  return { voxels_.data(), static_cast<std::uint32_t>(voxels_.size()), account_.data() };
}

void DeviceViscosity::describe(StepArguments& g) const
{
  g.viscous_words = runs_ ? words_.data() : nullptr;
  g.relaxed = relaxed_.data();
  g.viscous_properties = properties_.data();
  g.viscous_count = static_cast<std::uint32_t>(voxels_.size());
  g.viscous_terms = runs_ ? terms_ : 0;
}

void DeviceViscosity::run(EffectSet running)
{
  runs_ = running.has(Effect::viscosity);
  if (!runs_)
    reset();
}

void DeviceViscosity::list_arrays(ArrayList& list)
{
  list.add(Effect::viscosity, "Prony terms", voxels_.bytes() + properties_.bytes() + words_.bytes());
  list_state(list, Effect::viscosity, "relaxed stresses", relaxed_);
  list_state(list, Effect::viscosity, "work of viscous stresses", account_);
}

void DeviceViscosity::reset()
{
  relaxed_.clear();
  reset_account();
}

void DeviceViscosity::keep_account()
{
  account_ = DeviceArray<double>(2 * voxels_.size());
  reset_account();
}

void DeviceViscosity::relax(const StepArguments& g, const float4* u, const float4* u_before, double elapsed,
                            cudaStream_t stream)
{
  if (!idle())
    require(launch_relaxation(g, view(), u, u_before, static_cast<float>(elapsed), stream),
            "relaxing viscous stresses");
}

// Work that viscosity has absorbed: the changes of H : E by relaxation since the account was opened, minus the present
// H : E, where H is the relaxed stress and E the strain.
double DeviceViscosity::work() const
{
  if (account_.size() == 0)
    return 0;
  std::vector<double> account;
  account_.download(account);
  double sum = 0;
  for (std::size_t v = 0; v < voxels_.size(); ++v)
    if (counted_[v] != 0)
      sum += account[2 * v] - account[2 * v + 1];
  return sum;
}

}  // namespace cuda
}  // namespace frontalis
