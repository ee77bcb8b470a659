#include "frontalis/study/statics.hpp"

#include "frontalis/error.hpp"
#include "frontalis/solver/guard.hpp"

#include <Eigen/Cholesky>
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace frontalis
{
namespace
{

using ElementMatrix = Eigen::Matrix<double, 24, 24>;  // index 3 * corner + axis

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

// the properties of a voxel that determine its stiffness
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
  // removes the asymmetry of rounding errors
  return 0.5 * (k + k.transpose());
}

}  // namespace

RestState find_equilibrium(Model model, const EquilibriumSettings& settings)
{
  constexpr double longest = 60;  // periods
  model.damping = 4 * std::acos(-1.0) / settings.period;
  for (auto& load : model.loads)
    load.ramp = settings.ramp * settings.period;
  // with few voxels, several threads would wait for each other longer than they work
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

// Voxels couple only neighbouring planes of nodes. With planes across the longest axis of the grid the stiffness is
// therefore block tridiagonal, and its Cholesky factor consists of dense blocks.
struct LinearStatics::System
{
  struct Unknown
  {
    int plane = 0, row = -1;  // row in the plane's block; -1: fixed component
  };
  std::vector<std::array<Unknown, 3>> unknowns;    // one per node and component
  Vectors fixed;                                   // prescribed displacements [m]
  std::vector<Eigen::VectorXd> forces;             // per plane: forces that prescribed displacements cause [N]
  std::vector<Eigen::LLT<Eigen::MatrixXd>> plane;  // per plane: factor of its own block
  std::vector<Eigen::MatrixXd> next;               // per plane: factor of the block that couples it to the next
  bool positive_definite = true;

  void factorise(std::vector<Eigen::MatrixXd> diagonal)
  {
    for (std::size_t p = 0; p < diagonal.size() && positive_definite; ++p)
    {
      plane.emplace_back(diagonal[p]);
      positive_definite = plane.back().info() == Eigen::Success;
      if (p + 1 == diagonal.size() || !positive_definite)
        continue;
      plane[p].matrixU().solveInPlace<Eigen::OnTheRight>(next[p]);
      diagonal[p + 1].noalias() -= next[p] * next[p].transpose();
    }
  }

  void solve_in_place(std::vector<Eigen::VectorXd>& x) const
  {
    for (std::size_t p = 0; p < x.size(); ++p)
    {
      if (p > 0)
        x[p].noalias() -= next[p - 1] * x[p - 1];
      plane[p].matrixL().solveInPlace(x[p]);
    }
    for (std::size_t p = x.size(); p-- > 0;)
    {
      if (p + 1 < x.size())
        x[p].noalias() -= next[p].transpose() * x[p + 1];
      plane[p].matrixU().solveInPlace(x[p]);
    }
  }
};

LinearStatics::LinearStatics(const Model& model, const std::array<double, 9>& gradient)
    : system_(std::make_unique<System>())
{
  if (!model.muscles.empty() || !model.sliding.empty())
    throw Error("linear statics: the model has muscles or sliding nodes; it must have neither");
  std::vector<std::array<bool, 3>> held(model.nodes.size(), { { false, false, false } });
  system_->fixed.assign(model.nodes.size(), { { 0, 0, 0 } });
  for (const auto& rigid : model.rigid)
    held[rigid.node] = { { true, true, true } };
  for (const auto& [node, load] : model.prescribed)
    for (int axis = 0; axis < 3; ++axis)
      if (model.loads[load].fixed[axis])
      {
        held[node][axis] = true;
        system_->fixed[node][axis] = model.loads[load].value[axis];
      }
  const auto along = std::max_element(model.size.begin(), model.size.end()) - model.size.begin();
  const std::size_t planes = static_cast<std::size_t>(model.size[along]) + 1;
  std::vector<int> rows(planes, 0);
  system_->unknowns.resize(model.nodes.size());
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
    for (int axis = 0; axis < 3; ++axis)
    {
      const int plane = model.nodes[n][along];
      system_->unknowns[n][axis] = { plane, held[n][axis] ? -1 : rows[plane]++ };
    }

  std::vector<Eigen::MatrixXd> diagonal;
  for (std::size_t p = 0; p < planes; ++p)
  {
    diagonal.emplace_back(Eigen::MatrixXd::Zero(rows[p], rows[p]));
    system_->forces.emplace_back(Eigen::VectorXd::Zero(rows[p]));
    if (p + 1 < planes)
      system_->next.emplace_back(Eigen::MatrixXd::Zero(rows[p + 1], rows[p]));
  }
  std::map<std::vector<float>, ElementMatrix> known;
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    const auto [entry, is_new] = known.try_emplace(stiffness_key(model, e));
    if (is_new)
      entry->second = element_stiffness(model, e, gradient);
    const ElementMatrix& k = entry->second;
    for (int row = 0; row < 24; ++row)
    {
      const auto [plane, i] = system_->unknowns[model.voxel_nodes[e][row / 3]][row % 3];
      for (int column = 0; i >= 0 && column < 24; ++column)
      {
        const auto node = model.voxel_nodes[e][column / 3];
        const auto [other, j] = system_->unknowns[node][column % 3];
        if (j < 0)
          system_->forces[plane][i] -= k(row, column) * system_->fixed[node][column % 3];
        else if (other <= plane)
          (other == plane ? diagonal[plane] : system_->next[other])(i, j) += k(row, column);
      }
    }
  }
  system_->factorise(std::move(diagonal));
}

LinearStatics::~LinearStatics() = default;

bool LinearStatics::positive_definite() const { return system_->positive_definite; }

Vectors LinearStatics::solve(const Vectors& forces) const
{
  if (!positive_definite())
    throw Error("linear statics: the stiffness is not positive definite");
  std::vector<Eigen::VectorXd> x = system_->forces;
  Vectors u = system_->fixed;
  const auto for_each_unknown = [&](const auto& visit)
  {
    for (std::size_t n = 0; n < u.size(); ++n)
      for (int axis = 0; axis < 3; ++axis)
        if (const auto [plane, row] = system_->unknowns[n][axis]; row >= 0)
          visit(x[plane][row], n, axis);
  };
  for_each_unknown([&](double& value, std::size_t n, int axis) { value += forces[n][axis]; });
  system_->solve_in_place(x);
  for_each_unknown([&](double value, std::size_t n, int axis) { u[n][axis] = value; });
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
      // count a face once: for the voxel below it, or in plane 0, which has none, for the voxel above it
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
