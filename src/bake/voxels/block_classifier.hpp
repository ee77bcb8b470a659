#pragma once

#include "bake/mesh/cluster_search.hpp"
#include "bake/voxels/voxelise.hpp"

namespace frontalis
{

enum class Answer : std::int8_t
{
  no,
  yes,
  unknown
};

/// Facts that are known to hold for all points of a block of voxels.
struct BlockState
{
  struct Depth
  {
    bool known = false;  ///< whether no threshold of the depth field lies in the block
    double value = 0;    ///< if known: depth of the centre [m]; all depths lie between the same thresholds
  };
  std::vector<Answer> inside_body;    ///< one answer per body
  std::vector<Depth> depth;           ///< one per depth field
  std::vector<Answer> inside_volume;  ///< one answer per volume
  std::vector<Answer> in_sight;       ///< one per volume; see Volumes::Entry::needs_sight()
};

/// Finds the materials and muscles in the voxels of a block. A uniform block is decided as a whole; any other is halved
/// repeatedly, down to single voxels, which are sampled. Not thread-safe.
class BlockClassifier
{
public:
  /// The arguments are those of voxelise().
  BlockClassifier(const Volumes& volumes, const Grid& grid, int samples, double fill_min,
                  const std::vector<const PreparedSurface*>& kept_at);

  /// Adds the voxels of the block from `begin` to `end` (exclusive).
  void visit(const VoxelPlace& begin, const VoxelPlace& end);

  /// Tells for each sample of a voxel whether it is tissue.
  std::vector<char> tissue_samples(const VoxelPlace& place);
  /// Adds the part of a voxel that the `chosen` samples represent. The fill of the added voxel is that of the part.
  void add_part(const VoxelPlace& place, const std::vector<char>& chosen);

  Voxels take() { return std::move(voxels_); }

private:
  BlockState unknown() const;
  void visit(const VoxelPlace& begin, const VoxelPlace& end, BlockState state);
  void sample_alone(const VoxelPlace& place);

  // The next functions determine unknown entries of a block's state. decide() returns whether all are known then.
  bool decide(const Box& box, BlockState& state);
  void decide_volume(std::size_t volume, const Box& box, BlockState& state);
  void decide_body(std::size_t body, const Box& box, BlockState& state) const;
  void decide_depth(std::size_t field, const Box& box, BlockState& state) const;
  void decide_sight(std::size_t volume, const Box& box, BlockState& state) const;
  Answer volume_answer(std::size_t volume, const Box& box, const BlockState& state) const;

  // The next functions sample a voxel.
  void sample(const Box& box, const BlockState& state);
  bool sample_volume(std::size_t volume, const Vector3d& p, const BlockState& state);
  bool sample_body(std::size_t body, const Vector3d& p, const BlockState& state);
  double sample_depth(std::size_t field, const Vector3d& p, const BlockState& state);
  bool in_sight(const Volumes::Entry& entry, const Vector3d& p, double bound) const;

  void add_share(const std::vector<Answer>& inside, const std::vector<double>& depth, double share);
  void add_sizes(double voxels);
  void add_voxel(const VoxelPlace& place, double fill, const Vector3d& centre);

  const Volumes& volumes_;
  const Grid& grid_;
  double fill_min_;
  const std::vector<const PreparedSurface*>& kept_at_;
  double voxel_volume_;
  double reach_;                               ///< half the diagonal of a voxel [m]
  std::vector<Vector3d> offsets_;              ///< offsets of the samples from the voxel's lower corner, in voxel edges
  const std::vector<char>* chosen_ = nullptr;  ///< samples to use; null: all
  std::vector<char>* is_tissue_ = nullptr;     ///< receives whether each sample is tissue; null: not needed
  Vector3d mean_offset_{ 0, 0, 0 };
  Voxels voxels_;

  /// Proportions of materials and muscles in a voxel, or in each voxel of a uniform block, by index.
  struct Proportions
  {
    std::vector<double> material, muscle, volume;
    std::vector<std::vector<double>> band;
  };
  Proportions nothing_, share_;
  Vector3d tissue_offset_{ 0, 0, 0 };  ///< sum of the samples' offsets times their shares of material

  // Data computed once per sampled voxel, near its middle, and used for all its samples.
  struct NearbyBody
  {
    bool known = false;
    std::vector<std::int32_t> triangles;  ///< triangles that overlap the voxel
    double winding = 0;                   ///< winding number at the middle
    double variation = 0;  ///< bound on the change of `winding` within the voxel if no triangle is crossed
  };
  struct NearbyDepth
  {
    ClusterSearch search;  ///< of points in the voxel, the middle first
    bool known = false;
    double distance = 0;  ///< distance of the middle from the surface [m]
    double depth = 0;     ///< depth of the middle [m]
    bool steady = false;  ///< false: a border is so near that the depth may change sign without passing 0
  };
  Vector3d middle_{ 0, 0, 0 };
  std::vector<NearbyBody> nearby_body_;
  std::vector<NearbyDepth> nearby_depth_;

  // answers for the current sample; -1 or NaN: not computed yet
  std::vector<std::int8_t> body_here_;
  std::vector<double> depth_here_;
};

}  // namespace frontalis
