#pragma once

#include "frontalis/scene/scene.hpp"

namespace frontalis
{

/// A scene with a generated head is written for the default head. Returns it with its places moved as the first of its
/// heads is deformed: the origin of the face frame, landmarks, centres and joints of bones, the points that define
/// shapes and muscles, and boxes. The sides of boxes that bound the tissue and the skin move in steps of 6 mm, so that
/// the grids of voxels of 1, 2 and 3 mm stay where they are; sides less than 24 mm apart keep their distance. Any other
/// crop moves as a whole, and with the bone if it is a box in which bones hold nodes. Nothing moves in a scene with the
/// default head or without a head.
Scene following_head(const Scene& scene);

}  // namespace frontalis
