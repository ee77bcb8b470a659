#pragma once

#include "frontalis/physics/number.hpp"

namespace frontalis
{
namespace physics
{

/// Eigenvalues and unit eigenvectors (columns) of a symmetric matrix; unordered.
template <class T>
struct SymmetricEigen
{
  T value[3];
  Matrix3<T> vector;
};

/// Cyclic Jacobi rotations (Golub & Van Loan, Matrix Computations, 8.5) in a fixed number of sweeps without branches.
/// Four sweeps reach full single precision, six full double precision.
template <class T>
FRONTALIS_LAW SymmetricEigen<T> symmetric_eigen(Matrix3<T> A)
{
  using N = Number<T>;
  SymmetricEigen<T> result;
  auto& V = result.vector.a;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      V[i][j] = N::of(i == j ? 1 : 0);
  constexpr int sweeps = N::is_double ? 6 : 4;
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (int pair = 0; pair < 3; ++pair)
    {
      const int p = pair == 2 ? 1 : 0, q = pair == 0 ? 1 : 2, r = 3 - p - q;
      // Tangent of the smaller angle that zeroes a_pq.
      const T off = A.a[p][q];
      const T half = N::of(0.5) * (A.a[q][q] - A.a[p][p]);
      const T root = N::sqrt(half * half + off * off);
      const T denominator = N::select(half >= N::of(0), half + root, half - root);
      const T safe = N::select(denominator * denominator > N::of(1e-30), denominator, N::of(1));
      const T t = N::select(denominator * denominator > N::of(1e-30), off / safe, N::of(0));
      const T c = N::of(1) / N::sqrt(t * t + N::of(1));
      const T s = t * c;
      A.a[p][p] = A.a[p][p] - t * off;
      A.a[q][q] = A.a[q][q] + t * off;
      A.a[p][q] = A.a[q][p] = N::of(0);
      const T arp = A.a[r][p], arq = A.a[r][q];
      A.a[r][p] = A.a[p][r] = c * arp - s * arq;
      A.a[r][q] = A.a[q][r] = s * arp + c * arq;
      for (int i = 0; i < 3; ++i)
      {
        const T vp = V[i][p], vq = V[i][q];
        V[i][p] = c * vp - s * vq;
        V[i][q] = s * vp + c * vq;
      }
    }
  for (int i = 0; i < 3; ++i)
    result.value[i] = A.a[i][i];
  return result;
}

}  // namespace physics
}  // namespace frontalis
