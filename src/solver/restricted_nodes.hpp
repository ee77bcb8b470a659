#pragma once

#include "frontalis/model/model.hpp"
#include "gliding_nodes.hpp"
#include "slide_kernel.hpp"

#include <memory>
#include <vector>

namespace frontalis
{

/// What constraints did in some steps [J], and what it takes to say so. A step takes a node's velocity from v- to v+
/// and would have taken it to v* without them: their impulse is I = (dt / gain) m (v+ - v*), its work I . (v- + v+) /
/// 2, which is the change of m v- . v+ / 2 in central differences. Where they moved the node by d other than dt v+
/// says, the other forces, m (v* - keep v-) / gain, worked along d too: that is taken away. Added up node after node.
template <class Real>
struct ConstraintWork
{
  const Real* velocity_before[3];  ///< v- of all nodes [m/s]
  const double* mass;              ///< of all nodes [kg]
  double keep, gain;               ///< of the update v* = keep v- + gain force / mass

  double bones = 0;     ///< by nodes and surfaces that follow bones
  double loads = 0;     ///< by prescribed displacements
  double sliding = 0;   ///< by surfaces that stand still: what their constraint errs by
  double friction = 0;  ///< lost to it
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
  /// The same, and adds to `work`.
  void apply(std::int32_t first, std::int32_t last, Real* const u[3], Real* const v[3], const Real* const before[3],
             const Drive& drive, ConstraintWork<Real>& work);
  bool empty() const { return rigid_.empty() && prescribed_.empty() && sliding_.empty() && gliding_.empty(); }

private:
  using Block = SlidingBlock<Real>;
  struct Sliding
  {
    SurfaceTree::Point rest;
    SurfaceContact contact;
  };

  void make_blocks(const std::vector<SlidingNode>& nodes);
  static void renew(void* self, std::int32_t block, int lane, const Real u[3], Real v[3]);

  struct Unconstrained;

  const Model& model_;
  SlideKernel<Real> kernel_;
  std::vector<std::unique_ptr<SurfaceTree>> trees_;
  std::vector<RigidNode> rigid_;  // all lists sorted by node
  std::vector<PrescribedNode> prescribed_;
  GlidingNodes<Real> gliding_;
  std::vector<Sliding> sliding_;  // the others: surfaces that stand still and have no friction
  std::vector<Block> blocks_;
  std::vector<std::int32_t> block_node_, block_count_;
  std::vector<std::array<std::int32_t, Block::width>> block_sliding_;  // into sliding_; -1: does not slide
};

}  // namespace frontalis
