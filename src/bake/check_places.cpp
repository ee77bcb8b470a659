#include "bake/checks.hpp"

#include "bake/messages.hpp"

#include <algorithm>
#include <functional>
#include <set>

namespace frontalis
{
namespace
{

/// How far a surface reaches into another: its vertex that is deepest in the other.
struct Penetration
{
  double depth = 0;  ///< [m]
  Vector3d place{ 0, 0, 0 };
};

Penetration penetration(const PreparedSurface& of, const PreparedSurface& into)
{
  constexpr std::size_t most_points = 3000;
  const std::vector<Vector3>& vertices = of.mesh().vertices;
  const std::size_t stride = 1 + vertices.size() / most_points;
  Penetration deepest;
  for (std::size_t v = 0; v < vertices.size(); v += stride)
  {
    const Vector3d p = to_vector(vertices[v]);
    if (!into.box().contains(p) || into.tree().winding_number(p) < 0.5)
      continue;
    if (const double depth = into.tree().closest(p).distance; depth > deepest.depth)
      deepest = { depth, p };
  }
  return deepest;
}

/// The bones that move what constraints hold at each surface, let slide on it or push by it; an empty name stands for
/// none.
std::map<std::string, std::set<std::string>> bones_at_surfaces(const Scene& scene)
{
  std::map<std::string, std::set<std::string>> bones;
  for (const SceneConstraint& constraint : scene.constraints)
    // Bodies that are only shown have a `within` of 0.
    if (constraint.restricts_nodes() || constraint.within != 0)
      for (const std::string& surface : constraint.surfaces)
        bones[surface].insert(constraint.bone);
  return bones;
}

/// Warns of surfaces beside the tissue, such as bones, that overlap although they move with different bones.
void find_overlapping_bones(const Scene& scene, const std::vector<const PreparedSurface*>& bodies, BakeMonitor& monitor)
{
  constexpr double allowed = 2.5e-3;  // [m]; segmented joints overlap by less
  const auto bones = bones_at_surfaces(scene);
  for (std::size_t a = 0; a < bodies.size(); ++a)
    for (std::size_t b = a + 1; b < bodies.size(); ++b)
    {
      const auto of_a = bones.find(bodies[a]->name()), of_b = bones.find(bodies[b]->name());
      if (of_a == bones.end() || of_b == bones.end() || of_a->second == of_b->second ||
          !bodies[a]->box().intersects(bodies[b]->box()))
        continue;
      const Penetration there = penetration(*bodies[a], *bodies[b]), back = penetration(*bodies[b], *bodies[a]);
      const Penetration& deepest = there.depth > back.depth ? there : back;
      if (deepest.depth > allowed)
        monitor.warn(
            "surfaces '{}' and '{}', which move with different bones, overlap by {} at {}: one of them is "
            "misplaced, or they were not parted; check both",
            bodies[a]->name(), bodies[b]->name(), length_text(deepest.depth, scene.unit),
            place_text(deepest.place, scene.unit));
    }
}

/// Reports surfaces beside the tissue at which nothing holds it or lets it slide, as it is in front of teeth.
void find_free_bones(const Scene& scene, const std::vector<const PreparedSurface*>& bodies, BakeMonitor& monitor)
{
  const auto bones = bones_at_surfaces(scene);
  for (const PreparedSurface* const body : bodies)
    if (bones.count(body->name()) == 0)
      monitor.found(
          "surface '{}' bounds the tissue, but no constraint names it: the tissue can move through its place, "
          "unless another surface is in front of it",
          body->name());
}

/// Warns of centres of bones that lie far from the surfaces that move with the bone.
void find_distant_centres(const Scene& scene, const PreparedSurfaces& surfaces, BakeMonitor& monitor)
{
  constexpr double farthest = 0.15;  // [m]; arms of robots and hinges of jaws may turn small parts
  for (const auto& [bone, centre] : scene.bone_centres)
  {
    Box box;
    for (const SceneConstraint& constraint : scene.constraints)
      for (const std::string& name : constraint.surfaces)
        if (constraint.bone == bone)
          box.extend(named_surface(surfaces, name, scene.file).box());
    if (box.isEmpty())
      continue;
    if (const double distance = box.exteriorDistance(to_vector(centre));
        distance > std::max(farthest, box.diagonal().norm()))
      monitor.warn(
          "{}: the centre of bone '{}', {}, lies {} from the surfaces that move with it, which span {}; check its sign "
          "and its length unit",
          scene.file, bone, place_text(to_vector(centre), scene.unit), length_text(distance, scene.unit),
          box_text(box, scene.unit));
  }
}

/// Warns of pairs NAME_left and NAME_right of which one lies elsewhere than the mirror image of the other, as no other
/// pair does.
void find_displaced_sides(const Scene& scene, const PreparedSurfaces& surfaces, BakeMonitor& monitor)
{
  constexpr std::size_t fewest_pairs = 4;
  constexpr double allowed = 10e-3;  // [m]
  constexpr double unusual = 5;      // times the median of all pairs
  std::map<std::string, Vector3d> surfaces_at, landmarks_at;
  for (const auto& surface : surfaces)
    surfaces_at[surface->name()] = surface->box().center();
  for (const SceneLandmark& landmark : scene.landmarks)
    if (!landmark.head)
      landmarks_at[landmark.name] = to_vector(landmark.position);
  struct Pair
  {
    std::string kind, name, other;
    Vector3d left, right;
  };
  std::vector<Pair> pairs;
  const auto add = [&](const char* kind, const std::map<std::string, Vector3d>& places)
  {
    for (const auto& [name, place] : places)
      if (const auto other = counterpart(places, name); other != places.end())
        pairs.push_back({ kind, name, other->first, place, other->second });
  };
  add("surface", surfaces_at);
  add("landmark", landmarks_at);
  if (pairs.size() < fewest_pairs)
    return;
  // Medians, so that a pair that is wrong does not move the plane between the sides.
  const auto median_of = [&](const std::function<Vector3d(const Pair&)>& vector)
  {
    Vector3d middle;
    for (int axis = 0; axis < 3; ++axis)
    {
      std::vector<double> along;
      along.reserve(pairs.size());
      for (const Pair& pair : pairs)
        along.push_back(vector(pair)[axis]);
      middle[axis] = median(along);
    }
    return middle;
  };
  const Vector3d left = median_of([](const Pair&pair) { return (pair.left - pair.right).normalized(); }).normalized(),
                 middle = median_of([](const Pair&pair) { return 0.5 * (pair.left + pair.right); });
  const auto off = [&](const Pair& pair) -> Vector3d
  { return pair.left - pair.right + 2 * left.dot(pair.right - middle) * left; };
  const Vector3d usual = median_of(off);
  std::vector<double> distances;
  distances.reserve(pairs.size());
  for (const Pair& pair : pairs)
    distances.push_back((off(pair) - usual).norm());
  const double limit = std::max(allowed, unusual * median(distances));
  for (std::size_t p = 0; p < pairs.size(); ++p)
    if (distances[p] > limit)
      monitor.warn("{} '{}' lies {} from the mirror image of '{}', half of the pairs within {}: check both",
                   pairs[p].kind, pairs[p].name, length_text(distances[p], scene.unit), pairs[p].other,
                   length_text(median(distances), scene.unit));
}

}  // namespace

void check_moving_bones(const Scene& scene, const Model& model, BakeMonitor& monitor)
{
  constexpr double most = 0.5;  // share of the nodes; in whole faces a mandible has up to 0.13
  std::set<std::string> moved;
  for (const auto* poses : { &scene.expressions, &scene.action_units })
    for (const auto& [name, pose] : *poses)
      for (const BonePose& bone : pose.bones)
        moved.insert(bone.bone);
  std::map<std::int32_t, std::size_t> nodes;
  for (const RigidNode& node : model.rigid)
    ++nodes[node.bone];
  for (const SlidingNode& node : model.sliding)
    ++nodes[model.constraint_surfaces[node.surface].bone];
  const auto all = static_cast<double>(model.rigid.size() + model.sliding.size());
  for (const auto& [bone, count] : nodes)
    if (bone >= 0 && moved.count(model.bones[bone]) > 0 && static_cast<double>(count) > most * all)
      monitor.warn(
          "{}: bone '{}', which expressions move, has {:.0f} % of the nodes that are held or slide, so that most of "
          "the face moves with it: check the surfaces and 'bone' of the constraints, and whether the jaw was parted "
          "from the skull",
          scene.file, model.bones[bone], 100 * static_cast<double>(count) / all);
}

void check_places(const Scene& scene, const PreparedSurfaces& surfaces, const Volumes& volumes, BakeMonitor& monitor)
{
  std::vector<const PreparedSurface*> bodies;
  std::set<std::string> told;
  for (const Volume& volume : scene.volumes)
    for (const std::string& name : volume.outside)
      if (volume.tissue && told.insert(name).second)
        if (const PreparedSurface& body = named_surface(surfaces, name, scene.file);
            body.box().intersects(volumes.tissue_box()))
          bodies.push_back(&body);
  find_overlapping_bones(scene, bodies, monitor);
  find_free_bones(scene, bodies, monitor);
  find_distant_centres(scene, surfaces, monitor);
  find_displaced_sides(scene, surfaces, monitor);
}

}  // namespace frontalis
