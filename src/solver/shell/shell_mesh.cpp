#include "frontalis/solver/shell_mesh.hpp"

#include "frontalis/physics/hourglass.hpp"
#include "frontalis/physics/materials/lookup.hpp"
#include "frontalis/physics/trilinear.hpp"
#include "solver/contact/body_motion.hpp"
#include "solver/shell/moment_balance.hpp"
#include "solver/stepping/discretisation.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace frontalis
{
namespace
{

using Vector = physics::Vec3<double>;
// Distances below this fraction of a voxel's edge are rounding errors, because coordinates in a voxel have single
// precision.
constexpr double coordinate_rounding = 1e-5;

// Returns the positions of a shell's vertices that follow from the voxels at rest. Where such a position differs by
// rounding errors only from the vertex of Shell::surface, the position of that vertex is returned.
std::vector<Vector> carried_vertices(const Model& model, const Shell& shell)
{
  std::vector<Vector> places;
  places.reserve(shell.surface.vertices.size());
  for (std::size_t v = 0; v < shell.surface.vertices.size(); ++v)
  {
    const auto& at = shell.binding.coordinates[v];
    double weight[8];
    physics::trilinear_weights<double>(at[0], at[1], at[2], weight);
    Vector carried{ 0, 0, 0 };
    for (std::size_t b = 0; b < 8; ++b)
      carried = carried + weight[b] * vector_of(rest_position(model, model.voxel_nodes[shell.binding.voxel[v]][b]));
    const Vector own = vector_of(shell.surface.vertices[v]);
    places.push_back(norm(own - carried) < coordinate_rounding * model.spacing[0] ? own : carried);
  }
  return places;
}

}  // namespace

ShellMesh::ShellMesh(const Model& model)
{
  for (const Shell& shell : model.shells)
    add(model, shell);
  // Vertices are sorted by voxel, so that neighbours in the grid are close to each other in memory.
  std::vector<std::int32_t> order(binding.voxel.size()), rank(order.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return binding.voxel[a] < binding.voxel[b]; });
  const Binding before = binding;
  for (std::size_t v = 0; v < order.size(); ++v)
  {
    rank[order[v]] = static_cast<std::int32_t>(v);
    binding.voxel[v] = before.voxel[order[v]];
    binding.coordinates[v] = before.coordinates[order[v]];
  }
  for (Triangle& t : triangles)
    for (auto& v : t.vertex)
      v = rank[v];
  std::stable_sort(triangles.begin(), triangles.end(),
                   [](const Triangle& a, const Triangle& b) { return a.vertex < b.vertex; });
}

void ShellMesh::add(const Model& model, const Shell& shell)
{
  const auto first = static_cast<std::int32_t>(binding.voxel.size());
  binding.voxel.insert(binding.voxel.end(), shell.binding.voxel.begin(), shell.binding.voxel.end());
  binding.coordinates.insert(binding.coordinates.end(), shell.binding.coordinates.begin(),
                             shell.binding.coordinates.end());
  // For each directed edge, the corner opposite to it.
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> opposite;
  for (const auto& t : shell.surface.triangles)
    for (std::size_t i = 0; i < 3; ++i)
      opposite[{ t[(i + 1) % 3], t[(i + 2) % 3] }] = t[i];
  const Material& material = model.materials[shell.material];
  const double mu = physics::shear_modulus_of(material.law, material.parameters),
               young = physics::young_modulus(mu, material.parameters[1]);
  const double poisson = young / (2 * mu) - 1;
  const std::vector<Vector> carried = carried_vertices(model, shell);
  std::vector<BentTriangle> bent;
  bent.reserve(shell.surface.triangles.size());
  for (const auto& t : shell.surface.triangles)
  {
    std::array<Vector, 6> x{}, creased{};
    std::array<bool, 3> beyond{};
    std::array<std::int32_t, 6> vertex{};
    for (std::size_t i = 0; i < 3; ++i)
    {
      const auto across = opposite.find({ t[(i + 2) % 3], t[(i + 1) % 3] });
      beyond[i] = across != opposite.end();
      const std::int32_t outer = beyond[i] ? across->second : t[0];
      x[i] = carried[t[i]];
      x[i + 3] = carried[outer];
      creased[i] = vector_of(shell.surface.vertices[t[i]]);
      creased[i + 3] = vector_of(shell.surface.vertices[outer]);
      vertex[i] = first + t[i];
      vertex[i + 3] = first + outer;
    }
    bent.push_back(bent_triangle(x, beyond, shell.thickness, young, poisson));
    // bending is measured from the creased shape, and stretching from the positions that the voxels give the vertices
    const Triangle free_of_moment = shell_triangle(creased, beyond, shell.thickness, young, poisson);
    std::copy_n(free_of_moment.rest.height, 3, bent.back().triangle.rest.height);
    bent.back().triangle.vertex = vertex;
  }
  balance_moments(bent, poisson);
  for (const BentTriangle& of : bent)
    triangles.push_back(of.triangle);
}

void spread_forces(const Model& model, const Binding& binding, const std::vector<Vector>& on_points,
                   std::vector<std::array<double, 3>>& on_nodes)
{
  for (std::size_t p = 0; p < on_points.size(); ++p)
  {
    const auto& at = binding.coordinates[p];
    double weight[8];
    physics::trilinear_weights<double>(at[0], at[1], at[2], weight);
    for (std::size_t b = 0; b < 8; ++b)
      add_vector(on_nodes[model.voxel_nodes[binding.voxel[p]][b]], weight[b] * on_points[p]);
  }
}

}  // namespace frontalis
