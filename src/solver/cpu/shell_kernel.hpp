#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace frontalis
{

/// Up to `width` triangles of a shell: physics::ShellTriangle and the numbers of its vertices, one triangle per lane.
/// Lanes beyond the last triangle have no stiffness.
template <class Real>
struct ShellBlock
{
  static constexpr int width = 16;

  Real from_corner[5][3][width];
  Real metric[3][width];
  Real area_twice[width], shear[width], dilatation[width];
  Real height[3][width], bending[6][width];
  std::int32_t vertex[6][width];
};

/// Weighted sums of vectors: the interpolation of bound points and its transpose. Sums are computed in blocks of
/// `width`, one per lane; a block has as many rows as its longest sum, and shorter ones have rows of weight 0.
template <class Real>
struct WeightedSums
{
  static constexpr int width = 16;
  struct Row
  {
    std::int32_t index[width];
    Real weight[width];
  };
  using Terms = std::vector<std::pair<std::int32_t, Real>>;

  WeightedSums() = default;
  explicit WeightedSums(const std::vector<Terms>& sums);

  std::int32_t blocks() const { return static_cast<std::int32_t>(begin.size()) - 1; }

  std::vector<std::int32_t> begin{ 0 };  ///< first row of each block, and the number of rows
  std::vector<Row> rows;
};

/// The components x, y, z of vectors.
template <class Real>
using ConstComponents = std::array<const Real*, 3>;
template <class Real>
using Components = std::array<Real*, 3>;

template <class Real>
struct ShellKernels
{
  /// Forces of blocks [first, last) at the displacements u of vertices, as [block][vertex of the triangle][axis][lane].
  void (*forces)(const ShellBlock<Real>* blocks, const ConstComponents<Real>& u, Real* forces, std::int32_t first,
                 std::int32_t last);
  /// Blocks [first, last) of the sums of `in`; writes whole blocks to `out`.
  void (*sum)(const WeightedSums<Real>& sums, const ConstComponents<Real>& in, const Components<Real>& out,
              std::int32_t first, std::int32_t last);
};

/// The kernels without SIMD, in any precision.
template <class Real>
ShellKernels<Real> plain_shell_kernels();

}  // namespace frontalis
