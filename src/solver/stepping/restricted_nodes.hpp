#pragma once

#include "frontalis/model/model.hpp"
#include "solver/contact/kept_level.hpp"
#include "solver/cpu/slide_kernel.hpp"
#include "solver/stepping/node_part.hpp"

#include <vector>

namespace frontalis
{

/// Rigid, prescribed and sliding nodes: overwrites their displacement and velocity after the update of a step. Threads
/// may process disjoint ranges of node planes at the same time. Real is the backend's number type.
template <class Real>
class RestrictedNodes : public NodePart<Real>
{
public:
  using Block = SlidingBlock<Real>;
  /// The tangent plane normal . p = height of a node that slides on a bone, in the bone's frame.
  struct Carried
  {
    physics::Vec3<double> normal;
    double height;                          ///< [m]
    physics::Vec3<double> found_at;         ///< the place for which the plane was found [m]
    physics::SymmetricMatrix<double> bend;  ///< physics::LevelPlane::bend
  };
  /// Nodes of a block that slide on the same bone.
  struct Carrier
  {
    std::int32_t block, bone;
    RigidTransform pose;  ///< pose of the bone for which the planes of the block were computed last
    std::int64_t moves;   ///< 1: the bone moved in that step, so that the planes have a velocity; 0: it did not
  };
  /// State of sliding nodes on their surfaces.
  struct Contacts
  {
    std::vector<Block> blocks;
    std::vector<RoughBlock<Real>> rough;  ///< one per block if any surface has friction
    std::vector<Carried> carried;         ///< planes of nodes that slide on bones
    std::vector<Carrier> carriers;
  };

  /// The kernels may also read the nodes of a plane that lie between sliding nodes, and write them back unchanged.
  explicit RestrictedNodes(const Model& model, const SlideKernels<Real>& kernels = plain_slide_kernels<Real>());

  void reset() override;
  void constrain(const NodeShare& share, Real* const u[3], Real* const v[3], const Real* const before[3],
                 const ConstraintStep& step) override;
  void account(const NodeShare& share, EnergyAccount<Real>& account, const Real* const v[3], double) override
  {
    for (auto k = share.first_plane; k < share.end_plane; ++k)
      account.friction(k, *this, v);
  }
  /// Energy [J] that friction dissipated at nodes [first, last) in the latest step: the sum of -I . ((v- + v+) / 2 -
  /// velocity of the surface), with the impulse I = m (v+ - v*) along the surface. The velocities [m/s] are v- before
  /// the step, v* without constraints and v+ after the step. Mass [kg] and velocities are those of all nodes. Nodes are
  /// summed in order.
  double friction_loss(std::int32_t first, std::int32_t last, const std::vector<double>& mass,
                       const Real* const before[3], const Real* const without[3], const Real* const after[3]) const;
  void run(EffectSet running) override;
  void list_arrays(ArrayList& list) override;
  bool idle() const override
  {
    return model_.rigid.empty() && prescribed_.empty() && !(slides_ && !model_.sliding.empty());
  }

private:
  struct Sliding
  {
    physics::Vec3<double> rest;
    KeptLevel level;
    std::int32_t bone;     // -1: the surface stands still
    std::int32_t carried;  // index into Contacts::carried, or -1
    double friction;
  };
  /// A node that needs a new tangent plane.
  struct Renewal
  {
    std::int32_t block;
    int lane;
    std::int32_t index;           ///< into sliding_
    physics::Vec3<double> place;  ///< in the surface's frame [m]
  };
  /// A rigid node on a bone.
  struct MovedNode
  {
    std::int32_t node, bone;
    physics::Vec3<double> rest;
  };
  /// Successive rigid nodes that stand still.
  struct StillRun
  {
    std::int32_t node, count;
  };
  void make_blocks(const std::vector<SlidingNode>& nodes);
  /// Index of the first block that does not begin before a node.
  std::int32_t block_of(std::int32_t node) const;
  void follow_paths(std::int32_t first, std::int32_t last, Real* const u[3], Real* const v[3],
                    const Real* const before[3], const ConstraintStep& step);
  void hold_still(std::int32_t first, std::int32_t last, Real* const u[3], Real* const v[3]) const;
  void follow_bones(std::int32_t first, std::int32_t last, Real* const u[3], Real* const v[3],
                    const Real* const before[3], const ConstraintStep& step);
  void carry(Carrier& carrier, const Real* const u[3], const ConstraintStep& step);
  void renew(const WaitingBlock* waiting, std::int32_t count, Real* const u[3], Real* const v[3],
             const ConstraintStep& step);
  void renew_batch(Renewal* renewals, int count, Real* const u[3], Real* const v[3], const ConstraintStep& step);
  void flatten(const Renewal& renewal, Real* const u[3], Real* const v[3], const ConstraintStep& step);
  void take(const Renewal& renewal, const physics::LevelPlane<double>& plane, Real* const u[3], Real* const v[3],
            const ConstraintStep& step);

  const Model& model_;
  SlideKernels<Real> kernels_;
  std::vector<physics::DistanceField> fields_;  // of the model's surfaces
  std::vector<MovedNode> rigid_;                // all lists are sorted by node
  std::vector<StillRun> still_;
  std::vector<PrescribedNode> prescribed_;
  std::vector<Sliding> sliding_;
  std::int32_t carried_ = 0;  // number of nodes that slide on bones
  Contacts contacts_;
  std::vector<std::int32_t> block_node_, block_count_;
  std::vector<std::array<std::int32_t, Block::width>> block_sliding_;  // index into sliding_, or -1
  bool slides_ = true, rubs_ = true;
};

}  // namespace frontalis
