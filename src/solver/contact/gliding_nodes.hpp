#pragma once

#include "frontalis/model/surface.hpp"
#include "frontalis/physics/pose.hpp"
#include "solver/contact/kept_level.hpp"
#include "solver/stepping/array_list.hpp"
#include "solver/stepping/constraint_step.hpp"

#include <algorithm>
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

/// The sliding nodes of a model with friction, processed one by one in double precision. Nodes on a bone are processed
/// in the frame of the bone. Their tangent planes are found in each step: if a plane were kept for several steps, its
/// replacement would make the surface's reaction jump, which friction follows.
template <class Real>
class GlidingNodes
{
public:
  using Point = physics::Vec3<double>;
  struct Node
  {
    std::int32_t node;
    std::int32_t bone;  // -1: the surface stands still
    double friction;
    Point rest;
    KeptLevel level;
  };
  struct State
  {
    Point normal{ 0, 0, 0 };  // normal of the plane normal . p = height; zero: the node has no plane yet
    double height = 0;
    double pressing = 0;  // reaction per mass, delayed as friction is (friction_response()) [m/s2]
    // Values of the latest step:
    Point outward{ 0, 0, 0 };           // the normal in the scene's frame
    Point surface_velocity{ 0, 0, 0 };  // [m/s]
  };
  using States = std::vector<State>;

  /// Adds a node. Add nodes in ascending order.
  void add(const Node& node) { nodes_.push_back(node); }
  std::size_t size() const { return nodes_.size(); }
  void rub(bool on) { rubs_ = on; }
  void list_arrays(ArrayList& list) const { list.add(Effect::sliding, "nodes that glide", nodes_); }
  /// Moves the nodes in [first, last) back to their surfaces. See RestrictedNodes::constrain.
  void apply(std::int32_t first, std::int32_t last, Real* const u[3], Real* const v[3], const ConstraintStep& step,
             States& states) const;
  /// See RestrictedNodes::friction_loss.
  double friction_loss(std::int32_t first, std::int32_t last, const std::vector<double>& mass,
                       const Real* const before[3], const Real* const without[3], const Real* const after[3],
                       const States& states) const;

private:
  /// Indices of the nodes in [first, last).
  std::pair<std::size_t, std::size_t> range(std::int32_t first, std::int32_t last) const;

  std::vector<Node> nodes_;
  bool rubs_ = true;
};

}  // namespace frontalis
