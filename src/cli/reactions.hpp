#pragma once

#include "frontalis/runner/face_frame.hpp"

#include <string>
#include <vector>

namespace frontalis
{

/// Forces and moments as BodyFrame has them: moments are about the centre of rotations given with `--bone`.
void print_reactions(const Model& model, const std::vector<BodyFrame>& bodies);

/// Header of a table (CSV) with one row per frame and body.
inline const std::string reaction_heading =
    "frame,time_s,body,force_x_N,force_y_N,force_z_N,moment_x_Nm,moment_y_Nm,"
    "moment_z_Nm\n";
std::string reaction_rows(const Model& model, int frame, double time, const std::vector<BodyFrame>& bodies);

/// Collects what acts on bodies over time, to be drawn.
class ReactionPlot
{
public:
  /// `path` has no extension.
  ReactionPlot(std::string path, const Model& model) : path_(std::move(path)), model_(model) {}
  void add(double time, const std::vector<BodyFrame>& bodies);
  /// Writes PATH.png and PATH.svg: of each body the magnitude of the force and its three components. Throws Error.
  void write() const;

private:
  std::string path_;
  const Model& model_;
  std::vector<double> time_;
  std::vector<std::vector<BodyFrame>> bodies_;
};

}  // namespace frontalis
