#include "bake/shapes/sheet_mesh.hpp"

namespace frontalis
{

void add_sheet(TriangleMesh& mesh, std::int32_t n, std::int32_t m,
               const std::function<Vector3(std::int32_t, std::int32_t)>& at)
{
  const auto base = static_cast<std::int32_t>(mesh.vertices.size());
  for (std::int32_t j = 0; j <= m; ++j)
  {
    for (std::int32_t i = 0; i <= n; ++i)
      mesh.vertices.push_back(at(i, j));
  }
  const auto number = [&](std::int32_t i, std::int32_t j) { return base + j * (n + 1) + i; };
  const auto at_number = [&](std::int32_t v) -> const Vector3& { return mesh.vertices[static_cast<std::size_t>(v)]; };
  for (std::int32_t j = 0; j < m; ++j)
  {
    for (std::int32_t i = 0; i < n; ++i)
    {
      const std::int32_t a = number(i, j), b = number(i + 1, j), c = number(i + 1, j + 1), d = number(i, j + 1);
      const Vector3 bd = at_number(d) - at_number(b), ac = at_number(c) - at_number(a);
      // the shorter diagonal; of equal ones that which mirrors the other half's
      const double excess = dot(ac, ac) - dot(bd, bd);
      if (std::abs(excess) < 1e-9 * dot(ac, ac) ? n % 2 == 0 && i < n / 2 : excess > 0)
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
}

}  // namespace frontalis
