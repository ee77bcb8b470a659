#pragma once

#include "bake/voxels/block_classifier.hpp"
#include "bake/voxels/gap_walls.hpp"
#include "bake/voxels/voxel_index.hpp"

#include <optional>

namespace frontalis
{

/// Separates the two sides of slits and of gaps that are thinner than voxels. In each voxel near a gap, two points of
/// the tissue are joined if the line between them does not leave the tissue and no slit cuts it. Points that are joined
/// form a part; parts of neighbouring voxels are joined by the same rule. Slits count as half a voxel longer than they
/// are, where they cross tissue themselves: so they part the voxels that they cross for the most part. A voxel with
/// several parts is replaced by one voxel per part, with its own filling. Around a point of the grid, voxels that are
/// joined form a group, and each group gets a node of its own: voxels of different groups are put in different flaps
/// (Model::Flap), which are sets of voxels with nodes of their own.
class Gaps
{
public:
  /// The arguments must outlive this object.
  Gaps(const Scene& scene, const Volumes& volumes, const PreparedSurfaces& surfaces, const Grid& grid);

  /// Divides the voxels at gaps and sets their flaps and joints. Voxels that are replaced get flap -1. A part that
  /// fills less than fill_min of a voxel, or has no sample, is added to the largest part of that voxel. Changes nothing
  /// if there is no gap.
  void part(Voxels& voxels, BakeMonitor& monitor);

  /// A voxel at a gap.
  struct Owner
  {
    Vector3d centre{ 0, 0, 0 };  ///< centre of the voxel, scene coordinates [m]
    int flap = 0;
  };
  /// The voxel whose tissue contains a point near a gap, or is nearest to the point. `inside`: a point of the same
  /// tissue farther from its surface. It decides on the side of a gap, since a slit may pass a little beside the gap
  /// and cut a sliver with the point off the tissue.
  std::optional<Owner> owner(const Vector3d& p, const Vector3d& inside) const;

  /// Whether the tissue of a voxel extends to a point of a surface without a gap in between, so that the surface may
  /// hold it. `centre`: centre of the voxel, scene coordinates. True for voxels that are not near a gap.
  bool extends_to(const Vector3d& centre, int flap, const Vector3d& point) const;
  bool near_gap(const Vector3d& p) const { return level(place_of(p)) == Level::at_gap; }

private:
  /// The tissue in a voxel.
  struct Tissue
  {
    std::uint32_t voxel = 0;
    std::vector<Vector3d> points;
    std::vector<int> sample;               ///< number of each point in the sequence of samples
    std::vector<std::uint64_t> enclosing;  ///< bodies around each point
    std::vector<int> part;                 ///< part of each point; -1: a part that is not kept
    std::vector<GapWalls::Piece> pieces;   ///< pieces of walls in and near the voxel
    std::vector<std::uint32_t> copies;     ///< voxels that represent the parts
    std::vector<std::uint64_t> joined;     ///< joined pairs of a voxel of this tissue and one of a neighbour
  };
  enum class Level : char
  {
    far,     ///< no neighbour is at a gap
    beside,  ///< the cell is a neighbour of a voxel at a gap and has one part
    at_gap
  };

  void mark(const Voxels& voxels, BakeMonitor& monitor);
  void find_points(Tissue& tissue, const VoxelPlace& place) const;
  void find_parts(Tissue& tissue) const;
  void join_to(Tissue& tissue, const Tissue& other) const;
  std::size_t add_copies(Voxels& voxels);
  void assign_flaps(Voxels& voxels) const;
  Level level(const VoxelPlace& place) const;
  const Tissue* tissue_at(const VoxelPlace& place) const;
  std::size_t cell(const VoxelPlace& place) const;
  VoxelPlace place_of(const Vector3d& p) const;

  const Scene& scene_;
  const Volumes& volumes_;
  const Grid& grid_;
  const PreparedSurfaces& surfaces_;
  std::optional<GapWalls> walls_;  // set only if there may be gaps
  bool thin_gaps_;
  int samples_;  ///< number of samples along each voxel edge
  std::vector<const PreparedSurface*> none_;
  std::vector<Level> level_;             ///< level of each cell of the grid; empty: there is no gap
  std::vector<std::int32_t> tissue_of_;  ///< for each cell its index in tissue_, or -1
  std::vector<Tissue> tissue_;
  std::vector<std::int8_t> flap_;  ///< flap of each voxel
  std::vector<VoxelPlace> place_;  ///< place of each voxel
};

}  // namespace frontalis
