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
  std::int32_t first_voxel[strips];  ///< index of the strip's first voxel in the model; its other voxels follow
  std::int32_t fibre_begin;          ///< range of FibreSlots
  std::int32_t fibre_end;
  std::int32_t law_begin;  ///< range of LawSlots
  std::int32_t law_end;
  std::int32_t viscous;  ///< index of the ViscousSlot; -1: none
  std::int32_t cut;      ///< index of the CutSlot; -1: all voxels are whole
  bool simple;           ///< whether no voxel has laws, viscosity or a CutSlot

  /// Index of the voxel in a lane, or -1.
  std::int32_t voxel(int lane) const
  {
    return lane % strip < count[lane / strip] ? first_voxel[lane / strip] + lane % strip : -1;
  }
};

/// Elasticity of a tile's voxels; 0 in unused lanes.
struct alignas(64) TileStiffness
{
  float mu[Tile::width];          ///< shear modulus times tissue volume [N m]
  float kappa[Tile::width];       ///< bulk modulus times tissue volume [N m]
  float stiffening[Tile::width];  ///< of the neo-Hookean law [-]
  float hourglass[Tile::width];   ///< scalar stiffness [N/m]
  float bound[Tile::width];       ///< bound of the largest eigenvalue of the stiffness at rest [N/m]
};

/// Assumed-strain hourglass control of a tile's voxels [N m].
struct alignas(64) TileStabilisation
{
  float bending[Tile::width], coupling[Tile::width], torsion[Tile::width], warping[Tile::width];
};

/// The fibres of one muscle in a tile. Lanes of voxels without them have the weight 0.
struct alignas(64) FibreSlot
{
  /// fraction of the voxel that is this muscle, times tissue volume and stress reference [N m]
  float weight[Tile::width];
  float x[Tile::width], y[Tile::width], z[Tile::width];
};

/// A law other than neo-Hookean in a tile. Lanes of voxels without it have the weight 0.
struct alignas(64) LawSlot
{
  float weight[Tile::width];       ///< fraction of the voxel's tissue, times tissue volume [m3]
  float per_tangent[Tile::width];  ///< LawPart::per_tangent [m]
  float at_rest[Tile::width];      ///< tangent stiffness at rest [Pa]
  float parameters[physics::parameter_slots][Tile::width];  ///< ordered as in physics/materials/description.hpp
  Law law;
  std::int32_t material;  ///< LawPart::material
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
/// instruction set; with fewer SIMD lanes, a tile is processed in several parts.
struct VoxelRows
{
  VoxelRows(const Model& model, const Discretisation& discretisation);
  /// Computes the stiffness bounds again after effects were switched.
  void renew_bounds(const Discretisation& discretisation);
  /// Lists the arrays. The arrays of fibres are attributed to the effect `of_fibres`.
  void list_arrays(Effect of_fibres, ArrayList& list) const;

  std::int32_t planes = 0;  ///< number of node planes
  std::vector<Tile> tiles;
  std::vector<std::int32_t> plane_tiles;   ///< the tiles of voxel plane k are plane_tiles[k] .. plane_tiles[k + 1]
  std::vector<std::int32_t> plane_nodes;   ///< the nodes of node plane k are plane_nodes[k] .. plane_nodes[k + 1]
  std::vector<std::int32_t> plane_voxels;  ///< the voxels of voxel plane k are plane_voxels[k] .. plane_voxels[k + 1]
  std::vector<TileStiffness> stiffness;    ///< one per tile
  std::vector<TileStabilisation> stabilisation;  ///< one per tile; empty without assumed-strain hourglass control
  std::vector<FibreSlot> fibres;
  std::vector<std::int32_t> fibre_muscle;  ///< muscle of each FibreSlot
  std::vector<LawSlot> laws;
  std::vector<ViscousSlot> viscous;
  std::vector<CutSlot> cut;
};

}  // namespace frontalis
