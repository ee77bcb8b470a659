#include "solver/contact/touching_surface.hpp"

#include "solver/contact/body_motion.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <queue>

namespace frontalis
{
namespace
{

using Vector = TouchingSurface::Vector;

// Parts of a surface whose distance along the surface is below this length, in voxel edges, never touch.
constexpr double joined_within = 2;

// If the cosine of the angle between two triangles is below this value, their common edge is a crease, where vertices
// have two normals.
constexpr double crease = 0.5;

struct Facet
{
  Vector area;    // normal whose length is the triangle's area [m2]
  Vector normal;  // unit vector
};

std::vector<Facet> facets_of(const TriangleMesh& mesh)
{
  std::vector<Facet> facets;
  for (const auto& t : mesh.triangles)
  {
    const Vector a = vector_of(mesh.vertices[t[0]]);
    const Vector area = 0.5 * cross(vector_of(mesh.vertices[t[1]]) - a, vector_of(mesh.vertices[t[2]]) - a);
    facets.push_back({ area, (1 / std::max(norm(area), 1e-30)) * area });
  }
  return facets;
}

// For each corner of each triangle, the neighbour across the opposite edge; -1 if the edge does not belong to exactly
// two triangles, if their orientations disagree, or if the edge is a crease.
std::vector<std::array<std::int32_t, 3>> smooth_neighbours(const TriangleMesh& mesh, const std::vector<Facet>& facets)
{
  using Side = std::pair<std::int32_t, std::size_t>;  // a triangle and one of its corners
  std::map<std::pair<std::int32_t, std::int32_t>, std::vector<Side>> edges;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i)
    {
      const auto from = mesh.triangles[t][(i + 1) % 3], to = mesh.triangles[t][(i + 2) % 3];
      edges[std::minmax(from, to)].push_back({ static_cast<std::int32_t>(t), i });
    }
  std::vector<std::array<std::int32_t, 3>> neighbours(mesh.triangles.size(), { { -1, -1, -1 } });
  for (const auto& [ends, sides] : edges)
  {
    if (sides.size() != 2)
      continue;
    const auto [t, i] = sides[0];
    const auto [s, j] = sides[1];
    const bool same_turn = mesh.triangles[t][(i + 1) % 3] == mesh.triangles[s][(j + 2) % 3];
    if (!same_turn || dot(facets[t].normal, facets[s].normal) < crease)
      continue;
    neighbours[t][i] = s;
    neighbours[s][j] = t;
  }
  return neighbours;
}

void set_frame(TouchingSurface::Vertex& v)
{
  const Vector& n = v.normal;
  const Vector axis = std::abs(n.x) < 0.7 ? Vector{ 1, 0, 0 } : Vector{ 0, 1, 0 };
  const Vector first = cross(axis, n);
  v.tangent[0] = (1 / norm(first)) * first;
  v.tangent[1] = cross(n, v.tangent[0]);
}

}  // namespace

TouchingSurface::TouchingSurface(const Model& model)
    : edge(*std::min_element(model.spacing.begin(), model.spacing.end())), model_(model)
{
  std::int32_t sources = 0;
  joined_begin_.assign(1, 0);
  for (std::size_t c = 0; c < model.self_contacts.size(); ++c)
  {
    add(static_cast<std::int32_t>(c), sources);
    sources += static_cast<std::int32_t>(model.self_contacts[c].surface.vertices.size());
  }
  sort_vertices();
}

void TouchingSurface::add(std::int32_t contact, std::int32_t first_source)
{
  const SelfContact& from = model_.self_contacts[contact];
  const TriangleMesh& mesh = from.surface;
  const std::vector<Facet> facets = facets_of(mesh);
  const auto neighbours = smooth_neighbours(mesh, facets);
  const auto first_triangle = static_cast<std::int32_t>(triangles.size());
  for (const auto& around : neighbours)
  {
    triangles.push_back({ { { -1, -1, -1 } }, { { -1, -1, -1 } } });
    for (std::size_t i = 0; i < 3; ++i)
      triangles.back().neighbour[i] = around[i] < 0 ? -1 : first_triangle + around[i];
  }
  const std::vector<double> areas = vertex_areas(mesh);
  std::vector<std::int32_t> fan;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i)
    {
      if (triangles[first_triangle + t].vertex[i] >= 0)
        continue;
      // The triangles around this corner that join without a crease share one vertex.
      const std::int32_t source = mesh.triangles[t][i];
      Vector normal{ 0, 0, 0 };
      double area = 0;
      fan.assign(1, static_cast<std::int32_t>(t));
      for (std::size_t f = 0; f < fan.size(); ++f)
      {
        const auto& corners = mesh.triangles[fan[f]];
        const std::size_t corner = std::find(corners.begin(), corners.end(), source) - corners.begin();
        auto& vertex = triangles[first_triangle + fan[f]].vertex[corner];
        if (vertex >= 0)
          continue;
        vertex = static_cast<std::int32_t>(vertices.size());
        normal = normal + facets[fan[f]].area;
        area += norm(facets[fan[f]].area) / 3;
        for (const std::size_t side : { (corner + 1) % 3, (corner + 2) % 3 })
          if (neighbours[fan[f]][side] >= 0)
            fan.push_back(neighbours[fan[f]][side]);
      }
      Vertex v;
      v.voxel = from.binding.voxel[source];
      v.contact = contact;
      v.source_in_contact = source;
      v.source = first_source + source;
      v.coordinates = from.binding.coordinates[source];
      v.area_share = static_cast<float>(area / std::max(areas[source], 1e-30));
      v.rest = vector_of(mesh.vertices[source]);
      v.normal = (1 / std::max(norm(normal), 1e-30)) * normal;
      set_frame(v);
      vertices.push_back(v);
    }
  join(mesh, first_source, joined_within * *std::max_element(model_.spacing.begin(), model_.spacing.end()));
}

// Finds the shortest paths along edges from each vertex, up to the length `within` [m].
void TouchingSurface::join(const TriangleMesh& mesh, std::int32_t first_source, double within)
{
  // The neighbours of each vertex along edges, and the lengths of these edges.
  std::vector<std::vector<std::pair<std::int32_t, double>>> around(mesh.vertices.size());
  for (const auto& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i)
      for (const std::size_t other : { (i + 1) % 3, (i + 2) % 3 })
        around[t[i]].push_back({ t[other], norm(vector_of(mesh.vertices[t[other]]) - vector_of(mesh.vertices[t[i]])) });
  for (auto& edges : around)
  {
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  }
  std::vector<double> way(mesh.vertices.size(), within);
  using Reached = std::pair<double, std::int32_t>;
  for (std::size_t v = 0; v < around.size(); ++v)
  {
    std::vector<std::int32_t> reached;
    std::priority_queue<Reached, std::vector<Reached>, std::greater<>> front;
    front.push({ 0, static_cast<std::int32_t>(v) });
    way[v] = 0;
    while (!front.empty())
    {
      const auto [at, from] = front.top();
      front.pop();
      if (at > way[from])
        continue;
      reached.push_back(from);
      for (const auto& [to, length] : around[from])
      {
        const double next = at + length;
        if (next < way[to])
        {
          way[to] = next;
          front.push({ next, to });
        }
      }
    }
    std::sort(reached.begin(), reached.end());
    reached.erase(std::unique(reached.begin(), reached.end()), reached.end());
    for (const auto r : reached)
    {
      way[r] = within;
      joined_.push_back(first_source + r);
    }
    joined_begin_.push_back(static_cast<std::int32_t>(joined_.size()));
  }
}

void TouchingSurface::sort_vertices()
{
  std::vector<std::int32_t> order(vertices.size()), rank(vertices.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::int32_t a, std::int32_t b) { return vertices[a].voxel < vertices[b].voxel; });
  std::vector<Vertex> sorted;
  for (const auto v : order)
  {
    rank[v] = static_cast<std::int32_t>(sorted.size());
    sorted.push_back(vertices[v]);
  }
  vertices = std::move(sorted);
  for (Triangle& t : triangles)
    for (auto& v : t.vertex)
      v = rank[v];
}

Binding TouchingSurface::binding() const
{
  Binding all;
  for (const Vertex& vertex : vertices)
  {
    all.voxel.push_back(vertex.voxel);
    all.coordinates.push_back(vertex.coordinates);
  }
  return all;
}

void TouchingSurface::list_arrays(ArrayList& list, Effect effect) const
{
  if (vertices.empty())
    return;
  list.add(effect, "vertices", vertices);
  list.add(effect, "triangles", triangles);
  list.add(effect, "joined vertices", joined_begin_);
  list.add(effect, "joined vertices", joined_);
}

bool TouchingSurface::joined(std::size_t v, std::size_t w) const
{
  const auto begin = joined_.begin() + joined_begin_[vertices[v].source];
  const auto end = joined_.begin() + joined_begin_[vertices[v].source + 1];
  return std::binary_search(begin, end, vertices[w].source);
}

}  // namespace frontalis
