#pragma once

#include "bake/bake_monitor.hpp"
#include "bake/voxels/voxelise.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace frontalis
{

// Checks of a scene for mistakes that the bake would follow without a word.

/// The thing called NAME_right if `name` is NAME_left, and things.end() for any other name or without such a thing.
template <class Thing>
auto counterpart(const std::map<std::string, Thing>& things, const std::string& name)
{
  const std::string left = "_left";
  const std::size_t end = name.size() - std::min(name.size(), left.size());
  return name.substr(end) == left ? things.find(name.substr(0, end) + "_right") : things.end();
}

/// The middle of the values, of which there must be one at least.
inline double median(std::vector<double> values)
{
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The plane between the left and the right half of the face: points p with left.dot(p) == offset.
struct MiddlePlane
{
  Vector3d left;      ///< unit normal
  double offset = 0;  ///< [m]
};

/// The middle plane of the pairs of surfaces NAME_left and NAME_right; nothing without pairs.
std::optional<MiddlePlane> middle_plane(const PreparedSurfaces& surfaces);

/// Throws Error if a surface or landmark called NAME_left lies to the right of NAME_right in the face frame. A face
/// that is mirrored, by its files or by its frame, would otherwise be baked without a word. Warns if left and right do
/// not lie beside each other in the face frame, or on one side of it, and of files with the same mesh.
void check_sides(const Scene& scene, const PreparedSurfaces& surfaces, BakeMonitor& monitor);

/// Warns of holes in mesh files, within the tissue, that are probably faults: in surfaces that tissue is outside of,
/// such as bones, and in the skin on one side of the face alone. Holes of eyes and mouth have a counterpart on the
/// other side or lie in the middle. Sides are those of the pairs of surfaces NAME_left and NAME_right.
void check_holes(const Scene& scene, const PreparedSurfaces& surfaces, const Volumes& volumes, BakeMonitor& monitor);

/// Warns of surfaces that the scene cuts out of the tissue, such as bones, but that lie nowhere near it, wholly outside
/// of the skin, or are smaller than a voxel: their length unit or their place is wrong, and tissue fills the place
/// where they should be.
void find_surfaces_apart(const Scene& scene, const Volumes& volumes, BakeMonitor& monitor);

/// Reports how much of each muscle was clipped, and warns of muscles that lie mostly outside of the tissue or differ
/// from their counterpart. Throws Error if a volume is empty or a muscle lies nearly wholly outside.
void check_volumes(const Scene& scene, const Volumes& volumes, const Voxels& voxels, BakeMonitor& monitor);

/// Warns of surfaces beside the tissue, such as bones, that overlap although they move with different bones; of centres
/// far from their bones; and of pairs NAME_left, NAME_right that are not mirror images of each other's places, as other
/// pairs are. Reports surfaces beside the tissue that no constraint names.
void check_places(const Scene& scene, const PreparedSurfaces& surfaces, const Volumes& volumes, BakeMonitor& monitor);

/// Warns of a bone that expressions or action units move and to which most held and sliding nodes belong, such as
/// that of a jaw that was not parted from the skull.
void check_moving_bones(const Scene& scene, const Model& model, BakeMonitor& monitor);

/// Warns of materials, muscles, layers and gravity that are so far from any tissue, bone or silicone that a unit is
/// probably missing or wrong: a number without a unit is in SI units, so that 'young: 34' is 34 Pa.
void check_magnitudes(const Scene& scene, const Model& model, BakeMonitor& monitor);

/// Warns of bones that expressions, action units or the demo turn although the scene gives no centre for them.
void check_bone_centres(const Scene& scene, BakeMonitor& monitor);

}  // namespace frontalis
