#include "frontalis/study/linear_statics.hpp"

#include "frontalis/error.hpp"
#include "frontalis/solver/solver.hpp"

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <map>

namespace frontalis
{
namespace
{

using ElementMatrix = Eigen::Matrix<double, 24, 24>;  // index 3 * corner + axis

// a voxel of the model alone
Model lone_voxel(const Model& model, std::size_t e)
{
  Model one;
  one.spacing = model.spacing;
  one.size = { { 1, 1, 1 } };
  one.voxels = { { { 0, 0, 0 } } };
  one.fill = { model.fill[e] };
  one.materials = model.materials;
  const auto begin = model.mixture_begin[e], end = model.mixture_begin[e + 1];
  one.mixture_begin = { 0, end - begin };
  one.mixture_material.assign(model.mixture_material.begin() + begin, model.mixture_material.begin() + end);
  one.mixture_proportion.assign(model.mixture_proportion.begin() + begin, model.mixture_proportion.begin() + end);
  if (!model.material_directions.empty())
    one.material_directions = { model.material_directions[e] };
  one.fibre_begin = { 0, 0 };
  one.hourglass = model.hourglass;
  one.integration = model.integration;
  build_nodes(one);
  return one;
}

// the properties of a voxel that decide its stiffness
std::vector<float> make_of(const Model& model, std::size_t e)
{
  std::vector<float> make{ model.fill[e] };
  for (auto m = model.mixture_begin[e]; m < model.mixture_begin[e + 1]; ++m)
  {
    make.push_back(model.mixture_material[m]);
    make.push_back(model.mixture_proportion[m]);
  }
  if (!model.material_directions.empty())
    make.insert(make.end(), model.material_directions[e].begin(), model.material_directions[e].end());
  return make;
}

ElementMatrix element_stiffness(const Model& model, std::size_t e, const std::array<double, 9>& gradient)
{
  const auto one = std::make_shared<const Model>(lone_voxel(model, e));
  const auto solver = make_solver(one, { Backend::reference, 1, 0 });
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
  // symmetric but for rounding
  return 0.5 * (k + k.transpose());
}

}  // namespace

struct LinearStatics::System
{
  std::vector<std::array<int, 3>> unknown;  // of each component of each node; -1: fixed
  Vectors fixed;                            // prescribed displacements
  Eigen::VectorXd forces;                   // that the prescribed displacements exert on the unknowns
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> factor;
};

LinearStatics::LinearStatics(const Model& model, const std::array<double, 9>& gradient)
    : system_(std::make_unique<System>())
{
  if (!model.muscles.empty() || !model.sliding.empty())
    throw Error("linear statics: the model has muscles or sliding nodes; it must have neither");
  auto& [unknown, fixed, forces, factor] = *system_;
  unknown.assign(model.nodes.size(), { { 0, 0, 0 } });
  fixed.assign(model.nodes.size(), { { 0, 0, 0 } });
  for (const auto& rigid : model.rigid)
    unknown[rigid.node] = { { -1, -1, -1 } };
  for (const auto& [node, load] : model.prescribed)
    for (int axis = 0; axis < 3; ++axis)
      if (model.loads[load].fixed[axis])
      {
        unknown[node][axis] = -1;
        fixed[node][axis] = model.loads[load].value[axis];
      }
  int count = 0;
  for (auto& node : unknown)
    for (int& component : node)
      component = component < 0 ? -1 : count++;

  forces = Eigen::VectorXd::Zero(count);
  std::vector<Eigen::Triplet<double>> entries;
  std::map<std::vector<float>, ElementMatrix> known;
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    const auto [entry, is_new] = known.try_emplace(make_of(model, e));
    if (is_new)
      entry->second = element_stiffness(model, e, gradient);
    for (int row = 0; row < 24; ++row)
    {
      const int i = unknown[model.voxel_nodes[e][row / 3]][row % 3];
      for (int column = 0; i >= 0 && column < 24; ++column)
      {
        const auto node = model.voxel_nodes[e][column / 3];
        const int j = unknown[node][column % 3];
        if (j < 0)
          forces[i] -= entry->second(row, column) * fixed[node][column % 3];
        else if (j <= i)
          entries.emplace_back(i, j, entry->second(row, column));
      }
    }
  }
  Eigen::SparseMatrix<double> stiffness(count, count);
  stiffness.setFromTriplets(entries.begin(), entries.end());
  factor.compute(stiffness);
}

LinearStatics::~LinearStatics() = default;

bool LinearStatics::positive_definite() const { return system_->factor.info() == Eigen::Success; }

Vectors LinearStatics::solve(const Vectors& forces) const
{
  if (!positive_definite())
    throw Error("linear statics: the stiffness is not positive definite");
  Eigen::VectorXd right = system_->forces;
  Vectors u = system_->fixed;
  const auto for_each_unknown = [this](const auto& visit)
  {
    for (std::size_t n = 0; n < system_->unknown.size(); ++n)
      for (int axis = 0; axis < 3; ++axis)
        if (system_->unknown[n][axis] >= 0)
          visit(n, axis, system_->unknown[n][axis]);
  };
  for_each_unknown([&](std::size_t n, int axis, int i) { right[i] += forces[n][axis]; });
  const Eigen::VectorXd solution = system_->factor.solve(right);
  for_each_unknown([&](std::size_t n, int axis, int i) { u[n][axis] = solution[i]; });
  return u;
}

Vectors face_forces(const Model& model, int axis, std::int32_t index, const std::array<double, 3>& traction)
{
  Vectors forces(model.nodes.size());
  const int second = (axis + 1) % 3, third = (axis + 2) % 3;
  const double quarter = 0.25 * model.spacing[second] * model.spacing[third];
  for (const auto& corners : model.voxel_nodes)
    for (const int side : { 0, 1 })
    {
      const auto first = corners[static_cast<std::size_t>(side) << axis];
      // a face that two voxels share is counted by the lower one alone; the plane 0 has no lower ones
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
