#pragma once

#include "frontalis/model/model.hpp"
#include "frontalis/physics/distance_field.hpp"
#include "solver/cpu/attach_kernel.hpp"
#include "solver/stepping/node_part.hpp"

#include <vector>

namespace frontalis
{

physics::Vec3<double> rest_point(const Model& model, std::int32_t node);

/// Value of the surface's field at an attached node at rest, minus `ratio` times the value at its master [m]; 0 where
/// the field has no samples.
double level_offset(const Model& model, const AttachedNode& node);

/// Groups of a master and its attached nodes at surfaces and bones that do not move: the nodes are held, or all of them
/// slide on one surface. Sixteen masters form a block; the nodes that follow them are stored in rows of sixteen. No
/// node is in two groups, so that any thread may process any block.
template <class Real>
class AttachedBlocks
{
public:
  AttachedBlocks(const Model& model, const std::vector<double>& mass, AttachKernel<Real> kernel);

  /// Adds a master, which must not have a prescribed path, and its nodes. Returns false, and adds nothing, if a bone of
  /// a node moves or the nodes slide on several surfaces. Masters must be added in ascending order.
  bool add_group(const AttachedNode* begin, const AttachedNode* end);
  /// Forms the blocks. Call it after the last add_group().
  void finish();

  bool empty() const { return masters_.empty(); }
  /// Called after the masses have changed.
  void masses_changed();
  void reset();
  void list_arrays(ArrayList& list);
  /// Applies the constraints of the thread's part of the groups.
  void constrain(const NodeShare& share, Real* const u[3], Real* const v[3], double dt);

private:
  using Planes = LevelPlanes<Real>;
  struct Group
  {
    std::int32_t master, surface;
    std::vector<AttachedNode> held, levels;
  };

  std::int32_t first_block(int thread, int threads) const;
  void add_block(const Group* begin, const Group* end);
  static void renew(void* self, Planes& planes, int lane, std::int32_t node, const Real u[3]);

  const Model& model_;
  const std::vector<double>& mass_;
  AttachKernel<Real> kernel_;
  std::vector<physics::DistanceField> fields_;
  std::vector<Group> groups_;  // used until finish()
  std::vector<MasterBlock<Real>> masters_;
  std::vector<HeldRow<Real>> held_;
  std::vector<LevelRow<Real>> levels_;
  std::vector<std::size_t> rows_before_{ 0 };  // rows before each block; the last entry is the number of all rows
};

}  // namespace frontalis
