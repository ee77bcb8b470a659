#include "frontalis/study/calibrate.hpp"

#include "frontalis/study/csv.hpp"
#include "frontalis/study/table.hpp"
#include "study/fit/influence.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <optional>

namespace frontalis
{
namespace
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double range_margin = 1.2;         // measured range of a motion, divided by the range in the poses
constexpr double deviation = 1e-4;           // standard deviation of measured places of landmarks [m]
constexpr double gain_deviation = 1;         // standard deviation of gains from 1, a weak preference
constexpr int gauss_newton_iterations = 10;  // number of Gauss-Newton iterations
constexpr double degree = 3.14159265358979323846 / 180;  // [rad]

// The recorded poses as vectors, and what the latest simulation has shown of each.
struct Poses
{
  std::vector<VectorXd> position, effort;  // per pose: one number per actuator
  std::vector<VectorXd> places;            // per pose: measured displacements of the track's landmarks [m]
  std::vector<VectorXd> offset;            // per pose: simulated displacements minus those of the influence law [m]
};

// Indices of the coordinates of a track's landmarks in vectors of the coordinates of all landmarks.
std::vector<Index> coordinates_of(const Model& model, const LandmarkTrack& track)
{
  std::vector<Index> out;
  out.reserve(3 * track.landmarks.size());
  for (const std::size_t landmark : landmarks_of(model, track))
    for (const Index axis : { 0, 1, 2 })
      out.push_back(static_cast<Index>(3 * landmark) + axis);
  return out;
}

Poses poses_of(const ActuatorTrack& track, const LandmarkTrack& landmarks)
{
  if (track.time.size() != landmarks.time.size())
    throw Error(fmt::format("{} times of actuators, but {} of landmarks; must be the same times", track.time.size(),
                            landmarks.time.size()));
  Poses poses;
  for (std::size_t t = 0; t < track.time.size(); ++t)
  {
    if (std::abs(track.time[t] - landmarks.time[t]) > 1e-6)
      throw Error(fmt::format("actuators at {:g} s, but landmarks at {:g} s; must be the same times", track.time[t],
                              landmarks.time[t]));
    const auto vector = [](const std::vector<double>& numbers)
    { return VectorXd(Eigen::Map<const VectorXd>(numbers.data(), static_cast<Index>(numbers.size()))); };
    poses.position.push_back(vector(track.position[t]));
    poses.effort.push_back(vector(track.effort[t]));
    VectorXd& places = poses.places.emplace_back(static_cast<Index>(3 * landmarks.landmarks.size()));
    for (Index i = 0; i < places.size(); ++i)
      places[i] = landmarks.places[t][static_cast<std::size_t>(i / 3)][static_cast<std::size_t>(i % 3)];
    poses.offset.emplace_back(VectorXd::Zero(places.size()));
  }
  return poses;
}

// The components of bones' motions (parts) that the actuators cause, with limits that include all poses.
std::vector<Unknown> parts_of(const std::vector<Actuator>& actuators, const Poses& poses)
{
  std::map<std::string, Unknown> parts;
  for (std::size_t a = 0; a < actuators.size(); ++a)
    for (const auto& [part, per_unit] : actuators[a].moves)
      parts[part] = { part, 0, 0 };
  for (const VectorXd& position : poses.position)
  {
    std::map<std::string, double> values;
    for (std::size_t a = 0; a < actuators.size(); ++a)
      for (const auto& [part, per_unit] : actuators[a].moves)
        values[part] += per_unit * position[static_cast<Index>(a)];
    for (const auto& [part, value] : values)
    {
      parts[part].lower = std::min(parts[part].lower, range_margin * value);
      parts[part].upper = std::max(parts[part].upper, range_margin * value);
    }
  }
  std::vector<Unknown> out;
  out.reserve(parts.size());
  for (const auto& [name, part] : parts)
  {
    if (!(part.lower < part.upper))
      throw Error(fmt::format("the actuators of {} never leave 0; each must move in some pose", name));
    out.push_back(part);
  }
  return out;
}

// Matrix from the actuators' positions to the parts of motion: one row per part, one column per actuator.
MatrixXd motion_of(const std::vector<Actuator>& actuators, const std::vector<Unknown>& parts)
{
  MatrixXd out = MatrixXd::Zero(static_cast<Index>(parts.size()), static_cast<Index>(actuators.size()));
  for (Index a = 0; a < out.cols(); ++a)
    for (Index p = 0; p < out.rows(); ++p)
      if (const auto& moves = actuators[static_cast<std::size_t>(a)].moves;
          moves.count(parts[static_cast<std::size_t>(p)].name) > 0)
        out(p, a) = moves.at(parts[static_cast<std::size_t>(p)].name);
  return out;
}

// Work [J] of the tissue on bones per mm or degree of each part of motion.
VectorXd conjugate_forces(const Model& model, const std::vector<BodyFrame>& bones, const std::vector<Unknown>& parts)
{
  VectorXd out(static_cast<Index>(parts.size()));
  for (Index p = 0; p < out.size(); ++p)
  {
    const std::string& name = parts[static_cast<std::size_t>(p)].name;
    const std::size_t dot = name.rfind('.');
    const auto bone = std::find(model.bones.begin(), model.bones.end(), name.substr(0, dot)) - model.bones.begin();
    const auto axis = static_cast<std::size_t>(name.back() - 'x');
    const Reaction& reaction = bones[static_cast<std::size_t>(bone)].reaction;
    out[p] = name[dot + 1] == 'r' ? degree * double(reaction.moment[axis]) : millimetre * double(reaction.force[axis]);
  }
  return out;
}

double root_mean_square(double sum, std::size_t poses, std::size_t landmarks)
{
  return poses == 0 ? NAN : std::sqrt(sum / static_cast<double>(poses * landmarks));
}

}  // namespace

std::vector<Actuator> read_actuators(const std::string& path)
{
  std::vector<Actuator> out;
  try
  {
    for (const auto& entry : YAML::LoadFile(path)["actuators"])
      out.push_back({ entry.first.as<std::string>(), entry.second.as<std::map<std::string, double>>() });
  }
  catch (const YAML::BadFile&)
  {
    throw Error(path + ": cannot be read; must be a file of actuators (doc/robots.md)");
  }
  catch (const YAML::Exception& error)
  {
    throw Error(
        fmt::format("{}:{}: {}; must be like 'brow_lift: {{anchor.z: 1000}}'", path, error.mark.line + 1, error.msg));
  }
  if (out.empty())
    throw Error(path + ": has no actuators; must have some below 'actuators' (doc/robots.md)");
  return out;
}

ActuatorTrack read_actuator_track(const std::string& path, const std::vector<Actuator>& actuators)
{
  CsvReader table(path);
  const auto& header = table.header();
  const auto column = [&](const std::string& name) -> std::optional<std::size_t>
  {
    const auto found = std::find(header.begin(), header.end(), name);
    return found == header.end() ? std::nullopt : std::make_optional(std::size_t(found - header.begin()));
  };
  const auto needed = [&](const std::string& name)
  {
    const auto found = column(name);
    if (!found)
      throw Error(fmt::format("{}:1: has no column {}; the columns are {}", path, name, fmt::join(header, ", ")));
    return *found;
  };
  const std::size_t time = needed("time_s");
  std::vector<std::size_t> positions;
  std::vector<std::optional<std::size_t>> efforts;
  positions.reserve(actuators.size());
  efforts.reserve(actuators.size());
  for (const Actuator& actuator : actuators)
  {
    positions.push_back(needed(actuator.name));
    efforts.push_back(column(actuator.name + ".effort"));
  }
  ActuatorTrack track;
  while (table.next())
  {
    track.time.push_back(table.number(time));
    auto& position = track.position.emplace_back();
    auto& effort = track.effort.emplace_back();
    for (std::size_t a = 0; a < actuators.size(); ++a)
    {
      position.push_back(table.number(positions[a]));
      effort.push_back(efforts[a] ? table.number(*efforts[a]) : NAN);
    }
  }
  if (track.time.empty())
    throw Error(path + ": has no row below its header");
  return track;
}

Calibration calibrate(const std::shared_ptr<const Model>& model, const std::vector<Actuator>& actuators,
                      const ActuatorTrack& track, const LandmarkTrack& landmarks, const CalibrationSettings& settings)
{
  Poses poses = poses_of(track, landmarks);
  const std::vector<Unknown> parts = checked_unknowns(*model, parts_of(actuators, poses));
  const std::vector<Index> seen = coordinates_of(*model, landmarks);
  const MatrixXd motion = motion_of(actuators, parts);
  ForwardRuns runs(model, settings);
  double seconds = 0;
  const Influence influence = obtain_influence(runs, parts, settings, seconds);
  const InfluenceLaw law(*model, influence, parts);

  const std::size_t count = poses.position.size();
  std::vector<std::size_t> used, all;
  used.reserve(count);
  all.reserve(count);
  for (std::size_t p = 0; p < count; ++p)
  {
    all.push_back(p);
    if (settings.hold_out == 0 || p % static_cast<std::size_t>(settings.hold_out) != 1)
      used.push_back(p);
  }
  const auto values = [&](std::size_t pose, const VectorXd& gains) -> VectorXd
  { return motion * gains.cwiseProduct(poses.position[pose]); };
  const auto missing = [&](std::size_t pose, const VectorXd& gains) -> VectorXd
  { return poses.places[pose] - poses.offset[pose] - VectorXd(law.displacement(values(pose, gains))(seen)); };

  VectorXd gains = VectorXd::Ones(motion.cols());
  double before = 0;
  for (const std::size_t pose : all)
    before += missing(pose, gains).squaredNorm();
  const auto solve = [&]
  {
    const double weight = std::pow(deviation / gain_deviation, 2);
    for (int i = 0; i < gauss_newton_iterations; ++i)
    {
      MatrixXd h = weight * MatrixXd::Identity(gains.size(), gains.size());
      VectorXd g = weight * (VectorXd::Ones(gains.size()) - gains);
      for (const std::size_t pose : used)
      {
        const MatrixXd derivative = MatrixXd(law.derivative(values(pose, gains))(seen, Eigen::all)) * motion *
                                    poses.position[pose].asDiagonal();
        h += derivative.transpose() * derivative;
        g += derivative.transpose() * missing(pose, gains);
      }
      gains += h.ldlt().solve(g);
    }
  };

  Calibration out;
  double dot = 0, square = 0, error = 0, held_out_error = 0;
  const auto simulate = [&](std::size_t pose, const std::string& stage, std::size_t number, std::size_t of)
  {
    runs.announce(stage, static_cast<double>(number) / static_cast<double>(of));
    const VectorXd moved = values(pose, gains);
    std::map<std::string, double> named;
    for (std::size_t i = 0; i < parts.size(); ++i)
      named[parts[i].name] = moved[static_cast<Index>(i)];
    VectorXd displaced = (runs.settle(named) - influence.rest)(seen);
    poses.offset[pose] = displaced - VectorXd(law.displacement(moved)(seen));
    return displaced;
  };
  solve();
  for (int run = 0; run < settings.runs; ++run)
  {
    for (std::size_t i = 0; i < used.size(); ++i)
      simulate(used[i], fmt::format("correction {}", run + 1), i, used.size());
    solve();
  }
  for (const std::size_t pose : all)
  {
    const double square_error = (poses.places[pose] - simulate(pose, "poses", pose, count)).squaredNorm();
    (std::count(used.begin(), used.end(), pose) > 0 ? error : held_out_error) += square_error;
    // An actuator holds its bones in place, so that its effort is opposite to the tissue's forces.
    const VectorXd held = -motion.transpose() * conjugate_forces(*model, runs.bones(), parts);
    for (Index a = 0; a < held.size(); ++a)
      if (const double measured = poses.effort[pose][a]; std::isfinite(measured))
      {
        dot += held[a] * measured;
        square += held[a] * held[a];
      }
  }
  out.poses = used.size();
  out.held_out = count - used.size();
  const std::size_t points = landmarks.landmarks.size();
  out.error = root_mean_square(error, used.size(), points);
  out.held_out_error = root_mean_square(held_out_error, count - used.size(), points);
  out.error_before = root_mean_square(before, count, points);
  out.modulus = square > 0 ? dot / square : NAN;
  out.gains.assign(gains.begin(), gains.end());
  out.actuators = actuators;
  for (std::size_t a = 0; a < actuators.size(); ++a)
    for (auto& [part, per_unit] : out.actuators[a].moves)
      per_unit *= out.gains[a];
  return out;
}

std::string yaml_of(const Calibration& calibration)
{
  const auto mm = [](double metres) { return std::isfinite(metres) ? fmt::format("{:.4f}", 1e3 * metres) : "null"; };
  std::string text = fmt::format(
      "poses: {}\nheld_out: {}\n# errors of landmarks, root mean square [mm]\n"
      "error_before: {}\nerror: {}\nheld_out_error: {}\n"
      "# stiffness of the tissue over that of the scene\nmodulus: {}\n"
      "# motion of bones [mm, degrees] per unit of each position, and its share of the given one\n"
      "actuators:\n",
      calibration.poses, calibration.held_out, mm(calibration.error_before), mm(calibration.error),
      mm(calibration.held_out_error),
      std::isfinite(calibration.modulus) ? fmt::format("{:.5f}", calibration.modulus) : "null");
  for (std::size_t a = 0; a < calibration.actuators.size(); ++a)
  {
    std::string moves;
    for (const auto& [part, per_unit] : calibration.actuators[a].moves)
      moves += fmt::format("{}{}: {:.7g}", moves.empty() ? "" : ", ", part, per_unit);
    text += fmt::format("  {}: {{{}}}  # {:.5f}\n", calibration.actuators[a].name, moves, calibration.gains[a]);
  }
  return text;
}

}  // namespace frontalis
