#pragma once

#include "solver/stepping/discretisation.hpp"
#include "frontalis/model/model.hpp"

#include <vector>

namespace frontalis
{

/// Voxels that the CPU kernel processes together: two strips of up to eight neighbours along x, in one plane. The nodes
/// of a strip are contiguous in each of the four node rows at (j,k), (j+1,k), (j,k+1), (j+1,k+1).
struct Tile
{
  static constexpr int width = 16;
  static constexpr int strip = 8;
  static constexpr int strips = width / strip;
  std::int32_t node[strips][4];      ///< first node of each row
  std::int32_t count[strips];        ///< voxels, 0..8
  std::int32_t first_voxel[strips];  ///< in the model's order; the strip's other voxels follow
  std::int32_t fibre_begin;          ///< range of FibreSlots
  std::int32_t fibre_end;
  std::int32_t law_begin;  ///< range of LawSlots
  std::int32_t law_end;
  std::int32_t viscous;  ///< index of the ViscousSlot; -1: none
  std::int32_t cut;      ///< index of the CutSlot; -1: all voxels are whole

  /// Voxel of a lane, or -1.
  std::int32_t voxel(int lane) const
  {
    return lane % strip < count[lane / strip] ? first_voxel[lane / strip] + lane % strip : -1;
  }
};

/// Elasticity of a tile's voxels; 0 in unused lanes.
struct TileStiffness
{
  float mu[Tile::width];         ///< shear modulus times tissue volume [N m]
  float kappa[Tile::width];      ///< bulk modulus times tissue volume [N m]
  float hourglass[Tile::width];  ///< scalar stiffness [N/m]
  float bound[Tile::width];      ///< bound of the largest eigenvalue of the stiffness at rest [N/m]
};

/// Assumed-strain hourglass control of a tile's voxels [N m].
struct TileStabilisation
{
  float bending[Tile::width], coupling[Tile::width], torsion[Tile::width], warping[Tile::width];
};

/// The fibres of one muscle in a tile; weight 0 in lanes of voxels without them.
struct FibreSlot
{
  float weight[Tile::width];  ///< fraction of the voxel times its tissue volume times the stress reference [N m]
  float x[Tile::width], y[Tile::width], z[Tile::width];
  std::int32_t muscle;
};

/// A law other than neo-Hookean in a tile; weight 0 in lanes of voxels without it.
struct LawSlot
{
  Law law;
  std::int32_t material;                                    ///< LawPart::material
  float weight[Tile::width];                                ///< fraction times tissue volume [m3]
  float per_tangent[Tile::width];                           ///< LawPart::per_tangent [m]
  float at_rest[Tile::width];                               ///< tangent stiffness at rest [Pa]
  float parameters[physics::parameter_slots][Tile::width];  ///< order: physics/materials/description.hpp
};

/// Prony terms of a tile's voxels.
struct ViscousSlot
{
  float share[2][Tile::width];
  float rate[2][Tile::width];  ///< [1/s]
};

/// Centroids of the tissue in a tile's voxels.
struct CutSlot
{
  float x[Tile::width], y[Tile::width], z[Tile::width];
  float corner[8][Tile::width];  ///< Discretisation::corner_stiffness
};

/// The voxels of a model in tiles, plane by plane (k), and the nodes of each plane. Tiles have the same width for every
/// instruction set; a narrower one processes a tile in several parts.
struct VoxelRows
{
  VoxelRows(const Model& model, const Discretisation& discretisation);
  /// Computes the stiffness bounds again after effects were switched.
  void renew_bounds(const Discretisation& discretisation);
  /// Lists the arrays; those of fibres are attributed to the effect `of_fibres`.
  void list_arrays(Effect of_fibres, ArrayList& list) const;

  std::int32_t planes = 0;  ///< number of node planes
  std::vector<Tile> tiles;
  std::vector<std::int32_t> plane_tiles;         ///< tiles of voxel plane k: plane_tiles[k] .. plane_tiles[k + 1]
  std::vector<std::int32_t> plane_nodes;         ///< nodes of plane k, likewise
  std::vector<TileStiffness> stiffness;          ///< one per tile
  std::vector<TileStabilisation> stabilisation;  ///< one per tile; empty without assumed-strain hourglass control
  std::vector<FibreSlot> fibres;
  std::vector<LawSlot> laws;
  std::vector<ViscousSlot> viscous;
  std::vector<CutSlot> cut;
};

}  // namespace frontalis
