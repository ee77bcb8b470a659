#pragma once

#include "bake/voxels/block_classifier.hpp"
#include "bake/voxels/gap_walls.hpp"
#include "bake/voxels/voxel_index.hpp"

#include <optional>

namespace frontalis
{

/// Tissue near gaps that are thinner than voxels, and slits: which of it is joined to which.
///
/// In each voxel near a gap points of the tissue are joined if the line between them does not leave the tissue and is
/// not cut by a slit; what is joined forms a part. Parts of neighbouring voxels are joined alike. A voxel with several
/// parts is replaced by one voxel per part, with its own filling. At a point of the grid the voxels around it form
/// groups that are joined there; each group gets a node of its own, because voxels of groups that are not joined are
/// put in different flaps (Model::flaps).
class Gaps
{
public:
  /// The arguments must outlive this object.
  Gaps(const Scene& scene, const Volumes& volumes, const PreparedSurfaces& surfaces, const Grid& grid);

  /// Parts the voxels at gaps: sets their flaps and joints. Voxels that are replaced get flap -1. A part that fills
  /// less than fill_min of a voxel, or has no sample, is counted to the largest part of that voxel. Changes nothing if
  /// there is no gap.
  void part(Voxels& voxels, BakeMonitor& monitor);

  /// The voxel whose tissue a point in or just beside the tissue belongs to, if it is near a gap.
  struct Owner
  {
    Vector3d centre{ 0, 0, 0 };  ///< of the voxel, scene coordinates [m]
    int flap = 0;
  };
  std::optional<Owner> owner(const Vector3d& p) const;

  /// Whether the tissue of a voxel extends to a point of a surface, so that the surface may hold it: there is no gap in
  /// between. `centre`: of the voxel, scene coordinates. True for voxels that are not near a gap.
  bool extends_to(const Vector3d& centre, int flap, const Vector3d& point) const;
  bool near_gap(const Vector3d& p) const { return level(place_of(p)) == Level::at_gap; }

private:
  /// Tissue in a voxel.
  struct Tissue
  {
    std::uint32_t voxel = 0;
    std::vector<Vector3d> points;
    std::vector<int> sample;               ///< number of each point in the sequence of samples
    std::vector<std::uint64_t> enclosing;  ///< bodies around each point
    std::vector<int> part;                 ///< of each point; -1: of none that is kept
    std::vector<GapWalls::Piece> pieces;   ///< in and around the voxel
    std::vector<std::uint32_t> copies;     ///< voxels that stand for the parts
    std::vector<std::uint64_t> joined;     ///< pairs of voxels of this and of neighbours that are joined
  };
  enum class Level : char
  {
    far,     ///< nothing is asked
    beside,  ///< neighbour of a voxel at a gap; in one part
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
  std::optional<GapWalls> walls_;  // only if there may be gaps
  bool thin_gaps_;
  int samples_;  ///< along each edge of the scene's voxels
  std::vector<const PreparedSurface*> none_;
  std::vector<Level> level_;             ///< of each cell of the grid; empty: there is no gap
  std::vector<std::int32_t> tissue_of_;  ///< for each cell its entry in tissue_, or -1
  std::vector<Tissue> tissue_;
  std::vector<std::int8_t> flap_;  ///< of each voxel
  std::vector<VoxelPlace> place_;  ///< of each voxel
};

}  // namespace frontalis
