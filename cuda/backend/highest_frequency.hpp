#pragma once

#include "cuda/backend/cuda_solver.hpp"
#include "cuda/kernels/lanczos_kernels.hpp"
#include "solver/stepping/highest_frequency_search.hpp"

#include <vector>

namespace frontalis
{
namespace cuda
{

/// Memory of the search for the highest frequency.
struct CudaSolver::FrequencySearch
{
  DeviceArray<float4> start, moved, forces, present;
  // The sums of each iteration: `size` and then `along` of LanczosIteration.
  static constexpr std::size_t along_at = 2 * lanczos_blocks, sums_of_iteration = along_at + lanczos_blocks;
  DeviceArray<double> sums;
  PinnedArray<double> host_sums;
  // empty if no node follows a master
  DeviceArray<float> mobility;
  DeviceArray<SearchFollower> followers;
  DeviceArray<std::uint32_t> follower_begin;
  std::vector<float> following;  // mass that follows a node, times squared ratios [kg]

  // for modes_above()
  bool keeps_vectors;
  std::vector<double> lengths;  // of the vectors
  LanczosMatrix matrix;
  DeviceArray<uint2> shares;  // of each mode; its first entry has their number
  std::vector<std::int32_t> node_of_device;
  DeviceArray<InverseMass> masses;  // that change

  FrequencySearch(std::size_t nodes, bool keeps)
      : start(nodes),
        moved(nodes),
        forces(nodes),
        present(nodes),
        sums((most_lanczos_iterations + 1) * sums_of_iteration),
        host_sums(sums.size()),
        keeps_vectors(keeps)
  {
    for (const auto* field : { &forces, &present })
      require(cudaMemset(field->data(), 0, field->bytes()), "clearing forces");
  }

  /// The vector of an iteration. If they are not kept, those of every other iteration share memory.
  float4* vector(int iteration)
  {
    if (iteration == 0)
      return start.data();
    const auto index = static_cast<std::size_t>(keeps_vectors ? iteration - 1 : (iteration - 1) % 2);
    while (vectors_.size() <= index)
      vectors_.emplace_back(start.size());
    return vectors_[index].data();
  }
  double2* sizes(int iteration) const
  {
    return reinterpret_cast<double2*>(sums.data() + iteration * sums_of_iteration);
  }
  double* along(int iteration) const { return sums.data() + iteration * sums_of_iteration + along_at; }

  std::size_t bytes() const
  {
    return (4 + vectors_.size()) * start.bytes() + shares.bytes() + masses.bytes() + sums.bytes() + mobility.bytes() +
           followers.bytes() + follower_begin.bytes();
  }

private:
  std::vector<DeviceArray<float4>> vectors_;  // of the iterations after the first
};

}  // namespace cuda
}  // namespace frontalis
