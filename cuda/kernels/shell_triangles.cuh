#pragma once

#include "cuda/kernels/bound_points.cuh"
#include "cuda/kernels/shell_arguments.hpp"
#include "frontalis/physics/shell.hpp"

namespace frontalis
{
namespace cuda
{

/// Forces on the vertices of a triangle at displacements u, by an upper bound of the triangle's stiffness.
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

/// Finds the forces of a triangle on its vertices and stores them in `forces`, whose rows have the length `stride`.
/// `moved`: displacements of vertices.
__device__ __forceinline__ void put_shell_forces(const ShellTriangles& all, std::uint32_t t, const float4* moved,
                                                 float* forces, std::uint32_t stride)
{
  float word[4 * shell_words];
#pragma unroll
  for (std::uint32_t i = 0; i < shell_words; ++i)
  {
    const float4 four = all.words[i * std::size_t(all.count) + t];
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
  if (all.spring)
    shell_spring_forces(rest, word[30], u, reaction.force);
  else
    reaction = physics::shell_forces(rest, u);
#pragma unroll
  for (std::uint32_t i = 0; i < 6; ++i)
  {
    float* const to = forces + 3 * i * std::size_t(stride) + t;
    to[0] = reaction.force[i].x;
    to[stride] = reaction.force[i].y;
    to[2 * std::size_t(stride)] = reaction.force[i].z;
  }
}

/// A triangle's force on one of its vertices, whose x component is at `from`.
__device__ __forceinline__ physics::Vec3<float> shell_force(const float* from, std::uint32_t stride)
{
  return { from[0], from[stride], from[2 * std::size_t(stride)] };
}

}  // namespace cuda
}  // namespace frontalis
