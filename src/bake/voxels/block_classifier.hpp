#pragma once

#include "bake/voxels/volumes.hpp"
#include "bake/voxels/voxelise.hpp"

#include <vector>

namespace frontalis
{

enum class Answer : std::int8_t
{
  no,
  yes,
  unknown
};

/// What is known about all points of a box.
struct BlockState
{
  std::vector<Answer> solid;
  struct Interval
  {
    bool known = false;  ///< no threshold lies in the box
    double depth = 0;    ///< a depth that stands for all points, where known [m]
  };
  std::vector<Interval> depth;
  std::vector<Answer> volume;
  std::vector<Answer> sight;  ///< of each volume that asks for it: no `outside` surface on the way to `within`
};

/// Finds the composition of boxes of voxels: used by one thread.
class BlockClassifier
{
public:
  BlockClassifier(const Volumes& volumes, const Grid& grid, int samples, double fill_min);

  /// Visits voxels begin .. end (exclusive).
  void visit(const std::array<std::int32_t, 3>& begin, const std::array<std::int32_t, 3>& end);

  Voxels take() { return std::move(voxels_); }

private:
  struct Crossing
  {
    std::vector<std::int32_t> triangles;
    double winding = 0;    ///< at base_
    double variation = 0;  ///< of the smooth part within the voxel
  };

  void visit(const std::array<std::int32_t, 3>& begin, const std::array<std::int32_t, 3>& end, BlockState state);
  bool settle(const Box& box, BlockState& state);
  void settle_solid(std::size_t solid, const Box& box, BlockState& state) const;
  void settle_depth(std::size_t depth, const Box& box, BlockState& state) const;
  void settle_sight(std::size_t volume, const Box& box, BlockState& state) const;
  Answer volume_answer(std::size_t volume, const Box& box, const BlockState& state) const;
  bool layers_known(const BlockState& state) const;

  void sample(const Box& box, const BlockState& state);
  bool sample_volume(std::size_t volume, const Vector3& p, const BlockState& state);
  bool sample_solid(std::size_t solid, const Vector3& p, const BlockState& state);
  double sample_depth(std::size_t depth, const Vector3& p, const BlockState& state);
  bool in_sight(const Volumes::Entry& entry, const Vector3& p, double bound) const;
  void count(const std::vector<Answer>& inside, const std::vector<double>& depth, double share);
  void count_bands(const std::vector<Answer>& inside, const std::vector<double>& depth, double share);
  void clear_shares();
  void add_sizes(double voxels);
  void emit(const std::array<std::int32_t, 3>& place, double fill);

  const Volumes& volumes_;
  const Grid& grid_;
  double fill_min_;
  double voxel_volume_;
  double reach_ = 0;              ///< half diagonal of a voxel [m]
  std::vector<Vector3> offsets_;  ///< of samples, in voxels
  Voxels voxels_;

  // of the voxel being sampled
  Vector3 base_{};
  std::vector<Crossing> crossings_;
  std::vector<bool> gathered_;
  struct Nearby
  {
    bool known = false;
    std::int32_t triangle = -1;  ///< closest to base_
    double distance = 0;         ///< of base_
    double depth = 0;            ///< of base_
    bool steady = false;         ///< no rim so near that the sign could change without the distance
  };
  std::vector<Nearby> nearby_;
  std::vector<double> material_share_;
  std::vector<double> muscle_share_;
  std::vector<double> volume_share_;
  std::vector<std::vector<double>> band_share_;
  // of the sample: answers already found, -1 not yet
  std::vector<std::int8_t> solid_here_;
  std::vector<double> depth_here_;
};

}  // namespace frontalis
