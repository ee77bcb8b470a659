#pragma once

#include "frontalis/model/surface.hpp"
#include "frontalis/physics/pose.hpp"
#include "solver/contact/archive_contacts.hpp"
#include "solver/stepping/constraint_step.hpp"
#include "solver/stepping/array_list.hpp"
#include "solver/contact/surface_contact.hpp"

#include <algorithm>
#include <memory>
#include <vector>

namespace frontalis
{

inline physics::Pose pose_of(const RigidTransform& from)
{
  physics::Pose pose;
  std::copy(from.rotation.begin(), from.rotation.end(), pose.r);
  std::copy(from.translation.begin(), from.translation.end(), pose.t);
  return pose;
}

/// Sliding nodes whose surface moves with a bone or has friction, processed one by one in double precision. A node's
/// contact is stored in the frame of the bone.
template <class Real>
class GlidingNodes
{
public:
  struct Node
  {
    std::int32_t node;
    std::int32_t bone;  // -1: the surface is fixed
    double friction;
    SurfaceContact::Point rest;
    SurfaceContact contact;
    ContactPlane plane;
    SurfaceContact::Point reference;  // where the plane was found
    double pressing;                  // reaction per mass, delayed as friction needs it [m/s2]
    // values of the latest step
    SurfaceContact::Point normal;            // outward unit normal
    SurfaceContact::Point surface_velocity;  // [m/s]
  };

  void add(Node node) { nodes_.push_back(std::move(node)); }
  void reset();
  /// Switches friction on or off.
  void rub(bool on)
  {
    rubs_ = on;
    for (auto& node : nodes_)
      node.pressing = on ? node.pressing : 0;
  }
  void list_arrays(ArrayList& list) const { list.add(Effect::sliding, "nodes that glide", nodes_); }
  bool empty() const { return nodes_.empty(); }
  void archive(ByteArchive& archive) { archive_contacts(nodes_, archive); }
  /// Nodes whose index lies in [first, last). They are stored in the order of their nodes.
  std::pair<const Node*, const Node*> range(std::int32_t first, std::int32_t last) const;
  /// See RestrictedNodes::friction_loss.
  double friction_loss(std::int32_t first, std::int32_t last, const std::vector<double>& mass,
                       const Real* const before[3], const Real* const without[3], const Real* const after[3]) const;
  void apply(std::int32_t first, std::int32_t last, Real* const u[3], Real* const v[3], const ConstraintStep& step);

private:
  std::vector<Node> nodes_;
  bool rubs_ = true;
};

}  // namespace frontalis
