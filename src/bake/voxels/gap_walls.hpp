#pragma once

#include "bake/voxels/voxelise.hpp"

namespace frontalis
{

/// The walls that separate tissue: bodies (see Volumes::Entry) that bound tissue volumes, and slits. Slits are
/// continued by half a voxel beyond their borders: thus they cut just those voxels in two that they already cross for
/// the most part. Scene coordinates.
class GapWalls
{
public:
  /// A triangle of a wall.
  struct Piece
  {
    std::int32_t wall = -1, triangle = -1;
    bool beyond = false;  ///< it continues a slit beyond its border
  };
  enum class Way
  {
    inside,
    out,     ///< the line leaves the tissue
    beyond,  ///< the line passes a slit just beyond its border
    and_in,  ///< the line leaves the tissue and comes back, or is cut by a slit
  };

  /// `spacing`: the edges of voxels [m]. Throws Error if more than 64 surfaces bound the tissue.
  GapWalls(const Volumes& volumes, const PreparedSurfaces& surfaces, const Vector3d& spacing);

  /// For each cell of the grid, x fastest, whether a slit passes through it. With `thin_gaps`, also whether it has a
  /// gap next to a wall that is less than 2.2 voxel edges wide.
  std::vector<char> cells_with_gaps(const Volumes& volumes, const Grid& grid, bool thin_gaps,
                                    BakeMonitor& monitor) const;

  std::vector<Piece> pieces_in(const Box& box) const;
  /// The bodies that enclose a point, one bit each.
  std::uint64_t enclosing(const Vector3d& p) const;
  /// The bodies that enclose a point p of a box, found from those that enclose the box's centre and from the pieces in
  /// the box.
  std::uint64_t enclosing(const Vector3d& p, const Vector3d& centre, std::uint64_t at_centre,
                          const std::vector<Piece>& pieces) const;
  /// The way from a point p of the tissue to q along a line. `enclosing`: bodies that enclose p; `pieces`: at least the
  /// pieces between the points.
  Way way_out(const Vector3d& p, std::uint64_t enclosing, const Vector3d& q, const std::vector<Piece>& pieces) const;

private:
  /// The conditions of a tissue volume, with one bit per body.
  struct Tissue
  {
    std::uint64_t closed_by = 0, inside = 0, outside = 0;
  };
  bool is_tissue(std::uint64_t enclosing) const;
  /// Width [m] of the gap that begins at the point p of a wall, along the unit vector `away`; 0: there is no gap.
  double gap_at(const Volumes& volumes, const Vector3d& p, const Vector3d& away, double widest) const;

  PreparedSurfaces slits_;                     ///< slits, continued
  std::vector<std::int32_t> own_;              ///< number of triangles of each wall without its continuation
  std::vector<const PreparedSurface*> walls_;  ///< bodies, then slits
  std::vector<double> sign_;                   ///< for each body the factor that turns its normals out of the tissue
  std::size_t bodies_ = 0;
  std::vector<Tissue> tissue_;
};

}  // namespace frontalis
