#pragma once

#include "bake/bake_stages.hpp"
#include "bake/voxels/volumes.hpp"

#include <cstdint>
#include <vector>

namespace frontalis
{

/// Box grid in scene axes: voxel (i,j,k) runs from lower + (i,j,k) * spacing.
struct Grid
{
  Vector3 lower{ 0, 0, 0 };    ///< [m]
  Vector3 spacing{ 0, 0, 0 };  ///< [m]
  std::array<std::int32_t, 3> size{ { 0, 0, 0 } };
};

/// The grid that holds the scene's tissue. Throws Error, before anything is allocated, where it would have fewer than 8
/// cells, or where the model would have more voxels than can be counted or take more memory than is free, both
/// estimated from 2000 points. The text has the numbers, and the length unit that was probably meant.
Grid make_grid(const Scene& scene, const Volumes& volumes);

/// Voxels with tissue, in scene axes, in no particular but always the same order.
struct Voxels
{
  std::vector<std::array<std::int32_t, 3>> place;
  std::vector<float> fill;
  // entries of voxel e: begin[e] .. begin[e + 1]
  std::vector<std::uint32_t> mixture_begin{ 0 };
  std::vector<std::int16_t> material;
  std::vector<float> proportion;
  std::vector<std::uint32_t> muscle_begin{ 0 };
  std::vector<std::int16_t> muscle;
  std::vector<float> weight;
  std::vector<double>
      volume_size;  ///< of each volume of the scene, clipped to the tissue, before voxels are dropped [m3]
  /// of each volume with layers: what its bands hold, and behind them what is left below them [m3]
  std::vector<std::vector<double>> band_size;

  void append(const Voxels& other);
};

/// Finds each voxel's proportions. A block of voxels whose box no surface, depth or crop passes through is all alike
/// and is looked at once; else it is halved down to single voxels, which are sampled at samples^3 points of a
/// low-discrepancy lattice (the R3 sequence, whose projections on every axis are even too, so that faces along the axes
/// are met as well as oblique ones). Voxels with less tissue than `fill_min` are left out.
Voxels voxelise(const Volumes& volumes, const Grid& grid, int samples, double fill_min, BakeStages& stages);

}  // namespace frontalis
