#include "bake/mesh/halve_edges.hpp"

#include "frontalis/model/skin_film.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <unordered_set>

namespace frontalis
{
namespace
{

using Vector = physics::Vec3<double>;

std::uint64_t key_of(std::int32_t a, std::int32_t b)
{
  return static_cast<std::uint64_t>(std::min(a, b)) << 32U | static_cast<std::uint32_t>(std::max(a, b));
}

// A mesh whose edges are halved one after the other.
class Halving
{
  using Edge = std::pair<double, std::uint64_t>;  // squared length and key

public:
  Halving(TriangleMesh& mesh, const std::function<double(const Vector3d&)>& longest)
      : mesh_(mesh), longest_(longest), normals_(vertex_normals(mesh))
  {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (std::size_t c = 0; c < 3; ++c)
        triangles_of_[key_of(mesh.triangles[t][c], mesh.triangles[t][(c + 1) % 3])].push_back(t);
  }

  std::vector<std::array<std::int32_t, 2>> run()
  {
    std::vector<std::array<std::int32_t, 2>> parents;
    for (;;)
    {
      const std::vector<Edge> edges = edges_to_halve();
      if (edges.empty())
        return parents;
      for (const Edge& edge : edges)
      {
        const auto [a, b] = ends_of(edge.second);
        halve(edge.second, a, b);
        parents.push_back({ a, b });
      }
    }
  }

private:
  static std::array<std::int32_t, 2> ends_of(std::uint64_t key)
  {
    return { static_cast<std::int32_t>(key >> 32U), static_cast<std::int32_t>(key & 0xffffffffU) };
  }

  Edge edge_of(std::uint64_t key) const
  {
    const auto [a, b] = ends_of(key);
    return { (vertex(mesh_, b) - vertex(mesh_, a)).squaredNorm(), key };
  }
  std::array<Edge, 3> edges_of(std::size_t triangle) const
  {
    const Triangle& t = mesh_.triangles[triangle];
    return { edge_of(key_of(t[0], t[1])), edge_of(key_of(t[1], t[2])), edge_of(key_of(t[2], t[0])) };
  }
  bool is_long(const Edge& edge) const
  {
    const auto [a, b] = ends_of(edge.second);
    return std::sqrt(edge.first) > longest_(0.5 * (vertex(mesh_, a) + vertex(mesh_, b)));
  }

  // All edges of triangles with one that is too long, and the longest edges of triangles with one of them; longest
  // first.
  std::vector<Edge> edges_to_halve() const
  {
    std::vector<Edge> found;
    std::unordered_set<std::uint64_t> known;
    const auto add = [&](const Edge& edge)
    {
      if (known.insert(edge.second).second)
        found.push_back(edge);
    };
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
    {
      const std::array<Edge, 3> edges = edges_of(t);
      if (std::any_of(edges.begin(), edges.end(), [&](const Edge& edge) { return is_long(edge); }))
        std::for_each(edges.begin(), edges.end(), add);
    }
    for (std::size_t i = 0; i < found.size(); ++i)
      for (const std::size_t t : triangles_of_.at(found[i].second))
      {
        const std::array<Edge, 3> edges = edges_of(t);
        add(*std::max_element(edges.begin(), edges.end()));
      }
    std::sort(found.rbegin(), found.rend());
    return found;
  }

  void halve(std::uint64_t key, std::int32_t a, std::int32_t b)
  {
    const auto vector = [](const Vector3d& v) { return Vector{ v[0], v[1], v[2] }; };
    Vector normal{};
    const Vector at = curved_middle(vector(vertex(mesh_, a)), vector(normals_[a]), vector(vertex(mesh_, b)),
                                    vector(normals_[b]), normal);
    const auto middle = static_cast<std::int32_t>(mesh_.vertices.size());
    mesh_.vertices.push_back({ at.x, at.y, at.z });
    normals_.emplace_back(normal.x, normal.y, normal.z);
    const auto found = triangles_of_.find(key);
    const std::vector<std::size_t> around = std::move(found->second);
    triangles_of_.erase(found);
    for (const std::size_t t : around)
    {
      const std::size_t added = mesh_.triangles.size();
      Triangle first = mesh_.triangles[t], second = first;
      std::int32_t opposite = 0;
      for (std::size_t c = 0; c < 3; ++c)
      {
        if (first[c] != a && first[c] != b)
          opposite = first[c];
        // The first half keeps corner a, the second corner b.
        if (mesh_.triangles[t][c] == b)
          first[c] = middle;
        if (mesh_.triangles[t][c] == a)
          second[c] = middle;
      }
      mesh_.triangles[t] = first;
      mesh_.triangles.push_back(second);
      for (std::size_t& of : triangles_of_[key_of(b, opposite)])
        of = of == t ? added : of;
      triangles_of_[key_of(a, middle)].push_back(t);
      triangles_of_[key_of(b, middle)].push_back(added);
      triangles_of_[key_of(opposite, middle)] = { t, added };
    }
  }

  TriangleMesh& mesh_;
  const std::function<double(const Vector3d&)>& longest_;
  std::vector<Vector3d> normals_;
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> triangles_of_;
};

}  // namespace

std::vector<std::array<std::int32_t, 2>> halve_edges(TriangleMesh& mesh,
                                                     const std::function<double(const Vector3d&)>& longest)
{
  return Halving(mesh, longest).run();
}

TriangleMesh refined(const TriangleMesh& surface, const Box& box, double longest)
{
  TriangleMesh mesh;
  mesh.vertices = surface.vertices;
  std::vector<Triangle> left;
  const auto keep = [&](const Triangle& t)
  {
    const auto [a, b, c] = corners(mesh, t);
    if (Box(a).extend(b).extend(c).intersects(box))
      left.push_back(t);
  };
  for (const Triangle& t : surface.triangles)
    keep(t);
  while (!left.empty())
  {
    const Triangle t = left.back();
    left.pop_back();
    double length = 0;
    int edge = 0;
    for (int e = 0; e < 3; ++e)
      if (const double now = (vertex(mesh, t[(e + 1) % 3]) - vertex(mesh, t[e])).norm(); now > length)
      {
        length = now;
        edge = e;
      }
    if (length <= longest)
    {
      mesh.triangles.push_back(t);
      continue;
    }
    const std::int32_t from = t[edge], to = t[(edge + 1) % 3], opposite = t[(edge + 2) % 3];
    const auto middle = static_cast<std::int32_t>(mesh.vertices.size());
    mesh.vertices.push_back(to_array(0.5 * (vertex(mesh, from) + vertex(mesh, to))));
    keep({ from, middle, opposite });
    keep({ middle, to, opposite });
  }
  join_vertices(mesh);
  return mesh;
}

}  // namespace frontalis
