#pragma once

#include "frontalis/byte_archive.hpp"
#include "frontalis/solver/allocation.hpp"
#include "solver/cpu/voxel_rows.hpp"

#include <array>
#include <utility>
#include <vector>

namespace frontalis
{

struct StepPlan;

/// Those of a model's tiles that are computed: as in VoxelRows.
struct AwakeTiles
{
  std::vector<Tile> tiles;
  std::vector<std::int32_t> plane_tiles;
  std::vector<TileStiffness> stiffness;
  std::vector<TileStabilisation> stabilisation;
};

/// Tiles that are at rest and not computed; their nodes stay where they are, and those that they share with tiles that
/// are awake are a held border.
///
/// A node has stirred when it is farther from its anchor than a twenty-fourth of the tolerance, and its anchor is then
/// where it is. Tiles fall asleep when nothing has stirred in them and two tiles around for 50 ms. They wake when a
/// node stirs two tiles away or nearer, when the activation of a muscle in them changes, and all of them when a bone
/// moves or somebody sets the motion or switches an effect. Anchors stay while a tile sleeps, so that a slow drift
/// adds up from nap to nap. Nobody sleeps while loads are ramped.
///
/// What is not computed shows no drift, and a viscous layer that fell asleep creeping would have to creep on. So all
/// are woken after a nap, for a trial of 20 ms. The first nap takes 100 ms, each after it twice the one before and up
/// to 0.8 s, but, from 100 ms on, no longer than the nodes' ways in the trial let expect a twenty-fourth of the
/// tolerance for. What they missed in the nap shows in the trial, since viscous stresses relax in tiles that sleep too.
class SleepingTiles
{
public:
  SleepingTiles(const Model& model, const VoxelRows& rows, double tolerance);

  /// As in the beginning, at time 0.
  void reset();
  /// All awake, and for as long as tiles that have just stirred.
  void wake(double time);
  /// Before a plan: who falls asleep, who wakes, by how nodes have moved since.
  template <class Real>
  void look(const std::array<const Real*, 3>& u, const StepPlan& plan);

  bool any() const { return sleeping_ > 0; }
  bool all() const { return sleeping_ == state_.asleep.size(); }
  /// Since the latest look others sleep than before: the first step must hold all that sleep.
  bool changed() const { return changed_; }
  void held() { changed_ = false; }
  const AwakeTiles& awake() const { return awake_; }
  /// Planes of nodes with voxels that are awake, as ranges.
  const std::vector<std::pair<std::int32_t, std::int32_t>>& planes() const { return planes_; }
  /// Nodes that stay, in planes [first, last), as ranges.
  template <class Visit>
  void each_held(std::int32_t first, std::int32_t last, const Visit& visit) const
  {
    for (auto r = plane_held_[first]; r < plane_held_[last]; ++r)
      visit(held_[r].first, held_[r].second);
  }
  const char* held_nodes() const { return any() ? node_held_.data() : nullptr; }  ///< of each node: 1 where it stays
  /// Frequency bound squared of what is computed, and of what sleeps as it fell asleep.
  double frequency(double computed);
  void list_allocations(AllocationList& list) const;

  /// What the motion depends on.
  struct State
  {
    std::array<std::vector<float>, 3> anchor;  // displacement [m], one a node
    std::vector<double> stirred;               // time [s], one a tile
    std::vector<char> asleep;                  // one a tile
    std::vector<float> activation;             // at which muscles stirred last
    std::vector<double> pose;                  // of bones, twelve numbers each
    double frequency_squared = 0, latest_frequency_squared = 0;
    std::array<std::vector<float>, 3> before;  // displacement [m] as the trial began, one a node
    double nap = 0;                            // how long [s]; 0: nobody sleeps
    double turn = 0;                           // when the nap or the trial ends [s]
    bool trial = false;

    void archive(ByteArchive& archive);
  };
  const State& state() const { return state_; }
  void restore(const State& state);

private:
  template <class Visit>
  void each_node(std::size_t tile, const Visit& visit) const;
  template <class Real>
  void nap_or_try(const std::array<const Real*, 3>& u, double time);
  void sort();

  const Model& model_;
  const VoxelRows& rows_;
  double stir_;
  double ramps_ = 0;  // when the last load has its full size [s]
  State state_;
  std::size_t sleeping_ = 0;
  bool changed_ = false;
  AwakeTiles awake_;
  std::vector<std::pair<std::int32_t, std::int32_t>> planes_, held_;
  std::vector<std::int32_t> plane_held_;
  std::vector<char> node_held_;
  std::vector<char> node_touched_, touched_;  // marks of a look
};

}  // namespace frontalis
