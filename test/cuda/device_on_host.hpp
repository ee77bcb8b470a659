#pragma once

#include "block_on_host.hpp"

#include <cuda_runtime.h>

#include <cmath>
#include <cstdint>
#include <cstring>

// Replacements for names that only nvcc defines, so that the host can run device code.

#define __noinline__
#undef __shared__
#define __shared__
#define threadIdx BlockOnHost::thread()
#define blockDim BlockOnHost::size()
static inline void __syncthreads() { BlockOnHost::barrier(); }
static inline int __syncthreads_or(int any) { return BlockOnHost::barrier(any != 0) ? 1 : 0; }
static inline void __syncwarp(std::uint32_t) {}
static inline void __nanosleep(unsigned) { BlockOnHost::wait(); }
static inline std::uint32_t __activemask() { return 1; }
static inline int __any_sync(std::uint32_t, int any) { return any; }
template <class T>
static inline T __shfl_sync(std::uint32_t, T value, int from)
{
  return BlockOnHost::exchange(value, [from](std::uint32_t) { return static_cast<std::uint32_t>(from); });
}
// Like on a GPU, the last lane gets its own value.
template <class T>
static inline T __shfl_down_sync(std::uint32_t, T value, std::uint32_t by)
{
  return BlockOnHost::exchange(value, [by](std::uint32_t lane) { return std::min(lane + by, BlockOnHost::lanes - 1); });
}
template <class T>
static inline T __shfl_xor_sync(std::uint32_t, T value, int mask)
{
  return BlockOnHost::exchange(value, [mask](std::uint32_t lane) { return lane ^ static_cast<std::uint32_t>(mask); });
}
using std::max;
template <class T>
static inline T __ldg(const T* at)
{
  return *at;
}
static inline std::uint32_t __float_as_uint(float x)
{
  std::uint32_t bits = 0;
  std::memcpy(&bits, &x, sizeof bits);
  return bits;
}
static inline float __uint_as_float(std::uint32_t bits)
{
  float x = 0;
  std::memcpy(&x, &bits, sizeof x);
  return x;
}
static inline std::int32_t __float_as_int(float x) { return static_cast<std::int32_t>(__float_as_uint(x)); }
static inline float __int_as_float(std::int32_t bits) { return __uint_as_float(static_cast<std::uint32_t>(bits)); }
static inline float __fdiv_rn(float x, float y) { return x / y; }
static inline long long __float2ll_rn(float x) { return llrintf(x); }
static inline int __float2int_rn(float x) { return static_cast<int>(lrintf(x)); }
template <class T>
static inline T atomicMin(T* at, T value)
{
  const T old = *at;
  *at = value < old ? value : old;
  return old;
}
// One thread runs at a time.
template <class T>
static inline T atomicAdd(T* at, T value)
{
  const T old = *at;
  *at = old + value;
  return old;
}
template <class T>
static inline T atomicMax(T* at, T value)
{
  const T old = *at;
  *at = old < value ? value : old;
  return old;
}
template <class T>
static inline T atomicExch(T* at, T value)
{
  const T old = *at;
  *at = value;
  return old;
}
