#include "bake/mesh/surface.hpp"

#include "bake/messages.hpp"

#include <set>

namespace frontalis
{

PreparedSurface::PreparedSurface(std::string name, TriangleMesh mesh)
    : name_(std::move(name)),
      mesh_(std::move(mesh)),
      tree_(mesh_),
      box_(bounding_box(mesh_)),
      rim_(unbalanced_edges(mesh_))
{
  // Pseudonormals: for an edge the sum of its faces' normals, for a vertex this sum weighted by the faces' angles.
  std::map<std::pair<std::int32_t, std::int32_t>, Vector3d> edges;
  vertex_normals_.assign(mesh_.vertices.size(), Vector3d::Zero());
  for (const Triangle& t : mesh_.triangles)
  {
    const auto v = corners(mesh_, t);
    const Vector3d normal = (v[1] - v[0]).cross(v[2] - v[0]).normalized();
    face_normals_.push_back(normal);
    for (std::size_t c = 0; c < 3; ++c)
    {
      const std::int32_t a = t[c], b = t[(c + 1) % 3];
      Vector3d& edge = edges.emplace(std::minmax(a, b), Vector3d::Zero()).first->second;
      edge += normal;
      const Vector3d e = (v[(c + 1) % 3] - v[c]).normalized(), f = (v[(c + 2) % 3] - v[c]).normalized();
      const double angle = std::acos(std::max(-1.0, std::min(1.0, e.dot(f))));
      vertex_normals_[a] += angle * normal;
    }
  }
  for (Vector3d& normal : vertex_normals_)
    normal.normalize();
  edge_normals_.reserve(mesh_.triangles.size());
  for (const Triangle& t : mesh_.triangles)
  {
    std::array<Vector3d, 3> normals;
    for (std::size_t c = 0; c < 3; ++c)
      normals[c] = edges.at(std::minmax(t[c], t[(c + 1) % 3])).normalized();
    edge_normals_.push_back(normals);
  }
}

double PreparedSurface::winding_variation(const Vector3d& p, double radius) const
{
  double sum = 0;
  for (const auto& edge : rim_)
  {
    const Vector3d a = vertex(mesh_, edge[0]), b = vertex(mesh_, edge[1]);
    const double distance = std::sqrt(squared_distance_to_segment(p, a, b)) - radius;
    if (distance <= 0)
      return 1e300;
    sum += (b - a).norm() / (distance * distance);
  }
  return radius * sum / (4 * pi);
}

bool PreparedSurface::rim_within(const Vector3d& p, double distance) const
{
  for (const auto& edge : rim_)
    if (squared_distance_to_segment(p, vertex(mesh_, edge[0]), vertex(mesh_, edge[1])) < distance * distance)
      return true;
  return false;
}

const Vector3d& PreparedSurface::pseudonormal(const ClosestPoint& closest) const
{
  const std::int32_t t = closest.triangle;
  if (closest.feature >= 4)
    return vertex_normals_[mesh_.triangles[t][closest.feature - 4]];
  if (closest.feature >= 1)
    return edge_normals_[t][closest.feature - 1];
  return face_normals_[t];
}

double PreparedSurface::signed_distance(const Vector3d& p, const ClosestPoint& closest) const
{
  return (p - closest.point).dot(pseudonormal(closest)) < 0 ? -closest.distance : closest.distance;
}

const PreparedSurface& named_surface(const PreparedSurfaces& surfaces, const std::string& name,
                                     const std::string& place)
{
  for (const auto& surface : surfaces)
    if (surface->name() == name)
      return *surface;
  throw Error(place + ": there is no surface '" + name + "'");
}

namespace
{

/// The surfaces that a bake needs: all but parts of heads that nothing in the scene names.
std::vector<const Surface*> needed_surfaces(const Scene& scene)
{
  std::set<std::string> named{ scene.skin.surface };
  const auto add = [&](const std::vector<std::string>& names) { named.insert(names.begin(), names.end()); };
  for (const Volume& v : scene.volumes)
  {
    for (const auto* names : { &v.closed_by, &v.inside, &v.outside, &v.without, &v.slits })
      add(*names);
    add({ v.within });
  }
  for (const SceneConstraint& constraint : scene.constraints)
  {
    add(constraint.surfaces);
    add({ constraint.on });
  }
  for (const SceneMaterial& material : scene.materials)
    add({ material.along });
  for (const Layer& layer : scene.layers)
    add({ layer.surface });
  for (const SceneMuscle& muscle : scene.muscles)
    add({ muscle.origin.surface, muscle.insertion.surface });
  for (const SceneLoad& load : scene.loads)
  {
    add({ load.surface });
    add(load.clear_of);
  }
  std::vector<const Surface*> needed;
  for (const Surface& surface : scene.surfaces)
    if (!surface.shape || !surface.shape->head || named.count(surface.name) > 0)
      needed.push_back(&surface);
  return needed;
}

}  // namespace

PreparedSurfaces prepare_surfaces(const Scene& scene, BakeMonitor& monitor)
{
  const std::vector<const Surface*> needed = needed_surfaces(scene);
  PreparedSurfaces prepared(needed.size());
  std::vector<LoadedSurface> loaded(needed.size());
  parallel_for(monitor, needed.size(), 1,
               [&](std::size_t s)
               {
                 const Surface& surface = *needed[s];
                 try
                 {
                   loaded[s] = load_surface(surface, scene.unit);
                 }
                 catch (const Error& error)
                 {
                   throw Error(place_in_scene(scene, "surface", surface) + ": " + error.what());
                 }
                 prepared[s] = std::make_unique<PreparedSurface>(surface.name, std::move(loaded[s].mesh));
               });
  for (const LoadedSurface& surface : loaded)
  {
    for (const std::string& finding : surface.findings)
      monitor.found(finding);
    for (const std::string& warning : surface.warnings)
      monitor.warn("{}", warning);
  }
  return prepared;
}

TriangleMesh join_surfaces(const std::vector<const PreparedSurface*>& parts)
{
  Box box;
  for (const PreparedSurface* part : parts)
    box.extend(part->box());

  // Winding numbers of each surface at points spread over the box.
  constexpr int points = 400;
  std::vector<std::vector<double>> winding(parts.size(), std::vector<double>(points));
  for (int i = 0; i < points; ++i)
  {
    const Vector3d p = spread_point(box, i);
    for (std::size_t s = 0; s < parts.size(); ++s)
      winding[s][i] = parts[s]->tree().winding_number(p);
  }

  // The surfaces may be oriented either way. Of all combinations of orientations, the one whose sums of winding numbers
  // are nearest to whole numbers is chosen. If these sums are negative, all surfaces are flipped.
  constexpr std::size_t most_combined_parts = 12;
  const std::size_t combinations = parts.size() > most_combined_parts ? 1 : std::size_t{ 1 } << (parts.size() - 1);
  const auto is_flipped = [](std::size_t combination, std::size_t part)
  { return part > 0 && (combination >> (part - 1) & 1) != 0; };
  std::size_t best = 0;
  double least = 1e300;
  bool negative = false;
  for (std::size_t combination = 0; combination < combinations; ++combination)
  {
    double error = 0, sum = 0;
    for (std::size_t i = 0; i < points; ++i)
    {
      double w = 0;
      for (std::size_t s = 0; s < parts.size(); ++s)
        w += is_flipped(combination, s) ? -winding[s][i] : winding[s][i];
      error += (w - std::round(w)) * (w - std::round(w));
      sum += w;
    }
    if (error < least - 1e-9)
    {
      least = error;
      best = combination;
      negative = sum < 0;
    }
  }

  TriangleMesh mesh;
  for (std::size_t s = 0; s < parts.size(); ++s)
    append(mesh, parts[s]->mesh(), is_flipped(best, s) != negative);
  join_vertices(mesh);
  return mesh;
}

}  // namespace frontalis
