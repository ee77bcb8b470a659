#pragma once

#include "frontalis/model/model.hpp"
#include "solver/contact/gliding_nodes.hpp"
#include "solver/cpu/slide_kernel.hpp"

#include <memory>
#include <vector>

namespace frontalis
{

/// Rigid, prescribed and sliding nodes: overwrites their displacement and velocity after the update of a step. Threads
/// may process disjoint ranges of node planes. Real is the backend's number type.
template <class Real>
class RestrictedNodes : public EffectPart
{
public:
  using Block = SlidingBlock<Real>;
  struct Sliding
  {
    SurfaceTree::Point rest;
    SurfaceContact contact;
  };
  /// State of sliding nodes on their surfaces.
  struct Contacts
  {
    GlidingNodes<Real> gliding;    ///< those whose surface moves with a bone or has friction
    std::vector<Sliding> sliding;  ///< the others
    std::vector<Block> blocks;

    void archive(ByteArchive& archive)
    {
      gliding.archive(archive);
      archive_contacts(sliding, archive);
      archive(blocks);
    }
  };

  /// The kernel may read nodes between the sliding nodes of a node plane and write them back unchanged.
  explicit RestrictedNodes(const Model& model, SlideKernel<Real> kernel = slide_plainly<Real>);

  void reset() override;
  const Contacts& contacts() const { return contacts_; }
  void restore(const Contacts& contacts)
  {
    contacts_ = contacts;
    contacts_.gliding.rub(rubs_);
  }
  /// Applies the constraints to nodes in [first, last), which must be whole node planes. `u`: displacements after the
  /// update of the step; `before`: displacements before it.
  void apply(std::int32_t first, std::int32_t last, Real* const u[3], Real* const v[3], const Real* const before[3],
             const ConstraintStep& step);
  /// Energy [J] that friction dissipated at nodes [first, last) in the latest step: -I . (mean of v- and v+ - velocity
  /// of the surface), with I = m (v+ - v*) along the surface; v-: before the step, v*: without constraints, v+: after
  /// it [m/s]. Mass [kg] and velocities are those of all nodes. Nodes are summed in order.
  double friction_loss(std::int32_t first, std::int32_t last, const std::vector<double>& mass,
                       const Real* const before[3], const Real* const without[3], const Real* const after[3]) const
  {
    return slides_ ? contacts_.gliding.friction_loss(first, last, mass, before, without, after) : 0;
  }
  void run(EffectSet running) override;
  void list_arrays(ArrayList& list) override;
  bool idle() const
  {
    const bool slides = slides_ && !(contacts_.sliding.empty() && contacts_.gliding.empty());
    return rigid_.empty() && prescribed_.empty() && !slides;
  }

private:
  void make_blocks(const std::vector<SlidingNode>& nodes);
  void follow_paths(std::int32_t first, std::int32_t last, Real* const u[3], Real* const v[3],
                    const Real* const before[3], const ConstraintStep& step);
  void follow_bones(std::int32_t first, std::int32_t last, Real* const u[3], Real* const v[3],
                    const Real* const before[3], const ConstraintStep& step);
  static void renew(void* self, std::int32_t block, int lane, const Real u[3], Real v[3]);

  const Model& model_;
  SlideKernel<Real> kernel_;
  std::vector<std::unique_ptr<SurfaceTree>> trees_;
  std::vector<RigidNode> rigid_;  // all lists sorted by node
  std::vector<PrescribedNode> prescribed_;
  Contacts contacts_;
  std::vector<std::int32_t> block_node_, block_count_;
  std::vector<std::array<std::int32_t, Block::width>> block_sliding_;  // index into contacts_.sliding, or -1
  bool slides_ = true, rubs_ = true;
};

}  // namespace frontalis
