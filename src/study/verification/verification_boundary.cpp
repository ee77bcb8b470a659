// Verifies bodies whose sides do not follow the grid. They are baked in the same way as a user's scene.

#include "frontalis/error.hpp"
#include "frontalis/solver/bound_displacement.hpp"
#include "study/verification/boundary_bodies.hpp"
#include "study/verification/calculix.hpp"
#include "study/verification/verification_cases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <unistd.h>

namespace frontalis
{
namespace
{

/// A folder that is removed with this object.
struct ScratchFolder
{
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / fmt::format("frontalis_verification_{}", ::getpid());

  ScratchFolder() { std::filesystem::create_directories(path); }
  ~ScratchFolder()
  {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
};

/// Turns a vector from scene axes to local axes by the transposed rotation.
Point turned_back(const RigidTransform& to_scene, const Point& v)
{
  Point out{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      out[i] += to_scene.rotation[3 * j + i] * v[j];
  return out;
}

void hold_mirrors(const BoundaryBody& body, Model& model)
{
  if (body.mirror == BoundaryBody::Mirror::none)
    return;
  for (std::size_t plane = 0; plane < 3; ++plane)
  {
    const auto nodes = nodes_where(model, [&](const Point& p) { return std::abs(model.to_scene(p)[plane]) < 1e-9; });
    const bool antisymmetric = plane == 2 && body.mirror == BoundaryBody::Mirror::antisymmetric_z;
    std::array<bool, 3> fixed{};
    for (std::size_t local = 0; local < 3; ++local)
      for (std::size_t axis = 0; axis < 3; ++axis)
        if (model.to_scene.rotation[3 * axis + local] == 1)
          fixed[local] = (axis == plane) != antisymmetric;
    prescribe(model, nodes, fixed);
  }
}

/// Loads the end of a bar, one load per triangle with the traction at its middle.
void load_end(const BoundaryBody& body, Model& model)
{
  if (!body.traction)
    return;
  for (const auto& triangle : body.end.triangles)
  {
    Load load;
    load.name = "end";
    Point middle{};
    for (const auto corner : triangle)
    {
      Point local = body.end.vertices[corner];
      for (std::size_t axis = 0; axis < 3; ++axis)
      {
        middle[axis] += local[axis] / 3;
        local[axis] -= model.to_scene.translation[axis];
      }
      load.mesh.vertices.push_back(turned_back(model.to_scene, local));
    }
    load.mesh.triangles = { { { 0, 1, 2 } } };
    load.value = turned_back(model.to_scene, body.traction(middle));
    load.binding = bind_points(model, load.mesh.vertices);
    model.loads.push_back(load);
  }
}

/// Squared error and squared displacement, weighted by area.
struct Difference
{
  double error = 0, size = 0;
  double relative() const { return std::sqrt(error / size); }
};

void compare(const BoundaryBody& body, const Model& model, const TriangleMesh& mesh, const Binding& binding,
             const std::array<std::vector<double>, 3>& u, Difference& sum)
{
  const std::vector<double> area = vertex_areas(mesh);
  const double* const nodes[3] = { u[0].data(), u[1].data(), u[2].data() };
  for (std::size_t v = 0; v < area.size(); ++v)
  {
    const Point exact = body.exact(model.to_scene(mesh.vertices[v]));
    if (std::isnan(exact[0]))
      continue;
    const Point found = model.to_scene.turned(bound_displacement(model, binding, v, nodes));
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      sum.error += area[v] * (found[axis] - exact[axis]) * (found[axis] - exact[axis]);
      sum.size += area[v] * exact[axis] * exact[axis];
    }
  }
}

/// Root mean square error of the displacement, divided by the root mean square displacement.
double error_of(const BoundaryBody& body, double edge, const Backend& backend, const BakeScene& bake)
{
  Scene scene = body.scene;
  scene.accuracy.voxel = { edge, edge, edge };
  Model model = bake(scene);
  hold_mirrors(body, model);
  load_end(body, model);
  EquilibriumSettings search;
  search.backend = backend;
  // Settling is tested over windows of some hundred steps, which are many periods of a thin layer of coarse voxels.
  search.period = std::max(body.period, 0.04);
  const RestState state = find_equilibrium(model, search);
  std::array<std::vector<double>, 3> u;
  for (const Point& moved : state.displacements)
    for (std::size_t axis = 0; axis < 3; ++axis)
      u[axis].push_back(moved[axis]);
  Difference sum;
  compare(body, model, model.skin, model.skin_binding, u, sum);
  for (const Load& load : model.loads)
    if (load.kind == Load::Kind::pressure)
      compare(body, model, load.mesh, load.binding, u, sum);
  return sum.relative();
}

void measure(const std::vector<BoundaryBody>& bodies, const Backend& backend, const BakeScene& bake, Finding& finding)
{
  if (!bake)
  {
    finding.skipped = "the program was built without a bake";
    return;
  }
  const std::vector<double> edges = { 3e-3, 2e-3, 1.5e-3, 1e-3 };
  Table table({ "body", "boundary", "3 mm [%]", "2 mm [%]", "1.5 mm [%]", "1 mm [%]", "order" });
  for (BoundaryBody body : bodies)
    for (const char* const boundary : { "staircase", "true" })
    {
      const bool staircase = boundary == std::string("staircase");
      body.scene.accuracy.boundary = boundary;
      body.scene.accuracy.fill_min = staircase ? 0.2 : 0.05;
      std::vector<double> errors;
      std::vector<Table::Cell> row{ body.name, boundary };
      for (const double edge : edges)
      {
        errors.push_back(error_of(body, edge, backend, bake));
        row.emplace_back(std::round(1e4 * errors.back()) / 100);
      }
      const double order = slope(edges, errors);
      row.emplace_back(std::round(100 * order) / 100);
      table.add(row);
      for (const std::size_t at : { 1, 3 })
        finding.checks.absolute(fmt::format("{}, {}, {}", body.name, millimetres(edges[at]), boundary), "1", 0,
                                errors[at], staircase ? std::nan("") : body.bounds[at / 2]);
      if (staircase)
        continue;
      const bool converges = order >= 1.4 || (errors[1] <= 0.01 && errors[3] <= 0.005);
      finding.checks.absolute(body.name + ", shortfall from order 1.4 (none if 1 % at 2 mm and 0.5 % at 1 mm), true",
                              "1", 0, converges ? 0 : 1.4 - order, body.converges ? 0 : std::nan(""));
    }
  finding.tables.emplace_back("RMS error of the displacement over its RMS", table);
}

}  // namespace

void verify_attachment(const Backend& backend, const BakeScene& bake, Finding& finding)
{
  std::vector<BoundaryBody> bodies;
  for (const bool slides : { false, true })
  {
    for (const double poisson : { 0.3, 0.49 })
      bodies.push_back(curved_layer(5e-3, poisson, slides, false));
    bodies.push_back(curved_layer(5e-3, 0.49, slides, true));
  }
  measure(bodies, backend, bake, finding);
}

void verify_fitted_layers(const Backend& backend, const BakeScene& bake, Finding& finding)
{
  if (!calculix_is_installed())
  {
    finding.skipped = calculix_is_missing;
    return;
  }
  std::vector<BoundaryBody> bodies;
  for (const bool mixed : { true, false })
  {
    const FittedLayer layer = fitted_layer(mixed);
    finding.checks.absolute(layer.body.name + ", CalculiX with elements twice as large", "1", 0, layer.mesh_error,
                            0.003);
    bodies.push_back(layer.body);
  }
  measure(bodies, backend, bake, finding);
}

void verify_free_sides(const Backend& backend, const BakeScene& bake, Finding& finding)
{
  const ScratchFolder folder;
  const std::string path = folder.path.string();
  measure({ pressed_sphere(0.3), pressed_sphere(0.49), turned_bar(false, BarLoad::bending, path),
            turned_bar(true, BarLoad::bending, path), turned_bar(true, BarLoad::torsion, path) },
          backend, bake, finding);
}

}  // namespace frontalis
