#pragma once

#include "frontalis/model/model.hpp"

namespace frontalis
{

/// One voxel of 10 mm with two skin triangles on its upper face, a landmark and two muscles; the face frame is turned
/// by 90 degrees about z and shifted by 1 m along x.
inline Model small_model()
{
  Model model;
  model.spacing = { { 0.01, 0.01, 0.01 } };
  model.size = { { 1, 1, 1 } };
  model.voxels = { { { 0, 0, 0 } } };
  model.fill = { 1 };
  build_nodes(model);
  model.muscles.resize(2);
  model.muscles[0].name = "raiser";
  model.muscles[1].name = "knitter";
  model.skin.vertices = { { { 0, 0, 0.01 } }, { { 0.01, 0, 0.01 } }, { { 0.01, 0.01, 0.01 } }, { { 0, 0.01, 0.01 } } };
  model.skin.triangles = { { { 0, 1, 2 } }, { { 0, 2, 3 } } };
  model.landmarks = { "brow" };
  model.landmark_positions = { { { 0, 0, 0.01 } } };
  model.to_face.rotation = { { 0, -1, 0, 1, 0, 0, 0, 0, 1 } };
  model.to_face.translation = { { 1, 0, 0 } };
  return model;
}

}  // namespace frontalis
