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

/// An actuator, and the motion of bones that it causes per unit of its position, by parts of motion with the names and
/// units of value_controls(): BONE.x [mm], BONE.rx [degrees] and so on.
struct Actuator
{
  std::string name;
  std::map<std::string, double> moves;
};

/// Reads the entry `actuators` of a file (YAML, doc/robots.md). Throws Error with the file's line.
std::vector<Actuator> read_actuators(const std::string& path);

/// Positions and efforts of actuators at several times.
struct ActuatorTrack
{
  std::vector<double> time;                   ///< ascending from 0 [s]
  std::vector<std::vector<double>> position;  ///< per time and actuator, 0 at the face's rest
  /// Per time and actuator; NaN: not measured. Conjugate to the position if the believed motion were true: for an
  /// actuator that moves a bone by its position in metres, the force on the bone along this motion [N].
  std::vector<std::vector<double>> effort;
};

/// Reads a table (CSV) with the columns time_s, one per actuator, named like it, and ACTUATOR.effort of those whose
/// effort was measured. Other columns are not read. Throws Error with the file's line.
ActuatorTrack read_actuator_track(const std::string& path, const std::vector<Actuator>& actuators);

struct CalibrationSettings : FitSettings
{
  int hold_out = 4;  ///< every so many poses, one is not used and shows the error of the others' answer; 0: none
};

struct Calibration
{
  std::vector<Actuator> actuators;      ///< with the motion that was found
  std::vector<double> gains;            ///< found over given motion, per actuator
  double modulus = 0;                   ///< found stiffness of all tissue over that of the model; NaN: no efforts
  std::size_t poses = 0, held_out = 0;  ///< number of poses that were used, and that were not
  double error = 0;                     ///< of landmarks in the used poses, root mean square [m]
  double held_out_error = 0;            ///< the same in those held out; NaN: there is none
  double error_before = 0;              ///< in all poses with the given motion, as the influence predicts it [m]
};

/// Finds the gains of actuators from places of landmarks in still poses, and the modulus from efforts. Gains: least
/// squares of the measured influence of each motion, corrected by `settings.runs` simulations of every pose. Modulus:
/// least squares of the efforts against those of the last simulation, to which they are proportional as long as tissue
/// is loaded by nothing else than the actuators. `landmarks` has the same times as `track`. Throws Error if times or
/// names do not fit, or an actuator never moves. Passes on what FitSettings::watch throws.
Calibration calibrate(const std::shared_ptr<const Model>& model, const std::vector<Actuator>& actuators,
                      const ActuatorTrack& track, const LandmarkTrack& landmarks, const CalibrationSettings& settings);

/// The calibration as YAML, whose entry `actuators` read_actuators() reads.
std::string yaml_of(const Calibration& calibration);

}  // namespace frontalis
