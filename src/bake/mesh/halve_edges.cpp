#include "bake/mesh/halve_edges.hpp"

#include "frontalis/model/skin_film.hpp"

#include <queue>
#include <unordered_map>

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
public:
  Halving(TriangleMesh& mesh, const std::function<double(const Vector3d&)>& longest) : mesh_(mesh), longest_(longest)
  {
    std::vector<Vector3d> normals(mesh.vertices.size(), Vector3d::Zero());
    for (const Triangle& t : mesh.triangles)
    {
      const auto [a, b, c] = corners(mesh, t);
      for (const std::int32_t v : t)
        normals[v] += (b - a).cross(c - a);
    }
    normals_.reserve(normals.size());
    for (const Vector3d& normal : normals)
      normals_.push_back(normal.normalized());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (std::size_t c = 0; c < 3; ++c)
        triangles_of_[key_of(mesh.triangles[t][c], mesh.triangles[t][(c + 1) % 3])].push_back(t);
    for (const auto& [key, triangles] : triangles_of_)
      add_if_long(key);
  }

  std::vector<std::array<std::int32_t, 2>> run()
  {
    std::vector<std::array<std::int32_t, 2>> parents;
    while (!queue_.empty())
    {
      const std::uint64_t key = queue_.top().second;
      queue_.pop();
      const auto [a, b] = ends_of(key);
      halve(key, a, b);
      parents.push_back({ a, b });
    }
    return parents;
  }

private:
  static std::array<std::int32_t, 2> ends_of(std::uint64_t key)
  {
    return { static_cast<std::int32_t>(key >> 32U), static_cast<std::int32_t>(key & 0xffffffffU) };
  }

  void add_if_long(std::uint64_t key)
  {
    const auto [a, b] = ends_of(key);
    const Vector3d p = vertex(mesh_, a), q = vertex(mesh_, b);
    if ((q - p).norm() > longest_(0.5 * (p + q)))
      queue_.emplace((q - p).squaredNorm(), key);
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
      add_if_long(key_of(opposite, middle));
    }
    add_if_long(key_of(a, middle));
    add_if_long(key_of(b, middle));
  }

  TriangleMesh& mesh_;
  const std::function<double(const Vector3d&)>& longest_;
  std::vector<Vector3d> normals_;
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> triangles_of_;
  std::priority_queue<std::pair<double, std::uint64_t>> queue_;  // squared length and key of edges that are too long
};

}  // namespace

std::vector<std::array<std::int32_t, 2>> halve_edges(TriangleMesh& mesh,
                                                     const std::function<double(const Vector3d&)>& longest)
{
  return Halving(mesh, longest).run();
}

}  // namespace frontalis
