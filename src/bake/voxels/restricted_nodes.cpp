#include "bake/voxels/model_stages.hpp"

#include "frontalis/model/sample_field.hpp"
#include "bake/fibres/fibres.hpp"
#include "bake/messages.hpp"
#include "bake/voxels/tissue_sheet.hpp"

namespace frontalis
{
namespace
{

constexpr std::size_t nodes_per_task = 4096;

/// Signed distance [m] of each node that a surface restricts; NaN for all other nodes.
using Distances = std::vector<double>;

/// Finds the nodes that a surface restricts.
class NodeFinder
{
public:
  NodeFinder(const LocalFrame& frame, const Model& model, BakeMonitor& monitor)
      : frame_(frame), model_(model), monitor_(monitor)
  {
    edge_ = std::max({ model.spacing[0], model.spacing[1], model.spacing[2] });
    positions_.reserve(model.nodes.size());
    for (std::size_t n = 0; n < model.nodes.size(); ++n)
      positions_.push_back(frame.to_scene(to_vector(rest_position(model, n))));
    if (frame.gaps == nullptr)
      return;
    voxels_of_.resize(model.nodes.size());
    for (std::size_t e = 0; e < model.voxels.size(); ++e)
      if (frame.gaps->near_gap(frame.voxel_centre(model, e)))
        for (const std::int32_t n : model.voxel_nodes[e])
          voxels_of_[n].push_back(e);
  }

  /// Distances of nodes from a surface of a constraint or a load. A `within` below 0 means the default. The crop takes
  /// those nodes that lie in it or, with `crop_surface`, those whose closest point on the surface does.
  Distances find(const PreparedSurface& surface, double within, const Region& crop, bool crop_surface = false)
  {
    const double reach = reach_of(within);
    const double side = tissue_side(surface);
    const double bound = std::max(reach, side == 0 ? 0 : 2 * edge_);
    const Box box = to_box(crop);
    Distances distances(positions_.size(), std::nan(""));
    parallel_for(monitor_, positions_.size(), nodes_per_task,
                 [&](std::size_t n)
                 {
                   const Vector3d& p = positions_[n];
                   if (box.squaredExteriorDistance(p) > (crop_surface ? bound * bound : 0) ||
                       surface.box().squaredExteriorDistance(p) > bound * bound)
                     return;
                   const ClosestPoint closest = surface.tree().closest(p, bound);
                   if (closest.triangle < 0 || (crop_surface && !box.contains(closest.point)))
                     return;
                   // accept farther nodes on the far side of the surface, but not those beside an open surface
                   const double height = (p - closest.point).dot(surface.pseudonormal(closest));
                   if ((closest.distance <= reach || side * height < -0.5 * closest.distance) &&
                       tissue_extends(n, closest.point))
                     distances[n] = surface.signed_distance(p, closest);
                 });
    return distances;
  }

  double reach_of(double within) const { return within < 0 ? 0.75 * edge_ : within; }
  double edge() const { return edge_; }

  /// The part of a surface that nodes may slide on. `others`: surfaces that restrict nodes too; see tissue_sheet().
  const PreparedSurface& sheet_of(const PreparedSurface& surface, std::vector<const PreparedSurface*> others)
  {
    auto& sheet = sheet_[&surface];
    others.erase(std::remove(others.begin(), others.end(), &surface), others.end());
    if (!sheet)
      sheet = std::make_unique<PreparedSurface>(surface.name(),
                                                tissue_sheet(surface, tissue_side(surface), others, frame_, model_));
    return *sheet;
  }

  /// tissue_side() of tissue_sheet.hpp, found once per surface
  double tissue_side(const PreparedSurface& surface)
  {
    const auto known = side_.find(&surface);
    if (known != side_.end())
      return known->second;
    return side_[&surface] = frontalis::tissue_side(surface, frame_, model_);
  }

private:
  /// Whether the tissue around a node extends to a point of a surface, or there is a gap in between.
  bool tissue_extends(std::size_t node, const Vector3d& point) const
  {
    if (voxels_of_.empty() || voxels_of_[node].empty())
      return true;
    return std::any_of(voxels_of_[node].begin(), voxels_of_[node].end(),
                       [&](std::size_t e)
                       { return frame_.gaps->extends_to(frame_.voxel_centre(model_, e), flap_of(model_, e), point); });
  }

  const LocalFrame& frame_;
  const Model& model_;
  BakeMonitor& monitor_;
  std::vector<std::vector<std::size_t>> voxels_of_;  ///< for each node its voxels near gaps; empty without gaps
  double edge_ = 0;                                  ///< longest edge of a voxel [m]
  std::vector<Vector3d> positions_;
  std::map<const PreparedSurface*, double> side_;
  std::map<const PreparedSurface*, std::unique_ptr<PreparedSurface>> sheet_;
};

/// Whether only one constraint holds ends of a muscle. With two, each may hold one end.
bool named_once(const Scene& scene, const std::string& muscle)
{
  const auto names = [&muscle](const SceneConstraint& constraint)
  { return std::count(constraint.of.begin(), constraint.of.end(), muscle) > 0; };
  return std::count_if(scene.constraints.begin(), scene.constraints.end(), names) == 1;
}

}  // namespace

std::int32_t bone_of(const std::string& name, Model& model)
{
  if (name.empty())
    return -1;
  const auto known = std::find(model.bones.begin(), model.bones.end(), name);
  const auto bone = static_cast<std::int32_t>(known - model.bones.begin());
  if (known == model.bones.end())
    model.bones.push_back(name);
  return bone;
}

void restrict_nodes(const Scene& scene, const PreparedSurfaces& surfaces, const std::vector<MuscleFibres>& fibres,
                    const LocalFrame& frame, Model& model, BakeMonitor& monitor)
{
  NodeFinder finder(frame, model, monitor);
  const std::size_t nodes = model.nodes.size();
  enum class Kind : std::int8_t
  {
    free,
    sliding,
    prescribed,
    rigid
  };
  struct Restriction
  {
    Kind kind = Kind::free;
    std::int32_t of = -1;  // bone of a rigid node, surface of a sliding one
    std::int32_t constraint = -1;
    double distance = 0;  // distance of a sliding node from its surface [m]
  };
  std::vector<Restriction> restrictions(nodes);
  std::vector<const PreparedSurface*> bones;  // surfaces that restrict nodes
  for (const SceneConstraint& constraint : scene.constraints)
    if (constraint.restricts_nodes())
      for (const std::string& name : constraint.surfaces)
        bones.push_back(&named_surface(surfaces, name, place_in_scene(scene, "constraint", constraint)));
  // calls restrict(node, distance, surface) for the nodes that surfaces of a constraint or a load restrict; with
  // `slides`, `surface` is the sheet of the surface that faces tissue
  const auto for_each_node = [&](const std::string& place, const std::vector<std::string>& names, const auto& part,
                                 const auto& restrict, bool slides = false, bool crop_surface = false)
  {
    bool any = false;
    for (const std::string& name : names)
    {
      const PreparedSurface& whole = named_surface(surfaces, name, place);
      const PreparedSurface& surface = slides ? finder.sheet_of(whole, bones) : whole;
      const Distances distances = finder.find(surface, part.within, part.crop, crop_surface);
      for (std::size_t n = 0; n < nodes; ++n)
      {
        if (std::isnan(distances[n]))
          continue;
        any = true;
        restrict(n, distances[n], surface);
      }
    }
    if (!any)
      throw failure(
          "{}: no tissue node lies within {} of its surface inside its crop; check the surface, the crop and 'within'",
          place, length_text(finder.reach_of(part.within), scene.unit));
  };

  for (std::size_t c = 0; c < scene.constraints.size(); ++c)
  {
    const SceneConstraint& constraint = scene.constraints[c];
    model.constraints.push_back(constraint.name);
    if (constraint.kind != SceneConstraint::Kind::rigid)
      continue;
    const std::int32_t bone = bone_of(constraint.bone, model);
    const std::string place = place_in_scene(scene, "constraint", constraint);
    std::vector<bool> near(nodes, false);
    for_each_node(
        place, constraint.surfaces, constraint, [&](std::size_t n, double, const PreparedSurface&) { near[n] = true; },
        false, attaches(scene, constraint));
    std::vector<bool> held = constraint.of.empty() ? near : std::vector<bool>(nodes, false);
    for (const std::string& name : constraint.of)
    {
      const auto m = static_cast<std::size_t>(index_of(scene.muscles, name, place, "muscle"));
      const MuscleEndNodes origin = origin_nodes(m, fibres[m], near, frame, model);
      if (origin.nodes.empty())
        throw failure(
            "{}: of: neither end of muscle '{}' lies within {} of these surfaces inside the crop; check the "
            "muscle's origin and 'within'",
            place, name, length_text(finder.reach_of(constraint.within), scene.unit));
      if (fibres[m].from_origin && !origin.at_origin && named_once(scene, name))
        monitor.warn(
            "{}: of: muscle '{}' is held at its insertion, because its origin is farther than {} from these surfaces; "
            "check the place of the muscle",
            place, name, length_text(finder.reach_of(constraint.within), scene.unit));
      for (const std::size_t n : origin.nodes)
        held[n] = true;
    }
    for (std::size_t n = 0; n < nodes; ++n)
      if (held[n] && restrictions[n].kind != Kind::rigid)
        restrictions[n] = { Kind::rigid, bone, static_cast<std::int32_t>(c) };
  }

  for (std::size_t l = 0; l < scene.loads.size(); ++l)
  {
    const SceneLoad& load = scene.loads[l];
    if (load.kind != SceneLoad::Kind::displacement)
      continue;
    const std::string place = place_in_scene(scene, "load", load);
    const std::size_t before = model.prescribed.size();
    std::size_t twice = 0;
    for_each_node(place, { load.surface }, load,
                  [&](std::size_t n, double, const PreparedSurface&)
                  {
                    if (restrictions[n].kind == Kind::rigid)
                      return;
                    twice += restrictions[n].kind == Kind::prescribed ? 1 : 0;
                    restrictions[n].kind = Kind::prescribed;
                    model.prescribed.push_back({ static_cast<std::int32_t>(n), static_cast<std::int32_t>(l) });
                  });
    if (model.prescribed.size() == before)
      monitor.warn("{} moves nothing: constraints hold all nodes near its surface; check its surface and crop", place);
    if (twice > 0)
      monitor.warn("{} moves {} that another load moves as well: part their surfaces or crops", place,
                   count_text(twice, "node", "nodes"));
  }

  // For each field of the model, its surfaces. Surfaces that move alike and have tissue on the same side share a field,
  // so that nodes can slide from one to the next; a sphere has a field of its own.
  std::vector<std::vector<SlidingSurface>> sheets;
  for (std::size_t c = 0; c < scene.constraints.size(); ++c)
  {
    const SceneConstraint& constraint = scene.constraints[c];
    if (constraint.kind != SceneConstraint::Kind::sliding)
      continue;
    const std::int32_t bone = bone_of(constraint.bone, model);
    // finds or adds the field for a sheet; returns its index among the model's surfaces
    const auto index_of = [&](const PreparedSurface& sheet)
    {
      auto& list = model.constraint_surfaces;
      const PreparedSurface& whole = named_surface(surfaces, sheet.name(), "");
      std::size_t index = 0;
      for (; index < list.size(); ++index)
      {
        const PreparedSurface& first = *sheets[index].front().whole;
        const bool moves_alike = list[index].bone == bone && list[index].friction == constraint.friction;
        const bool joins =
            !is_sphere(first) && !is_sphere(whole) && finder.tissue_side(first) == finder.tissue_side(whole);
        if (moves_alike && (&first == &whole || joins))
          break;
      }
      if (index == list.size())
      {
        list.push_back({ {}, bone, constraint.friction, {} });
        sheets.emplace_back();
      }
      std::vector<SlidingSurface>& sheets_here = sheets[index];
      const auto is_it = [&](const SlidingSurface& other) { return other.whole == &whole; };
      if (std::none_of(sheets_here.begin(), sheets_here.end(), is_it))
      {
        list[index].name += (sheets_here.empty() ? "" : ", ") + sheet.name();
        sheets_here.push_back({ &whole, &sheet });
      }
      return static_cast<std::int32_t>(index);
    };
    std::map<const PreparedSurface*, std::int32_t> indices;
    for_each_node(
        place_in_scene(scene, "constraint", constraint), constraint.surfaces, constraint,
        [&](std::size_t n, double d, const PreparedSurface& sheet)
        {
          std::int32_t& index = indices.try_emplace(&sheet, -1).first->second;
          if (index < 0)
            index = index_of(sheet);
          const Restriction& known = restrictions[n];
          if (known.kind < Kind::sliding || (known.kind == Kind::sliding && std::abs(d) < std::abs(known.distance)))
            restrictions[n] = { Kind::sliding, index, static_cast<std::int32_t>(c), d };
        },
        true, attaches(scene, constraint));
  }

  // Nodes may also slide on to bones that hold other nodes rigidly: add the sheets of these bones.
  for (std::size_t s = 0; s < sheets.size(); ++s)
    for (const SceneConstraint& constraint : scene.constraints)
      if (constraint.kind == SceneConstraint::Kind::rigid &&
          bone_of(constraint.bone, model) == model.constraint_surfaces[s].bone)
        for (const std::string& name : constraint.surfaces)
        {
          const PreparedSurface& first = *sheets[s].front().whole;
          const PreparedSurface& whole = named_surface(surfaces, name, "");
          const auto is_it = [&](const SlidingSurface& other) { return other.whole == &whole; };
          if (is_sphere(first) || is_sphere(whole) || finder.tissue_side(first) != finder.tissue_side(whole) ||
              std::any_of(sheets[s].begin(), sheets[s].end(), is_it))
            continue;
          const PreparedSurface& sheet = finder.sheet_of(whole, bones);
          // a sheet that is the whole surface means that no tissue faces it
          if (sheet.mesh().triangles.size() < whole.mesh().triangles.size())
            sheets[s].push_back({ &whole, &sheet });
        }

  std::vector<std::vector<std::array<double, 3>>> rest(sheets.size());  // positions of the nodes that slide on each
  for (std::size_t n = 0; n < nodes; ++n)
    if (restrictions[n].kind == Kind::sliding)
      rest[restrictions[n].of].push_back(rest_position(model, static_cast<std::int32_t>(n)));
  // add all nodes near a surface: attach_nodes() later makes some of them masters, which need the field too
  for (std::size_t s = 0; s < sheets.size() && scene.accuracy.boundary == "true"; ++s)
    for (const SlidingSurface& surface : sheets[s])
    {
      const Distances distances = finder.find(*surface.sheet, 3.5 * finder.edge(), Region());
      for (std::size_t n = 0; n < nodes; ++n)
        if (!std::isnan(distances[n]))
          rest[s].push_back(rest_position(model, static_cast<std::int32_t>(n)));
    }
  for (std::size_t s = 0; s < sheets.size(); ++s)
    model.constraint_surfaces[s].field = distance_field(sheets[s], rest[s], frame, model, monitor);

  for (std::size_t n = 0; n < nodes; ++n)
  {
    const auto node = static_cast<std::int32_t>(n);
    const auto& [kind, of, constraint, distance] = restrictions[n];
    if (kind == Kind::rigid)
      model.rigid.push_back({ node, of, constraint });
    else if (kind == Kind::sliding)
      model.sliding.push_back(
          { node, of, level_at(model.constraint_surfaces[of].field, rest_position(model, node)), constraint });
  }
  if (model.rigid.size() == nodes)
    monitor.warn("{}: constraints hold every node, so that no tissue is free; check their surfaces and 'within'",
                 scene.file);
  for (std::size_t c = 0; c < scene.constraints.size(); ++c)
    if (scene.constraints[c].restricts_nodes() &&
        std::none_of(restrictions.begin(), restrictions.end(),
                     [c](const Restriction& of) { return of.constraint == static_cast<std::int32_t>(c); }))
      monitor.warn("{}: holds no node, because other constraints or loads hold all nodes near its surfaces",
                   place_in_scene(scene, "constraint", scene.constraints[c]));
}

}  // namespace frontalis
