#include "bake/messages.hpp"
#include "bake/voxels/model_stages.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace frontalis
{
namespace
{

double share_kept(const SceneWeakness& weakness, const Vector3& place)
{
  if (weakness.radius == 0)
    return weakness.keeps;
  double squared = 0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    squared += std::pow((place[axis] - weakness.centre[axis]) / weakness.radius, 2);
  const double lost = weakness.dose ? std::exp(-squared) : squared <= 1 ? 1 : 0;
  return 1 - (1 - weakness.keeps) * lost;
}

}  // namespace

// Lowers the weight of the muscle in weak voxels, so that backends need no code for weakness, and models without it
// take no extra time. If the muscle has passive stress, the difference is given to another muscle, NAME_passive, which
// is never active.
void weaken_muscles(const Scene& scene, const LocalFrame& frame, Model& model, BakeReport* report)
{
  if (scene.weakness.empty())
    return;
  const std::vector<std::int32_t> begin = std::exchange(model.fibre_begin, { 0 });
  const auto muscle = std::exchange(model.fibre_muscle, {});
  const auto weight = std::exchange(model.fibre_weight, {});
  const auto direction = std::exchange(model.fibre_direction, {});
  const auto add = [&](std::int32_t of, double proportion, const std::array<float, 3>& along)
  {
    model.fibre_muscle.push_back(static_cast<std::int16_t>(of));
    model.fibre_weight.push_back(static_cast<float>(proportion));
    model.fibre_direction.push_back(along);
  };
  std::map<std::int32_t, std::int32_t> passive_part;
  std::vector<double> whole(model.muscles.size(), 0), left(model.muscles.size(), 0);
  std::vector<bool> weakens(scene.weakness.size(), false);
  const auto is_of = [&](const SceneWeakness& weakness, std::size_t m)
  {
    const auto& names = weakness.muscles;
    return names.empty() ? !scene.muscles[m].of_rest
                         : std::find(names.begin(), names.end(), scene.muscles[m].name) != names.end();
  };
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    const Vector3 place = to_array(frame.voxel_centre(model, e));
    for (std::int32_t f = begin[e]; f < begin[e + 1]; ++f)
    {
      const Muscle of = model.muscles[muscle[f]];
      double kept = 1;
      for (std::size_t w = 0; w < scene.weakness.size(); ++w)
      {
        const SceneWeakness& weakness = scene.weakness[w];
        if (!is_of(weakness, muscle[f]))
          continue;
        const double share = share_kept(weakness, place);
        kept *= share;
        weakens[w] = weakens[w] || share < 0.999;
      }
      whole[muscle[f]] += double(weight[f]);
      left[muscle[f]] += kept * double(weight[f]);
      if (kept > 0)
        add(muscle[f], kept * weight[f], direction[f]);
      if (!of.passive || kept == 1)
        continue;
      const auto part = passive_part.emplace(muscle[f], model.muscles.size());
      if (part.second && std::any_of(model.muscles.begin(), model.muscles.end(),
                                     [&](const Muscle& other) { return other.name == of.name + "_passive"; }))
        throw failure("{}: weakness: muscle '{}' needs the name {}_passive for its passive part; rename that muscle",
                      scene.file, of.name, of.name);
      if (part.second)
        model.muscles.push_back({ of.name + "_passive", of.stress_reference, true, of.tension_length });
      add(part.first->second, (1 - kept) * weight[f], direction[f]);
    }
    model.fibre_begin.push_back(static_cast<std::int32_t>(model.fibre_muscle.size()));
  }
  for (std::size_t w = 0; w < weakens.size(); ++w)
  {
    const SceneWeakness& weakness = scene.weakness[w];
    // Muscles whose effect is switched off have no fibres.
    bool is_known = false, has_fibres = false;
    for (std::size_t m = 0; m < whole.size(); ++m)
      if (is_of(weakness, m))
      {
        is_known = true;
        has_fibres = has_fibres || whole[m] > 0;
      }
    const bool lacks_fibres = is_known && !has_fibres;
    if (!lacks_fibres && weakness.radius > 0 && weakness.keeps < 1 && !weakens[w])
      throw failure("{}: weakness: no voxel of {} lies within {} of {}; check its place and radius", scene.file,
                    weakness.muscles.empty() ? "a muscle" : fmt::format("{}", fmt::join(weakness.muscles, ", ")),
                    length_text(weakness.radius, scene.unit), place_text(to_vector(weakness.centre), scene.unit));
  }
  if (report != nullptr)
    for (BakeReport::MuscleForce& force : report->forces)
      for (std::size_t m = 0; m < whole.size(); ++m)
        if (model.muscles[m].name == force.name && whole[m] > 0)
          force.left = left[m] / whole[m];
}

}  // namespace frontalis
