#pragma once

#include "bake/mesh/surface.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <string>

namespace frontalis
{

/// The thing called NAME_right if `name` is NAME_left, and things.end() for any other name or without such a thing.
template <class Thing>
auto counterpart(const std::map<std::string, Thing>& things, const std::string& name)
{
  const std::string left = "_left";
  const std::size_t end = name.size() - std::min(name.size(), left.size());
  return name.substr(end) == left ? things.find(name.substr(0, end) + "_right") : things.end();
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

}  // namespace frontalis
