#pragma once

#include "frontalis/study/fit.hpp"

#include <array>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace frontalis
{

// Calibration of a robot's face: how far its actuators move the bones (anchors) of the model, and how stiff its skin
// is.

/// An actuator, and the motion of bones that it causes per unit of its position. A bone that several actuators move is
/// first shifted by the sum of their shifts, then turned by the sum of their turns.
struct Actuator
{
  std::string name;
  /// per bone: shift along x, y and z [mm] and rotation vector [degrees], along the axes of the face frame
  std::map<std::string, std::array<double, 6>> moves;
  std::array<double, 3> about{};  ///< point of the face frame about which bones turn [mm]
};

/// Reads the entry `actuators` of a file (YAML, doc/robots.md). Throws Error with the file's line, also if actuators
/// turn a bone about different points.
std::vector<Actuator> read_actuators(const std::string& path);

/// Positions and efforts of actuators at several times.
struct ActuatorTrack
{
  std::vector<double> time;                   ///< ascending from 0 [s]
  std::vector<std::vector<double>> position;  ///< per time and actuator, 0 at the face's rest
  /// Per time and actuator; NaN: not measured. Effort times a change of position is the work on the bones in the motion
  /// that Actuator::moves gives: for an actuator that moves a bone by its position in metres, the effort is the force
  /// on the bone along this motion [N].
  std::vector<std::vector<double>> effort;
};

/// Reads a table (CSV) with the column time_s, a column with the name of each actuator, and a column ACTUATOR.effort
/// for each actuator whose effort was measured. Other columns are not read. Throws Error with the file's line.
ActuatorTrack read_actuator_track(const std::string& path, const std::vector<Actuator>& actuators);

struct CalibrationSettings : FitSettings
{
  int hold_out = 4;  ///< one in this many poses is not used in the calibration, but tests its result; 0: all are used
};

struct Calibration
{
  std::vector<Actuator> actuators;      ///< actuators with the motions that were found
  std::vector<double> gains;            ///< motion found divided by the given motion, per actuator
  double modulus = 0;                   ///< stiffness found of all tissue, divided by the model's; NaN: no efforts
  std::size_t poses = 0, held_out = 0;  ///< number of poses that were used, and that were not
  double error = 0;                     ///< error of landmarks in the used poses, root mean square [m]
  double held_out_error = 0;            ///< error in the poses held out; NaN: there are none
  double error_before = 0;              ///< predicted error in all poses with the given motions [m]
};

/// Finds the gains of actuators from places of landmarks in still poses, and the modulus from efforts. The gains are a
/// least-squares solution with the measured influence of each motion (fit()), corrected by `settings.runs` simulations
/// of every pose. The modulus is a least-squares ratio of the measured efforts to those of the last simulation. Efforts
/// are proportional to the modulus as long as nothing but the actuators loads the tissue. `landmarks` has the same
/// times as `track`. Throws Error if times or names do not fit, or an actuator never moves. Passes on what
/// FitSettings::watch throws.
Calibration calibrate(const std::shared_ptr<const Model>& model, const std::vector<Actuator>& actuators,
                      const ActuatorTrack& track, const LandmarkTrack& landmarks, const CalibrationSettings& settings);

/// The calibration as YAML, whose entry `actuators` read_actuators() reads.
std::string yaml_of(const Calibration& calibration);

}  // namespace frontalis
