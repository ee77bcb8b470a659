#pragma once

#include "solver/cpu/simd_number.hpp"

#include <cstring>

namespace frontalis
{

/// SIMD lanes that load, gather and store vectors as records of four numbers, the first three of which are the
/// components.
template <class Architecture>
struct RecordLanes
{
  using Real = float;
  using Batch = xsimd::batch<float, Architecture>;
  using Vector = physics::Vec3<Batch>;
  static constexpr int count = static_cast<int>(Batch::size);

  static FRONTALIS_LAW Batch load(const float* p) { return Batch::load_unaligned(p); }
  static FRONTALIS_LAW void store(const Batch& x, float* p) { x.store_unaligned(p); }
  static FRONTALIS_LAW bool any_positive(const Batch& x) { return xsimd::any(x > Batch(0.0f)); }

  /// Returns one bit per lane: whether the lane's number is positive.
  static FRONTALIS_LAW std::uint32_t positive(const Batch& x)
  {
#if defined(__AVX512F__)
    if constexpr (count == 16)
      return _mm512_cmp_ps_mask(x, _mm512_setzero_ps(), _CMP_GT_OQ);
#endif
#if defined(__AVX__)
    if constexpr (count == 8)
      return static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_cmp_ps(x, _mm256_setzero_ps(), _CMP_GT_OQ)));
#endif
    alignas(64) float lane[count];
    store(x, lane);
    std::uint32_t bits = 0;
    for (int l = 0; l < count; ++l)
      bits |= lane[l] > 0 ? 1U << l : 0U;
    return bits;
  }

  /// Gathers p[index] and p[index + 1].
  static FRONTALIS_LAW void gather_two(const float* p, const std::int32_t* index, Batch& first, Batch& second)
  {
#if defined(__SSE2__)
    typename Batch::register_type even{}, odd{};
    each_quarter(even, [&](int l) { return two(p + index[l], p + index[l + 1]); });
    each_quarter(odd, [&](int l) { return two(p + index[l + 2], p + index[l + 3]); });
    first = shuffled<0x88>(even, odd);
    second = shuffled<0xdd>(even, odd);
#else
    float low[count], high[count];
    for (int l = 0; l < count; ++l)
    {
      low[l] = p[index[l]];
      high[l] = p[index[l] + 1];
    }
    first = load(low);
    second = load(high);
#endif
  }

  /// Gathers the vectors of the records that begin at p[stride * index].
  static FRONTALIS_LAW Vector gather_records(const float* p, std::ptrdiff_t stride, const std::int32_t* index)
  {
    return gather_vectors([=](int l) { return p + stride * index[l]; });
  }

  /// Gathers the vectors at the addresses at(lane). The number after each vector must be readable or, if `before` is 1,
  /// the number before it.
  template <int before = 0, class At>
  static FRONTALIS_LAW Vector gather_vectors(const At& at)
  {
#if defined(__SSE2__)
    typename Batch::register_type record[4] = {};
    for (int i = 0; i < 4; ++i)
      each_quarter(record[i], [&](int l) { return _mm_loadu_ps(at(l + i) - before); });
    const Batch xy = shuffled<0x44>(record[0], record[1]), xy2 = shuffled<0x44>(record[2], record[3]);
    const Batch zw = shuffled<0xee>(record[0], record[1]), zw2 = shuffled<0xee>(record[2], record[3]);
    if constexpr (before == 1)
      return { shuffled<0xdd>(xy, xy2), shuffled<0x88>(zw, zw2), shuffled<0xdd>(zw, zw2) };
    return { shuffled<0x88>(xy, xy2), shuffled<0xdd>(xy, xy2), shuffled<0x88>(zw, zw2) };
#else
    float lane[3][count];
    for (int l = 0; l < count; ++l)
      for (int axis = 0; axis < 3; ++axis)
        lane[axis][l] = at(l)[axis];
    return { load(lane[0]), load(lane[1]), load(lane[2]) };
#endif
  }

  /// Stores vectors as records; the record of lane l begins at p[record(l)].
  static FRONTALIS_LAW void store_records(const Vector& v, float* p)
  {
#if defined(__SSE2__)
    const Batch none(0.0f);
    const Batch xy = shuffled<0x44>(v.x, v.y), xy2 = shuffled<0xee>(v.x, v.y);
    const Batch zw = shuffled<0x44>(v.z, none), zw2 = shuffled<0xee>(v.z, none);
    store(shuffled<0x88>(xy, zw), p);
    store(shuffled<0xdd>(xy, zw), p + count);
    store(shuffled<0x88>(xy2, zw2), p + 2 * count);
    store(shuffled<0xdd>(xy2, zw2), p + 3 * count);
#else
    float lane[3][count];
    store(v.x, lane[0]);
    store(v.y, lane[1]);
    store(v.z, lane[2]);
    for (int l = 0; l < count; ++l)
      for (int axis = 0; axis < 4; ++axis)
        p[record(l) + axis] = axis < 3 ? lane[axis][l] : 0;
#endif
  }
  static constexpr int record(int l) { return (l % 4) * count + 4 * (l / 4); }
  static FRONTALIS_LAW void add_record(const float* from, float* to)
  {
#if defined(__SSE2__)
    _mm_storeu_ps(to, _mm_add_ps(_mm_loadu_ps(to), _mm_loadu_ps(from)));
#else
    for (int axis = 0; axis < 3; ++axis)
      to[axis] += from[axis];
#endif
  }
  static FRONTALIS_LAW void copy_record(const float* from, float* to) { std::memcpy(to, from, 4 * sizeof(float)); }

private:
#if defined(__SSE2__)
  static FRONTALIS_LAW __m128 two(const float* first, const float* second)
  {
    return _mm_loadh_pi(_mm_castpd_ps(_mm_load_sd(reinterpret_cast<const double*>(first))),
                        reinterpret_cast<const __m64*>(second));
  }
  // Sets each 128-bit part of a register to make(index of the part's first lane).
  template <class Register, class Make>
  static FRONTALIS_LAW void each_quarter(Register& to, const Make& make)
  {
    if constexpr (count == 4)
      to = make(0);
#if defined(__AVX2__)
    else if constexpr (count == 8)
      to = _mm256_insertf128_ps(_mm256_castps128_ps256(make(0)), make(4), 1);
#endif
#if defined(__AVX512F__)
    else if constexpr (count == 16)
    {
      const __m256 low = _mm256_insertf128_ps(_mm256_castps128_ps256(make(0)), make(4), 1);
      const __m256 high = _mm256_insertf128_ps(_mm256_castps128_ps256(make(8)), make(12), 1);
      to = _mm512_insertf32x8(_mm512_castps256_ps512(low), high, 1);
    }
#endif
  }
  // Applies _mm_shuffle_ps to each 128-bit part.
  template <int mask>
  static FRONTALIS_LAW Batch shuffled(const Batch& a, const Batch& b)
  {
    if constexpr (count == 4)
      return Batch(_mm_shuffle_ps(a, b, mask));
#if defined(__AVX2__)
    else if constexpr (count == 8)
      return Batch(_mm256_shuffle_ps(a, b, mask));
#endif
#if defined(__AVX512F__)
    else if constexpr (count == 16)
      return Batch(_mm512_shuffle_ps(a, b, mask));
#endif
  }
#endif
};

}  // namespace frontalis
