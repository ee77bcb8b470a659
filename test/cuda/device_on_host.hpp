#pragma once

#include <cuda_runtime.h>

#include <cmath>
#include <cstdint>
#include <cstring>

// Replacements for names that only nvcc defines, so that the host can run device code.

#define __noinline__
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
static inline long long __float2ll_rn(float x) { return llrintf(x); }
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
