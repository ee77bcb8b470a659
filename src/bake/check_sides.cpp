#include "bake/checks.hpp"

#include "bake/messages.hpp"

#include <boost/algorithm/string/case_conv.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace frontalis
{
namespace
{

struct Thing
{
  std::string place;  // beginning of a message about it
  Box box;
};

/// Where the middles of most pairs lie along `left` [m]: their median, 0 without pairs.
double middle_of_pairs(const std::map<std::string, Thing>& things, const Vector3d& left)
{
  std::vector<double> middles;
  for (const auto& [name, thing] : things)
    if (const auto other = counterpart(things, name); other != things.end())
      middles.push_back(0.5 * left.dot(thing.box.center() + other->second.box.center()));
  return middles.empty() ? 0 : median(middles);
}

/// Examines things by their names; those without a counterpart are ignored.
void check_pairs(const Scene& scene, const std::map<std::string, Thing>& things, BakeMonitor& monitor)
{
  constexpr double least_distance = 1e-3;  // [m]
  constexpr double clear = 0.5;            // cosine; axes of a scene without 'frame' may lie in any direction
  const Vector3d left = to_vector(scene.frame.up).cross(to_vector(scene.frame.forward)).normalized();
  constexpr std::size_t enough_pairs = 3;  // from which their middle is that of the face, even if one pair is wrong
  const double middle = middle_of_pairs(things, left);
  std::size_t pairs = 0, exchanged = 0, across = 0;
  std::string first, first_across, first_on_one_side;
  for (const auto& [name, thing] : things)
  {
    const auto other = counterpart(things, name);
    if (other == things.end())
      continue;
    ++pairs;
    const Box& there = other->second.box;
    const Vector3d apart = thing.box.center() - there.center();
    if (thing.box.min() == there.min() && thing.box.max() == there.max())
      throw failure(
          "{} lies where '{}' does; give each its own data, or use one of them, named without a side, for both",
          thing.place, other->first);
    // Of a mirrored surface that is used twice, both lie on one side, if not exactly in one place.
    const double here = left.dot(thing.box.center()) - middle, opposite = left.dot(there.center()) - middle;
    if (first_on_one_side.empty() && std::min(std::abs(here), std::abs(opposite)) > 2 * apart.norm())
      first_on_one_side = fmt::format("{} and '{}' lie on the {} side of the face, {} apart", thing.place, other->first,
                                      here > 0 ? "left" : "right", length_text(apart.norm(), scene.unit));
    if (apart.norm() > least_distance && std::abs(left.dot(apart)) < clear * apart.norm() && across++ == 0)
      first_across =
          fmt::format("{} lies {} from '{}'", thing.place, length_text(apart.norm(), scene.unit), other->first);
    if (apart.norm() < least_distance || left.dot(apart) > -clear * apart.norm())
      continue;
    if (exchanged++ == 0)
      first = fmt::format("{} lies {} to the right of '{}'", thing.place, length_text(-left.dot(apart), scene.unit),
                          other->first);
  }
  if (exchanged > 0)
    throw failure("{} in the face frame (pairs with left and right exchanged: {} of {}): {}", first, exchanged, pairs,
                  exchanged == pairs
                      ? "the data are mirrored or turned, or 'forward' and 'up' of the scene's 'frame' are "
                        "not those of the data"
                      : "exchange their names or files; if all bones or all muscles are exchanged, their data are "
                        "mirrored or turned, as between the axes LPS and RAS of medical images");
  if (!first_on_one_side.empty() && pairs >= enough_pairs)
    monitor.warn("{}: one of them is probably mirrored or used for both sides", first_on_one_side);
  if (pairs > 0 && across == pairs)
    monitor.warn(
        "{}, but not to its left in the face frame: 'forward' and 'up' of the scene's 'frame' are not those of "
        "the data, so that directions and pictures will be wrong",
        first_across);
}

/// Warns of names that look like those of sides but are not NAME_left and NAME_right.
void find_other_names_of_sides(const Scene& scene, const std::map<std::string, Thing>& things, BakeMonitor& monitor)
{
  std::map<std::string, std::string> given;  // by the names in lower case
  for (const auto& [name, thing] : things)
    given.emplace(boost::algorithm::to_lower_copy(name), name);
  constexpr std::array<std::array<const char*, 2>, 5> sides{
    { { "left", "right" }, { "links", "rechts" }, { "gauche", "droite" }, { "izquierda", "derecha" }, { "l", "r" } }
  };
  for (const auto& [name, as_given] : given)
    for (const auto& [left, right] : sides)
      for (const bool first : { false, true })
        for (const char separator : { '_', '-', '.', ' ' })
        {
          const std::string part = first ? std::string(left) + separator : separator + std::string(left);
          const std::size_t at = first ? 0 : name.size() - std::min(name.size(), part.size());
          if (part == "_left" || name.compare(at, part.size(), part) != 0)
            continue;
          const std::string rest = first ? name.substr(part.size()) : name.substr(0, at);
          const std::string other = first ? std::string(right) + separator + rest : rest + separator + right;
          if (given.count(other) > 0)
            return monitor.warn(
                "{}: '{}' and '{}' look like two sides, but only NAME_left and NAME_right are taken for such: rename "
                "them, here to '{}_left' and '{}_right', so that exchanged and displaced sides are found",
                scene.file, as_given, given.at(other), rest, rest);
        }
}

/// Warns of surfaces from different files, and of surfaces of different muscles, that have the same mesh.
void find_equal_surfaces(const Scene& scene, const PreparedSurfaces& surfaces, BakeMonitor& monitor)
{
  const auto is_muscle = [&](const Surface& surface)
  {
    return std::any_of(scene.muscles.begin(), scene.muscles.end(),
                       [&](const SceneMuscle& muscle)
                       {
                         const Volume& volume =
                             scene.volumes[index_of(scene.volumes, muscle.volume, scene.file, "volume")];
                         return volume.inside == std::vector<std::string>{ surface.name };
                       });
  };
  for (auto a = surfaces.begin(); a != surfaces.end(); ++a)
    for (auto b = std::next(a); b != surfaces.end(); ++b)
    {
      const Surface &one = scene.surfaces[index_of(scene.surfaces, (*a)->name(), scene.file, "surface")],
                    &other = scene.surfaces[index_of(scene.surfaces, (*b)->name(), scene.file, "surface")];
      const bool may_be_equal = one.file == other.file && !(is_muscle(one) && is_muscle(other));
      if (!one.file.empty() && !other.file.empty() && !may_be_equal &&
          (*a)->mesh().triangles.size() == (*b)->mesh().triangles.size() && (*a)->box().min() == (*b)->box().min() &&
          (*a)->box().max() == (*b)->box().max())
        monitor.warn("{} has the mesh of '{}'; check whether one file was exported, copied or named twice",
                     place_in_scene(scene, "surface", one), other.name);
    }
}

}  // namespace

std::optional<MiddlePlane> middle_plane(const PreparedSurfaces& surfaces)
{
  std::map<std::string, Thing> things;
  for (const auto& surface : surfaces)
    things[surface->name()] = { {}, surface->box() };
  Vector3d left = Vector3d::Zero();
  for (const auto& [name, thing] : things)
    if (const auto other = counterpart(things, name); other != things.end())
      left += (thing.box.center() - other->second.box.center()).normalized();
  if (left.isZero())
    return std::nullopt;
  left.normalize();
  return MiddlePlane{ left, middle_of_pairs(things, left) };
}

void check_sides(const Scene& scene, const PreparedSurfaces& surfaces, BakeMonitor& monitor)
{
  std::map<std::string, Thing> things;
  for (const Surface& given : scene.surfaces)
    for (const auto& surface : surfaces)
      if (given.name == surface->name())
        things[given.name] = { place_in_scene(scene, "surface", given), surface->box() };
  check_pairs(scene, things, monitor);
  find_other_names_of_sides(scene, things, monitor);
  things.clear();
  for (const SceneLandmark& landmark : scene.landmarks)
    if (!landmark.head)
      things[landmark.name] = { place_in_scene(scene, "landmark", landmark), Box(to_vector(landmark.position)) };
  check_pairs(scene, things, monitor);
  find_equal_surfaces(scene, surfaces, monitor);
}

}  // namespace frontalis
