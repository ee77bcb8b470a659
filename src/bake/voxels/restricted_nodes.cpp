#include "bake/voxels/restricted_nodes.hpp"

#include "frontalis/error.hpp"
#include "bake/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

namespace frontalis
{
namespace
{

constexpr std::size_t grain = 4096;

/// Distance of a node that a surface catches; not a number where it does not.
using Caught = std::vector<double>;

class NodeCatcher
{
public:
  NodeCatcher(const Scene& scene, const std::vector<std::unique_ptr<PreparedSurface>>& surfaces,
              const LocalFrame& frame, const Model& model, BakeStages& stages)
      : scene_(scene), surfaces_(surfaces), frame_(frame), model_(model), stages_(stages)
  {
    edge_ = std::max({ model.spacing[0], model.spacing[1], model.spacing[2] });
    positions_.reserve(model.nodes.size());
    for (const auto& node : model.nodes)
      positions_.push_back(scene_position(node[0], node[1], node[2]));
  }

  /// Signed distances of the nodes that the surface catches, and how many there are.
  std::size_t nodes_near(const PreparedSurface& surface, double within, const Region& crop, Caught& caught)
  {
    if (within < 0)
      within = 0.75 * edge_;
    const double side = tissue_side(surface);
    const double bound = std::max(within, side == 0 ? 0 : 2 * edge_);
    caught.assign(positions_.size(), std::nan(""));
    parallel_ranges(
        positions_.size(), grain,
        [&](std::size_t begin, std::size_t end)
        {
          for (std::size_t n = begin; n < end; ++n)
          {
            const Vector3& p = positions_[n];
            if (!contains(crop, p) || surface.box().squared_distance(p) > bound * bound)
              continue;
            const ClosestPoint closest = surface.tree().closest(p, bound);
            if (closest.triangle < 0)
              continue;
            const double distance = surface.signed_distance(p, closest);
            const double height = dot(p - closest.point, surface.pseudonormal(closest));
            // beyond the surface, and not merely beside an open one
            const bool beyond = side * height < -0.5 * closest.distance;
            if (closest.distance <= within || beyond)
              caught[n] = distance;
          }
        },
        &stages_);
    return static_cast<std::size_t>(
        std::count_if(caught.begin(), caught.end(), [](double d) { return !std::isnan(d); }));
  }

  const PreparedSurface& surface(const std::string& name, const std::string& place) const
  {
    return named_surface(surfaces_, name, place);
  }

  [[noreturn]] void none(const std::string& place, double within) const
  {
    char text[64];
    std::snprintf(text, sizeof(text), "%.3g mm", 1e3 * (within < 0 ? 0.75 * edge_ : within));
    throw Error(place + ": no tissue node lies within " + text +
                " of its surface inside its crop; check the surface, the crop and 'within'");
  }

  /// The part of a surface that the model can touch, all of one that moves, in local coordinates.
  TriangleMesh local_mesh(const PreparedSurface& surface, bool moves) const
  {
    if (moves)
      return frame_.to_local(surface.mesh());
    constexpr double margin = 30e-3;
    Box box;
    for (const Vector3& p : positions_)
      box.include(p);
    for (std::size_t a = 0; a < 3; ++a)
    {
      box.lower[a] -= margin;
      box.upper[a] += margin;
    }
    const TriangleMesh& mesh = surface.mesh();
    std::vector<bool> keep(mesh.triangles.size());
    for (std::size_t t = 0; t < keep.size(); ++t)
    {
      Box triangle;
      for (const std::int32_t v : mesh.triangles[t])
        triangle.include(mesh.vertices[static_cast<std::size_t>(v)]);
      keep[t] = triangle.overlaps(box);
    }
    return frame_.to_local(keep_triangles(mesh, keep));
  }

  std::string place(const char* what, const std::string& name, int line) const
  {
    return scene_.file + ":" + std::to_string(line) + ": " + what + " '" + name + "'";
  }

private:
  Vector3 scene_position(double i, double j, double k) const
  {
    const Vector3 local{ i * model_.spacing[0], j * model_.spacing[1], k * model_.spacing[2] };
    Vector3 p = frame_.origin;
    for (std::size_t a = 0; a < 3; ++a)
      p[frame_.scene_axis(a)] += local[a];
    return p;
  }

  /// +1: the tissue lies on the side of the outward normals, -1: on the other, 0: on both.
  double tissue_side(const PreparedSurface& surface)
  {
    const auto known = side_.find(&surface);
    if (known != side_.end())
      return known->second;
    const std::size_t voxels = model_.voxels.size();
    std::vector<double> sums((voxels + grain - 1) / grain, 0), weights(sums.size(), 0);
    parallel_ranges(voxels, grain,
                    [&](std::size_t begin, std::size_t end)
                    {
                      for (std::size_t e = begin; e < end; ++e)
                      {
                        const auto& v = model_.voxels[e];
                        const Vector3 p = scene_position(v[0] + 0.5, v[1] + 0.5, v[2] + 0.5);
                        if (surface.box().squared_distance(p) > 4 * edge_ * edge_)
                          continue;
                        const ClosestPoint closest = surface.tree().closest(p, 2 * edge_);
                        if (closest.triangle < 0)
                          continue;
                        const auto fill = static_cast<double>(model_.fill[e]);
                        sums[begin / grain] += surface.signed_distance(p, closest) > 0 ? fill : -fill;
                        weights[begin / grain] += fill;
                      }
                    });
    double sum = 0, weight = 0;
    for (std::size_t r = 0; r < sums.size(); ++r)
    {
      sum += sums[r];
      weight += weights[r];
    }
    const double side = std::abs(sum) < 0.4 * weight || weight == 0 ? 0 : (sum > 0 ? 1 : -1);
    side_[&surface] = side;
    return side;
  }

  const Scene& scene_;
  const std::vector<std::unique_ptr<PreparedSurface>>& surfaces_;
  const LocalFrame& frame_;
  const Model& model_;
  BakeStages& stages_;
  double edge_ = 0;
  std::vector<Vector3> positions_;
  std::map<const PreparedSurface*, double> side_;
};

/// Index of the constraint's bone, which becomes one of the model's; -1: none.
std::int32_t bone_of(const SceneConstraint& constraint, Model& model)
{
  if (constraint.bone.empty())
    return -1;
  const auto known = std::find(model.bones.begin(), model.bones.end(), constraint.bone);
  const auto bone = static_cast<std::int32_t>(known - model.bones.begin());
  if (known == model.bones.end())
    model.bones.push_back(constraint.bone);
  return bone;
}

}  // namespace

void restrict_nodes(const Scene& scene, const std::vector<std::unique_ptr<PreparedSurface>>& surfaces,
                    const LocalFrame& frame, Model& model, BakeStages& stages)
{
  NodeCatcher catcher(scene, surfaces, frame, model, stages);
  const std::size_t nodes = model.nodes.size();
  enum class Kind : std::int8_t
  {
    free,
    sliding,
    prescribed,
    rigid
  };
  std::vector<Kind> kind(nodes, Kind::free);
  std::vector<std::int32_t> of(nodes, -1);  // bone or surface
  std::vector<std::int32_t> held_by(nodes, -1);
  std::vector<double> distance(nodes, 0);
  Caught caught;
  for (const SceneConstraint& constraint : scene.constraints)
    model.constraints.push_back(constraint.name);

  for (std::size_t c = 0; c < scene.constraints.size(); ++c)
  {
    const SceneConstraint& constraint = scene.constraints[c];
    if (constraint.kind != SceneConstraint::Kind::rigid)
      continue;
    const std::int32_t bone = bone_of(constraint, model);
    const std::string place = catcher.place("constraint", constraint.name, constraint.line);
    std::size_t count = 0;
    for (const std::string& name : constraint.surfaces)
    {
      count += catcher.nodes_near(catcher.surface(name, place), constraint.within, constraint.crop, caught);
      for (std::size_t n = 0; n < nodes; ++n)
      {
        if (std::isnan(caught[n]) || kind[n] == Kind::rigid)
          continue;
        kind[n] = Kind::rigid;
        of[n] = bone;
        held_by[n] = static_cast<std::int32_t>(c);
      }
    }
    if (count == 0)
      catcher.none(place, constraint.within);
  }

  for (std::size_t l = 0; l < scene.loads.size(); ++l)
  {
    const SceneLoad& load = scene.loads[l];
    if (load.kind != SceneLoad::Kind::displacement)
      continue;
    const std::string place = catcher.place("load", load.name, load.line);
    if (catcher.nodes_near(catcher.surface(load.surface, place), load.within, load.crop, caught) == 0)
      catcher.none(place, load.within);
    for (std::size_t n = 0; n < nodes; ++n)
    {
      if (std::isnan(caught[n]) || kind[n] == Kind::rigid)
        continue;
      kind[n] = Kind::prescribed;
      model.prescribed.push_back({ static_cast<std::int32_t>(n), static_cast<std::int32_t>(l) });
    }
  }

  for (std::size_t c = 0; c < scene.constraints.size(); ++c)
  {
    const SceneConstraint& constraint = scene.constraints[c];
    if (constraint.kind != SceneConstraint::Kind::sliding)
      continue;
    const std::int32_t bone = bone_of(constraint, model);
    const std::string place = catcher.place("constraint", constraint.name, constraint.line);
    std::size_t count = 0;
    for (const std::string& name : constraint.surfaces)
    {
      const PreparedSurface& surface = catcher.surface(name, place);
      const std::size_t found = catcher.nodes_near(surface, constraint.within, constraint.crop, caught);
      count += found;
      if (found == 0)
        continue;
      const auto known =
          std::find_if(model.constraint_surfaces.begin(), model.constraint_surfaces.end(),
                       [&](const ConstraintSurface& other)
                       { return other.name == name && other.bone == bone && other.friction == constraint.friction; });
      const auto index = static_cast<std::int32_t>(known - model.constraint_surfaces.begin());
      if (known == model.constraint_surfaces.end())
        model.constraint_surfaces.push_back(
            { name, catcher.local_mesh(surface, bone >= 0), bone, constraint.friction });
      for (std::size_t n = 0; n < nodes; ++n)
      {
        if (std::isnan(caught[n]) || kind[n] > Kind::sliding ||
            (kind[n] == Kind::sliding && std::abs(distance[n]) <= std::abs(caught[n])))
          continue;
        kind[n] = Kind::sliding;
        of[n] = index;
        held_by[n] = static_cast<std::int32_t>(c);
        distance[n] = caught[n];
      }
    }
    if (count == 0)
      catcher.none(place, constraint.within);
  }

  for (std::size_t n = 0; n < nodes; ++n)
  {
    if (kind[n] == Kind::rigid)
      model.rigid.push_back({ static_cast<std::int32_t>(n), of[n], held_by[n] });
    else if (kind[n] == Kind::sliding)
      model.sliding.push_back({ static_cast<std::int32_t>(n), of[n], distance[n], held_by[n] });
  }
}

}  // namespace frontalis
