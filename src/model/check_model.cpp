#include "frontalis/effect.hpp"
#include "frontalis/model/model.hpp"
#include "frontalis/physics/materials/lookup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace frontalis
{
namespace
{

template <class... Values>
[[noreturn]] void fail(const std::string& array, fmt::format_string<Values...> found, Values&&... values)
{
  throw Error(array + ": " + fmt::format(found, std::forward<Values>(values)...));
}

void check_length(const std::string& array, std::size_t found, std::size_t right, const std::string& of)
{
  if (found != right)
    fail(array, "has {} entries; must have {}, one per {}", found, right, of);
}

template <class Integer>
void check_index(const std::string& array, std::size_t at, Integer index, std::size_t count, Integer lowest = 0)
{
  if (index < lowest || (index >= 0 && static_cast<std::size_t>(index) >= count))
    fail(array, "entry {} is {}; indices run from {} to {}", at, index, lowest, static_cast<std::ptrdiff_t>(count) - 1);
}

void check_finite(const std::string& array, std::size_t at, double value)
{
  if (!std::isfinite(value))
    fail(array, "entry {} is {}; it must be finite", at, value);
}

void check_positive(const std::string& array, std::size_t at, double value)
{
  check_finite(array, at, value);
  if (!(value > 0))
    fail(array, "entry {} is {}; it must be above 0", at, value);
}

void check_not_negative(const std::string& array, const std::string& what, double value)
{
  if (!(value >= 0) || !std::isfinite(value))
    fail(array, "{} is {}; it must be finite and at least 0", what, value);
}

void check_proportion(const std::string& array, std::size_t at, double value)
{
  check_finite(array, at, value);
  if (value < 0 || value > 1.0001)
    fail(array, "entry {} is {}; proportions lie between 0 and 1", at, value);
}

template <std::size_t N, class T>
void check_finite(const std::string& array, std::size_t at, const std::array<T, N>& values)
{
  for (const T value : values)
    check_finite(array, at, static_cast<double>(value));
}

void check_ranges(const std::string& array, const std::vector<std::int32_t>& begin, std::size_t voxels,
                  std::size_t entries)
{
  check_length(array, begin.size(), voxels + 1, "voxel and an end");
  if (begin.front() != 0)
    fail(array, "starts at {}; it must start at 0", begin.front());
  for (std::size_t e = 0; e < voxels; ++e)
  {
    if (begin[e] > begin[e + 1])
      fail(array, "decreases after entry {}", e);
  }
  if (static_cast<std::size_t>(begin.back()) != entries)
    fail(array, "ends at {}; there are {} entries", begin.back(), entries);
}

void check_mesh(const std::string& array, const TriangleMesh& mesh)
{
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    check_finite(array + ".vertices", v, mesh.vertices[v]);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
  {
    for (const std::int32_t v : mesh.triangles[t])
      check_index(array + ".triangles", t, v, mesh.vertices.size());
  }
}

void check_binding(const std::string& array, const Binding& binding, std::size_t points, std::size_t voxels)
{
  check_length(array + ".voxel", binding.voxel.size(), points, "point");
  check_length(array + ".coordinates", binding.coordinates.size(), points, "point");
  for (std::size_t p = 0; p < points; ++p)
  {
    check_index(array + ".voxel", p, binding.voxel[p], voxels);
    check_finite(array + ".coordinates", p, binding.coordinates[p]);
  }
}

void check_grid(const Model& model)
{
  for (std::size_t a = 0; a < 3; ++a)
    check_positive("spacing", a, model.spacing[a]);
  const std::size_t voxels = model.voxels.size();
  check_length("fill", model.fill.size(), voxels, "voxel");
  check_length("voxel_nodes", model.voxel_nodes.size(), voxels, "voxel (see build_nodes)");
  for (std::size_t e = 0; e < voxels; ++e)
  {
    check_proportion("fill", e, model.fill[e]);
    if (!(model.fill[e] > 0))
      fail("fill", "entry {} is 0; a voxel without tissue must be left out", e);
    for (int a = 0; a < 3; ++a)
      check_index("voxels", e, model.voxels[e][a], static_cast<std::size_t>(model.size[a]));
    for (const std::int32_t n : model.voxel_nodes[e])
      check_index("voxel_nodes", e, n, model.nodes.size());
  }
}

void check_direction(const std::string& array, std::size_t at, const float* d)
{
  const double length = std::hypot(static_cast<double>(d[0]), static_cast<double>(d[1]), static_cast<double>(d[2]));
  if (std::abs(length - 1) > 1e-3)
    fail(array, "entry {} has length {:.6g}; it must be 1", at, length);
}

void check_material_directions(const Model& model)
{
  const auto& directions = model.material_directions;
  if (!directions.empty())
    check_length("material_directions", directions.size(), model.voxels.size(), "voxel, or none at all");
  for (std::size_t e = 0; e < directions.size(); ++e)
  {
    check_finite("material_directions", e, directions[e]);
    for (const int family : { 0, 3 })
      if (const float* const d = directions[e].data() + family; d[0] != 0 || d[1] != 0 || d[2] != 0)
        check_direction("material_directions", e, d);
  }
}

void check_mixtures(const Model& model)
{
  for (std::size_t m = 0; m < model.materials.size(); ++m)
  {
    const Material& material = model.materials[m];
    check_finite("materials", m, material.parameters);
    check_positive("materials (bulk modulus)", m, material.parameters[physics::bulk_modulus_slot]);
    check_positive("materials (density)", m, material.density);
    for (std::size_t term = 0; term < 2; ++term)
      if (material.viscous_share[term] != 0)
      {
        check_proportion("materials (viscous_share)", m, static_cast<float>(material.viscous_share[term]));
        check_positive("materials (viscous_time)", m, material.viscous_time[term]);
      }
    if (!(material.viscous_share[0] + material.viscous_share[1] < 1))
      fail("materials (viscous_share)", "the shares of entry {} do not add up to less than 1", m);
    if (static_cast<std::size_t>(material.law) >= physics::material_table.size())
      fail("materials (law)", "entry {} has law {}; the laws run from 0 to {}", m, static_cast<int>(material.law),
           physics::material_table.size() - 1);
  }
  const std::size_t entries = model.mixture_material.size();
  check_ranges("mixture_begin", model.mixture_begin, model.voxels.size(), entries);
  check_length("mixture_proportion", model.mixture_proportion.size(), entries, "entry of mixture_material");
  for (std::size_t m = 0; m < entries; ++m)
  {
    check_index("mixture_material", m, model.mixture_material[m], model.materials.size());
    check_proportion("mixture_proportion", m, model.mixture_proportion[m]);
  }
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    double sum = 0;
    for (std::int32_t m = model.mixture_begin[e]; m < model.mixture_begin[e + 1]; ++m)
      sum += model.mixture_proportion[static_cast<std::size_t>(m)];
    if (std::abs(sum - 1) > 1e-4)
      fail("mixture_proportion", "proportions of voxel {} add up to {:.6g}; they must add up to 1", e, sum);
  }
}

void check_fibres(const Model& model)
{
  for (std::size_t m = 0; m < model.muscles.size(); ++m)
  {
    check_positive("muscles (stress_reference)", m, model.muscles[m].stress_reference);
    for (const double time : { model.muscles[m].rise_time, model.muscles[m].fall_time })
      check_not_negative("muscles", fmt::format("rise or fall time [s] of entry {}", m), time);
  }
  const std::size_t entries = model.fibre_muscle.size();
  check_ranges("fibre_begin", model.fibre_begin, model.voxels.size(), entries);
  check_length("fibre_weight", model.fibre_weight.size(), entries, "entry of fibre_muscle");
  check_length("fibre_direction", model.fibre_direction.size(), entries, "entry of fibre_muscle");
  for (std::size_t m = 0; m < entries; ++m)
  {
    check_index("fibre_muscle", m, model.fibre_muscle[m], model.muscles.size());
    check_proportion("fibre_weight", m, model.fibre_weight[m]);
    check_finite("fibre_direction", m, model.fibre_direction[m]);
    check_direction("fibre_direction", m, model.fibre_direction[m].data());
  }
}

void check_field(const std::string& array, const SampledField& field)
{
  using physics::DistanceField;
  check_finite(array + " (origin)", 0, field.origin);
  check_not_negative(array, "radius", field.radius);
  if (field.radius > 0)
    return;
  check_positive(array + " (spacing)", 0, field.spacing);
  std::size_t bricks = 1;
  for (const std::int32_t count : field.bricks)
    bricks *= static_cast<std::size_t>(std::max(count, 0));
  check_length(array + " (table)", field.table.size(), bricks, "brick");
  const std::size_t stored = field.samples.size() / DistanceField::brick_size;
  check_length(array + " (samples)", field.samples.size(), stored * DistanceField::brick_size, "sample of a brick");
  for (std::size_t b = 0; b < bricks; ++b)
    check_index(array + " (table)", b, field.table[b], stored, -1);
  for (std::size_t s = 0; s < field.samples.size(); ++s)
    check_finite(array + " (samples)", s, static_cast<double>(field.samples[s]));
}

void check_constraints(const Model& model)
{
  for (const ConstraintSurface& surface : model.constraint_surfaces)
  {
    const std::string name = "constraint_surfaces '" + surface.name + "'";
    check_field(name, surface.field);
    check_index(name + " (bone)", 0, surface.bone, model.bones.size(), -1);
    check_not_negative(name, "friction", surface.friction);
  }
  for (std::size_t n = 0; n < model.rigid.size(); ++n)
  {
    check_index("rigid (node)", n, model.rigid[n].node, model.nodes.size());
    check_index("rigid (bone)", n, model.rigid[n].bone, model.bones.size(), -1);
    check_index("rigid (constraint)", n, model.rigid[n].constraint, model.constraints.size(), -1);
  }
  for (std::size_t n = 0; n < model.sliding.size(); ++n)
  {
    check_index("sliding (node)", n, model.sliding[n].node, model.nodes.size());
    check_index("sliding (surface)", n, model.sliding[n].surface, model.constraint_surfaces.size());
    check_finite("sliding (distance)", n, model.sliding[n].distance);
    check_index("sliding (constraint)", n, model.sliding[n].constraint, model.constraints.size(), -1);
  }
  for (std::size_t n = 0; n < model.prescribed.size(); ++n)
  {
    check_index("prescribed (node)", n, model.prescribed[n].node, model.nodes.size());
    check_index("prescribed (load)", n, model.prescribed[n].load, model.loads.size());
  }
}

void check_loads(const Model& model)
{
  check_finite("gravity", 0, model.gravity);
  for (std::size_t l = 0; l < model.loads.size(); ++l)
  {
    const Load& load = model.loads[l];
    const std::string name = "loads '" + load.name + "'";
    if (load.kind > Load::Kind::displacement)
      fail(name, "kind {} is not known", static_cast<int>(load.kind));
    check_finite(name + " (value)", l, load.value);
    check_finite(name + " (ramp)", l, load.ramp);
    check_mesh(name, load.mesh);
    check_binding(name + ".binding", load.binding, load.mesh.vertices.size(), model.voxels.size());
  }
}

void check_presets(const Model& model)
{
  for (const Model::AccuracyProfile& profile : model.profiles)
    for (const auto& [what, value] : { std::pair{ "error", profile.error }, { "cost", profile.cost } })
      check_not_negative("profiles '" + profile.name + "'", what, value);
  for (const Model::Expression& expression : model.expressions)
  {
    for (std::size_t m = 0; m < expression.activation.size(); ++m)
    {
      check_index("expressions '" + expression.name + "'", m, expression.activation[m].first, model.muscles.size());
      check_proportion("expressions '" + expression.name + "'", m, expression.activation[m].second);
    }
  }
  for (std::size_t p = 0; p < model.demo.size(); ++p)
  {
    check_index("demo", p, model.demo[p].expression, model.expressions.size(), -1);
    check_finite("demo (ramp)", p, model.demo[p].ramp);
    check_positive("demo (seconds)", p, model.demo[p].seconds);
  }
}

void check_settings(const Model& model)
{
  check_finite("to_scene", 0, model.to_scene.rotation);
  check_finite("to_scene", 0, model.to_scene.translation);
  check_finite("to_face", 0, model.to_face.rotation);
  check_finite("to_face", 0, model.to_face.translation);
  check_not_negative("time", "damping", model.damping);
  check_positive("time_scaling", 0, model.time_scaling);
  check_positive("frame_rate", 0, model.frame_rate);
  check_not_negative("time", "activation_slew", model.activation_slew);
  check_positive("time_step_share", 0, model.time_step_share);
  if (model.time_step_share > 1)
    fail("time_step_share", "is {}; it must be at most 1", model.time_step_share);
  if (model.hourglass > HourglassControl::assumed_strain || model.integration > Integration::selective_reduced ||
      model.precision > Precision::double_precision || model.time_step_estimate > TimeStepEstimate::assembled)
    fail("hourglass, integration, precision, step_estimate", "a setting is not known");
  if (model.mass_scaling.kind > MassScalingSettings::Kind::selective)
    fail("mass_scaling", "kind {} is not known", static_cast<int>(model.mass_scaling.kind));
  check_positive("mass_scaling (factor)", 0, model.mass_scaling.factor);
  check_not_negative("mass_scaling", "time_step", model.mass_scaling.time_step);
  for (std::size_t m = 0; m < model.mass_scaling.materials.size(); ++m)
    check_index("mass_scaling (materials)", m, model.mass_scaling.materials[m], model.materials.size());
  for (const std::string& name : model.switched_off)
    effect_from_name(name);
}

}  // namespace

void check_model(const Model& model)
{
  check_grid(model);
  check_mixtures(model);
  check_material_directions(model);
  check_fibres(model);
  check_constraints(model);
  check_loads(model);
  check_mesh("skin", model.skin);
  check_binding("skin_binding", model.skin_binding, model.skin.vertices.size(), model.voxels.size());
  check_length("landmark_positions", model.landmark_positions.size(), model.landmarks.size(), "landmark");
  for (std::size_t l = 0; l < model.landmark_positions.size(); ++l)
    check_finite("landmark_positions", l, model.landmark_positions[l]);
  check_binding("landmark_binding", model.landmark_binding, model.landmarks.size(), model.voxels.size());
  check_presets(model);
  check_settings(model);
}

}  // namespace frontalis
