#include "bake/voxels/contact_bodies.hpp"

#include "bake/mesh/cluster_search.hpp"
#include "bake/mesh/halve_edges.hpp"
#include "bake/mesh/remesh.hpp"
#include "bake/messages.hpp"
#include "frontalis/model/sample_field.hpp"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>

namespace frontalis
{
namespace
{

constexpr double largest_spacing = 0.5e-3;  // largest distance between samples of the field [m]
constexpr double spacing_share = 0.5;       // largest distance between samples, in shortest voxel edges
constexpr double reach_share = 2;           // reach of the field from a surface, in longest voxel edges
constexpr double deepest_inside = 20e-3;    // reach of the field into a body, more than the thickness of tissue [m]
constexpr double shown_tolerance = 150e-6;  // by which skin that is only shown may be off its surface [m]
constexpr double overlap_share = 0.5;       // largest depth of tissue in a body at rest, in shortest voxel edges

// A closed surface. The distance from it is positive outside.
struct Body
{
  const PreparedSurface* surface;
  double sign;
};

Body closed_body(const PreparedSurface& surface, const std::string& place)
{
  if (!surface.closed())
    throw Error(
        fmt::format("{}: surface '{}' is open, so that it has no inside that tissue could be kept out of; close "
                    "it, or take a part of it that is closed",
                    place, surface.name()));
  return { &surface, signed_volume(surface.mesh()) < 0 ? -1.0 : 1.0 };
}

// Distance from the union of several bodies, of a point in local coordinates. `extent`: see ClusterSearch.
Distance distance_from(const std::vector<Body>& bodies, const LocalFrame& frame, double extent)
{
  std::vector<ClusterSearch> searches;
  searches.reserve(bodies.size());
  for (const Body& body : bodies)
    searches.emplace_back(body.surface->tree(), extent);
  using OfThread = tbb::enumerable_thread_specific<std::vector<ClusterSearch>>;
  return [&, of_thread = std::make_shared<OfThread>(searches)](const std::array<double, 3>& local)
  {
    std::vector<ClusterSearch>& search = of_thread->local();
    const Vector3d p = frame.to_scene(to_vector(local));
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t b = 0; b < bodies.size(); ++b)
      least = std::min(least, bodies[b].sign * bodies[b].surface->signed_distance(p, search[b].closest(p)));
    return least;
  };
}

SampledField field_of(const std::vector<Body>& bodies, const LocalFrame& frame, const Model& model, double reach,
                      BakeMonitor& monitor)
{
  Box box;
  for (const Body& body : bodies)
    for (const Vector3& v : body.surface->mesh().vertices)
      box.extend(frame.to_local(to_vector(v)));
  const double edge = *std::min_element(model.spacing.begin(), model.spacing.end());
  const double spacing = std::min(largest_spacing, spacing_share * edge);
  return sample_band(
      to_array(box.min()), to_array(box.max()), distance_from(bodies, frame, cluster_extent * spacing), spacing, reach,
      [&](std::size_t count, const std::function<void(std::size_t)>& body) { parallel_for(monitor, count, 1, body); },
      deepest_inside);
}

}  // namespace

namespace
{
void add_shape(const TriangleMesh& mesh, const LocalFrame& frame, Contact& contact)
{
  const auto first = static_cast<std::int32_t>(contact.shape.vertices.size());
  for (const Vector3& v : mesh.vertices)
    contact.shape.vertices.push_back(to_array(frame.to_local(to_vector(v))));
  for (const Triangle& t : mesh.triangles)
    contact.shape.triangles.push_back({ t[0] + first, t[1] + first, t[2] + first });
}

// Centre of the box around a mesh.
Vector3 centre_of(const TriangleMesh& mesh)
{
  Box box;
  for (const Vector3& v : mesh.vertices)
    box.extend(to_vector(v));
  return to_array(box.center());
}

// Whether a region has a side.
bool is_bounded(const Region& region) { return region.lower != Region{}.lower || region.upper != Region{}.upper; }

// The part of a mesh outside of a region. It has the same points on the region's sides as cut_mesh(mesh, region).
TriangleMesh part_beyond(const TriangleMesh& mesh, const Region& region)
{
  TriangleMesh beyond;
  Region rest;
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    Region below = rest, above = rest;
    below.upper[axis] = region.lower[axis];
    above.lower[axis] = region.upper[axis];
    if (std::isfinite(region.lower[axis]))
      append(beyond, cut_mesh(mesh, below));
    if (std::isfinite(region.upper[axis]))
      append(beyond, cut_mesh(mesh, above));
    rest.lower[axis] = region.lower[axis];
    rest.upper[axis] = region.upper[axis];
  }
  return beyond;
}

// The part of a mesh inside `region` and `box`, a little below the mesh: the deeper, the farther from the region's
// sides.
TriangleMesh part_below(const TriangleMesh& mesh, const Region& region, const Region& box)
{
  constexpr double slope = 0.12;  // depth divided by the distance from the closest side
  TriangleMesh below = cut_mesh(cut_mesh(mesh, region), box);
  const std::vector<Vector3d> normals = vertex_normals(below);
  for (std::size_t v = 0; v < below.vertices.size(); ++v)
  {
    Vector3& p = below.vertices[v];
    double away = std::numeric_limits<double>::infinity();
    for (std::size_t axis = 0; axis < 3; ++axis)
      away = std::min({ away, p[axis] - region.lower[axis], region.upper[axis] - p[axis] });
    p = to_array(to_vector(p) - slope * std::max(0.0, away) * normals[v]);
  }
  return below;
}

// Throws Error if the crop of surfaces that are only shown has nothing to act on.
void check_shown_crop(const Scene& scene, const SceneConstraint& constraint, const std::string& place)
{
  const std::vector<std::string>& shown = constraint.surfaces;
  if (std::find(shown.begin(), shown.end(), scene.skin.surface) == shown.end())
    throw failure(
        "{}: 'crop' stands beside '{}'; it takes a part of the skin's surface, '{}': show that surface, or leave out "
        "'crop'",
        place, fmt::join(shown, "', '"), scene.skin.surface);
  if (!is_bounded(scene.skin.crop))
    throw failure(
        "{}: 'crop' shows a part of '{}' below the skin, but the skin has no crop, so that it is that whole surface: "
        "give 'skin' a 'crop', or leave out this one",
        place, scene.skin.surface);
}

// Merges the points that lie in the same eighth of a voxel into one point at their centroid, with the sum of their
// areas. More points distribute a pressure no better to the nodes of voxels, but each of them costs time. The two sides
// of a sheet that is thinner than that stay apart. `surface` has the points as its vertices.
void thin_out(Contact& contact, const TriangleMesh& surface)
{
  const std::vector<Vector3d> normals = vertex_normals(surface);
  std::map<std::array<int, 4>, std::array<std::vector<std::size_t>, 2>> cells;
  for (std::size_t p = 0; p < contact.points.size(); ++p)
  {
    const auto& at = contact.binding.coordinates[p];
    const auto half = [&](std::size_t axis) { return static_cast<int>(std::floor(2 * at[axis])); };
    auto& sides = cells[{ contact.binding.voxel[p], half(0), half(1), half(2) }];
    const bool other = !sides[0].empty() && normals[p].dot(normals[sides[0].front()]) < 0;
    sides[other ? 1 : 0].push_back(p);
  }
  Contact thin;
  const auto merge = [&](std::int32_t voxel, const std::vector<std::size_t>& points)
  {
    double area = 0;
    Vector3d place = Vector3d::Zero(), in_voxel = Vector3d::Zero();
    for (const std::size_t p : points)
    {
      const auto& at = contact.binding.coordinates[p];
      area += contact.area[p];
      place += contact.area[p] * to_vector(contact.points[p]);
      in_voxel += contact.area[p] * Vector3d(at[0], at[1], at[2]);
    }
    if (!(area > 0))
      return;
    const Vector3d at = in_voxel / area;
    thin.points.push_back(to_array(place / area));
    thin.area.push_back(area);
    thin.binding.voxel.push_back(voxel);
    thin.binding.coordinates.push_back(
        { static_cast<float>(at[0]), static_cast<float>(at[1]), static_cast<float>(at[2]) });
  };
  for (const auto& [cell, sides] : cells)
    for (const std::vector<std::size_t>& points : sides)
      merge(cell[0], points);
  contact.points = std::move(thin.points);
  contact.area = std::move(thin.area);
  contact.binding = std::move(thin.binding);
}

// Throws Error if tissue is in a body at rest, because contact would throw the tissue out.
void check_overlap(const Scene& scene, const std::string& place, const Contact& contact,
                   const std::vector<Body>& bodies, const LocalFrame& frame, const Model& model)
{
  const double allowed = overlap_share * *std::min_element(model.spacing.begin(), model.spacing.end());
  const Distance distance = distance_from(bodies, frame, cluster_extent * largest_spacing);
  double deepest = 0;
  Vector3d where{ 0, 0, 0 };
  for (const auto& p : contact.points)
    if (const double level = distance(p).value; level < -deepest)
    {
      deepest = -level;
      where = frame.to_scene(to_vector(p));
    }
  if (deepest > allowed)
    throw Error(fmt::format(
        "{}: at rest its surface lies {} inside of the body, for example at {}; at most {}, half of a "
        "voxel, are allowed: move the body away, or crop the part that it must not touch",
        place, length_text(deepest, scene.unit), place_text(where, scene.unit), length_text(allowed, scene.unit)));
}

}  // namespace

void bind_contacts(const Scene& scene, const PreparedSurfaces& surfaces, const LocalFrame& frame, Model& model,
                   BakeMonitor& monitor)
{
  const double extrapolation = extrapolation_of(scene, model);
  for (const SceneConstraint& constraint : scene.constraints)
  {
    if (constraint.kind != SceneConstraint::Kind::contact)
      continue;
    const std::string place = place_in_scene(scene, "constraint", constraint);
    Contact contact;
    contact.name = constraint.name;
    contact.bone = bone_of(constraint.bone, model);
    contact.friction = constraint.friction;
    contact.reach = reach_share * *std::max_element(model.spacing.begin(), model.spacing.end());

    // no tissue touches a body that is only shown
    if (constraint.within == 0)
    {
      if (is_bounded(constraint.crop))
        check_shown_crop(scene, constraint, place);
      for (const std::string& name : constraint.surfaces)
      {
        TriangleMesh mesh = named_surface(surfaces, name, place).mesh();
        if (name == scene.skin.surface)
        {
          TriangleMesh rest = with_fewer_triangles(part_beyond(mesh, scene.skin.crop), shown_tolerance);
          if (is_bounded(constraint.crop))
            append(rest, with_fewer_triangles(part_below(mesh, scene.skin.crop, constraint.crop), shown_tolerance));
          join_vertices(rest);
          mesh = std::move(rest);
        }
        add_shape(mesh, frame, contact);
      }
      if (contact.shape.triangles.empty())
        throw Error(place + ": the skin's crop leaves nothing to show; leave out this constraint, or crop the skin");
      contact.centre = centre_of(contact.shape);
      contact.field = sphere_field(contact.centre, contact.reach);
      model.contacts.push_back(std::move(contact));
      continue;
    }

    std::vector<Body> bodies;
    for (const std::string& name : constraint.surfaces)
      bodies.push_back(closed_body(named_surface(surfaces, name, place), place));
    const auto shape_of = [&](const std::string& name)
    {
      return std::find_if(scene.surfaces.begin(), scene.surfaces.end(),
                          [&](const Surface& surface) { return surface.name == name; })
          ->shape;
    };
    for (const Body& body : bodies)
      add_shape(body.surface->mesh(), frame, contact);
    contact.centre = centre_of(contact.shape);
    if (const auto& push = constraint.pushed)
    {
      contact.mass = push->mass;
      contact.force = frame.turn(push->force);
      contact.spring = push->spring;
      contact.damping = push->damping;
    }
    const auto shape = shape_of(constraint.surfaces.front());
    if (bodies.size() == 1 && shape && shape->kind == Shape::Kind::sphere)
      contact.field = sphere_field(to_array(frame.to_local(to_vector(shape->centre))), shape->radius);
    else
      contact.field = field_of(bodies, frame, model, contact.reach, monitor);

    const std::string& on = constraint.on.empty() ? scene.skin.surface : constraint.on;
    const TriangleMesh surface = refined(named_surface(surfaces, on, place).mesh(), to_box(constraint.crop),
                                         *std::min_element(model.spacing.begin(), model.spacing.end()));
    const BoundMesh bound = bind_mesh(surface, constraint.crop, frame, model, extrapolation, monitor);
    if (bound.mesh.triangles.empty())
      throw Error(
          fmt::format("{}: no triangle of surface '{}' lies in its crop and within {} of the tissue; check 'on' "
                      "and the crop",
                      place, on, length_text(extrapolation, scene.unit)));
    if (bound.too_far > 0)
      monitor.found(fmt::format("constraint '{}': {} triangles of '{}' left out, too far from the tissue",
                                constraint.name, bound.too_far, on));
    set_points(contact, bound.mesh, bound.binding);
    check_overlap(scene, place, contact, bodies, frame, model);
    thin_out(contact, bound.mesh);
    model.contacts.push_back(std::move(contact));
  }
}

}  // namespace frontalis
