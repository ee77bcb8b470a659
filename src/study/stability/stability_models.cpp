#include "study/stability/stability_models.hpp"

#include "frontalis/solver/rigid_motion.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{

Material soft_tissue(double poisson) { return neo_hookean(34e3, poisson); }

Model soft_block(const std::array<std::int32_t, 3>& size) { return voxel_model(size, 1e-3, soft_tissue()); }

Model damped_block(const CaseFile& file)
{
  Model model = soft_block(file.size());
  model.damping = file.number("damping", "1/s");
  return model;
}

void hold(Model& model, const std::function<bool(const std::array<double, 3>&)>& condition, const std::string& bone)
{
  std::int32_t index = -1;
  if (!bone.empty())
  {
    const auto found = std::find(model.bones.begin(), model.bones.end(), bone);
    index = static_cast<std::int32_t>(found - model.bones.begin());
    if (found == model.bones.end())
      model.bones.push_back(bone);
  }
  for (const auto node : nodes_where(model, condition))
    model.rigid.push_back({ node, index });
}

void hold_face(Model& model, int axis, bool upper, const std::string& bone)
{
  const double h = model.spacing[axis];
  const double at = upper ? model.size[axis] * h : 0;
  hold(
      model, [=](const auto& p) { return std::abs(p[axis] - at) < 0.5 * h; }, bone);
}

void mix(Model& model, const std::function<std::vector<std::pair<int, float>>(std::size_t)>& mixture)
{
  model.mixture_begin.assign(1, 0);
  model.mixture_material.clear();
  model.mixture_proportion.clear();
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    for (const auto& [material, proportion] : mixture(e))
    {
      model.mixture_material.push_back(static_cast<std::int16_t>(material));
      model.mixture_proportion.push_back(proportion);
    }
    model.mixture_begin.push_back(static_cast<std::int32_t>(model.mixture_material.size()));
  }
}

void add_muscles(Model& model, const std::vector<Muscle>& muscles,
                 const std::function<std::vector<Fibre>(std::size_t)>& fibres)
{
  model.muscles = muscles;
  model.fibre_begin.assign(1, 0);
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    for (const Fibre& fibre : fibres(e))
    {
      model.fibre_muscle.push_back(static_cast<std::int16_t>(fibre.muscle));
      model.fibre_direction.push_back(fibre.direction);
      model.fibre_weight.push_back(fibre.weight);
    }
    model.fibre_begin.push_back(static_cast<std::int32_t>(model.fibre_muscle.size()));
  }
}

std::array<float, 3> along_x(std::size_t) { return { { 1, 0, 0 } }; }

Vectors displaced(const Model& model, const std::function<std::array<double, 3>(const std::array<double, 3>&)>& map)
{
  Vectors u(model.nodes.size());
  for (std::size_t n = 0; n < u.size(); ++n)
  {
    const auto rest = rest_position(model, n);
    const auto now = map(rest);
    for (std::size_t axis = 0; axis < 3; ++axis)
      u[n][axis] = now[axis] - rest[axis];
  }
  return u;
}

double farthest(const Vectors& a, const Vectors& b)
{
  double largest = 0;
  for (std::size_t n = 0; n < a.size(); ++n)
    largest = std::max(largest, std::hypot(a[n][0] - b[n][0], a[n][1] - b[n][1], a[n][2] - b[n][2]));
  return largest;
}

double farthest(const Vectors& a) { return farthest(a, Vectors(a.size())); }

RigidTransform turned_about(const std::array<double, 3>& rotation, const std::array<double, 3>& point)
{
  const RigidTransform turn = rigid_motion(rotation, {});
  std::array<double, 3> shift = point;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      shift[i] -= turn.rotation[3 * i + j] * point[j];
  return { turn.rotation, shift };
}

}  // namespace frontalis
