#pragma once

#include "frontalis/model/model.hpp"
#include "slide_kernel.hpp"
#include "surface_contact.hpp"

#include <memory>
#include <vector>

namespace frontalis
{

/// Rotation (as a rotation vector) and translation at a fraction of the way between two poses.
RigidTransform interpolate(const RigidTransform& from, const RigidTransform& to, double fraction);

/// What drives restricted nodes in one step.
struct Drive
{
  double time = 0;  ///< at the end of the step [s]
  double dt = 0;
  std::vector<RigidTransform> bone;  ///< at the end of the step
};

/// Rigid, prescribed and sliding nodes: overwrites their displacement and velocity after the update of a step. Threads
/// may take disjoint ranges of node planes. Real is the backend's number type.
template <class Real>
class RestrictedNodes
{
public:
  /// The kernel may read and write, unchanged, what lies between sliding nodes of one node plane.
  explicit RestrictedNodes(const Model& model, SlideKernel<Real> kernel = slide_plainly<Real>);

  void reset();
  /// Applies to nodes in [first, last), whole node planes; u holds the displacements after the step's update, before
  /// those before it.
  void apply(std::int32_t first, std::int32_t last, Real* const u[3], Real* const v[3], const Real* const before[3],
             const Drive& drive);
  bool empty() const { return rigid_.empty() && prescribed_.empty() && sliding_.empty(); }

private:
  using Block = SlidingBlock<Real>;
  struct Sliding
  {
    SurfaceTree::Point rest;
    SurfaceContact contact;
  };

  void make_blocks(const std::vector<SlidingNode>& nodes);
  static void renew(void* self, std::int32_t block, int lane, const Real u[3]);

  const Model& model_;
  SlideKernel<Real> kernel_;
  std::vector<std::unique_ptr<SurfaceTree>> trees_;
  std::vector<RigidNode> rigid_;  // all lists sorted by node
  std::vector<PrescribedNode> prescribed_;
  std::vector<Sliding> sliding_;
  std::vector<Block> blocks_;
  std::vector<std::int32_t> block_node_, block_count_;
  std::vector<std::array<std::int32_t, Block::width>> block_sliding_;  // into sliding_; -1: does not slide
};

}  // namespace frontalis
