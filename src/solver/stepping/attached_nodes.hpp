#pragma once

#include "frontalis/model/model.hpp"
#include "frontalis/physics/distance_field.hpp"
#include "frontalis/physics/element/attached_group.hpp"
#include "solver/cpu/slide_kernel.hpp"
#include "solver/stepping/attached_blocks.hpp"
#include "solver/stepping/node_part.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace frontalis
{

/// The attached nodes of a model and its joints, which are held by their masters with the ratio 1, in ascending order
/// of masters.
std::vector<AttachedNode> nodes_by_master(const Model& model);
/// For each node, the axes along which it has a prescribed path.
std::vector<std::array<bool, 3>> prescribed_axes(const Model& model);

/// Nodes whose motion follows that of another node (AttachedNode), and the joints of flaps (Model::Joint), whose two
/// nodes move as one. After the free update of a step, a master and the nodes that follow it get those velocities that
/// the constraints allow and that are nearest to the updated velocities in the mass-weighted norm (Gauss's principle).
/// Thus the nodes' masses, and forces of any kind on them, act on the master. Constraints at surfaces that stand still
/// do no work. No frequency of the model rises, because constraints lower Rayleigh quotients, so that the bounds of the
/// time step remain valid. Each group of a master and its nodes is computed by itself, in a fixed order. AttachedBlocks
/// computes the groups at surfaces that stand still.
template <class Real>
class AttachedNodes : public NodePart<Real>
{
public:
  /// `mass`: of every node [kg]; it and the model must outlive this object.
  AttachedNodes(const Model& model, const std::vector<double>& mass, AttachKernel<Real> kernel = attach_plainly<Real>);

  bool idle() const override { return groups_.empty() && blocks_.empty(); }
  bool groups() const override { return true; }
  /// Applies the constraints of the groups whose masters are in the share. The groups have no nodes in common.
  void constrain_groups(const NodeShare& share, Real* const u[3], Real* const v[3],
                        const ConstraintStep& step) override;

  void masses_changed() override;
  void run(EffectSet) override {}
  void reset() override;
  void list_arrays(ArrayList& list) override;

private:
  using Point = physics::Vec3<double>;
  struct Group
  {
    std::int32_t master;
    std::int32_t begin, end;  // range of ties_
    bool fixed[3];            // axes along which the master has a prescribed path
  };
  struct Tie
  {
    std::int32_t node, bone, surface;
    std::int32_t plane, master_plane;  // indices into planes_; -1: the node is held
    double ratio, mass;
    Point rest;
    double offset;  // level_offset() [m]
  };
  using Plane = physics::KeptLevel<double>;
  struct Bones;
  struct MovedGroup;

  void add_group(const AttachedNode* begin, const AttachedNode* end, const std::array<bool, 3>& fixed);
  void follow_on_bones(const Group& group, Real* const (&u)[3], Real* const (&v)[3], const Bones& bones);
  void renew(Plane& plane, std::int32_t surface, const Point& place) const;

  const Model& model_;
  const std::vector<double>& mass_;
  std::vector<physics::DistanceField> fields_;  // of the model's surfaces
  AttachedBlocks<Real> blocks_;
  std::vector<Group> groups_;  // groups that are not in blocks_, in ascending order of masters
  std::vector<Tie> ties_;
  std::vector<Plane> planes_;
};

}  // namespace frontalis
