#pragma once

#include <cstdint>
#include <vector>

namespace frontalis
{

/// Up to `width` triangles of a shell, one per lane: physics::ShellTriangle and their vertices. Lanes beyond the last
/// triangle have no stiffness.
template <class Real>
struct ShellBlock
{
  static constexpr int width = 16;

  Real from_corner[5][3][width];
  Real metric[3][width];
  Real inverse_area[width], shear[width], dilatation[width];
  Real height[3][width], bending[6][width];
  std::int32_t vertex[6][width];  ///< where ShellKernels::place() writes their displacements
};

/// Vertices of a shell, one per lane, and where they lie in their voxels. Lanes beyond the last vertex are copies of
/// the block's first vertex.
template <class Real>
struct ShellVertices
{
  static constexpr int width = ShellBlock<Real>::width;

  std::int32_t node[4][width];  ///< corners 0, 2, 4 and 6 of the voxel; corners 1, 3, 5 and 7 are the nodes after them
  Real coordinates[3][width];   ///< position in the voxel
};

/// A vector with a fourth number, 0, so that one instruction loads it.
template <class Real>
struct ShellVector
{
  alignas(4 * sizeof(Real)) Real x[4];
};

/// Weighted sums of vectors, for the transposed interpolation of bound points. Each sum is filled up to a
/// multiple of four terms with terms of weight 0, because wrong branch predictions at the ends of short sums would
/// otherwise take most of the time.
template <class Real>
struct WeightedSums
{
  struct Term
  {
    std::int32_t index;
    Real weight;
  };
  using Terms = std::vector<Term>;

  WeightedSums() = default;
  explicit WeightedSums(const std::vector<Terms>& sums)
  {
    for (const Terms& sum : sums)
    {
      terms.insert(terms.end(), sum.begin(), sum.end());
      while (terms.size() % 4 != 0)
        terms.push_back({ sum[0].index, 0 });
      begin.push_back(static_cast<std::int32_t>(terms.size()));
    }
  }

  std::vector<std::int32_t> begin{ 0 };  ///< first term of each sum; the last entry is the number of terms
  std::vector<Term> terms;
};

template <class Real>
struct ShellKernels
{
  /// Finds the displacements of the vertices of blocks [first, last) at the displacements u of nodes, as
  /// [block][place].
  void (*place)(const ShellVertices<Real>* blocks, const Real* const u[3], ShellVector<Real>* out, std::int32_t first,
                std::int32_t last);
  /// Finds the forces of blocks [first, last) at the displacements u that place() has found, as [block][vertex of the
  /// triangle][place].
  void (*forces)(const ShellBlock<Real>* blocks, const ShellVector<Real>* u, ShellVector<Real>* forces,
                 std::int32_t first, std::int32_t last);
  /// Computes the sums [first, last) of vectors.
  void (*sum)(const WeightedSums<Real>& sums, const ShellVector<Real>* in, ShellVector<Real>* out, std::int32_t first,
              std::int32_t last);
  /// The place where place() and forces() write the vector of a lane. Places are not in the order of lanes, because
  /// that order would need permutations.
  int (*place_of_lane)(int lane);
};

/// The kernels without SIMD, in any precision.
template <class Real>
ShellKernels<Real> plain_shell_kernels();

}  // namespace frontalis
