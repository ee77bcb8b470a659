#include "frontalis/study/calibrate.hpp"

#include "frontalis/physics/number.hpp"
#include "frontalis/solver/rigid_motion.hpp"
#include "frontalis/study/csv.hpp"
#include "frontalis/study/table.hpp"
#include "study/fit/influence.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

namespace frontalis
{
namespace
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double range_margin = 1.2;          // measured range of a motion, divided by the range in the poses
constexpr double deviation = 1e-4;            // standard deviation of measured places of landmarks [m]
constexpr double gain_deviation = 1;          // standard deviation of gains from 1, a weak preference
constexpr int gauss_newton_iterations = 10;   // number of Gauss-Newton iterations
constexpr double degree = physics::pi / 180;  // [rad]

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

constexpr const char* axes[] = { "x", "y", "z", "rx", "ry", "rz" };

// An actuator's motion as an entry of its file.
std::string text_of(const Actuator& actuator)
{
  std::vector<std::string> moves;
  bool turns = false;
  for (const auto& [bone, move] : actuator.moves)
    for (std::size_t i = 0; i < move.size(); ++i)
      if (move[i] != 0)
      {
        moves.push_back(fmt::format("{}.{}: {:.7g}", bone, axes[i], move[i]));
        turns |= i >= 3;
      }
  if (turns)
    moves.push_back(fmt::format("about: [{:.7g}]", fmt::join(actuator.about, ", ")));
  return fmt::format("{}: {{{}}}", actuator.name, fmt::join(moves, ", "));
}

Actuator actuator_from(const std::string& name, const YAML::Node& node)
{
  if (!node.IsMap())
    throw YAML::Exception(node.Mark(), fmt::format("{} has no motions of bones", name));
  Actuator out{ name, {}, {} };
  for (const auto& entry : node)
  {
    const auto key = entry.first.as<std::string>();
    if (key == "about")
    {
      out.about = entry.second.as<std::array<double, 3>>();
      continue;
    }
    const std::size_t dot = key.rfind('.');
    const auto* const axis = std::find(std::begin(axes), std::end(axes), key.substr(dot + 1));
    if (dot == std::string::npos || axis == std::end(axes))
      throw YAML::Exception(entry.first.Mark(), fmt::format("'{}' is no bone's .x, .y, .z, .rx, .ry or .rz", key));
    out.moves[key.substr(0, dot)][static_cast<std::size_t>(axis - axes)] = entry.second.as<double>();
  }
  return out;
}

bool turns(const std::array<double, 6>& move) { return move[3] != 0 || move[4] != 0 || move[5] != 0; }

// The actuators as unknowns, with limits that include all poses.
std::vector<Unknown> unknowns_of(const std::vector<Actuator>& actuators, const Poses& poses)
{
  std::vector<Unknown> out;
  for (std::size_t a = 0; a < actuators.size(); ++a)
  {
    // The stored influence of an actuator is that of its motion.
    Unknown unknown{ text_of(actuators[a]), 0, 0 };
    for (const VectorXd& position : poses.position)
    {
      unknown.lower = std::min(unknown.lower, range_margin * position[static_cast<Index>(a)]);
      unknown.upper = std::max(unknown.upper, range_margin * position[static_cast<Index>(a)]);
    }
    if (!(unknown.lower < unknown.upper))
      throw Error(fmt::format("actuator {} never leaves 0; each must move in some pose", actuators[a].name));
    out.push_back(unknown);
  }
  return out;
}

// The bones that actuators move to the given positions.
Controls moved_bones(const Model& model, const std::vector<Actuator>& actuators, const NamedValues& positions)
{
  struct Motion
  {
    std::array<double, 3> shift{}, turn{}, about{};  // [m], [rad]
  };
  std::map<std::string, Motion> motions;
  for (const Actuator& actuator : actuators)
    if (const auto position = positions.find(text_of(actuator)); position != positions.end())
      for (const auto& [bone, move] : actuator.moves)
      {
        Motion& motion = motions[bone];
        for (std::size_t i = 0; i < 3; ++i)
        {
          motion.shift[i] += millimetre * move[i] * position->second;
          motion.turn[i] += degree * move[3 + i] * position->second;
          if (turns(move))
            motion.about[i] = millimetre * actuator.about[i];
        }
      }
  Controls controls = rest_controls(model);
  for (auto& [bone, motion] : motions)
  {
    for (std::size_t i = 0; i < 3; ++i)
      motion.shift[i] -= motion.about[i];
    set_bone_motion(model, bone, composed(rigid_motion(motion.turn, motion.about), rigid_motion({}, motion.shift)),
                    controls.bone);
  }
  return controls;
}

// Work [J] of the tissue on bones per unit of an actuator's position.
double work_of(const Model& model, const std::vector<BodyFrame>& bones, const Actuator& actuator)
{
  using Vector = physics::Vec3<double>;
  double work = 0;
  for (const auto& [name, move] : actuator.moves)
  {
    const auto bone = std::find(model.bones.begin(), model.bones.end(), name) - model.bones.begin();
    const auto& [reaction, pose] = bones[static_cast<std::size_t>(bone)];
    const Vector force = vector_of(reaction.force);
    // moves the reference point of the moment from the bone's point that rests at the face frame's origin
    const Vector arm = vector_of(pose.translation) - millimetre * vector_of(actuator.about);
    const Vector moment = vector_of(reaction.moment) + cross(arm, force);
    const std::array<double, 3> shift{ { move[0], move[1], move[2] } };
    work += millimetre * dot(force, vector_of(pose.turned(shift))) +
            degree * dot(moment, Vector{ move[3], move[4], move[5] });
  }
  return work;
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
    {
      const Actuator& actuator = out.emplace_back(actuator_from(entry.first.as<std::string>(), entry.second));
      for (const Actuator& other : out)
        for (const auto& [bone, move] : actuator.moves)
          if (const auto same = other.moves.find(bone);
              same != other.moves.end() && turns(move) && turns(same->second) && other.about != actuator.about)
            throw YAML::Exception(entry.first.Mark(), fmt::format("{} and {} turn {} about different points",
                                                                  other.name, actuator.name, bone));
    }
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
  const std::vector<Unknown> unknowns = unknowns_of(actuators, poses);
  const std::vector<Index> seen = coordinates_of(*model, landmarks);
  ForwardRuns runs(model, settings,
                   [&](const Model& of, const NamedValues& positions)
                   { return moved_bones(of, actuators, positions); });
  double seconds = 0;
  const Influence influence = obtain_influence(runs, unknowns, settings, seconds);
  const InfluenceLaw law(*model, influence, unknowns);

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
  { return gains.cwiseProduct(poses.position[pose]); };
  const auto missing = [&](std::size_t pose, const VectorXd& gains) -> VectorXd
  { return poses.places[pose] - poses.offset[pose] - VectorXd(law.displacement(values(pose, gains))(seen)); };

  VectorXd gains = VectorXd::Ones(static_cast<Index>(actuators.size()));
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
        const MatrixXd derivative =
            MatrixXd(law.derivative(values(pose, gains))(seen, Eigen::all)) * poses.position[pose].asDiagonal();
        h += derivative.transpose() * derivative;
        g += derivative.transpose() * missing(pose, gains);
      }
      gains += h.ldlt().solve(g);
    }
  };

  Calibration out;
  double product = 0, square = 0, error = 0, held_out_error = 0;
  const auto simulate = [&](std::size_t pose, const std::string& stage, std::size_t number, std::size_t of)
  {
    runs.announce(stage, static_cast<double>(number) / static_cast<double>(of));
    const VectorXd moved = values(pose, gains);
    NamedValues named;
    for (std::size_t i = 0; i < unknowns.size(); ++i)
      named[unknowns[i].name] = moved[static_cast<Index>(i)];
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
    const std::vector<BodyFrame> bones = runs.bones();
    for (std::size_t a = 0; a < actuators.size(); ++a)
      if (const double measured = poses.effort[pose][static_cast<Index>(a)]; std::isfinite(measured))
      {
        const double held = -work_of(*model, bones, actuators[a]);
        product += held * measured;
        square += held * held;
      }
  }
  out.poses = used.size();
  out.held_out = count - used.size();
  const std::size_t points = landmarks.landmarks.size();
  out.error = root_mean_square(error, used.size(), points);
  out.held_out_error = root_mean_square(held_out_error, count - used.size(), points);
  out.error_before = root_mean_square(before, count, points);
  out.modulus = square > 0 ? product / square : NAN;
  out.gains.assign(gains.begin(), gains.end());
  out.actuators = actuators;
  for (std::size_t a = 0; a < actuators.size(); ++a)
    for (auto& [bone, move] : out.actuators[a].moves)
      for (double& per_unit : move)
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
    text += fmt::format("  {}  # {:.5f}\n", text_of(calibration.actuators[a]), calibration.gains[a]);
  return text;
}

}  // namespace frontalis
