#include "bake/shapes/head/follow_head.hpp"

#include "bake/messages.hpp"
#include "bake/shapes/head/head.hpp"

namespace frontalis
{
namespace
{

constexpr double step = 6e-3;        // [m] by which sides of the tissue move: a multiple of voxels of 1, 2 and 3 mm
constexpr double narrow = 4 * step;  // [m]; sides that are closer to each other keep their distance

/// Moves places as a head is deformed.
class Follower
{
public:
  explicit Follower(const Head& head) : head_(head) {}

  void move(Vector3& p) const { p = to_array(head_.moved(to_vector(p))); }

  void move(std::vector<Vector3>& points) const
  {
    for (Vector3& p : points)
      move(p);
  }

  /// Moves a box as its middle moves; a box of nodes at a bone also goes along with the bone's depth below the skin. Of
  /// a region without end each side moves by itself.
  void move(Region& region, bool at_bone = false) const
  {
    if ((to_vector(region.upper) - to_vector(region.lower)).maxCoeff() > 1)
    {
      move_sides(region, [](double way) { return way; });
      return;
    }
    const Vector3d middle = middle_of(region);
    Vector3d to = middle;
    if (at_bone)
      to += head_.bone_shift(middle);
    const Vector3d by = head_.moved(to) - middle;
    for (int a = 0; a < 3; ++a)
    {
      region.lower[a] += by[a];
      region.upper[a] += by[a];
    }
  }

  /// Moves each side of a region in whole steps.
  void move_sides(Region& region) const
  {
    move_sides(region, [](double way) { return step * std::round(way / step); });
  }

  void move_sides(Shape& box) const
  {
    Region region;
    for (int a = 0; a < 3; ++a)
    {
      region.lower[a] = box.centre[a] - box.size[a] / 2;
      region.upper[a] = box.centre[a] + box.size[a] / 2;
    }
    move_sides(region);
    for (int a = 0; a < 3; ++a)
    {
      box.centre[a] = (region.lower[a] + region.upper[a]) / 2;
      box.size[a] = region.upper[a] - region.lower[a];
    }
  }

private:
  /// Moves each side of a region by `moved(way)`, where `way` is that of the side's own middle. Two sides that are
  /// close to each other go where the region's middle goes, because rounding could change their distance by as much as
  /// they are apart.
  template <class Moved>
  void move_sides(Region& region, const Moved& moved) const
  {
    const Vector3d middle = middle_of(region), size = to_vector(region.upper) - to_vector(region.lower);
    for (int a = 0; a < 3; ++a)
      for (Vector3* corner : { &region.lower, &region.upper })
      {
        double& side = (*corner)[a];
        Vector3d at = middle;
        if (size[a] > narrow)
          at[a] = side;
        if (std::isfinite(side))
          side += moved((head_.moved(at) - at)[a]);
      }
  }

  /// Middle of the part of a region that lies in the face.
  static Vector3d middle_of(const Region& region)
  {
    const Vector3d lower = to_vector(region.lower).cwiseMax(Vector3d(-0.08, -0.08, -0.13));
    return (lower + to_vector(region.upper).cwiseMin(Vector3d(0.03, 0.08, 0.072))) / 2;
  }

  const Head& head_;
};

}  // namespace

Scene following_head(const Scene& given)
{
  Scene scene = given;
  const auto has_head = [](const Surface& surface) { return surface.shape && surface.shape->head; };
  const auto first = std::find_if(scene.surfaces.begin(), scene.surfaces.end(), has_head);
  if (first == scene.surfaces.end() || (first->shape->dimensions.empty() && first->shape->tissue == 1))
    return scene;
  std::shared_ptr<const Head> head;
  try
  {
    head = head_of(*first->shape);
  }
  catch (const Error& error)
  {
    throw Error(place_in_scene(scene, "surface", *first) + ": " + error.what());
  }
  const Follower follower(*head);
  for (Surface& surface : scene.surfaces)
    if (surface.shape && surface.shape->kind == Shape::Kind::box)
      follower.move_sides(*surface.shape);
    else if (surface.shape && !surface.shape->head)
    {
      follower.move(surface.shape->centre);
      for (std::vector<Vector3>& curve : surface.shape->curves)
        follower.move(curve);
      for (Shape::Depth& depth : surface.shape->depths)
        follower.move(depth.at);
      if (surface.shape->below)  // a surface above it in the file, which has been moved
        surface.shape->below = std::make_shared<const Surface>(
            *std::find_if(scene.surfaces.begin(), scene.surfaces.end(),
                          [&](const Surface& other) { return other.name == surface.shape->below->name; }));
    }
  for (Volume& volume : scene.volumes)
  {
    follower.move_sides(volume.crop);
    if (volume.tissue)  // it reaches the bones, which lie deeper below full tissue
      volume.depth_max *= std::max(1.0, first->shape->tissue);
  }
  follower.move_sides(scene.skin.crop);
  for (SceneFilm& film : scene.films)
    follower.move(film.crop);
  for (SceneMuscle& muscle : scene.muscles)
  {
    follower.move(muscle.origin.points);
    follower.move(muscle.insertion.points);
    if (muscle.net)
      follower.move(muscle.net->points);
  }
  for (SceneConstraint& constraint : scene.constraints)
    if (constraint.within == 0)  // what is only shown joins the skin
      follower.move_sides(constraint.crop);
    else
      follower.move(constraint.crop, constraint.restricts_nodes());
  for (SceneLoad& load : scene.loads)
    follower.move(load.crop);
  for (SceneWeakness& weakness : scene.weakness)
    follower.move(weakness.centre);
  for (SceneLandmark& landmark : scene.landmarks)
    follower.move(landmark.position);
  for (auto& [bone, centre] : scene.bone_centres)
    follower.move(centre);
  for (SceneJoint& joint : scene.joints)
    if (!joint.head)
      follower.move(joint.joint.at);
  follower.move(scene.frame.origin);
  return scene;
}

}  // namespace frontalis
