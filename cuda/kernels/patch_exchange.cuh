#pragma once

#include "cuda/kernels/step_kernel.hpp"

namespace frontalis
{
namespace cuda
{

// A displacement and its step number are written as one word of 16 bytes, so that a reader waits for exactly the data
// that it needs, without fences or barriers between blocks. Two buffers suffice: neighbouring patches read from each
// other, so that a writer is at most one step ahead of its readers.

/// Step number, stored in place of the inverse mass. Its highest bit is set, which distinguishes it from an inverse
/// mass.
__device__ __forceinline__ std::uint32_t mark(const StepArguments& g, std::int32_t step)
{
  return 0x80000000u | (g.steps_before + static_cast<std::uint32_t>(step - g.step_begin));
}

__device__ __forceinline__ void send(float4* to, const float* u, std::uint32_t mark)
{
#ifndef __CUDA_ARCH__  // tests run device code on the host
  *to = make_float4(u[0], u[1], u[2], __uint_as_float(mark));
#else
  asm volatile(
      "{ .reg .b64 low, high; .reg .b128 all; mov.b64 low, {%1, %2}; mov.b64 high, {%3, %4};"
      " mov.b128 all, {low, high}; st.relaxed.gpu.global.b128 [%0], all; }" ::"l"(to),
      "r"(__float_as_uint(u[0])), "r"(__float_as_uint(u[1])), "r"(__float_as_uint(u[2])), "r"(mark)
      : "memory");
#endif
}

/// Reads a word; its last component has the bits of its mark.
__device__ __forceinline__ float4 look_at(const float4* from)
{
#ifndef __CUDA_ARCH__
  return *from;
#else
  std::uint32_t word[4];
  asm volatile(
      "{ .reg .b64 low, high; .reg .b128 all; ld.relaxed.gpu.global.b128 all, [%4];"
      " mov.b128 {low, high}, all; mov.b64 {%0, %1}, low; mov.b64 {%2, %3}, high; }"
      : "=r"(word[0]), "=r"(word[1]), "=r"(word[2]), "=r"(word[3])
      : "l"(from));
  return make_float4(__uint_as_float(word[0]), __uint_as_float(word[1]), __uint_as_float(word[2]),
                     __uint_as_float(word[3]));
#endif
}

/// Waits for a word with this mark.
__device__ __forceinline__ float4 receive(const float4* from, std::uint32_t mark)
{
  float4 word = look_at(from);
  while (__float_as_uint(word.w) != mark)
  {
#ifndef __CUDA_ARCH__
    __nanosleep(0);  // on the host, threads take turns
#endif
    word = look_at(from);
  }
  return make_float4(word.x, word.y, word.z, 0);
}

/// Makes the state of a node known after its step. `last`: whether this is the last step of a launch, which writes all
/// nodes to global memory.
__device__ __forceinline__ void publish(const StepArguments& g, std::uint32_t node, const float (&u)[3],
                                        const float (&v)[3], float inverse_mass, bool on_border, bool last,
                                        float4* next, int step)
{
  if (last)
  {
    next[node] = make_float4(u[0], u[1], u[2], inverse_mass);
#pragma unroll
    for (int i = 0; i < 3; ++i)
      g.v[i][node] = v[i];
  }
  else if (on_border)
    send(next + node, u, mark(g, step + 1));
}

}  // namespace cuda
}  // namespace frontalis
