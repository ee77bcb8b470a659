#pragma once

#include <cmath>

// The laws in this folder are compiled for double (reference), for SIMD batches (CPU) and for float in CUDA kernels.
#if defined(__CUDACC__)
#define FRONTALIS_LAW __host__ __device__ __forceinline__
#elif defined(__GNUC__)
#define FRONTALIS_LAW inline __attribute__((always_inline))
#else
#define FRONTALIS_LAW inline
#endif

// Unrolls the loop that follows, so that arrays indexed by it stay in registers.
#if defined(__CUDACC__)
#define FRONTALIS_UNROLL _Pragma("unroll")
#else
#define FRONTALIS_UNROLL
#endif

namespace frontalis
{
namespace physics
{

constexpr double pi = 3.14159265358979323846;

/// The functions that a law needs of its number type beyond + - * / and comparisons. This version is for scalars; the
/// CPU backend specialises it for SIMD batches.
template <class T>
struct Number
{
  static FRONTALIS_LAW T of(double value) { return static_cast<T>(value); }
  /// `yes` if the condition holds, else `no`. Both are evaluated.
  static FRONTALIS_LAW T select(bool condition, T yes, T no) { return condition ? yes : no; }
  static FRONTALIS_LAW T max(T a, T b) { return a > b ? a : b; }
  static FRONTALIS_LAW T min(T a, T b) { return a < b ? a : b; }
  static FRONTALIS_LAW T sqrt(T a) { return static_cast<T>(::sqrt(static_cast<double>(a))); }
  static FRONTALIS_LAW T exp(T a) { return static_cast<T>(::exp(static_cast<double>(a))); }
  static FRONTALIS_LAW T log(T a) { return static_cast<T>(::log(static_cast<double>(a))); }
  static constexpr bool is_double = sizeof(T) == sizeof(double);
  /// a^(-1/3) for a > 0.
  static FRONTALIS_LAW T inverse_cube_root(T a) { return static_cast<T>(1.0 / ::cbrt(static_cast<double>(a))); }
};

#if defined(__CUDACC__)
template <>
struct Number<float>
{
  static FRONTALIS_LAW float of(double value) { return static_cast<float>(value); }
  static FRONTALIS_LAW float select(bool condition, float yes, float no) { return condition ? yes : no; }
  static FRONTALIS_LAW float max(float a, float b) { return fmaxf(a, b); }
  static FRONTALIS_LAW float min(float a, float b) { return fminf(a, b); }
  static FRONTALIS_LAW float sqrt(float a) { return sqrtf(a); }
  static FRONTALIS_LAW float exp(float a) { return expf(a); }
  static FRONTALIS_LAW float log(float a) { return logf(a); }
  static constexpr bool is_double = false;
  static FRONTALIS_LAW float inverse_cube_root(float a)
  {
#if defined(__CUDA_ARCH__)
    return rcbrtf(a);
#else
    return 1.0f / cbrtf(a);
#endif
  }
};
#endif

/// 3 x 3 matrix, row by row.
template <class T>
struct Matrix3
{
  T a[3][3];
};

template <class T>
struct Vec3
{
  T x, y, z;
};

template <class T>
struct SymmetricMatrix
{
  T xx, yy, zz, xy, xz, yz;
};
template <class T>
FRONTALIS_LAW Vec3<T> operator*(const SymmetricMatrix<T>& m, const Vec3<T>& a)
{
  return { m.xx * a.x + m.xy * a.y + m.xz * a.z, m.xy * a.x + m.yy * a.y + m.yz * a.z,
           m.xz * a.x + m.yz * a.y + m.zz * a.z };
}
template <class T>
FRONTALIS_LAW SymmetricMatrix<T> scaled(const T& s, const SymmetricMatrix<T>& m)
{
  return { s * m.xx, s * m.yy, s * m.zz, s * m.xy, s * m.xz, s * m.yz };
}

template <class T>
FRONTALIS_LAW Vec3<T> operator+(const Vec3<T>& a, const Vec3<T>& b)
{
  return { a.x + b.x, a.y + b.y, a.z + b.z };
}
template <class T>
FRONTALIS_LAW Vec3<T> operator-(const Vec3<T>& a, const Vec3<T>& b)
{
  return { a.x - b.x, a.y - b.y, a.z - b.z };
}
template <class T>
FRONTALIS_LAW Vec3<T> operator*(T s, const Vec3<T>& a)
{
  return { s * a.x, s * a.y, s * a.z };
}
template <class T>
FRONTALIS_LAW T dot(const Vec3<T>& a, const Vec3<T>& b)
{
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
FRONTALIS_LAW Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b)
{
  return { a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x };
}
template <class T>
FRONTALIS_LAW T norm(const Vec3<T>& a)
{
  return Number<T>::sqrt(dot(a, a));
}

}  // namespace physics
}  // namespace frontalis
