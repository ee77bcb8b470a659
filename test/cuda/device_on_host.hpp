#pragma once

#include <cuda_runtime.h>

#include <cmath>
#include <cstdint>
#include <cstring>

// Replacements for names that only nvcc defines, so that the host can run device code.

#define __noinline__
#undef __shared__
#define __shared__
// Each block has one thread.
struct ThreadOnHost
{
  std::uint32_t x;
};
static const ThreadOnHost threadIdx{ 0 }, blockDim{ 1 };
static inline void __syncthreads() {}
static inline void __syncwarp(std::uint32_t) {}
static inline int __syncthreads_or(int any) { return any; }
static inline std::uint32_t __activemask() { return 1; }
static inline int __any_sync(std::uint32_t, int any) { return any; }
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
