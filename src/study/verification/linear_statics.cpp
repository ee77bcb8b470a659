#include "frontalis/study/linear_statics.hpp"

#include "frontalis/error.hpp"
#include "frontalis/solver/solver.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>

namespace frontalis
{
namespace
{

using Matrix = std::vector<double>;  // 24 x 24: 3 * corner + axis

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

// what tells voxels of different make apart
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

Matrix element_stiffness(const Model& model, std::size_t e, const std::array<double, 9>& gradient)
{
  const auto one = std::make_shared<const Model>(lone_voxel(model, e));
  const auto solver = make_solver(one, { "reference", 1, 0 });
  Vectors u(8), f[2];
  for (std::size_t b = 0; b < 8; ++b)
  {
    const auto p = rest_position(*one, b);
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        u[b][i] += (gradient[3 * i + j] - (i == j ? 1 : 0)) * p[j];
  }
  const double step = 1e-6 * *std::min_element(model.spacing.begin(), model.spacing.end());
  Matrix k(576);
  for (std::size_t column = 0; column < 24; ++column)
  {
    for (int side = 0; side < 2; ++side)
    {
      Vectors moved = u;
      moved[column / 3][column % 3] += side == 0 ? -step : step;
      solver->set_displacements(moved);
      solver->internal_forces(f[side]);
    }
    for (std::size_t row = 0; row < 24; ++row)
      k[24 * row + column] = (f[1][row / 3][row % 3] - f[0][row / 3][row % 3]) / (2 * step);
  }
  // symmetric but for rounding
  for (std::size_t row = 0; row < 24; ++row)
    for (std::size_t column = 0; column < row; ++column)
      k[24 * row + column] = k[24 * column + row] = 0.5 * (k[24 * row + column] + k[24 * column + row]);
  return k;
}

}  // namespace

LinearStatics::LinearStatics(const Model& model, const std::array<double, 9>& gradient)
{
  if (!model.muscles.empty() || !model.sliding.empty())
    throw Error("linear statics has neither muscles nor sliding nodes");
  const std::size_t nodes = model.nodes.size();
  std::vector<std::array<bool, 3>> held(nodes, { { false, false, false } });
  fixed_.assign(nodes, { { 0, 0, 0 } });
  for (const auto& rigid : model.rigid)
    held[rigid.node] = { { true, true, true } };
  for (const auto& [node, load] : model.prescribed)
    for (int axis = 0; axis < 3; ++axis)
      if (model.loads[load].fixed[axis])
      {
        held[node][axis] = true;
        fixed_[node][axis] = model.loads[load].value[axis];
      }

  // unknowns are numbered along the longest way through the grid: a narrow band
  std::array<int, 3> axes{ { 0, 1, 2 } };
  std::sort(axes.begin(), axes.end(), [&](int a, int b) { return model.size[a] > model.size[b]; });
  std::vector<std::size_t> order(nodes);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b)
            {
              for (const int axis : axes)
                if (model.nodes[a][axis] != model.nodes[b][axis])
                  return model.nodes[a][axis] < model.nodes[b][axis];
              return false;
            });
  unknown_.assign(nodes, { { -1, -1, -1 } });
  for (const auto node : order)
    for (int axis = 0; axis < 3; ++axis)
      if (!held[node][axis])
        unknown_[node][axis] = static_cast<std::int32_t>(count_++);
  assemble(model, gradient);
  factorise();
}

void LinearStatics::assemble(const Model& model, const std::array<double, 9>& gradient)
{
  for (const auto& corners : model.voxel_nodes)
  {
    std::int32_t lowest = static_cast<std::int32_t>(count_), highest = -1;
    for (const auto node : corners)
      for (const auto unknown : unknown_[node])
        if (unknown >= 0)
        {
          lowest = std::min(lowest, unknown);
          highest = std::max(highest, unknown);
        }
    width_ = std::max(width_, static_cast<std::size_t>(std::max(highest - lowest, 0)));
  }
  band_.assign(count_ * (width_ + 1), 0);
  right_.assign(count_, 0);
  std::map<std::vector<float>, Matrix> known;
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    const auto entry = known.try_emplace(make_of(model, e));
    Matrix& k = entry.first->second;
    if (entry.second)
      k = element_stiffness(model, e, gradient);
    for (std::size_t row = 0; row < 24; ++row)
    {
      const auto i = unknown_[model.voxel_nodes[e][row / 3]][row % 3];
      for (std::size_t column = 0; i >= 0 && column < 24; ++column)
      {
        const auto node = model.voxel_nodes[e][column / 3];
        const auto j = unknown_[node][column % 3];
        if (j < 0)
          right_[i] -= k[24 * row + column] * fixed_[node][column % 3];
        else if (j <= i)
          band_[static_cast<std::size_t>(j) * (width_ + 1) + static_cast<std::size_t>(i - j)] += k[24 * row + column];
      }
    }
  }
}

void LinearStatics::factorise()
{
  const std::size_t stride = width_ + 1;
  for (std::size_t j = 0; j < count_; ++j)
  {
    double* const column = band_.data() + j * stride;
    if (!(column[0] > 0))
    {
      positive_definite_ = false;
      return;
    }
    const double scale = 1 / std::sqrt(column[0]);
    const std::size_t last = std::min(width_, count_ - 1 - j);
    for (std::size_t r = 0; r <= last; ++r)
      column[r] *= scale;
    for (std::size_t k = 1; k <= last; ++k)
    {
      const double factor = column[k];
      if (factor == 0)
        continue;
      double* const other = column + k * stride;
      for (std::size_t r = k; r <= last; ++r)
        other[r - k] -= factor * column[r];
    }
  }
}

void LinearStatics::back_substitute(std::vector<double>& x) const
{
  const std::size_t stride = width_ + 1;
  for (std::size_t j = 0; j < count_; ++j)
  {
    const double* const column = band_.data() + j * stride;
    x[j] /= column[0];
    for (std::size_t r = 1; r <= std::min(width_, count_ - 1 - j); ++r)
      x[j + r] -= column[r] * x[j];
  }
  for (std::size_t j = count_; j-- > 0;)
  {
    const double* const column = band_.data() + j * stride;
    for (std::size_t r = 1; r <= std::min(width_, count_ - 1 - j); ++r)
      x[j] -= column[r] * x[j + r];
    x[j] /= column[0];
  }
}

Vectors LinearStatics::solve(const Vectors& forces) const
{
  if (!positive_definite_)
    throw Error("linear statics: the stiffness is not positive definite");
  std::vector<double> x = right_;
  for (std::size_t n = 0; n < unknown_.size(); ++n)
    for (int axis = 0; axis < 3; ++axis)
      if (unknown_[n][axis] >= 0)
        x[unknown_[n][axis]] += forces[n][axis];
  back_substitute(x);
  Vectors u = fixed_;
  for (std::size_t n = 0; n < unknown_.size(); ++n)
    for (int axis = 0; axis < 3; ++axis)
      if (unknown_[n][axis] >= 0)
        u[n][axis] = x[unknown_[n][axis]];
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
      // the face of the voxel on the plane, but each face of the model once: its outer side
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
