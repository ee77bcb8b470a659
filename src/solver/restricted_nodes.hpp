#pragma once

#include "frontalis/model/model.hpp"
#include "surface_tree.hpp"

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

/// Rigid, prescribed and sliding nodes: overwrites their displacement and velocity after the update of a step. Node by
/// node, so that threads may take disjoint ranges of nodes. Real is the backend's number type.
template <class Real>
class RestrictedNodes
{
public:
  explicit RestrictedNodes(const Model& model);

  void reset();
  /// Applies to nodes in [first, last); u holds the displacements after the step's update, before those before it.
  void apply(std::int32_t first, std::int32_t last, Real* const u[3], Real* const v[3], const Real* const before[3],
             const Drive& drive);
  bool empty() const { return rigid_.empty() && prescribed_.empty() && sliding_.empty(); }

private:
  // tangent plane of the offset surface near the latest exact closest point: normal . u = offset
  struct Plane
  {
    std::int32_t node;
    Real normal[3];
    Real offset;
    Real reference[3];  // displacement at that search
    Real slip_squared;  // how far the node may have moved since; < 0: never searched
  };
  struct Sliding
  {
    std::int32_t node;
    std::int32_t surface;
    double distance;
    SurfaceTree::Point rest;
    SurfaceTree::Point foot;
  };

  void renew(Plane& plane, Sliding& s, const SurfaceTree::Point& u);

  const Model& model_;
  std::vector<RigidNode> rigid_;  // all lists sorted by node
  std::vector<PrescribedNode> prescribed_;
  std::vector<Plane> planes_;  // one a sliding node
  std::vector<Sliding> sliding_;
  std::vector<std::unique_ptr<SurfaceTree>> trees_;
};

}  // namespace frontalis
