#pragma once

#include "study/bench/bare_loop.hpp"

#include <xsimd/xsimd.hpp>

namespace frontalis
{

// Does not use the laws in physics/, since a reference that shares their code would hide their cost.
template <class Architecture>
struct BareLoopBody
{
  using Batch = xsimd::batch<float, Architecture>;
  static constexpr int lanes = static_cast<int>(Batch::size);

  static inline __attribute__((always_inline)) void sums(Batch& a, Batch& b)
  {
    const Batch difference = b - a;
    a = a + b;
    b = difference;
  }
  static inline __attribute__((always_inline)) void spread(Batch& a, Batch& b)
  {
    const Batch sum = a + b;
    a = a - b;
    b = sum;
  }
  static inline __attribute__((always_inline)) void add(float* p, const Batch& x)
  {
    (Batch::load_unaligned(p) + x).store_unaligned(p);
  }

  static inline __attribute__((always_inline)) void row(const BareLoop& loop, std::size_t node, std::size_t voxel,
                                                        float* below, float* above, std::size_t plane)
  {
    const std::size_t n = static_cast<std::size_t>(loop.nodes_per_edge), square = n * n;
    const std::size_t corner[8] = { 0, 1, n, n + 1, square, square + 1, square + n, square + n + 1 };
    Batch q[3][8];
    for (int c = 0; c < 3; ++c)
    {
      for (int b = 0; b < 8; ++b)
        q[c][b] = Batch::load_unaligned(loop.u[c] + node + corner[b]);
      for (int s = 1; s < 8; s *= 2)
        for (int b = 0; b < 8; ++b)
          if (!(b & s))
            sums(q[c][b], q[c][b | s]);
    }
    const Batch one(1.0f), slope(0.25f / loop.spacing);
    Batch F[3][3], C[3][3];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        F[i][j] = i == j ? one + slope * q[i][1 << j] : slope * q[i][1 << j];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
      {
        const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
        C[i][j] = F[i1][j1] * F[i2][j2] - F[i1][j2] * F[i2][j1];
      }
    const Batch J = F[0][0] * C[0][0] + F[0][1] * C[0][1] + F[0][2] * C[0][2];
    Batch trace(0.0f);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        trace = trace + F[i][j] * F[i][j];
    // y = J^(-1/3) by Newton's method from the tangent at J = 1
    Batch y = Batch(4.0f / 3) - Batch(1.0f / 3) * J;
    for (int i = 0; i < 3; ++i)
      y = y * (Batch(4.0f) - J * y * y * y) * Batch(1.0f / 3);
    const Batch mu = Batch::load_unaligned(loop.mu + voxel), kappa = Batch::load_unaligned(loop.kappa + voxel);
    const Batch volume(loop.spacing * loop.spacing * 0.25f);
    const Batch isochoric = mu * y * y;
    const Batch on_gradient = volume * isochoric;
    const Batch on_cofactor = volume * (kappa * (J - one) - isochoric * trace / (Batch(3.0f) * J));
    const Batch hourglass = Batch(0.05f * loop.spacing) * mu;
    for (int c = 0; c < 3; ++c)
    {
      q[c][0] = Batch(0.0f);
      for (int j = 0; j < 3; ++j)
        q[c][1 << j] = on_gradient * F[c][j] + on_cofactor * C[c][j];
      for (const int m : { 3, 5, 6, 7 })
        q[c][m] = q[c][m] * hourglass;
      for (int s = 1; s < 8; s *= 2)
        for (int b = 0; b < 8; ++b)
          if (!(b & s))
            spread(q[c][b], q[c][b | s]);
      for (int b = 0; b < 4; ++b)
        add(below + static_cast<std::size_t>(c) * plane + node % square + corner[b], q[c][b]);
      for (int b = 0; b < 4; ++b)
        add(above + static_cast<std::size_t>(c) * plane + node % square + corner[b], q[c][b + 4]);
    }
  }

  static void clear(float* p, std::size_t count)
  {
    for (std::size_t i = 0; i < count; ++i)
      p[i] = 0;
  }

  static void run(const BareLoop& loop, int first, int last, float* scratch)
  {
    const int n = loop.nodes_per_edge;
    const std::size_t square = static_cast<std::size_t>(n) * static_cast<std::size_t>(n), plane = square + 64;
    float* below = scratch;
    float* above = scratch + 3 * plane;
    clear(below, 3 * plane);
    for (int k = first - 1; k < last; ++k)
    {
      clear(above, 3 * plane);
      if (k >= 0 && k < n - 1)
        for (int j = 0; j < n - 1; ++j)
          for (int i = 0; i < n - 1; i += lanes)
            row(loop, (static_cast<std::size_t>(k) * n + j) * n + i,
                (static_cast<std::size_t>(k) * (n - 1) + j) * (n - 1) + i, below, above, plane);
      if (k >= first)
        for (int c = 0; c < 3; ++c)
        {
          const std::size_t begin = static_cast<std::size_t>(k) * square;
          const float* f = below + static_cast<std::size_t>(c) * plane;
          const float* u = loop.u[c] + begin;
          float* __restrict v = loop.v[c] + begin;
          float* __restrict next = loop.next[c] + begin;
          for (std::size_t i = 0; i < square; ++i)
          {
            const float velocity = loop.keep * v[i] - loop.dt * loop.inverse_mass * f[i];
            v[i] = velocity;
            next[i] = u[i] + loop.dt * velocity;
          }
        }
      float* const swapped = below;
      below = above;
      above = swapped;
    }
  }
};

}  // namespace frontalis
