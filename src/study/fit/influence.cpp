#include "study/fit/influence.hpp"

#include "frontalis/study/step_time.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <utility>

namespace frontalis
{
namespace
{

using Eigen::Index;
using Eigen::VectorXd;

// A face is in equilibrium when no landmark has moved by more than `resting_motion` during the last `rest_window`. What
// is left then is about as much again (doc/fitting.md). The rest of the face is not asked: where tissue touches tissue,
// a few nodes can tremble forever.
constexpr double rest_window = 0.05;      // simulated time [s]
constexpr int samples_per_window = 10;    // so that no vibration looks like rest
constexpr double resting_motion = 1e-5;   // [m]
constexpr double longest_relaxation = 5;  // simulated time within which a face must find its equilibrium [s]
// A rest value is well between the limits if its distance from both is at least this fraction of their range.
constexpr double interior_share = 0.1;

std::vector<double> numbers_of(const VectorXd& vector) { return { vector.begin(), vector.end() }; }

VectorXd places_from(const nlohmann::json& json, std::size_t size)
{
  const auto numbers = json.get<std::vector<double>>();
  if (numbers.size() != size)
    throw Error("has another number of coordinates");
  return Eigen::Map<const VectorXd>(numbers.data(), static_cast<Index>(size));
}

// Identifies a stored influence, which is valid only for the same scene, landmarks and generation of motions.
nlohmann::ordered_json heading_of(const Model& model)
{
  return { { "motion_generation", motion_generation },
           { "scene", model.scene_hash },
           { "landmarks", model.landmarks } };
}

// Reads the influence from a file; empty if the file is missing, damaged or of another model.
Influence read_influence(const std::string& path, const Model& model)
{
  Influence out;
  try
  {
    std::ifstream file(path);
    const auto json = nlohmann::json::parse(file);
    const nlohmann::ordered_json heading = heading_of(model);
    for (const auto& [key, value] : heading.items())
      if (json.at(key) != nlohmann::json(value))
        return {};
    const std::size_t size = 3 * model.landmarks.size();
    out.rest = places_from(json.at("rest"), size);
    for (const auto& [name, column] : json.at("unknowns").items())
    {
      auto& [at, displaced] = out.columns[name];
      at = column.at("at").get<std::array<double, 2>>();
      for (const std::size_t side : { 0, 1 })
        displaced[side] = places_from(column.at("displaced").at(side), size);
    }
    return out;
  }
  catch (const std::exception&)
  {
    return {};
  }
}

void keep_influence(const std::string& path, const Model& model, const Influence& influence)
{
  nlohmann::ordered_json json = heading_of(model);
  json["rest"] = numbers_of(influence.rest);
  for (const auto& [name, column] : influence.columns)
    json["unknowns"][name] = { { "at", column.at },
                               { "displaced", { numbers_of(column.displaced[0]), numbers_of(column.displaced[1]) } } };
  try
  {
    make_folder(std::filesystem::path(path).parent_path().string());
    write_text(path, json_text(json));
  }
  catch (const Error&)
  {
    // A file that cannot be written is no error: only the next fit takes longer.
  }
}

// The values at which to measure an unknown: both limits if the rest value is well between them; otherwise the farther
// limit and the middle between the rest value and this limit.
std::array<double, 2> measured_at(const Unknown& unknown, double rest)
{
  const double below = rest - unknown.lower, above = unknown.upper - rest;
  const double least = interior_share * (unknown.upper - unknown.lower);
  if (below > least && above > least)
    return { { unknown.lower, unknown.upper } };
  const double far = above >= below ? unknown.upper : unknown.lower;
  return { { (rest + far) / 2, far } };
}

double largest_distance(const VectorXd& places, const VectorXd& others)
{
  return (places - others).reshaped(3, places.size() / 3).colwise().norm().maxCoeff();
}

}  // namespace

ForwardRuns::ForwardRuns(std::shared_ptr<const Model> model, const FitSettings& settings,
                         std::function<Controls(const Model&, const NamedValues&)> controls)
    : model_(std::move(model)),
      controls_(std::move(controls)),
      watch_(settings.watch ? settings.watch : [](const std::string&, double) {}),
      solver_(make_solver(model_, settings.solver)),
      guard_(*solver_, model_)
{
}

void ForwardRuns::announce(const std::string& stage, double done)
{
  stage_ = stage;
  done_ = done;
  watch_(stage, done);
}

VectorXd ForwardRuns::places()
{
  SkinState skin;
  solver_->skin(skin);
  to_face_frame(*model_, skin);
  VectorXd out(static_cast<Index>(3 * skin.landmarks.size()));
  for (Index i = 0; i < out.size(); ++i)
    out[i] = double(skin.landmarks[static_cast<std::size_t>(i / 3)][static_cast<std::size_t>(i % 3)]);
  return out;
}

VectorXd ForwardRuns::settle(const NamedValues& values, bool from_rest)
{
  if (from_rest)
  {
    solver_->reset();
    guard_.restart();
  }
  VectorXd now = places(), window_begin = now;
  double sampled = solver_->time(), motion = 0, motion_before = INFINITY;
  int samples = 0;
  const auto moves = [&](const Equilibrium&)
  {
    watch_(stage_, done_);
    // The guard may go back in time.
    if (std::abs(solver_->time() - sampled) * model_->time_scaling < rest_window / samples_per_window)
      return true;
    sampled = solver_->time();
    now = places();
    motion = std::max(motion, largest_distance(now, window_begin));
    if (++samples < samples_per_window)
      return true;
    samples = 0;
    window_begin = now;
    motion_before = std::exchange(motion, 0);
    return motion_before > resting_motion;
  };
  std::string of;
  for (const auto& [name, value] : values)
    of += fmt::format(" {} {:g}", name, value);
  if (of.empty())
    of = " all at rest";
  bool reached = false;
  try
  {
    // The solver judges all tissue. With this tolerance it ends the relaxation only if nothing moves at all.
    reached = guard_
                  .settle(controls_(*model_, values), std::numeric_limits<double>::min(),
                          longest_relaxation / model_->time_scaling, moves)
                  .reached;
  }
  catch (const Unstable& error)
  {
    throw Error(fmt::format("with{}: {}", of, error.what()));
  }
  if (!reached && motion_before > resting_motion)
  {
    // Before the first window has ended, there is only its motion so far.
    const double moved = std::isfinite(motion_before) ? motion_before : largest_distance(places(), window_begin);
    throw Error(fmt::format("no equilibrium with{}: after {:g} s of relaxation a landmark moves by {:.2g} mm in {:g} s",
                            of, longest_relaxation, 1e3 * moved, rest_window));
  }
  return now;
}

std::vector<VectorXd> ForwardRuns::play(const ControlCurve& curve, const std::vector<double>& times)
{
  solver_->reset();
  guard_.restart();
  std::vector<VectorXd> out;
  out.reserve(times.size());
  double now = 0;
  const auto go_on = [&]
  {
    watch_(stage_, static_cast<double>(out.size()) / static_cast<double>(times.size()));
    return true;
  };
  for (const double time : times)
  {
    if (time > now)
      guard_.advance_checked((time - now) / model_->time_scaling, curve.at(time), go_on);
    now = std::max(now, time);
    out.push_back(places());
    go_on();
  }
  return out;
}

double rest_value(const Model& model, const std::string& unknown)
{
  const Controls rest = rest_controls(model);
  for (std::size_t m = 0; m < model.muscles.size(); ++m)
    if (model.muscles[m].name == unknown)
      return rest.activation[m];
  return 0;
}

Influence obtain_influence(ForwardRuns& runs, const std::vector<Unknown>& unknowns, const FitSettings& settings,
                           double& seconds)
{
  const Model& model = runs.model();
  const std::string path = settings.cache.empty() || model.scene_hash.empty()
                               ? ""
                               : settings.cache + "/" + model.scene_hash + ".influence.json";
  Influence influence = path.empty() ? Influence() : read_influence(path, model);
  const double begin = wall_seconds();
  const auto count = static_cast<double>(unknowns.size());
  bool measured = false;
  // Each column is kept at once, because a fit may be cancelled and a later one may need the same unknowns.
  const auto keep = [&]
  {
    measured = true;
    if (!path.empty())
      keep_influence(path, model, influence);
  };
  if (influence.rest.size() == 0)
  {
    runs.announce("influence", 0);
    influence.rest = runs.settle({});
    keep();
  }
  for (std::size_t i = 0; i < unknowns.size(); ++i)
  {
    const Unknown& unknown = unknowns[i];
    const auto at = measured_at(unknown, rest_value(model, unknown.name));
    if (const auto known = influence.columns.find(unknown.name);
        known != influence.columns.end() && known->second.at == at)
      continue;
    runs.announce("influence", static_cast<double>(i) / count);
    decltype(influence.columns)::mapped_type column;
    column.at = at;
    for (const std::size_t side : { 0, 1 })
      column.displaced[side] = runs.settle({ { unknown.name, at[side] } }) - influence.rest;
    influence.columns[unknown.name] = column;
    keep();
  }
  seconds = measured ? wall_seconds() - begin : 0;
  return influence;
}

InfluenceLaw::InfluenceLaw(const Model& model, const Influence& influence, const std::vector<Unknown>& unknowns)
    : rest_(static_cast<Index>(unknowns.size())),
      linear_(influence.rest.size(), rest_.size()),
      quadratic_(influence.rest.size(), rest_.size())
{
  for (Index i = 0; i < rest_.size(); ++i)
  {
    const std::string& name = unknowns[static_cast<std::size_t>(i)].name;
    const auto& [at, displaced] = influence.columns.at(name);
    rest_[i] = rest_value(model, name);
    // Coefficients of the parabola b s + c s^2 through both measured points, where s is the distance from the rest
    // value.
    const double first = at[0] - rest_[i], second = at[1] - rest_[i];
    quadratic_.col(i) = (displaced[1] / second - displaced[0] / first) / (second - first);
    linear_.col(i) = displaced[0] / first - quadratic_.col(i) * first;
  }
}

VectorXd InfluenceLaw::displacement(const VectorXd& values) const
{
  const VectorXd from_rest = values - rest_;
  return linear_ * from_rest + quadratic_ * from_rest.cwiseAbs2();
}

Eigen::MatrixXd InfluenceLaw::derivative(const VectorXd& values) const
{
  return linear_ + 2 * quadratic_ * (values - rest_).asDiagonal();
}

}  // namespace frontalis
