#pragma once

#include "cuda/kernels/bound_points.cuh"
#include "cuda/kernels/shell_arguments.hpp"
#include "frontalis/physics/shell.hpp"

namespace frontalis
{
namespace cuda
{

/// Forces on the vertices of a triangle by a stiffness that is nowhere below that of the triangle, at displacements u.
__device__ __forceinline__ void shell_spring_forces(const physics::ShellTriangle<float>& rest, float bending,
                                                    const physics::Vec3<float> (&u)[6],
                                                    physics::Vec3<float> (&force)[6])
{
  const physics::Vec3<float> a = u[1] - u[0], b = u[2] - u[0];
  const float stiffness = 2 * (rest.shear + rest.dilatation);
  const physics::Vec3<float> on_a = stiffness * (rest.metric[0] * a + rest.metric[1] * b);
  const physics::Vec3<float> on_b = stiffness * (rest.metric[1] * a + rest.metric[2] * b);
#pragma unroll
  for (int i = 0; i < 6; ++i)
    force[i] = -bending * u[i];
  force[0] = force[0] + on_a + on_b;
  force[1] = force[1] - on_a;
  force[2] = force[2] - on_b;
}

/// Finds the forces of a triangle of a patch. `moved`: displacements of the patch's vertices. `forces`: the patch's.
__device__ __forceinline__ void put_shell_forces(const ShellArguments& s, const PatchShell& patch, std::uint32_t t,
                                                 const float4* moved, float* forces)
{
  float word[4 * shell_words];
#pragma unroll
  for (int i = 0; i < shell_words; ++i)
  {
    const float4 four = __ldg(s.triangles + i * std::size_t(s.triangle_count) + patch.triangle_begin + t);
    word[4 * i] = four.x;
    word[4 * i + 1] = four.y;
    word[4 * i + 2] = four.z;
    word[4 * i + 3] = four.w;
  }
  physics::ShellTriangle<float> rest;
  static_assert(sizeof rest == 30 * sizeof(float), "a triangle is the first 30 numbers");
  memcpy(&rest, word, sizeof rest);
  physics::Vec3<float> u[6];
#pragma unroll
  for (int i = 0; i < 6; ++i)
  {
    const float4 at = moved[__float_as_uint(word[32 + i])];
    u[i] = { at.x, at.y, at.z };
  }
  physics::ShellReaction<float> reaction;
  if (s.spring)
    shell_spring_forces(rest, word[30], u, reaction.force);
  else
    reaction = physics::shell_forces(rest, u);
#pragma unroll
  for (int i = 0; i < 6; ++i)
  {
    float* const to = forces + 3 * i * patch.triangles + t;
    to[0] = reaction.force[i].x;
    to[patch.triangles] = reaction.force[i].y;
    to[2 * patch.triangles] = reaction.force[i].z;
  }
}

/// Adds every `step`th term of the force on a vertex, from number `first` on, in order.
__device__ __forceinline__ physics::Vec3<float> sum_shell_forces(const ShellArguments& s, const PatchShell& patch,
                                                                 std::uint32_t vertex, std::uint32_t first,
                                                                 std::uint32_t step, const float* forces)
{
  const uint2 sum = __ldg(s.sums + patch.vertex_begin + vertex);
  physics::Vec3<float> force{ 0, 0, 0 };
  for (std::uint32_t k = first; k < sum.y; k += step)
  {
    const float* const from = forces + __ldg(s.terms + sum.x + k);
    force = force + physics::Vec3<float>{ from[0], from[patch.triangles], from[2 * patch.triangles] };
  }
  return force;
}

}  // namespace cuda
}  // namespace frontalis
