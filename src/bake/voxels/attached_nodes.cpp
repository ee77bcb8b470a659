#include "bake/messages.hpp"
#include "bake/voxels/model_stages.hpp"
#include "bake/voxels/tissue_sheet.hpp"
#include "bake/voxels/voxel_index.hpp"
#include "frontalis/model/sample_field.hpp"
#include "frontalis/physics/sliding.hpp"

#include <map>
#include <numeric>
#include <optional>
#include <tuple>

namespace frontalis
{
namespace
{

/// A node and the surface that it is to be attached to.
struct Candidate
{
  AttachedNode node;
  const PreparedSurface* surface = nullptr;
  double side = 0;             ///< side of the surface on which the tissue is: +1 or -1
  double distance = 0;         ///< distance from the surface, positive in the tissue [m]
  Vector3d normal{ 0, 0, 0 };  ///< the surface's normal into the tissue, local axes
};

/// Finds whether the tissue around a node continues in a voxel near it, so that the node may follow a node of that
/// voxel. In a model with flaps, voxels at the same place or side by side may belong to the two sides of a gap. Such
/// voxels are connected by no shared nodes, or only around the end of the gap.
class ContinuousTissue
{
public:
  explicit ContinuousTissue(const Model& model) : model_(model)
  {
    if (model.flaps.empty())
      return;
    one_.resize(model.nodes.size());
    std::iota(one_.begin(), one_.end(), 0);
    for (const Model::Joint& joint : model.joints)
      one_[joint.node] = joint.master;
    voxels_of_.resize(model.nodes.size());
    for (std::size_t e = 0; e < model.voxels.size(); ++e)
      for (const std::int32_t n : model.voxel_nodes[e])
        voxels_of_[one_[n]].push_back(static_cast<std::int32_t>(e));
    ring_.assign(model.voxels.size(), 0);
  }

  /// The node that represents all nodes joined to `node`.
  std::int32_t joined(std::int32_t node) const { return one_.empty() ? node : one_[node]; }

  void begin_at(std::int32_t node)
  {
    node_ = node;
    for (const std::int32_t voxel : found_)
      ring_[voxel] = 0;
    found_.clear();
    rings_ = 0;
  }
  bool reaches(std::int32_t voxel)
  {
    if (one_.empty())
      return true;
    const auto at = rest_place(model_, model_.nodes[node_]), place = rest_place(model_, model_.voxels[voxel]);
    std::int32_t apart = 0;  // distance in voxels
    for (std::size_t a = 0; a < 3; ++a)
      apart = std::max({ apart, place[a] - at[a], at[a] - place[a] - 1 });
    while (rings_ < apart + 1)
      add_ring();
    return ring_[voxel] > 0 && ring_[voxel] <= apart + 1;
  }

private:
  // Adds the voxels around the node, or those that share nodes with voxels of the latest ring.
  void add_ring()
  {
    ++rings_;
    const auto add_around = [&](std::int32_t node)
    {
      for (const std::int32_t voxel : voxels_of_[one_[node]])
        if (ring_[voxel] == 0)
        {
          ring_[voxel] = rings_;
          found_.push_back(voxel);
        }
    };
    if (rings_ == 1)
      add_around(node_);
    const std::size_t known = found_.size();
    for (std::size_t n = 0; n < known && rings_ > 1; ++n)
      if (ring_[found_[n]] == rings_ - 1)
        for (const std::int32_t node : model_.voxel_nodes[found_[n]])
          add_around(node);
  }

  const Model& model_;
  std::vector<std::int32_t> one_;                     ///< see joined(); empty without flaps
  std::vector<std::vector<std::int32_t>> voxels_of_;  ///< voxels around each representative node
  std::int32_t node_ = 0, rings_ = 0;
  std::vector<std::int32_t> ring_;   ///< ring of each voxel, from 1; 0: not found
  std::vector<std::int32_t> found_;  ///< voxels in the order of rings
};

/// Finds the masters of nodes near a surface. Coordinates are local.
class MasterFinder
{
public:
  MasterFinder(const LocalFrame& frame, const Model& model)
      : frame_(frame),
        model_(model),
        tissue_(model),
        index_(model),
        spacing_(to_vector(model.spacing)),
        edge_(spacing_.maxCoeff()),
        restricted_(model.nodes.size(), false)
  {
    for (int axis = 0; axis < 3; ++axis)
      reach_[axis] = static_cast<std::int32_t>(std::ceil(2.5 * edge_ / spacing_[axis]));
    mark(model.rigid);
    mark(model.sliding);
    mark(model.prescribed);
    // A restricted node also restricts the nodes joined to it: see settle_joints().
    std::vector<bool> any(model.nodes.size(), false);
    for (std::size_t n = 0; n < any.size(); ++n)
      if (restricted_[n])
        any[tissue_.joined(static_cast<std::int32_t>(n))] = true;
    for (std::size_t n = 0; n < any.size(); ++n)
      restricted_[n] = any[tissue_.joined(static_cast<std::int32_t>(n))];
  }

  double edge() const { return edge_; }

  /// Fills the candidate's master and ratio. Returns whether there is a master.
  ///
  /// Extrapolation from a master at the height d above the surface and the distance l beside the nearest point of the
  /// surface errs by about d / 2D + l / L of the displacement, where strain vanishes at the depth D and displacements
  /// vary along the surface over the length L. The master has the least d^2 / 2 + l^2, which is the least sum of the
  /// squares of both for L = 1.4 D. More weight of d would suit wide layers, and less weight thin bars in torsion.
  ///
  /// The ratio is kept between -1 and 1, so that no node moves farther than its master, such as one that is deeper
  /// below the surface than its master is above it.
  bool find(Candidate& candidate)
  {
    tissue_.begin_at(candidate.node.node);
    const Vector3d foot = rest(candidate.node.node) - candidate.distance * candidate.normal;
    corners_.clear();
    const VoxelPlace middle = cell_of(foot);
    VoxelPlace place{};
    for (place[2] = middle[2] - reach_[2]; place[2] <= middle[2] + reach_[2]; ++place[2])
      for (place[1] = middle[1] - reach_[1]; place[1] <= middle[1] + reach_[1]; ++place[1])
        for (place[0] = middle[0] - reach_[0]; place[0] <= middle[0] + reach_[0]; ++place[0])
          for (std::int32_t voxel = index_.find(place); voxel >= 0; voxel = index_.another(voxel))
            add_corners(voxel, foot, candidate.normal);
    std::sort(corners_.begin(), corners_.end());
    for (const auto& [squares, master, voxel] : corners_)
    {
      if (!tissue_.reaches(voxel))
        continue;
      const double height = distance(candidate, master);
      // A free node is close to the surface only where a crop ends the constraint.
      if (!(height >= 0.5 * edge_))
        continue;
      candidate.node.master = master;
      candidate.node.ratio = std::clamp(candidate.distance / height, -1.0, 1.0);
      return true;
    }
    return false;
  }

  /// Distance of a node from the candidate's surface, positive in the tissue [m]; NaN where it is unknown.
  double distance(const Candidate& candidate, std::int32_t node) const
  {
    if (candidate.node.surface >= 0)
      return candidate.side *
             level_at(model_.constraint_surfaces[candidate.node.surface].field, rest_position(model_, node));
    const Vector3d p = frame_.to_scene(rest(node));
    return candidate.side * candidate.surface->signed_distance(p, candidate.surface->tree().closest(p));
  }

private:
  template <class Restricted>
  void mark(const std::vector<Restricted>& nodes)
  {
    for (const Restricted& entry : nodes)
      restricted_[entry.node] = true;
  }

  Vector3d rest(std::int32_t node) const { return to_vector(rest_position(model_, node)); }

  VoxelPlace cell_of(const Vector3d& local) const
  {
    const Vector3d cell = (local.cwiseQuotient(spacing_).array() + 1e-9).floor();
    return { { static_cast<std::int32_t>(cell[0]), static_cast<std::int32_t>(cell[1]),
               static_cast<std::int32_t>(cell[2]) } };
  }

  /// Adds the free corners of a voxel that are above the surface and within 2.5 edges of the foot.
  void add_corners(std::int32_t voxel, const Vector3d& foot, const Vector3d& normal)
  {
    for (const std::int32_t node : model_.voxel_nodes[voxel])
    {
      if (restricted_[node])
        continue;
      const Vector3d from_foot = rest(node) - foot;
      const double squared = from_foot.squaredNorm(), height = from_foot.dot(normal);
      if (height > 0 && squared < 2.5 * 2.5 * edge_ * edge_)
        corners_.emplace_back(squared - 0.5 * height * height, node, voxel);
    }
  }

  const LocalFrame& frame_;
  const Model& model_;
  ContinuousTissue tissue_;
  VoxelIndex index_;
  Vector3d spacing_;
  double edge_;
  VoxelPlace reach_{};  ///< cells to look at on each side of the foot's cell
  std::vector<bool> restricted_;
  /// possible masters of a node: the sum of squares of find(), the master and its voxel
  std::vector<std::tuple<double, std::int32_t, std::int32_t>> corners_;
};

/// Finds the candidates among a model's rigid and sliding nodes.
class CandidateFinder
{
public:
  CandidateFinder(const Scene& scene, const PreparedSurfaces& surfaces, const LocalFrame& frame, const Model& model)
      : scene_(scene), surfaces_(surfaces), frame_(frame), model_(model)
  {
  }

  std::optional<Candidate> candidate(const RigidNode& rigid)
  {
    if (rigid.constraint < 0 || !attaches(scene_, scene_.constraints[rigid.constraint]))
      return std::nullopt;
    const Vector3d p = frame_.to_scene(to_vector(rest_position(model_, rigid.node)));
    Candidate best;
    const auto [surface, nearest] = nearest_surface(rigid.constraint, p);
    best.surface = surface;
    best.node = { rigid.node, 0, 0, rigid.bone, -1, rigid.constraint };
    const double outwards = best.surface->signed_distance(p, nearest);
    best.side = side_at(*best.surface, outwards);
    best.distance = best.side * outwards;
    const Vector3d& face = best.surface->pseudonormal(nearest);
    const Vector3d away = nearest.distance > 1e-3 * to_vector(model_.spacing).minCoeff()
                              ? Vector3d((p - nearest.point) / outwards)
                              : face;
    best.normal = frame_.turn(Vector3d(best.side * away.normalized()));
    return best;
  }

  std::optional<Candidate> candidate(const SlidingNode& sliding)
  {
    const ConstraintSurface& surface = model_.constraint_surfaces[sliding.surface];
    if (sliding.constraint < 0 || !attaches(scene_, scene_.constraints[sliding.constraint]))
      return std::nullopt;
    const auto rest = rest_position(model_, sliding.node);
    const physics::DistanceField field = view(surface.field);
    physics::FieldValue<double> value{};
    if (!physics::sample(field, physics::field_point(field, { rest[0], rest[1], rest[2] }), value))
      return std::nullopt;
    Candidate found;
    found.node = { sliding.node, 0, 0, -1, sliding.surface, sliding.constraint };
    found.surface = nearest_surface(sliding.constraint, frame_.to_scene(to_vector(rest))).first;
    found.side = side_at(*found.surface, value.value);
    found.distance = found.side * value.value;
    const Vector3d gradient(value.gradient.x, value.gradient.y, value.gradient.z);
    if (gradient.norm() < physics::least_gradient)
      return std::nullopt;
    found.normal = found.side * gradient.normalized();
    return found;
  }

private:
  /// The nearest surface of a constraint, and the closest point on it.
  std::pair<const PreparedSurface*, ClosestPoint> nearest_surface(std::int32_t constraint, const Vector3d& p) const
  {
    std::pair<const PreparedSurface*, ClosestPoint> nearest{ nullptr, {} };
    for (const std::string& name : scene_.constraints[constraint].surfaces)
    {
      const PreparedSurface& surface = named_surface(surfaces_, name, scene_.file);
      const ClosestPoint closest = surface.tree().closest(p);
      if (nearest.first == nullptr || closest.distance < nearest.second.distance)
        nearest = { &surface, closest };
    }
    return nearest;
  }

  /// The side of a surface on which the tissue is, +1 or -1. If it is on both sides: the side of a node whose signed
  /// distance from the surface is `outwards`.
  double side_at(const PreparedSurface& surface, double outwards)
  {
    const auto known = side_.find(&surface);
    const double side = known != side_.end() ? known->second : side_[&surface] = tissue_side(surface, frame_, model_);
    return side != 0 ? side : outwards < 0 ? -1 : 1;
  }

  const Scene& scene_;
  const PreparedSurfaces& surfaces_;
  const LocalFrame& frame_;
  const Model& model_;
  std::map<const PreparedSurface*, double> side_;
};

}  // namespace

bool attaches(const Scene& scene, const SceneConstraint& constraint)
{
  return scene.accuracy.boundary == "true" && constraint.restricts_nodes() && constraint.within < 0 &&
         constraint.friction == 0;
}

std::vector<const PreparedSurface*> attaching_surfaces(const Scene& scene, const PreparedSurfaces& surfaces)
{
  std::vector<const PreparedSurface*> found;
  for (const SceneConstraint& constraint : scene.constraints)
    for (const std::string& name : constraint.surfaces)
      if (attaches(scene, constraint))
        found.push_back(&named_surface(surfaces, name, place_in_scene(scene, "constraint", constraint)));
  return found;
}

void attach_nodes(const Scene& scene, const PreparedSurfaces& surfaces, const LocalFrame& frame, Model& model,
                  BakeMonitor& monitor)
{
  // Without the effect, nodes near bones stay rigid or slide at their own distance.
  if (scene.accuracy.boundary != "true" || scene.switched_off.has(Effect::attachment))
    return;
  CandidateFinder candidates(scene, surfaces, frame, model);
  MasterFinder masters(frame, model);
  std::size_t held = 0, freed = 0;
  // Attaches nodes of a list, and keeps the others in the list.
  const auto attach = [&](auto& list)
  {
    std::size_t kept = 0;
    for (std::size_t n = 0; n < list.size(); ++n)
    {
      const auto entry = list[n];
      auto candidate = candidates.candidate(entry);
      if (candidate && masters.find(*candidate))
        model.attached.push_back(candidate->node);
      else if (candidate && candidate->distance > 0.5 * masters.edge())
        ++freed;
      else
      {
        list[kept++] = entry;
        held += candidate ? 1 : 0;
      }
    }
    list.resize(kept);
  };
  attach(model.rigid);
  attach(model.sliding);
  std::sort(model.attached.begin(), model.attached.end(),
            [](const AttachedNode& a, const AttachedNode& b) { return a.node < b.node; });
  if (held + freed > 0)
    monitor.found(
        "boundary: tissue is less than about a voxel deep at {} of {} nodes near bones; those up to half a voxel "
        "above the bone are held there ({}), the others are free ({})",
        held + freed, held + freed + model.attached.size(), held, freed);
  for (const ConstraintSurface& surface : model.constraint_surfaces)
    if (surface.friction > 0)
      monitor.found("boundary: nodes that slide on '{}' keep their own distances, because it has friction",
                    surface.name);
}

}  // namespace frontalis
