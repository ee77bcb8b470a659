#pragma once

#include "cuda/backend/cuda_solver.hpp"
#include "cuda/kernels/lanczos_kernels.hpp"
#include "solver/stepping/highest_frequency_search.hpp"

#include <unordered_map>
#include <vector>

namespace frontalis
{
namespace cuda
{

/// Memory of the search for the highest frequency.
struct CudaSolver::FrequencySearch
{
  DeviceArray<float4> start, now, before, moved, forces, present;
  DeviceArray<double2> sizes;  // per vector
  DeviceArray<double> along;   // per iteration
  // empty if no node follows a master
  DeviceArray<float> mobility;
  DeviceArray<SearchFollower> followers;
  DeviceArray<std::uint32_t> follower_begin;

  std::unordered_map<std::int32_t, double> following;  // mass that follows a node, times squared ratios [kg]

  // for modes_above()
  std::vector<DeviceArray<float4>> vectors;  // of the latest iterations
  std::vector<double> lengths;               // of these vectors
  LanczosMatrix matrix;
  DeviceArray<uint2> shares;
  DeviceArray<std::uint32_t> listed;
  std::vector<std::int32_t> node_of_device;

  explicit FrequencySearch(std::size_t nodes)
      : start(nodes),
        now(nodes),
        before(nodes),
        moved(nodes),
        forces(nodes),
        present(nodes),
        sizes((most_lanczos_iterations + 1) * lanczos_blocks),
        along(most_lanczos_iterations * lanczos_blocks)
  {
    for (const auto* field : { &forces, &present })
      require(cudaMemset(field->data(), 0, field->bytes()), "clearing forces");
  }

  std::size_t bytes() const
  {
    return (6 + vectors.size()) * start.bytes() + shares.bytes() + listed.bytes() + sizes.bytes() + along.bytes() +
           mobility.bytes() + followers.bytes() + follower_begin.bytes();
  }
};

}  // namespace cuda
}  // namespace frontalis
