#include "solver/cpu/one_lane.hpp"
#include "solver/cpu/shell_kernel_body.hpp"

#include <algorithm>

namespace frontalis
{

template <class Real>
WeightedSums<Real>::WeightedSums(const std::vector<Terms>& sums)
{
  for (std::size_t first = 0; first < sums.size(); first += width)
  {
    const std::size_t last = std::min(first + width, sums.size());
    std::size_t longest = 0;
    for (std::size_t s = first; s < last; ++s)
      longest = std::max(longest, sums[s].size());
    const std::size_t begins = rows.size();
    rows.resize(begins + longest, Row{});
    for (std::size_t s = first; s < last; ++s)
      for (std::size_t term = 0; term < sums[s].size(); ++term)
      {
        rows[begins + term].index[s - first] = sums[s][term].first;
        rows[begins + term].weight[s - first] = sums[s][term].second;
      }
    begin.push_back(static_cast<std::int32_t>(rows.size()));
  }
}

template <class Real>
ShellKernels<Real> plain_shell_kernels()
{
  return { ShellKernelBody<OneLane<Real>>::forces, ShellKernelBody<OneLane<Real>>::sum };
}

template struct WeightedSums<float>;
template struct WeightedSums<double>;
template ShellKernels<float> plain_shell_kernels();
template ShellKernels<double> plain_shell_kernels();

}  // namespace frontalis
