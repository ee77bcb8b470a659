#include "frontalis/solver/shell_mesh.hpp"

#include "frontalis/physics/hourglass.hpp"
#include "frontalis/physics/trilinear.hpp"
#include "solver/contact/body_motion.hpp"
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
using Matrix = std::array<std::array<double, 3>, 3>;

// Fraction of the squared size of T below which squared singular values are damped. In an equilateral triangle the
// singular values are 0.7, 0.7 and 1.
constexpr double regularisation = 4e-4;

Matrix product(const Matrix& a, const Matrix& b)
{
  Matrix c{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t k = 0; k < 3; ++k)
        c[i][j] += a[i][k] * b[k][j];
  return c;
}

Matrix transposed(const Matrix& a)
{
  Matrix t;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      t[i][j] = a[j][i];
  return t;
}

Matrix inverse(const Matrix& a)
{
  Matrix b;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      b[j][i] = a[(i + 1) % 3][(j + 1) % 3] * a[(i + 2) % 3][(j + 2) % 3] -
                a[(i + 1) % 3][(j + 2) % 3] * a[(i + 2) % 3][(j + 1) % 3];
  const double determinant = a[0][0] * b[0][0] + a[0][1] * b[1][0] + a[0][2] * b[2][0];
  for (auto& row : b)
    for (double& x : row)
      x /= determinant;
  return b;
}

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

ShellMesh::Triangle shell_triangle(const std::array<Vector, 6>& x, const std::array<bool, 3>& beyond, double thickness,
                                   double young, double poisson)
{
  ShellMesh::Triangle out{};
  auto& rest = out.rest;
  const Vector a = x[1] - x[0], b = x[2] - x[0], area = cross(a, b);
  const double area_twice = norm(area);
  rest.inverse_area = 1 / area_twice;
  const Vector normal = (1 / area_twice) * area, across_a = cross(b, normal), across_b = cross(normal, a);
  const double per_area = 1 / (area_twice * area_twice);
  rest.metric[0] = per_area * dot(b, b);
  rest.metric[1] = -per_area * dot(a, b);
  rest.metric[2] = per_area * dot(a, a);
  const double volume = 0.5 * area_twice * thickness;
  rest.shear = volume * young / (2 * (1 + poisson));
  rest.dilatation = volume * young * poisson / (1 - poisson * poisson);
  // The membrane energy is at most (shear + dilatation) |grad u|^2. The term |grad u|^2 is a quadratic form of rank 2
  // in the corners' displacements; `trace` and `eigenvalues` are the sum and the product of its two eigenvalues.
  const double trace = 2 * (rest.metric[0] + rest.metric[1] + rest.metric[2]), eigenvalues = 3 * per_area;
  out.membrane = (rest.shear + rest.dilatation) * (trace + std::sqrt(std::max(0.0, trace * trace - 4 * eigenvalues)));

  const Vector e1 = (1 / norm(a)) * a, e2 = cross(normal, e1);
  const auto quadratic = [&](const Vector& at)
  {
    const double s = dot(at, e1), t = dot(at, e2);
    return std::array<double, 3>{ { 0.5 * s * s / area_twice, 0.5 * t * t / area_twice, 0.5 * s * t / area_twice } };
  };
  const auto of_a = quadratic(a), of_b = quadratic(b);
  const Vector corner[3] = { { 0, 0, 0 }, a, b };
  rest.from_corner[0] = a;
  rest.from_corner[1] = b;
  Matrix T, share;  // share: weights of the corners in the height of the triangle's plane at an outer vertex
  for (std::size_t i = 0; i < 3; ++i)
  {
    const Vector &p = corner[(i + 1) % 3], &q = corner[(i + 2) % 3];
    const Vector edge = (1 / norm(q - p)) * (q - p), to_own = corner[i] - p;
    const Vector mirrored = p + (2 * dot(to_own, edge)) * edge - to_own;
    const Vector outer = beyond[i] ? x[i + 3] - x[0] : mirrored;
    rest.from_corner[i + 2] = outer;
    rest.height[i] = dot(outer, normal);
    const double on_a = dot(outer, across_a) / area_twice, on_b = dot(outer, across_b) / area_twice;
    share[i] = { { 1 - on_a - on_b, on_a, on_b } };
    const auto of_outer = quadratic(outer);
    for (std::size_t k = 0; k < 3; ++k)
      T[i][k] = of_outer[k] - on_a * of_a[k] - on_b * of_b[k];
  }
  Matrix squared = product(transposed(T), T);
  for (std::size_t k = 0; k < 3; ++k)
    squared[k][k] += regularisation;
  // matrix that converts heights to curvatures times twice the area
  const Matrix curvature = product(inverse(squared), transposed(T));
  const double plate = young * std::pow(thickness, 3) / (12 * (1 - poisson * poisson));
  const double scale = 0.5 * plate / area_twice;
  const Matrix law{
    { { { scale, scale * poisson, 0 } }, { { scale * poisson, scale, 0 } }, { { 0, 0, 0.5 * scale * (1 - poisson) } } }
  };
  Matrix M = product(transposed(curvature), product(law, curvature));
  for (std::size_t i = 0; i < 3; ++i)
    if (!beyond[i])
    {
      // The height beyond this edge is eliminated by the condition that no moment passes through the edge.
      const Matrix before = M;
      for (std::size_t j = 0; j < 3; ++j)
        for (std::size_t k = 0; k < 3; ++k)
          M[j][k] = j == i || k == i ? 0 : before[j][k] - before[j][i] * before[i][k] / before[i][i];
      rest.from_corner[i + 2] = { 0, 0, 0 };
      rest.height[i] = 0;
    }
  for (std::size_t j = 0, at = 0; j < 3; ++j)
    for (std::size_t k = j; k < 3; ++k)
      rest.bending[at++] = M[j][k];
  for (std::size_t j = 0; j < 3; ++j)
    for (std::size_t k = 0; k < 3; ++k)
      out.bending += M[j][k] * ((j == k ? 1 : 0) + share[j][0] * share[k][0] + share[j][1] * share[k][1] +
                                share[j][2] * share[k][2]);
  return out;
}

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
  const double mu = shear_at_rest(material), young = physics::young_modulus(mu, material.parameters[1]);
  const double poisson = young / (2 * mu) - 1;
  const std::vector<Vector> carried = carried_vertices(model, shell);
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
    triangles.push_back(shell_triangle(x, beyond, shell.thickness, young, poisson));
    // bending is measured from the creased shape, and stretching from the positions that the voxels give the vertices
    const Triangle free_of_moment = shell_triangle(creased, beyond, shell.thickness, young, poisson);
    std::copy_n(free_of_moment.rest.height, 3, triangles.back().rest.height);
    triangles.back().vertex = vertex;
  }
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
