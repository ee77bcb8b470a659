#pragma once

#include <cuda_runtime.h>

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
