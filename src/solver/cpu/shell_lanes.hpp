#pragma once

#include "solver/cpu/shell_kernel_body.hpp"
#include "solver/cpu/simd_number.hpp"

#include <immintrin.h>

namespace frontalis
{

/// Lanes of an instruction set. Vectors are loaded and stored whole, four per 64 bytes of AVX-512, and turned into
/// batches of x, y and z, since it takes several times as long to gather each component. The loaded register k has the
/// vectors of lanes k, k + 4, k + 8 ..., one per 128 bits, within which unpacking and shuffling work.
template <class Architecture>
struct ShellLanes
{
  using Real = float;
  using Batch = xsimd::batch<float, Architecture>;
  using Register = typename Batch::register_type;
  static constexpr int count = static_cast<int>(Batch::size);

  static FRONTALIS_LAW Batch load(const float* p) { return Batch::load_unaligned(p); }

  static FRONTALIS_LAW physics::Vec3<Batch> gather(const ShellVector<float>* from, const std::int32_t* index)
  {
    const Register a = every_fourth(from, index), b = every_fourth(from, index + 1), c = every_fourth(from, index + 2),
                   d = every_fourth(from, index + 3);
    const Register ab = low(a, b), cd = low(c, d);
    return { Batch(first_halves(ab, cd)), Batch(second_halves(ab, cd)), Batch(first_halves(high(a, b), high(c, d))) };
  }

  static FRONTALIS_LAW void store(const physics::Vec3<Batch>& v, ShellVector<float>* to)
  {
    const Register none = Batch(0.0F);
    const Register xy[2] = { low(v.x, v.y), high(v.x, v.y) }, z[2] = { low(v.z, none), high(v.z, none) };
    FRONTALIS_UNROLL
    for (int i = 0; i < 2; ++i)
    {
      Batch(first_halves(xy[i], z[i])).store_unaligned(to[2 * i * count / 4].x);
      Batch(second_halves(xy[i], z[i])).store_unaligned(to[(2 * i + 1) * count / 4].x);
    }
  }
  static FRONTALIS_LAW __m128 vector(const ShellVector<float>& v) { return _mm_load_ps(v.x); }
  static FRONTALIS_LAW __m128 vector(float x, float y, float z) { return _mm_setr_ps(x, y, z, 0); }
  static FRONTALIS_LAW __m128 times(float weight, __m128 v) { return _mm_set1_ps(weight) * v; }
  static FRONTALIS_LAW void store(__m128 v, ShellVector<float>& to) { _mm_store_ps(to.x, v); }

  /// Where the first store() puts the vector of a lane.
  static int place(int lane) { return lane % 4 * (count / 4) + lane / 4; }

private:
  static FRONTALIS_LAW Register every_fourth(const ShellVector<float>* from, const std::int32_t* index)
  {
    const __m128 first = _mm_load_ps(from[index[0]].x);
    if constexpr (count == 4)
      return first;
#if defined(__AVX512F__)
    if constexpr (count == 16)
    {
      __m512 all = _mm512_insertf32x4(_mm512_castps128_ps512(first), _mm_load_ps(from[index[4]].x), 1);
      all = _mm512_insertf32x4(all, _mm_load_ps(from[index[8]].x), 2);
      return _mm512_insertf32x4(all, _mm_load_ps(from[index[12]].x), 3);
    }
#elif defined(__AVX2__)
    if constexpr (count == 8)
      return _mm256_insertf128_ps(_mm256_castps128_ps256(first), _mm_load_ps(from[index[4]].x), 1);
#endif
  }
#if defined(__AVX512F__)
  static FRONTALIS_LAW __m512 low(__m512 a, __m512 b) { return _mm512_unpacklo_ps(a, b); }
  static FRONTALIS_LAW __m512 high(__m512 a, __m512 b) { return _mm512_unpackhi_ps(a, b); }
  static FRONTALIS_LAW __m512 first_halves(__m512 a, __m512 b) { return _mm512_shuffle_ps(a, b, 0x44); }
  static FRONTALIS_LAW __m512 second_halves(__m512 a, __m512 b) { return _mm512_shuffle_ps(a, b, 0xee); }
#elif defined(__AVX2__)
  static FRONTALIS_LAW __m256 low(__m256 a, __m256 b) { return _mm256_unpacklo_ps(a, b); }
  static FRONTALIS_LAW __m256 high(__m256 a, __m256 b) { return _mm256_unpackhi_ps(a, b); }
  static FRONTALIS_LAW __m256 first_halves(__m256 a, __m256 b) { return _mm256_shuffle_ps(a, b, 0x44); }
  static FRONTALIS_LAW __m256 second_halves(__m256 a, __m256 b) { return _mm256_shuffle_ps(a, b, 0xee); }
#else
  static FRONTALIS_LAW __m128 low(__m128 a, __m128 b) { return _mm_unpacklo_ps(a, b); }
  static FRONTALIS_LAW __m128 high(__m128 a, __m128 b) { return _mm_unpackhi_ps(a, b); }
  static FRONTALIS_LAW __m128 first_halves(__m128 a, __m128 b) { return _mm_shuffle_ps(a, b, 0x44); }
  static FRONTALIS_LAW __m128 second_halves(__m128 a, __m128 b) { return _mm_shuffle_ps(a, b, 0xee); }
#endif
};

}  // namespace frontalis
