#include "frontalis/study/statics.hpp"

#include "frontalis/error.hpp"
#include "frontalis/physics/trilinear.hpp"
#include "frontalis/solver/guard.hpp"
#include "frontalis/solver/shell_mesh.hpp"

#include <Eigen/Sparse>
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace frontalis
{
namespace
{

using ElementMatrix = Eigen::Matrix<double, 24, 24>;  // index 3 * corner + axis
using Sparse = Eigen::SparseMatrix<double>;           // index 3 * node (or vertex) + axis
using Entries = std::vector<Eigen::Triplet<double>>;

void expect_size(const char* what, std::size_t found, std::size_t expected)
{
  if (found != expected)
    throw Error(fmt::format("linear statics: {} points have {}; there must be {}", found, what, expected));
}

Mixture mixture_of(const Model& model, std::size_t e)
{
  Mixture mixture;
  for (auto m = model.mixture_begin[e]; m < model.mixture_begin[e + 1]; ++m)
    mixture.emplace_back(model.mixture_material[m], model.mixture_proportion[m]);
  return mixture;
}

Model lone_voxel(const Model& model, std::size_t e)
{
  Model one =
      voxel_model({ { { 1, 1, 1 } }, model.spacing, model.materials, [&](const auto&) { return model.fill[e]; } });
  mix(one, [&](std::size_t) { return mixture_of(model, e); });
  if (!model.material_directions.empty())
    one.material_directions = { model.material_directions[e] };
  one.hourglass = model.hourglass;
  one.integration = model.integration;
  return one;
}

// The properties of a voxel that determine its stiffness.
std::vector<float> stiffness_key(const Model& model, std::size_t e)
{
  std::vector<float> key{ model.fill[e] };
  for (const auto& [material, proportion] : mixture_of(model, e))
    key.insert(key.end(), { static_cast<float>(material), proportion });
  if (!model.material_directions.empty())
    key.insert(key.end(), model.material_directions[e].begin(), model.material_directions[e].end());
  return key;
}

ElementMatrix element_stiffness(const Model& model, std::size_t e, const std::array<double, 9>& gradient)
{
  const auto one = std::make_shared<const Model>(lone_voxel(model, e));
  const auto solver = make_solver(one, { "reference", 1, 0 });
  const Vectors u = affine_displacements(*one, gradient);
  const double step = 1e-6 * *std::min_element(model.spacing.begin(), model.spacing.end());
  ElementMatrix k;
  Vectors before, after;
  for (int column = 0; column < 24; ++column)
  {
    Vectors moved = u;
    double& component = moved[column / 3][column % 3];
    component -= step;
    solver->set_displacements(moved);
    solver->internal_forces(before);
    component += 2 * step;
    solver->set_displacements(moved);
    solver->internal_forces(after);
    for (int row = 0; row < 24; ++row)
      k(row, column) = (after[row / 3][row % 3] - before[row / 3][row % 3]) / (2 * step);
  }
  // The mean of the matrix and its transpose is free of the asymmetry of rounding errors.
  return 0.5 * (k + k.transpose());
}

int row_of(std::size_t point, std::size_t axis) { return static_cast<int>(3 * point + axis); }

Sparse sparse(int rows, int columns, const Entries& entries)
{
  Sparse matrix(rows, columns);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

Sparse voxel_stiffness(const Model& model, const std::array<double, 9>& gradient)
{
  Entries entries;
  entries.reserve(model.voxels.size() * 24 * 24);
  std::map<std::vector<float>, ElementMatrix> known;
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    const auto [entry, is_new] = known.try_emplace(stiffness_key(model, e));
    if (is_new)
      entry->second = element_stiffness(model, e, gradient);
    const auto& nodes = model.voxel_nodes[e];
    for (int row = 0; row < 24; ++row)
      for (int column = 0; column < 24; ++column)
        entries.emplace_back(row_of(nodes[row / 3], row % 3), row_of(nodes[column / 3], column % 3),
                             entry->second(row, column));
  }
  const auto size = row_of(model.nodes.size(), 0);
  return sparse(size, size, entries);
}

// Stiffness of shells between their own vertices, by central differences of the forces of each triangle about the
// displacements `moved`.
Sparse vertex_stiffness(const ShellMesh& mesh, const std::vector<physics::Vec3<double>>& moved)
{
  Entries entries;
  entries.reserve(mesh.triangles.size() * 18 * 18);
  for (const auto& triangle : mesh.triangles)
  {
    const double step = 1e-6 / std::sqrt(triangle.rest.inverse_area);
    for (std::size_t column = 0; column < 18; ++column)
    {
      physics::Vec3<double> u[6];
      for (std::size_t i = 0; i < 6; ++i)
        u[i] = moved[triangle.vertex[i]];
      auto& vector = u[column / 3];
      double& component = column % 3 == 0 ? vector.x : column % 3 == 1 ? vector.y : vector.z;
      component -= step;
      const auto before = physics::shell_forces(triangle.rest, u);
      component += 2 * step;
      const auto after = physics::shell_forces(triangle.rest, u);
      for (std::size_t i = 0; i < 6; ++i)
      {
        const auto change = (0.5 / step) * (before.force[i] - after.force[i]);
        const double of_axis[3] = { change.x, change.y, change.z };
        for (std::size_t axis = 0; axis < 3; ++axis)
          entries.emplace_back(row_of(triangle.vertex[i], axis), row_of(triangle.vertex[column / 3], column % 3),
                               of_axis[axis]);
      }
    }
  }
  const auto size = row_of(moved.size(), 0);
  const Sparse own = sparse(size, size, entries);
  return 0.5 * Sparse(own + Sparse(own.transpose()));
}

// Stiffness of shells between the nodes that carry them.
Sparse shell_stiffness(const Model& model, const std::array<double, 9>& gradient)
{
  const ShellMesh mesh(model);
  const auto vertices = mesh.binding.voxel.size();
  Entries binding;
  std::vector<physics::Vec3<double>> moved(vertices);
  const Vectors of_nodes = affine_displacements(model, gradient);
  for (std::size_t v = 0; v < vertices; ++v)
  {
    const auto& at = mesh.binding.coordinates[v];
    double weight[8];
    physics::trilinear_weights<double>(at[0], at[1], at[2], weight);
    moved[v] = { 0, 0, 0 };
    for (std::size_t b = 0; b < 8; ++b)
    {
      const auto node = model.voxel_nodes[mesh.binding.voxel[v]][b];
      const Point& u = of_nodes[node];
      moved[v] = moved[v] + weight[b] * physics::Vec3<double>{ u[0], u[1], u[2] };
      for (std::size_t axis = 0; axis < 3; ++axis)
        binding.emplace_back(row_of(node, axis), row_of(v, axis), weight[b]);
    }
  }
  const Sparse bind = sparse(row_of(model.nodes.size(), 0), row_of(vertices, 0), binding);
  return bind * vertex_stiffness(mesh, moved) * bind.transpose();
}

}  // namespace

RestState find_equilibrium(Model model, const EquilibriumSettings& settings)
{
  constexpr double longest = 60;  // largest number of periods before a search for equilibrium has failed
  model.damping = 4 * std::acos(-1.0) / settings.period;
  for (auto& load : model.loads)
    load.ramp = settings.ramp * settings.period;
  // With few voxels, several threads would spend more time waiting for each other than working.
  const int threads = model.voxels.size() < 2000 ? 1 : 0;
  const auto shared = std::make_shared<const Model>(std::move(model));
  RestState result{ make_solver(shared, { settings.backend, threads, 0 }), {} };
  Controls target = result.solver->controls();
  std::fill(target.activation.begin(), target.activation.end(), settings.activation);
  std::fill(target.bone.begin(), target.bone.end(), settings.bone_pose);
  Guard guard(*result.solver, shared);
  guard.advance(settings.ramp * settings.period, target);
  const Equilibrium end = guard.settle(target, settings.tolerance, longest * settings.period);
  if (!end.reached)
    throw Error(fmt::format("no equilibrium within {:g} periods of {:g} s: {:.3g} of the displacement is left", longest,
                            settings.period, end.residual));
  result.solver->displacements(result.displacements);
  return result;
}

Point mean_displacement(const Vectors& displacements, const std::vector<std::int32_t>& nodes)
{
  Point mean{};
  for (const auto node : nodes)
    for (std::size_t axis = 0; axis < 3; ++axis)
      mean[axis] += displacements[node][axis] / static_cast<double>(nodes.size());
  return mean;
}

Point internal_force(Solver& solver, const std::vector<std::int32_t>& nodes)
{
  Vectors forces;
  solver.internal_forces(forces);
  Point sum{};
  for (const auto node : nodes)
    for (std::size_t axis = 0; axis < 3; ++axis)
      sum[axis] += forces[node][axis];
  return sum;
}

struct LinearStatics::System
{
  // for each component of each point, the index of its unknown; -1: the component is fixed
  std::vector<std::array<int, 3>> unknown;
  Vectors fixed;           // prescribed displacements [m]
  Eigen::VectorXd forces;  // forces that prescribed displacements cause [N]
  Eigen::SimplicialLLT<Sparse> factor;

  explicit System(std::size_t points) : unknown(points, { { 0, 0, 0 } }), fixed(points, { { 0, 0, 0 } }) {}

  template <class Visit>
  void for_each_unknown(const Visit& visit) const
  {
    for (std::size_t n = 0; n < unknown.size(); ++n)
      for (std::size_t axis = 0; axis < 3; ++axis)
        if (unknown[n][axis] >= 0)
          visit(unknown[n][axis], n, axis);
  }

  // Numbers the components that are not fixed, and factorises their stiffness.
  void factorise(const Sparse& stiffness)
  {
    int count = 0;
    for (auto& point : unknown)
      for (int& row : point)
        row = row < 0 ? -1 : count++;
    Entries kept;
    Eigen::VectorXd prescribed = Eigen::VectorXd::Zero(stiffness.cols());
    for (std::size_t n = 0; n < unknown.size(); ++n)
      for (std::size_t axis = 0; axis < 3; ++axis)
        prescribed[row_of(n, axis)] = fixed[n][axis];
    for_each_unknown([&](int row, std::size_t n, std::size_t axis) { kept.emplace_back(row, row_of(n, axis), 1); });
    const Sparse select = sparse(count, static_cast<int>(stiffness.cols()), kept);
    forces = -(select * (stiffness * prescribed));
    factor.compute(select * stiffness * select.transpose());
  }
};

LinearStatics::LinearStatics(const Model& model, const std::array<double, 9>& gradient)
    : system_(std::make_unique<System>(model.nodes.size()))
{
  if (!model.muscles.empty() || !model.sliding.empty())
    throw Error("linear statics: the model has muscles or sliding nodes; it must have neither");
  for (const auto& rigid : model.rigid)
    system_->unknown[rigid.node] = { { -1, -1, -1 } };
  for (const auto& [node, load] : model.prescribed)
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (model.loads[load].fixed[axis])
      {
        system_->unknown[node][axis] = -1;
        system_->fixed[node][axis] = model.loads[load].value[axis];
      }
  Sparse stiffness = voxel_stiffness(model, gradient);
  if (!model.shells.empty())
    stiffness += shell_stiffness(model, gradient);
  system_->factorise(stiffness);
}

LinearStatics::LinearStatics(const Model& model, const std::vector<std::array<bool, 3>>& fixed)
    : system_(std::make_unique<System>(fixed.size()))
{
  const ShellMesh mesh(model);
  if (mesh.binding.voxel.empty())
    throw Error("linear statics of shells: the model has no shells");
  expect_size("components that are held", fixed.size(), mesh.binding.voxel.size());
  for (std::size_t v = 0; v < fixed.size(); ++v)
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (fixed[v][axis])
        system_->unknown[v][axis] = -1;
  system_->factorise(vertex_stiffness(mesh, std::vector<physics::Vec3<double>>(fixed.size(), { 0, 0, 0 })));
}

LinearStatics::~LinearStatics() = default;

bool LinearStatics::positive_definite() const { return system_->factor.info() == Eigen::Success; }

Vectors LinearStatics::solve(const Vectors& forces) const
{
  if (!positive_definite())
    throw Error("linear statics: the stiffness is not positive definite");
  expect_size("forces", forces.size(), system_->unknown.size());
  Eigen::VectorXd x = system_->forces;
  system_->for_each_unknown([&](int row, std::size_t n, std::size_t axis) { x[row] += forces[n][axis]; });
  x = system_->factor.solve(x);
  Vectors u = system_->fixed;
  system_->for_each_unknown([&](int row, std::size_t n, std::size_t axis) { u[n][axis] = x[row]; });
  return u;
}

Vectors face_forces(const Model& model, int axis, std::int32_t index, const Point& traction)
{
  Vectors forces(model.nodes.size());
  const int second = (axis + 1) % 3, third = (axis + 2) % 3;
  const double quarter = 0.25 * model.spacing[second] * model.spacing[third];
  for (const auto& corners : model.voxel_nodes)
    for (const int side : { 0, 1 })
    {
      const auto first = corners[static_cast<std::size_t>(side) << axis];
      // Each face is counted once: for the voxel below it or, in plane 0, for the voxel above it.
      if (model.nodes[first][axis] != index || (side == 0 && index != 0))
        continue;
      for (std::size_t b = 0; b < 8; ++b)
        if (static_cast<int>(b >> axis & 1) == side)
          for (int i = 0; i < 3; ++i)
            forces[corners[b]][i] += quarter * traction[i];
    }
  return forces;
}

}  // namespace frontalis
