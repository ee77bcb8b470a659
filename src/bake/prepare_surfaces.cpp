#include "frontalis/bake/forehead_shape.hpp"
#include "frontalis/error.hpp"
#include "parallel.hpp"
#include "surface.hpp"

#include <cmath>
#include <sstream>

namespace frontalis
{
namespace
{

/// An open mesh is inside-out where it encloses a place negatively: the largest winding number in its bounding box.
bool inside_out(const TriangleMesh& mesh, bool closed)
{
  if (closed)
    return signed_volume(mesh) < 0;
  const TriangleTree tree(mesh);
  const Box box = bounding_box(mesh);
  constexpr int steps = 6;
  double strongest = 0;
  for (int s = 0; s < steps * steps * steps; ++s)
  {
    const std::array<int, 3> cell{ { s % steps, s / steps % steps, s / steps / steps } };
    Vector3 p{};
    for (std::size_t a = 0; a < 3; ++a)
      p[a] = box.lower[a] + (cell[a] + 0.5) / steps * (box.upper[a] - box.lower[a]);
    const double w = tree.winding_number(p);
    if (std::abs(w) > std::abs(strongest))
      strongest = w;
  }
  // a patch or a dome encloses nothing well enough to tell
  return strongest < -0.75;
}

struct Loaded
{
  TriangleMesh mesh;
  std::vector<std::string> findings;
};

Loaded load(const Surface& surface)
{
  Loaded loaded;
  if (surface.shape)
    loaded.mesh =
        surface.shape->kind == Shape::Kind::forehead ? make_forehead(*surface.shape) : make_shape(*surface.shape);
  else
    loaded.mesh = import_mesh(surface.file, surface.unit);
  TriangleMesh& mesh = loaded.mesh;
  const auto found = [&](const std::string& text)
  { loaded.findings.push_back("surface '" + surface.name + "': " + text); };

  const std::size_t dropped = join_vertices(mesh);
  if (mesh.triangles.empty())
    throw Error("has no triangle whose corners differ; a surface is wanted");
  if (!surface.shape && dropped > 0)
    found(std::to_string(dropped) + " triangles with a corner twice left out");
  const std::size_t turned = make_orientation_consistent(mesh);
  if (turned > 0)
    found(std::to_string(turned) + " triangles turned to agree with their neighbours");
  const Edges rim = unbalanced_edges(mesh);
  if (inside_out(mesh, rim.empty()))
  {
    flip(mesh);
    found("was inside-out; turned");
  }
  if (!rim.empty() && !surface.shape)
    found("is open, with " + std::to_string(rim.size()) + " boundary edges");
  return loaded;
}

}  // namespace

std::vector<std::unique_ptr<PreparedSurface>> prepare_surfaces(const Scene& scene, Stages& stages)
{
  std::vector<std::unique_ptr<PreparedSurface>> prepared(scene.surfaces.size());
  std::vector<Loaded> loaded(scene.surfaces.size());
  parallel_for(
      scene.surfaces.size(),
      [&](std::size_t s)
      {
        const Surface& surface = scene.surfaces[s];
        try
        {
          loaded[s] = load(surface);
          prepared[s] = std::make_unique<PreparedSurface>(surface.name, std::move(loaded[s].mesh), surface.line);
        }
        catch (const Error& error)
        {
          throw Error(scene.file + ":" + std::to_string(surface.line) + ": surface '" + surface.name +
                      "': " + error.what());
        }
      },
      &stages);
  for (const Loaded& surface : loaded)
  {
    for (const std::string& finding : surface.findings)
      stages.found(finding);
  }
  return prepared;
}

TriangleMesh join_surfaces(const std::vector<const PreparedSurface*>& parts)
{
  Box box;
  for (const PreparedSurface* part : parts)
    box.include(part->box());

  // winding numbers of each part at points spread over the box (R3 sequence, Roberts 2018)
  constexpr int points = 400;
  std::vector<std::vector<double>> winding(parts.size(), std::vector<double>(points));
  for (int i = 0; i < points; ++i)
  {
    const Vector3 step{ 0.8191725133961645, 0.6710436067037893, 0.5497004779019703 };
    Vector3 p{};
    for (std::size_t a = 0; a < 3; ++a)
      p[a] = box.lower[a] + std::fmod(0.5 + (i + 1) * step[a], 1.0) * (box.upper[a] - box.lower[a]);
    for (std::size_t s = 0; s < parts.size(); ++s)
      winding[s][static_cast<std::size_t>(i)] = parts[s]->tree().winding_number(p);
  }

  // of all ways to turn the parts, the one whose sum is nearest to whole numbers; the first part decides the overall
  // sense
  const std::size_t ways = parts.size() > 12 ? 1 : std::size_t{ 1 } << (parts.size() - 1);
  std::size_t best = 0;
  double least = 1e300;
  double sense = 1;
  for (std::size_t way = 0; way < ways; ++way)
  {
    double fault = 0, sum = 0;
    for (std::size_t i = 0; i < points; ++i)
    {
      double w = winding[0][i];
      for (std::size_t s = 1; s < parts.size(); ++s)
        w += (way >> (s - 1) & 1) != 0 ? -winding[s][i] : winding[s][i];
      fault += (w - std::round(w)) * (w - std::round(w));
      sum += w;
    }
    if (fault < least - 1e-9)
    {
      least = fault;
      best = way;
      sense = sum < 0 ? -1 : 1;
    }
  }

  TriangleMesh mesh;
  for (std::size_t s = 0; s < parts.size(); ++s)
  {
    const bool turned = (s > 0 && (best >> (s - 1) & 1) != 0) != (sense < 0);
    const auto base = static_cast<std::int32_t>(mesh.vertices.size());
    const TriangleMesh& part = parts[s]->mesh();
    mesh.vertices.insert(mesh.vertices.end(), part.vertices.begin(), part.vertices.end());
    for (const Triangle& t : part.triangles)
      mesh.triangles.push_back(turned ? Triangle{ base + t[0], base + t[2], base + t[1] }
                                      : Triangle{ base + t[0], base + t[1], base + t[2] });
  }
  join_vertices(mesh);
  return mesh;
}

}  // namespace frontalis
