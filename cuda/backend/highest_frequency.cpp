#include "cuda/backend/highest_frequency.hpp"

#include "solver/stepping/highest_frequency_search.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace cuda
{

void CudaSolver::ModeDeleter::operator()(Mode* mode) const { delete mode; }

std::optional<double> CudaSolver::highest_frequency_squared(int most_iterations)
{
  synchronise();
  if (!mode_)
  {
    mode_.reset(new Mode(device_.nodes()));
    const NodalVectors random = random_mode(model_->nodes.size());
    std::vector<float4> values(device_.nodes(), float4{ 0, 0, 0, 0 });
    for (std::size_t n = 0; n < random.size(); ++n)
    {
      const auto& x = random[n];
      values[device_.device_node()[n]] = { static_cast<float>(x[0]), static_cast<float>(x[1]), static_cast<float>(x[2]),
                                           0 };
      for (const double c : x)
      {
        mode_->largest = std::max(mode_->largest, std::abs(c) / std::sqrt(discretisation_.node_mass[n]));
        mode_->length += c * c;
      }
    }
    mode_->length = std::sqrt(mode_->length);
    mode_->mode.upload(values.data(), values.size());
  }
  Mode& m = *mode_;
  const auto nodes = static_cast<std::uint32_t>(device_.nodes());
  const float4* const u = u_[present_].data();
  const float* const mobility = device_.arguments().mobility;
  const DeviceArray<float> activation(conditions_.activation);
  queue_forces(u_[present_].data(), activation.data(), m.present.data(), true);
  std::vector<double2> seen;
  const auto multiply = [&](double step)
  {
    require(launch_displace(nodes, mobility, u, m.mode.data(), static_cast<float>(step / m.largest), m.moved.data(),
                            stream_),
            "displacing nodes");
    queue_forces(m.moved.data(), activation.data(), m.forces.data(), true);
    require(launch_product(nodes, mobility, u, m.forces.data(), m.present.data(), static_cast<float>(1 / step),
                           m.mode.data(), m.seen.data(), stream_),
            "a product with the stiffness");
    synchronise();
    m.seen.download(seen);
    double largest = 0, sum = 0;
    for (const double2& s : seen)
    {
      largest = std::max(largest, s.x);
      sum += s.y;
    }
    const double ratio = std::sqrt(sum) * m.largest / m.length;
    m.largest = largest;
    m.length = std::sqrt(sum);
    return ratio;
  };
  const double squared = largest_eigenvalue(most_iterations, mode_amplitude(*model_), multiply);
  if (!std::isfinite(squared))
    mode_.reset();
  return squared;
}

}  // namespace cuda
}  // namespace frontalis
