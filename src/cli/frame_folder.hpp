#pragma once

#include "frontalis/model/model.hpp"
#include "frontalis/solver/solver.hpp"

#include <string>

namespace frontalis
{

/// A folder of frames: skin_0000.ply, skin_0001.ply, ..., landmarks.csv and run.json. Every file is written whole or
/// not at all.
class FrameFolder
{
public:
  /// Makes the folder if it is missing and removes the files of an earlier run from it. Throws Error.
  FrameFolder(std::string path, const Model& model);

  /// Writes the skin, in the face frame, as binary little-endian PLY: vertices and normals as float, triangles.
  void add(double time, const SkinState& skin, const std::vector<Reaction>& reactions);
  /// Writes landmarks.csv (position [m] and motion from the first frame [mm], face frame), reactions.csv where
  /// the model has contact (force [N] and moment [N m], face frame) and run.json.
  void finish(const std::string& summary);

private:
  std::string path_;
  const Model& model_;
  int frames_ = 0;
  SkinState first_;
  std::string table_, reactions_;
};

}  // namespace frontalis
