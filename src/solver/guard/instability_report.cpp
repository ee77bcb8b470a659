#include "solver/guard/instability_report.hpp"

#include "frontalis/model/sample_field.hpp"
#include "frontalis/physics/materials/lookup.hpp"

#include <fmt/ranges.h>

#include <algorithm>

namespace frontalis
{
namespace
{

// Indices of the entries with a positive weight, by descending weight.
template <class Weight>
std::vector<std::int32_t> by_weight(std::int32_t begin, std::int32_t end, const Weight& weight)
{
  std::vector<std::int32_t> order;
  for (auto i = begin; i < end; ++i)
    if (weight(i) > 0)
      order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return weight(a) > weight(b); });
  return order;
}

template <class Nodes>
auto held(const Nodes& nodes, const std::array<std::int32_t, 8>& corners)
{
  return std::find_if(nodes.begin(), nodes.end(),
                      [&](const auto& entry)
                      { return std::find(corners.begin(), corners.end(), entry.node) != corners.end(); });
}

struct Cause
{
  std::string effect, advice;
};

Cause cause_of(const Model& model, Instability kind, std::int32_t e, const std::vector<std::int32_t>& materials,
               const std::vector<std::int32_t>& fibres, const std::vector<float>& activation,
               const std::vector<bool>& moved, const LostNode& lost)
{
  if (kind == Instability::time_step)
    return { "the time step", "lower accuracy's time_step_share" };
  if (kind == Instability::hourglass)
    return { "hourglass modes", model.hourglass == HourglassControl::scalar
                                    ? "set hourglass: assumed_strain, or take smaller voxels"
                                    : "set integration: selective_reduced, or take smaller voxels" };
  const auto& corners = model.voxel_nodes[e];
  if (kind == Instability::past_rim)
  {
    const auto sliding = std::find_if(model.sliding.begin(), model.sliding.end(),
                                      [&](const auto& entry) { return entry.node == lost.node; });
    const std::string& surface = model.constraint_surfaces[sliding->surface].name;
    if (lost.strayed > usual_travel)
      return { fmt::format(
                   "sliding on surface {}, {:.1f} mm away from where its nodes rest (it is known up to {:g} mm)",
                   surface, 1e3 * lost.strayed, 1e3 * usual_travel),
               "hold the tissue nearby, or let muscles, loads and bones move it less" };
    return { "sliding past the rim of surface " + surface,
             "continue the surface beyond the tissue, or hold the tissue near its rim" };
  }
  if (kind == Instability::inside_body)
    return { "contact", "press less deep, or move the body more slowly" };
  const auto rigid = held(model.rigid, corners);
  if (rigid != model.rigid.end() && rigid->bone >= 0 && moved[rigid->bone])
    return { "the motion of bone " + model.bones[rigid->bone], "move it in smaller parts" };
  const auto prescribed = held(model.prescribed, corners);
  if (prescribed != model.prescribed.end())
    return { "prescribed displacement " + model.loads[prescribed->load].name,
             "give it a longer ramp or a smaller value" };
  double soft = 1e300, stiff = 0;
  for (const auto m : materials)
  {
    const Material& material = model.materials[model.mixture_material[m]];
    const double shear = physics::shear_modulus_of(material.law, material.parameters);
    soft = std::min(soft, shear);
    stiff = std::max(stiff, shear);
  }
  for (const auto f : fibres)
  {
    const auto m = model.fibre_muscle[f];
    const double tension = double(activation[m]) * double(model.fibre_weight[f]) * model.muscles[m].stress_reference;
    if (tension > soft)
      return { "the contraction of muscle " + model.muscles[m].name,
               "lower its stress_reference or activation, or let it rise more slowly (time's activation_slew, the "
               "muscle's rise_time)" };
  }
  if (const auto sliding = held(model.sliding, corners); sliding != model.sliding.end())
    return { "sliding on surface " + model.constraint_surfaces[sliding->surface].name,
             "smooth the surface there, or take smaller voxels" };
  for (const auto& load : model.loads)
    if (std::find(load.binding.voxel.begin(), load.binding.voxel.end(), e) != load.binding.voxel.end())
      return { "load " + load.name, "give it a longer ramp or a smaller value" };
  if (stiff > 100 * soft)
    return { "materials of very different stiffness in one voxel",
             "take smaller voxels, or scale the mass of the stiff one" };
  return { "the elasticity of " + model.materials[model.mixture_material[materials.front()]].name,
           "lower accuracy's time_step_share, or add damping" };
}

std::string place(const std::array<double, 3>& at)
{
  return fmt::format("({:.1f}, {:.1f}, {:.1f}) mm", 1e3 * at[0], 1e3 * at[1], 1e3 * at[2]);
}

}  // namespace

std::string words_for(Instability instability)
{
  constexpr const char* words[] = { "nothing was found",
                                    "displacements are no longer finite",
                                    "energy grows without a cause",
                                    "hourglass energy grows without a cause",
                                    "voxels turn inside out",
                                    "the time step is longer than critical",
                                    "nodes have left the known part of their surface",
                                    "tissue is deep inside of a body that it touches" };
  return words[static_cast<int>(instability)];
}

InstabilityReport describe(const Model& model, Instability kind, double time, std::int32_t voxel, double jacobian,
                           const std::vector<float>& activation, const std::vector<bool>& moved, const LostNode& lost)
{
  InstabilityReport report;
  report.kind = kind;
  report.time = time;
  report.voxel = voxel;
  report.jacobian = jacobian;
  const auto place = rest_place(model, model.voxels[voxel]);
  std::array<double, 3> centre;
  for (int axis = 0; axis < 3; ++axis)
    centre[axis] = (place[axis] + 0.5) * model.spacing[axis];
  report.scene = model.to_scene(centre);
  report.face = model.to_face(centre);
  const auto materials = by_weight(model.mixture_begin[voxel], model.mixture_begin[voxel + 1],
                                   [&](auto m) { return model.mixture_proportion[m]; });
  const auto fibres = by_weight(model.fibre_begin[voxel], model.fibre_begin[voxel + 1],
                                [&](auto f)
                                {
                                  const auto m = model.fibre_muscle[f];
                                  return double(model.fibre_weight[f]) * model.muscles[m].stress_reference *
                                         (1e-6 + double(activation[m]));
                                });
  for (const auto m : materials)
    report.material.push_back(model.materials[model.mixture_material[m]].name);
  for (const auto f : fibres)
    report.muscle.push_back(model.muscles[model.fibre_muscle[f]].name);
  const Cause cause = cause_of(model, kind, voxel, materials, fibres, activation, moved, lost);
  report.effect = cause.effect;
  report.advice = cause.advice;
  return report;
}

std::string InstabilityReport::text() const
{
  return fmt::format(
      "the motion is unstable at {:g} s: {}, with shorter time steps too. Worst is voxel {} at {} in the scene, "
      "{} in the face frame (J {:g}, material {}{}). Most likely at fault is {}: {}",
      time, words_for(kind), voxel, place(scene), place(face), jacobian, fmt::join(material, ", "),
      muscle.empty() ? "" : fmt::format(", muscle {}", fmt::join(muscle, ", ")), effect, advice);
}

}  // namespace frontalis
