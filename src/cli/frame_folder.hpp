#pragma once

#include "frontalis/runner/face_frame.hpp"
#include "frontalis/solver/tissue_state.hpp"

#include <optional>
#include <string>
#include <vector>

namespace frontalis
{

/// Files that a folder of frames has on request.
struct FrameFiles
{
  bool vtp = false;  ///< skin_0000.vtp, ... and skin.pvd
  bool vtu = false;  ///< tissue_0000.vtu, ... and tissue.pvd
};

/// A folder of frames: skin_0000.ply, skin_0001.ply, ..., landmarks.csv and run.json, and those of `FrameFiles`. The
/// files .pvd list frames with their times for ParaView. Every file is written completely or not at all.
class FrameFolder
{
public:
  /// Makes the folder if it is missing and removes the files of an earlier run from it. The model must outlive this
  /// object. Throws Error.
  FrameFolder(std::string path, const Model& model, FrameFiles files);

  /// Writes the skin, in the face frame, as binary little-endian PLY: vertices and normals as float, triangles. A VTP
  /// file also has the displacement from `rest` [m]. A VTU file has the present tissue of `solver`.
  void add(double time, const SkinState& skin, const SkinState& rest, const std::vector<BodyFrame>& bodies,
           const Solver& solver);
  /// Writes landmarks.csv (position [m] and motion from rest [mm], face frame), run.json and, if tissue
  /// may touch bodies, reactions.csv (force [N] and moment [N m], face frame).
  void finish(const std::string& summary);

private:
  std::string path_;
  const Model& model_;
  FrameFiles files_;
  std::optional<TissueReader> tissue_;
  int frames_ = 0;
  std::string table_, reactions_, skins_, tissues_;
};

}  // namespace frontalis
