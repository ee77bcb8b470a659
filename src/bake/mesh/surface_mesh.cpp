#include "bake/mesh/surface_mesh.hpp"

#include <cstring>
#include <tuple>
#include <unordered_map>

namespace frontalis
{
namespace
{

/// A triangle's edge from its lower to its higher vertex number.
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
  {
    for (std::size_t c = 0; c < 3; ++c)
    {
      const std::int32_t a = mesh.triangles[t][c], b = mesh.triangles[t][(c + 1) % 3];
      edges.push_back({ std::min(a, b), std::max(a, b), static_cast<std::int32_t>(t), a < b });
    }
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

struct PlaceHash
{
  std::size_t operator()(const Vector3& p) const
  {
    std::uint64_t hash = 1469598103934665603ull;
    for (const double c : p)
    {
      const double value = c == 0 ? 0 : c;  // one zero
      std::uint64_t bits = 0;
      std::memcpy(&bits, &value, sizeof(bits));
      hash = (hash ^ bits) * 1099511628211ull;
      hash ^= hash >> 29;
    }
    return static_cast<std::size_t>(hash);
  }
};

}  // namespace

Edges unbalanced_edges(const TriangleMesh& mesh)
{
  const std::vector<HalfEdge> half = sorted_half_edges(mesh);
  Edges edges;
  for (std::size_t begin = 0, end = 0; begin < half.size(); begin = end)
  {
    int balance = 0;
    for (end = begin; end < half.size() && half[end].low == half[begin].low && half[end].high == half[begin].high;
         ++end)
      balance += half[end].forward ? 1 : -1;
    for (; balance > 0; --balance)
      edges.push_back({ half[begin].low, half[begin].high });
    for (; balance < 0; ++balance)
      edges.push_back({ half[begin].high, half[begin].low });
  }
  return edges;
}

double signed_volume(const TriangleMesh& mesh)
{
  if (mesh.vertices.empty())
    return 0;
  const Vector3 origin = bounding_box(mesh).centre();
  double sum = 0;
  for (const Triangle& t : mesh.triangles)
    sum += dot(mesh.vertices[static_cast<std::size_t>(t[0])] - origin,
               cross(mesh.vertices[static_cast<std::size_t>(t[1])] - origin,
                     mesh.vertices[static_cast<std::size_t>(t[2])] - origin));
  return sum / 6;
}

Box bounding_box(const TriangleMesh& mesh)
{
  Box box;
  for (const Vector3& v : mesh.vertices)
    box.include(v);
  return box;
}

std::size_t join_vertices(TriangleMesh& mesh)
{
  std::unordered_map<Vector3, std::int32_t, PlaceHash> first;
  first.reserve(mesh.vertices.size());
  TriangleMesh joined;
  std::size_t dropped = 0;
  for (const Triangle& t : mesh.triangles)
  {
    Triangle corners{};
    for (std::size_t c = 0; c < 3; ++c)
    {
      const Vector3& place = mesh.vertices[static_cast<std::size_t>(t[c])];
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
  // neighbours across edges of exactly two triangles; `same` where they run along the edge the same way, which is wrong
  struct Neighbour
  {
    std::int32_t triangle = -1;
    bool same = false;
  };
  std::vector<std::array<Neighbour, 3>> neighbours(mesh.triangles.size());
  const std::vector<HalfEdge> half = sorted_half_edges(mesh);
  bool any_wrong = false;
  const auto slot = [&](std::int32_t triangle) -> Neighbour&
  {
    auto& slots = neighbours[static_cast<std::size_t>(triangle)];
    return slots[0].triangle < 0 ? slots[0] : (slots[1].triangle < 0 ? slots[1] : slots[2]);
  };
  for (std::size_t begin = 0, end = 0; begin < half.size(); begin = end)
  {
    for (end = begin; end < half.size() && half[end].low == half[begin].low && half[end].high == half[begin].high;)
      ++end;
    if (end - begin != 2)
      continue;
    const bool same = half[begin].forward == half[begin + 1].forward;
    any_wrong = any_wrong || same;
    slot(half[begin].triangle) = { half[begin + 1].triangle, same };
    slot(half[begin + 1].triangle) = { half[begin].triangle, same };
  }
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
    {
      for (const Neighbour& n : neighbours[component[at]])
      {
        if (n.triangle < 0 || turn[static_cast<std::size_t>(n.triangle)] >= 0)
          continue;
        turn[static_cast<std::size_t>(n.triangle)] = static_cast<std::int8_t>(turn[component[at]] ^ (n.same ? 1 : 0));
        component.push_back(static_cast<std::size_t>(n.triangle));
      }
    }
    std::size_t ones = 0;
    for (const std::size_t t : component)
      ones += static_cast<std::size_t>(turn[t]);
    const int wanted = 2 * ones > component.size() ? 0 : 1;
    for (const std::size_t t : component)
    {
      if (turn[t] == wanted)
      {
        std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
        ++turned;
      }
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
  {
    if (keep[t])
      for (const std::int32_t v : mesh.triangles[t])
        number[static_cast<std::size_t>(v)] = 0;
  }
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
      corners[c] = number[static_cast<std::size_t>(mesh.triangles[t][c])];
    kept.triangles.push_back(corners);
  }
  return kept;
}

}  // namespace frontalis
