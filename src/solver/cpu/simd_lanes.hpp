#pragma once

#include "solver/cpu/simd_number.hpp"

namespace frontalis
{

/// Loads and sums of SIMD batches that xsimd lacks. The lanes of a batch are voxels along x, in strips of `Strip`
/// lanes. Different strips need not be contiguous in memory.
template <class Architecture, class Real, int Strip>
struct SimdLanes
{
  using Batch = xsimd::batch<Real, Architecture>;
  static constexpr int count = static_cast<int>(Batch::size);

  static FRONTALIS_LAW Batch load(const Real* p) { return Batch::load_unaligned(p); }

  /// Loads floats into a batch of doubles.
  template <class Narrow,
            class = std::enable_if_t<std::is_same<Narrow, float>::value && !std::is_same<Real, float>::value>>
  static FRONTALIS_LAW Batch load(const Narrow* p)
  {
#if defined(__AVX512F__)
    if constexpr (count == 8)
      return _mm512_cvtps_pd(_mm256_loadu_ps(p));
#elif defined(__AVX2__)
    if constexpr (count == 4)
      return _mm256_cvtps_pd(_mm_loadu_ps(p));
#endif
    alignas(64) Real wide[count];
    for (int i = 0; i < count; ++i)
      wide[i] = p[i];
    return Batch::load_aligned(wide);
  }

  static FRONTALIS_LAW void store(const Batch& x, float* p)
  {
    if constexpr (std::is_same<Real, float>::value)
      x.store_unaligned(p);
    else
    {
      alignas(64) Real wide[count];
      x.store_aligned(wide);
      for (int i = 0; i < count; ++i)
        p[i] = static_cast<float>(wide[i]);
    }
  }

  /// Loads a batch from one strip, or from two.
  static FRONTALIS_LAW Batch load(const Real* first, [[maybe_unused]] const Real* second)
  {
#if defined(__AVX512F__)
    if constexpr (count == 2 * Strip)
      return _mm512_insertf32x8(_mm512_castps256_ps512(_mm256_loadu_ps(first)), _mm256_loadu_ps(second), 1);
#endif
    return load(first);
  }

  /// Whether a batch can be two strips.
  static constexpr bool two_strips = count == 2 * Strip;

  /// Adds forces to the nodes of a row: `low` to the lower nodes of the voxels, `high` to the next nodes. Neighbouring
  /// voxels share nodes, so that both are first added in registers: a load that overlaps a recent store would stall.
  static FRONTALIS_LAW void add(Real* first, const Batch& low, const Batch& high)
  {
    alignas(64) Real last[count];
    high.store_aligned(last);
    (load(first) + (low + moved_up(high))).store_unaligned(first);
    first[count] += last[count - 1];
  }

  /// Like add(), for a batch of two strips.
  static FRONTALIS_LAW void add(Real* first, [[maybe_unused]] Real* second, const Batch& low, const Batch& high)
  {
#if defined(__AVX512F__)
    if constexpr (two_strips)
    {
      // The last number of each strip comes to its front, where the first mask leaves it out of the sum.
      const __m512 turned =
          _mm512_permutexvar_ps(_mm512_set_epi32(14, 13, 12, 11, 10, 9, 8, 15, 6, 5, 4, 3, 2, 1, 0, 7), high);
      const __m512 sum = _mm512_mask_add_ps(low, 0xfefe, low, turned);
      add(first, _mm512_castps512_ps256(sum), _mm512_castps512_ps256(turned));
      add(second, _mm512_extractf32x8_ps(sum, 1), _mm512_extractf32x8_ps(turned, 1));
      return;
    }
#endif
    add(first, low, high);
  }

private:
#if defined(__AVX512F__)
  static FRONTALIS_LAW void add(Real* first, __m256 sum, __m256 turned)
  {
    _mm256_storeu_ps(first, _mm256_add_ps(_mm256_loadu_ps(first), sum));
    first[Strip] += _mm256_cvtss_f32(turned);
  }
#endif
#if defined(__AVX2__)
  static FRONTALIS_LAW __m256 moved_up(__m256 x)
  {
    const __m256i next = _mm256_set_epi32(6, 5, 4, 3, 2, 1, 0, 0);
    return _mm256_blend_ps(_mm256_permutevar8x32_ps(x, next), _mm256_setzero_ps(), 1);
  }
#endif
  /// Moves each lane's number to the next lane; the first becomes 0.
  static FRONTALIS_LAW Batch moved_up(const Batch& x)
  {
#if defined(__AVX512F__)
    if constexpr (std::is_same<Real, float>::value && count == 16)
      return _mm512_maskz_permutexvar_ps(0xfffe, _mm512_set_epi32(14, 13, 12, 11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0, 0),
                                         x);
    else if constexpr (std::is_same<Real, double>::value && count == 8)
      return _mm512_maskz_permutexvar_pd(0xfe, _mm512_set_epi64(6, 5, 4, 3, 2, 1, 0, 0), x);
#elif defined(__AVX2__)
    if constexpr (std::is_same<Real, float>::value && count == 8)
      return moved_up(__m256(x));
    else if constexpr (std::is_same<Real, double>::value && count == 4)
      return _mm256_blend_pd(_mm256_permute4x64_pd(x, 0x90), _mm256_setzero_pd(), 1);
#elif defined(__SSE2__)
    if constexpr (std::is_same<Real, float>::value && count == 4)
      return _mm_castsi128_ps(_mm_slli_si128(_mm_castps_si128(x), 4));
    else if constexpr (std::is_same<Real, double>::value && count == 2)
      return _mm_castsi128_pd(_mm_slli_si128(_mm_castpd_si128(x), 8));
#endif
    alignas(64) Real lane[count + 1];
    lane[0] = 0;
    x.store_unaligned(lane + 1);
    return Batch::load_aligned(lane);
  }
};

}  // namespace frontalis
