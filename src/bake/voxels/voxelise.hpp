#pragma once

#include "bake/voxels/volumes.hpp"

namespace frontalis
{

/// Indices of a voxel along the axes of its grid.
using VoxelPlace = std::array<std::int32_t, 3>;

/// Grid of voxels along the axes of the scene.
struct Grid
{
  Vector3d lower{ 0, 0, 0 };    ///< lower corner of the grid [m]
  Vector3d spacing{ 0, 0, 0 };  ///< voxel edges [m]
  VoxelPlace size{ { 0, 0, 0 } };

  /// The corner of a voxel with the smallest coordinates [m].
  Vector3d corner(const VoxelPlace& p) const { return lower + Vector3d(p[0], p[1], p[2]).cwiseProduct(spacing); }
};

/// The grid that holds the scene's tissue. Throws Error, before anything is allocated, if the grid has fewer than 8
/// cells, or if the model, as estimated from 2000 points, has too many voxels for its indices or for the free memory.
/// The message names the length unit that was probably meant.
Grid make_grid(const Scene& scene, const Volumes& volumes);

/// For each voxel a list of indices, of materials or muscles, and their shares. Voxel e has begin[e] .. begin[e + 1].
struct Shares
{
  std::vector<std::int32_t> begin{ 0 };
  std::vector<std::int16_t> number;
  std::vector<float> share;

  /// Adds the list of the next voxel: the indices of all positive `shares`, and these shares divided by `whole`.
  void add(const std::vector<double>& shares, double whole);
  void append(const Shares& other);
};

/// Voxels with tissue, along the axes of the scene, in an order that depends on the scene alone.
struct Voxels
{
  std::vector<VoxelPlace> place;
  std::vector<float> fill;
  std::vector<std::array<float, 3>> centre;  ///< centroid of the tissue, from -1 to 1 along each axis
  Shares materials, muscles;
  /// The number of each voxel's flap (Model::Flap), 0: it is in no flap; empty if there are no flaps. Voxels of
  /// different flaps may share a place.
  std::vector<std::int8_t> flap;
  /// Two voxels of different flaps that are joined at a point of the grid. The first is in the lower flap.
  struct Joint
  {
    std::uint32_t a = 0, b = 0;
    VoxelPlace at{};
  };
  std::vector<Joint> joints;
  /// Size of each volume of the scene in the tissue [m3], before voxels with too little tissue are left out.
  std::vector<double> volume_size;
  /// For each volume with layers, the size of each band (Volumes::Band) and, as last entry, of the rest of the volume
  /// [m3].
  std::vector<std::vector<double>> band_size;

  /// Adds the voxels of another block of the same grid.
  void append(const Voxels& other);
};

/// Finds the materials and muscles in each voxel. A block of voxels through which no surface, depth threshold or crop
/// passes is decided as a whole; others are halved down to single voxels, which are sampled at samples^3 points of the
/// low-discrepancy sequence R3. The sequence is evenly spread along each axis too, so that surfaces along the axes are
/// sampled as well as oblique ones. Voxels with a smaller proportion of tissue than `fill_min` are left out, except
/// where one of the surfaces `kept_at` passes through them.
Voxels voxelise(const Volumes& volumes, const Grid& grid, int samples, double fill_min,
                const std::vector<const PreparedSurface*>& kept_at, BakeMonitor& monitor);

}  // namespace frontalis
