#pragma once

#include "frontalis/runner/face_frame.hpp"

#include <string>
#include <vector>

namespace frontalis
{

/// Prints forces and moments on bodies. The reference point of moments is the point about which `--bone` rotates a
/// bone.
void print_reactions(const Model& model, const std::vector<BodyFrame>& bodies);

/// Header of a table (CSV) with one row per frame and body.
inline const std::string reaction_heading =
    "frame,time_s,body,force_x_N,force_y_N,force_z_N,moment_x_Nm,moment_y_Nm,"
    "moment_z_Nm\n";
std::string reaction_rows(const Model& model, int frame, double time, const std::vector<BodyFrame>& bodies);

/// Collects the forces on bodies over time, for a plot.
class ReactionPlot
{
public:
  /// `path` has no extension. Throws Error if the model has no bodies that tissue touches.
  ReactionPlot(std::string path, const Model& model);
  void add(double time, const std::vector<BodyFrame>& bodies);
  /// Writes PATH.png and PATH.svg with the magnitude and the components of the force on each body. Throws Error.
  void write() const;

private:
  std::string path_;
  const Model& model_;
  std::vector<double> time_;
  std::vector<std::vector<BodyFrame>> bodies_;
};

}  // namespace frontalis
