#include "frontalis/physics/materials/lookup.hpp"
#include "model/effect_description.hpp"
#include "model/model_checks.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace frontalis
{
namespace checks
{

void check_mesh(const std::string& array, const TriangleMesh& mesh)
{
  check_each(array + ".vertices", check_finite, mesh.vertices);
  check_each(array + ".triangles", index_below(mesh.vertices.size()), mesh.triangles);
}

void check_binding(const std::string& array, const Binding& binding, std::size_t points, std::size_t voxels)
{
  check_length(array + ".voxel", binding.voxel.size(), points, "point");
  check_length(array + ".coordinates", binding.coordinates.size(), points, "point");
  check_each(array + ".voxel", index_below(voxels), binding.voxel);
  check_each(array + ".coordinates", check_finite, binding.coordinates);
}

void check_field(const std::string& array, const SampledField& field)
{
  using physics::DistanceField;
  check_entry(array + " (origin)", 0, check_finite, field.origin);
  check_not_negative(array, "radius", field.radius);
  if (field.radius > 0)
    return;
  check_positive(array + " (spacing)", 0, field.spacing);
  std::size_t bricks = 1;
  for (const std::int32_t count : field.bricks)
  {
    const auto along = static_cast<std::size_t>(std::max(count, 0));
    constexpr auto most = std::numeric_limits<std::size_t>::max();  // the product may be too large for its type
    bricks = along > 0 && bricks > most / along ? most : bricks * along;
  }
  check_length(array + " (table)", field.table.size(), bricks, "brick");
  const std::size_t stored = field.samples.size() / DistanceField::brick_size;
  check_length(array + " (samples)", field.samples.size(), stored * DistanceField::brick_size, "sample of a brick");
  check_each(array + " (table)", index_below(stored, -1), field.table);
  check_each(array + " (samples)", check_finite, field.samples);
}

}  // namespace checks

namespace
{

using namespace checks;

void check_ranges(const std::string& array, const std::vector<std::int32_t>& begin, std::size_t voxels,
                  std::size_t entries)
{
  check_length(array, begin.size(), voxels + 1, "voxel and an end");
  if (begin.front() != 0)
    fail(array, "starts at {}; it must start at 0", begin.front());
  const auto decrease = std::is_sorted_until(begin.begin(), begin.end());
  if (decrease != begin.end())
    fail(array, "decreases after entry {}", decrease - begin.begin() - 1);
  if (static_cast<std::size_t>(begin.back()) != entries)
    fail(array, "ends at {}; there are {} entries", begin.back(), entries);
}

void check_grid(const Model& model)
{
  for (std::size_t axis = 0; axis < 3; ++axis)
    check_positive("spacing", axis, model.spacing[axis]);
  const std::size_t voxels = model.voxels.size();
  check_length("fill", model.fill.size(), voxels, "voxel");
  check_length("voxel_nodes", model.voxel_nodes.size(), voxels, "voxel (see build_nodes)");
  check_each("fill", check_proportion, model.fill);
  check_each("voxel_nodes", index_below(model.nodes.size()), model.voxel_nodes);
  for (std::size_t f = 0; f < model.flaps.size(); ++f)
  {
    const auto [first, shift] = model.flaps[f];
    if (shift <= 0 || shift > first || (f > 0 && first <= model.flaps[f - 1].first))
      fail("flaps", "entry {} has planes from {} on that rest {} planes lower; planes must ascend", f, first, shift);
  }
  for (std::size_t e = 0; e < voxels; ++e)
  {
    if (!(model.fill[e] > 0))
      fail("fill", "entry {} is 0; a voxel without tissue must be left out", e);
    for (int axis = 0; axis < 3; ++axis)
      index_below(static_cast<std::size_t>(model.size[axis]))("voxels", e, model.voxels[e][axis]);
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
  check_each("material_directions", check_finite, directions);
  for (std::size_t e = 0; e < directions.size(); ++e)
    for (const int family : { 0, 3 })
      if (const float* const d = directions[e].data() + family; d[0] != 0 || d[1] != 0 || d[2] != 0)
        check_direction("material_directions", e, d);
}

void check_mixtures(const Model& model)
{
  check_each("materials", check_finite, model.materials, &Material::parameters);
  check_each("materials (density)", check_positive, model.materials, &Material::density);
  for (std::size_t m = 0; m < model.materials.size(); ++m)
  {
    const Material& material = model.materials[m];
    check_positive("materials (bulk modulus)", m, material.parameters[physics::bulk_modulus_slot]);
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
  check_each("mixture_material", index_below(model.materials.size()), model.mixture_material);
  check_each("mixture_proportion", check_proportion, model.mixture_proportion);
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
  check_each("muscles (stress_reference)", check_positive, model.muscles, &Muscle::stress_reference);
  for (std::size_t m = 0; m < model.muscles.size(); ++m)
    for (const double time : { model.muscles[m].rise_time, model.muscles[m].fall_time })
      check_not_negative("muscles", fmt::format("rise or fall time [s] of entry {}", m), time);
  check_each("muscles (tone)", check_proportion, model.muscles, &Muscle::tone);
  const std::size_t entries = model.fibre_muscle.size();
  check_ranges("fibre_begin", model.fibre_begin, model.voxels.size(), entries);
  check_length("fibre_weight", model.fibre_weight.size(), entries, "entry of fibre_muscle");
  check_length("fibre_direction", model.fibre_direction.size(), entries, "entry of fibre_muscle");
  check_each("fibre_muscle", index_below(model.muscles.size()), model.fibre_muscle);
  check_each("fibre_weight", check_proportion, model.fibre_weight);
  check_each("fibre_direction", check_finite, model.fibre_direction);
  for (std::size_t m = 0; m < entries; ++m)
    check_direction("fibre_direction", m, model.fibre_direction[m].data());
}

void check_constraints(const Model& model)
{
  const auto node = index_below(model.nodes.size());
  const auto bone_or_none = index_below(model.bones.size(), -1);
  const auto constraint_or_none = index_below(model.constraints.size(), -1);
  for (const ConstraintSurface& surface : model.constraint_surfaces)
  {
    const std::string name = "constraint_surfaces '" + surface.name + "'";
    check_field(name, surface.field);
    bone_or_none(name + " (bone)", 0, surface.bone);
    check_not_negative(name, "friction", surface.friction);
  }
  check_each("rigid (node)", node, model.rigid, &RigidNode::node);
  check_each("rigid (bone)", bone_or_none, model.rigid, &RigidNode::bone);
  check_each("rigid (constraint)", constraint_or_none, model.rigid, &RigidNode::constraint);
  check_each("sliding (node)", node, model.sliding, &SlidingNode::node);
  check_each("sliding (surface)", index_below(model.constraint_surfaces.size()), model.sliding, &SlidingNode::surface);
  check_each("sliding (distance)", check_finite, model.sliding, &SlidingNode::distance);
  check_each("sliding (constraint)", constraint_or_none, model.sliding, &SlidingNode::constraint);
  check_each("prescribed (node)", node, model.prescribed, &PrescribedNode::node);
  check_each("prescribed (load)", index_below(model.loads.size()), model.prescribed, &PrescribedNode::load);
}

void check_loads(const Model& model)
{
  check_entry("gravity", 0, check_finite, model.gravity);
  for (std::size_t l = 0; l < model.loads.size(); ++l)
  {
    const Load& load = model.loads[l];
    const std::string name = "loads '" + load.name + "'";
    if (load.kind > Load::Kind::displacement)
      fail(name, "kind {} is not known", static_cast<int>(load.kind));
    check_entry(name + " (value)", l, check_finite, load.value);
    check_finite(name + " (ramp)", l, load.ramp);
    index_below(model.muscles.size(), -1)(name + " (activation)", l, load.activation);
    check_mesh(name, load.mesh);
    check_binding(name + ".binding", load.binding, load.mesh.vertices.size(), model.voxels.size());
  }
}

void check_size_of_weight(const std::string& array, std::size_t at, double value)
{
  check_proportion(array, at, std::abs(value));
}

void check_bones(const Model& model, const std::string& name, const std::vector<Model::BonePose>& poses)
{
  check_each(name + " (bone)", index_below(model.bones.size()), poses, &Model::BonePose::bone);
  for (const auto field : { &Model::BonePose::shift, &Model::BonePose::turn, &Model::BonePose::centre })
    check_each(name + " (motion of a bone)", check_finite, poses, field);
}

void check_presets(const Model& model)
{
  for (const Model::AccuracyProfile& profile : model.profiles)
    for (const auto& [what, value] : { std::pair{ "error", profile.error }, { "cost", profile.cost } })
      check_not_negative("profiles '" + profile.name + "'", what, value);
  for (const auto* poses : { &model.expressions, &model.action_units })
    for (const Model::Expression& pose : *poses)
    {
      const std::string name = (poses == &model.expressions ? "expressions '" : "action_units '") + pose.name + "'";
      using Activation = std::pair<std::int32_t, float>;
      check_each(name, index_below(model.muscles.size()), pose.activation, &Activation::first);
      check_each(name, check_size_of_weight, pose.activation, &Activation::second);
      check_bones(model, name, pose.bones);
    }
  check_each("demo", index_below(model.expressions.size(), -2), model.demo, &Model::DemoPhase::expression);
  check_each("demo (ramp)", check_finite, model.demo, &Model::DemoPhase::ramp);
  check_each("demo (seconds)", check_positive, model.demo, &Model::DemoPhase::seconds);
  for (const Model::DemoPhase& phase : model.demo)
    check_bones(model, "demo", phase.bones);
}

void check_settings(const Model& model)
{
  for (const auto& [name, map] : { std::pair{ "to_scene", model.to_scene }, { "to_face", model.to_face } })
  {
    check_entry(name, 0, check_finite, map.rotation);
    check_entry(name, 0, check_finite, map.translation);
  }
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
  check_not_negative("mass_scaling", "in_motion", model.mass_scaling.in_motion);
  check_each("mass_scaling (materials)", index_below(model.materials.size()), model.mass_scaling.materials);
  for (const std::string& name : model.switched_off)
    effect_from_name(name);
}

void check_film(const Model& model)
{
  const SkinFilm& film = model.film;
  if (film.laws.empty())
    return;
  for (std::size_t l = 0; l < film.laws.size(); ++l)
  {
    check_positive("film (thickness)", l, film.laws[l].thickness);
    check_positive("film (modulus)", l, film.laws[l].modulus);
    check_positive("film (base_modulus)", l, film.laws[l].base_modulus);
    check_finite("film (poisson)", l, film.laws[l].poisson);
    check_not_negative("film", "stretch", film.laws[l].stretch);
  }
  check_length("film/law", film.law.size(), model.skin.vertices.size(), "vertex of the skin");
  check_each("film/law", index_below(film.laws.size(), -1), film.law);
  if (!film.crease.empty() && film.crease.size() != model.skin.vertices.size())
    fail("film/crease", "has {} entries; the skin has {} vertices", film.crease.size(), model.skin.vertices.size());
  for (std::size_t v = 0; v < film.crease.size(); ++v)
    check_finite("film/crease", v, film.crease[v]);
  if (film.parents.size() > model.skin.vertices.size())
    fail("film/parents", "has {} entries; the skin has {} vertices", film.parents.size(), model.skin.vertices.size());
  const std::size_t carried = model.skin.vertices.size() - film.parents.size();
  check_each("film/carried", index_below(carried), film.carried);
  for (std::size_t v = 0; v < film.parents.size(); ++v)
    check_entry("film/parents", v, index_below(carried + v), film.parents[v]);
}

}  // namespace

void check_model(const Model& model)
{
  check_grid(model);
  check_mixtures(model);
  check_material_directions(model);
  check_fibres(model);
  check_constraints(model);
  check_effects(model);
  check_loads(model);
  check_mesh("skin", model.skin);
  check_film(model);
  check_binding("skin_binding", model.skin_binding, model.skin.vertices.size(), model.voxels.size());
  check_length("landmark_positions", model.landmark_positions.size(), model.landmarks.size(), "landmark");
  check_each("landmark_positions", check_finite, model.landmark_positions);
  check_binding("landmark_binding", model.landmark_binding, model.landmarks.size(), model.voxels.size());
  check_presets(model);
  check_settings(model);
}

}  // namespace frontalis
