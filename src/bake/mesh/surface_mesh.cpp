#include "bake/mesh/surface_mesh.hpp"

#include <boost/functional/hash.hpp>

#include <map>
#include <set>
#include <tuple>
#include <unordered_map>

namespace frontalis
{
namespace
{

/// An edge of a triangle, stored from its lower to its higher vertex number.
struct HalfEdge
{
  std::int32_t low, high, triangle;
  bool forward;  ///< the triangle runs from low to high
  bool operator<(const HalfEdge& other) const
  {
    return std::tie(low, high, triangle) < std::tie(other.low, other.high, other.triangle);
  }
};

std::vector<HalfEdge> sorted_half_edges(const TriangleMesh& mesh)
{
  std::vector<HalfEdge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c)
    {
      const std::int32_t a = mesh.triangles[t][c], b = mesh.triangles[t][(c + 1) % 3];
      edges.push_back({ std::min(a, b), std::max(a, b), static_cast<std::int32_t>(t), a < b });
    }
  std::sort(edges.begin(), edges.end());
  return edges;
}

/// Calls body(begin, end) for each edge, with the range of its half-edges.
template <class Body>
void for_each_edge(const std::vector<HalfEdge>& half_edges, const Body& body)
{
  for (auto begin = half_edges.begin(); begin != half_edges.end();)
  {
    const auto end = std::find_if(begin, half_edges.end(),
                                  [&](const HalfEdge& e) { return e.low != begin->low || e.high != begin->high; });
    body(begin, end);
    begin = end;
  }
}

/// Keeps the part of a mesh below `limit` along an axis (sign +1) or above it (sign -1).
TriangleMesh cut(TriangleMesh mesh, std::size_t axis, double limit, double sign)
{
  const auto height = [&](std::int32_t v) { return sign * (limit - mesh.vertices[v][axis]); };
  std::map<std::array<std::int32_t, 2>, std::int32_t> crossings;
  const auto crossing = [&](std::int32_t a, std::int32_t b)
  {
    const auto found = crossings.insert({ { std::min(a, b), std::max(a, b) }, 0 });
    if (found.second)
    {
      // The point is interpolated from the lower vertex index, so that both triangles of an edge get bitwise the same
      // point.
      const auto [p, q] = std::minmax(a, b);
      const double along = height(p) / (height(p) - height(q));
      const Vector3d from = vertex(mesh, p), to = vertex(mesh, q);
      Vector3d point = from + along * (to - from);
      point[axis] = limit;
      found.first->second = static_cast<std::int32_t>(mesh.vertices.size());
      mesh.vertices.push_back(to_array(point));
    }
    return found.first->second;
  };
  std::vector<Triangle> triangles;
  for (const Triangle& t : mesh.triangles)
  {
    std::vector<std::int32_t> polygon;
    for (std::size_t c = 0; c < 3; ++c)
    {
      const std::int32_t here = t[c], next = t[(c + 1) % 3];
      if (height(here) >= 0)
        polygon.push_back(here);
      if ((height(here) > 0 && height(next) < 0) || (height(here) < 0 && height(next) > 0))
        polygon.push_back(crossing(here, next));
    }
    for (std::size_t c = 2; c < polygon.size(); ++c)
      triangles.push_back({ polygon[0], polygon[c - 1], polygon[c] });
  }
  mesh.triangles = std::move(triangles);
  return mesh;
}

}  // namespace

void append(TriangleMesh& mesh, const TriangleMesh& part, bool flipped)
{
  const auto base = static_cast<std::int32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), part.vertices.begin(), part.vertices.end());
  for (const Triangle& t : part.triangles)
    mesh.triangles.push_back({ base + t[0], base + t[flipped ? 2 : 1], base + t[flipped ? 1 : 2] });
}

Edges unbalanced_edges(const TriangleMesh& mesh)
{
  Edges edges;
  for_each_edge(sorted_half_edges(mesh),
                [&](auto begin, auto end)
                {
                  const auto forward = std::count_if(begin, end, [](const HalfEdge& e) { return e.forward; });
                  auto surplus = 2 * forward - (end - begin);
                  for (; surplus > 0; --surplus)
                    edges.push_back({ begin->low, begin->high });
                  for (; surplus < 0; ++surplus)
                    edges.push_back({ begin->high, begin->low });
                });
  return edges;
}

double signed_volume(const TriangleMesh& mesh)
{
  if (mesh.vertices.empty())
    return 0;
  const Vector3d origin = bounding_box(mesh).center();
  double sum = 0;
  for (const Triangle& t : mesh.triangles)
  {
    const auto [a, b, c] = corners(mesh, t);
    sum += (a - origin).dot((b - origin).cross(c - origin));
  }
  return sum / 6;
}

double surface_area(const TriangleMesh& mesh)
{
  double sum = 0;
  for (const Triangle& t : mesh.triangles)
  {
    const auto [a, b, c] = corners(mesh, t);
    sum += 0.5 * (b - a).cross(c - a).norm();
  }
  return sum;
}

std::vector<Vector3d> vertex_normals(const TriangleMesh& mesh)
{
  std::vector<Vector3d> normals(mesh.vertices.size(), Vector3d::Zero());
  for (const Triangle& t : mesh.triangles)
  {
    const auto [a, b, c] = corners(mesh, t);
    for (const std::int32_t v : t)
      normals[v] += (b - a).cross(c - a);
  }
  for (Vector3d& n : normals)
    n.normalize();
  return normals;
}

Box bounding_box(const TriangleMesh& mesh)
{
  Box box;
  for (const Vector3& v : mesh.vertices)
    box.extend(to_vector(v));
  return box;
}

std::size_t join_vertices(TriangleMesh& mesh)
{
  std::unordered_map<Vector3, std::int32_t, boost::hash<Vector3>> first;
  first.reserve(mesh.vertices.size());
  TriangleMesh joined;
  std::size_t dropped = 0;
  for (const Triangle& t : mesh.triangles)
  {
    Triangle corners{};
    for (std::size_t c = 0; c < 3; ++c)
    {
      const Vector3& place = mesh.vertices[t[c]];
      const auto found = first.emplace(place, static_cast<std::int32_t>(joined.vertices.size()));
      if (found.second)
        joined.vertices.push_back(place);
      corners[c] = found.first->second;
    }
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0])
      ++dropped;
    else
      joined.triangles.push_back(corners);
  }
  mesh = std::move(joined);
  return dropped;
}

std::size_t make_orientation_consistent(TriangleMesh& mesh)
{
  struct Neighbour
  {
    std::int32_t triangle = -1;
    bool disagrees = false;  // true: both triangles run along the edge in the same direction
  };
  std::vector<std::array<Neighbour, 3>> neighbours(mesh.triangles.size());
  bool any_wrong = false;
  const auto add = [&](std::int32_t triangle, const Neighbour& neighbour)
  {
    auto& slots = neighbours[triangle];
    (slots[0].triangle < 0 ? slots[0] : slots[1].triangle < 0 ? slots[1] : slots[2]) = neighbour;
  };
  for_each_edge(sorted_half_edges(mesh),
                [&](auto begin, auto end)
                {
                  if (end - begin != 2)
                    return;
                  const HalfEdge &a = begin[0], &b = begin[1];
                  any_wrong = any_wrong || a.forward == b.forward;
                  add(a.triangle, { b.triangle, a.forward == b.forward });
                  add(b.triangle, { a.triangle, a.forward == b.forward });
                });
  if (!any_wrong)
    return 0;

  std::vector<std::int8_t> turn(mesh.triangles.size(), -1);
  std::size_t turned = 0;
  for (std::size_t seed = 0; seed < mesh.triangles.size(); ++seed)
  {
    if (turn[seed] >= 0)
      continue;
    std::vector<std::size_t> component{ seed };
    turn[seed] = 0;
    for (std::size_t at = 0; at < component.size(); ++at)
      for (const Neighbour& n : neighbours[component[at]])
      {
        if (n.triangle < 0 || turn[n.triangle] >= 0)
          continue;
        turn[n.triangle] = static_cast<std::int8_t>(turn[component[at]] ^ (n.disagrees ? 1 : 0));
        component.push_back(n.triangle);
      }
    std::size_t ones = 0;
    for (const std::size_t t : component)
      ones += turn[t];
    const int wanted = 2 * ones > component.size() ? 0 : 1;
    for (const std::size_t t : component)
      if (turn[t] == wanted)
      {
        std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
        ++turned;
      }
  }
  return turned;
}

void flip(TriangleMesh& mesh)
{
  for (Triangle& t : mesh.triangles)
    std::swap(t[1], t[2]);
}

TriangleMesh keep_triangles(const TriangleMesh& mesh, const std::vector<bool>& keep,
                            std::vector<std::int32_t>* vertex_of)
{
  std::vector<std::int32_t> number(mesh.vertices.size(), -1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (keep[t])
      for (const std::int32_t v : mesh.triangles[t])
        number[v] = 0;
  TriangleMesh kept;
  if (vertex_of != nullptr)
    vertex_of->clear();
  for (std::size_t v = 0; v < number.size(); ++v)
  {
    if (number[v] < 0)
      continue;
    number[v] = static_cast<std::int32_t>(kept.vertices.size());
    kept.vertices.push_back(mesh.vertices[v]);
    if (vertex_of != nullptr)
      vertex_of->push_back(static_cast<std::int32_t>(v));
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
  {
    if (!keep[t])
      continue;
    Triangle corners{};
    for (std::size_t c = 0; c < 3; ++c)
      corners[c] = number[mesh.triangles[t][c]];
    kept.triangles.push_back(corners);
  }
  return kept;
}

TriangleMesh cut_mesh(const TriangleMesh& mesh, const Region& region)
{
  TriangleMesh part = mesh;
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    if (std::isfinite(region.lower[axis]))
      part = cut(std::move(part), axis, region.lower[axis], -1);
    if (std::isfinite(region.upper[axis]))
      part = cut(std::move(part), axis, region.upper[axis], 1);
  }
  return keep_triangles(part, std::vector<bool>(part.triangles.size(), true));
}

TriangleMesh continued(TriangleMesh mesh, const Vector3d& box_size)
{
  const Edges edges = unbalanced_edges(mesh);
  const std::set<std::array<std::int32_t, 2>> border(edges.begin(), edges.end());
  struct Corner
  {
    Vector3d outwards{ 0, 0, 0 };  ///< sum of the directions away from the triangles at its edges
    double width = 0;              ///< sum of the widths of the strip there [m]
    int edges = 0;
    std::int32_t moved = 0;
  };
  std::map<std::int32_t, Corner> corner_of;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t c = 0; c < 3; ++c)
    {
      const std::int32_t from = t[c], to = t[(c + 1) % 3];
      if (border.count({ from, to }) == 0)
        continue;
      const Vector3d along = (vertex(mesh, to) - vertex(mesh, from)).normalized(),
                     across = vertex(mesh, from) - vertex(mesh, t[(c + 2) % 3]);
      const Vector3d outwards = (across - across.dot(along) * along).normalized();
      for (const std::int32_t v : { from, to })
      {
        Corner& corner = corner_of[v];
        corner.outwards += outwards;
        corner.width += 0.5 * outwards.cwiseAbs().dot(box_size);
        ++corner.edges;
      }
    }
  for (auto& [v, corner] : corner_of)
  {
    // The corner moves so far that each of its edges does so by the width, but by at most twice the width.
    const double squared = std::max(corner.outwards.squaredNorm(), 0.25 * corner.edges * corner.edges);
    corner.moved = static_cast<std::int32_t>(mesh.vertices.size());
    mesh.vertices.push_back(to_array(vertex(mesh, v) + corner.width / squared * corner.outwards));
  }
  for (const auto& [from, to] : border)
  {
    mesh.triangles.push_back({ to, from, corner_of[from].moved });
    mesh.triangles.push_back({ to, corner_of[from].moved, corner_of[to].moved });
  }
  return mesh;
}

void add_sheet(TriangleMesh& mesh, std::int32_t n, std::int32_t m,
               const std::function<Vector3d(std::int32_t, std::int32_t)>& at)
{
  const auto base = static_cast<std::int32_t>(mesh.vertices.size());
  for (std::int32_t j = 0; j <= m; ++j)
    for (std::int32_t i = 0; i <= n; ++i)
      mesh.vertices.push_back(to_array(at(i, j)));
  const auto number = [&](std::int32_t i, std::int32_t j) { return base + j * (n + 1) + i; };
  for (std::int32_t j = 0; j < m; ++j)
    for (std::int32_t i = 0; i < n; ++i)
    {
      const std::int32_t a = number(i, j), b = number(i + 1, j), c = number(i + 1, j + 1), d = number(i, j + 1);
      const double bd = (vertex(mesh, d) - vertex(mesh, b)).squaredNorm();
      const double ac = (vertex(mesh, c) - vertex(mesh, a)).squaredNorm();
      // The shorter diagonal is chosen. If both are equal, diagonals are mirrored about the middle column.
      if (std::abs(ac - bd) < 1e-9 * ac ? n % 2 == 0 && i < n / 2 : ac > bd)
      {
        mesh.triangles.push_back({ a, b, d });
        mesh.triangles.push_back({ b, c, d });
      }
      else
      {
        mesh.triangles.push_back({ a, b, c });
        mesh.triangles.push_back({ a, c, d });
      }
    }
}

}  // namespace frontalis
