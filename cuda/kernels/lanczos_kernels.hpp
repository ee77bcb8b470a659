#pragma once

#include "cuda/kernels/step_kernel.hpp"

namespace frontalis
{

/// Number of thread blocks of the kernels that sum over a vector, each of which reports sums over its part. With more,
/// small models take longer to join the sums.
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
  const float4 *now, *before;
  float4* after;  ///< may be `before`
  float4* moved;
  double amplitude;            ///< largest displacement of a node [m]
  const double2* size_before;  ///< sums of the vector before; null in the first iteration
  const double2* size;         ///< sums of `now`
  double2* size_next;          ///< receives those of `after`
  double* along;               ///< receives sums of the products of `now` with its image
};

/// moved = u + displacements along `now`. Held nodes do not move.
cudaError_t launch_displace(const LanczosIteration& iteration, cudaStream_t stream);

/// after = the image of `now`, found from the forces, without its parts along `now` and `before`.
cudaError_t launch_lanczos_product(const LanczosIteration& iteration, cudaStream_t stream);

/// A mode that a search has found: the sum of its vectors times components. Vectors may have any length.
struct VectorSum
{
  static constexpr int most_vectors = 32;
  const float4* vector[most_vectors];
  float component[most_vectors];  ///< for the vectors as they are
  int vectors;
  std::uint32_t nodes;
  float least;            ///< share from which on a node is listed; the list has room for 1 / least nodes
  uint2* list;            ///< receives device nodes and the bits of their shares, in any order
  std::uint32_t* listed;  ///< receives their number; zero before
};

/// Lists the nodes with the largest shares in a mode (solver/stepping/added_mass.hpp).
cudaError_t launch_list_shares(const VectorSum& mode, cudaStream_t stream);

/// Inverse masses that nodes get [1/kg].
struct InverseMass
{
  std::uint32_t node;  ///< device node
  float own;           ///< of the node
  float of_group;      ///< of the node and of those that follow it
};

/// Writes inverse masses to the last component of `u` and `other`, to `mobility`, and those of groups to `of_groups`;
/// the last two may be null.
cudaError_t launch_set_inverse_masses(const InverseMass* masses, std::uint32_t count, float4* u, float4* other,
                                      float* mobility, float* of_groups, cudaStream_t stream);

}  // namespace frontalis
