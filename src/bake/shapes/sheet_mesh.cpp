#include "bake/shapes/sheet_mesh.hpp"

namespace frontalis
{

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
      // the shorter diagonal; where both are equal, mirrored about the middle
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
