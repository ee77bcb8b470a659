#pragma once

#include "cuda/kernels/step_kernel.hpp"

namespace frontalis
{

/// Number of thread blocks of the kernels that sum over a vector, each of which reports sums over its part. A
/// block has as many threads. With more, small models take longer to join the sums.
constexpr int lanczos_blocks = 256;

/// A node whose displacement is `ratio` times that of its master (Discretisation::Follower).
struct SearchFollower
{
  std::uint32_t node, master;  ///< device nodes
  float ratio;
};

/// An iteration of the search for the highest frequency (solver/stepping/highest_frequency_search.hpp). `now` and
/// `before` are vectors of any length; the iteration stands for those of unit length. Of the sums, `x` is the squared
/// length and `y` the largest |component| / sqrt(mass).
struct LanczosIteration
{
  std::uint32_t nodes;
  const float* mobility;                ///< squares of roots_for_search(); null: the inverse mass in u
  const SearchFollower* followers;      ///< in the order of their masters
  const std::uint32_t* follower_begin;  ///< first follower of each master, and the number of all
  std::uint32_t masters;                ///< number of masters with followers
  const float4* u;
  const float4* present;  ///< forces at u
  float4* forces;         ///< forces at `moved`; those of followers are added to their masters
  float4 *now, *before, *moved;
  double amplitude;            ///< largest displacement of a node [m]
  const double2* size_before;  ///< sums of the vector before; null in the first iteration
  const double2* size;         ///< sums of `now`
  double2* size_next;          ///< receives those of the vector that replaces `before`
  double* along;               ///< receives sums of the products of `now` with its image
};

/// moved = u + displacements along `now`. Held nodes do not move.
cudaError_t launch_displace(const LanczosIteration& iteration, cudaStream_t stream);

/// Replaces `before` by the image of `now`, found from the forces, without its parts along both vectors.
cudaError_t launch_lanczos_product(const LanczosIteration& iteration, cudaStream_t stream);

}  // namespace frontalis
