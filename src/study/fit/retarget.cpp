#include "frontalis/study/fit.hpp"

#include "frontalis/study/csv.hpp"
#include "frontalis/study/table.hpp"
#include "study/fit/landmark_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

using Eigen::Index;
using Eigen::VectorXd;

// Displacements from rest, one vector per time; NaN for landmarks that the track does not contain.
std::vector<VectorXd> targets_of(const LandmarkTrack& track, const std::vector<std::size_t>& landmarks, Index size)
{
  std::vector<VectorXd> out(track.time.size(), VectorXd::Constant(size, NAN));
  for (std::size_t t = 0; t < out.size(); ++t)
    for (std::size_t l = 0; l < landmarks.size(); ++l)
      for (std::size_t axis = 0; axis < 3; ++axis)
        out[t][static_cast<Index>(3 * landmarks[l] + axis)] = track.places[t][l][axis];
  return out;
}

ControlCurve curve_of(const Model& model, const std::vector<Unknown>& unknowns, const std::vector<double>& time,
                      const std::vector<VectorXd>& values)
{
  ControlCurve curve{ time, {} };
  curve.controls.reserve(values.size());
  for (const VectorXd& moment : values)
  {
    std::map<std::string, double> named;
    for (std::size_t i = 0; i < unknowns.size(); ++i)
      named[unknowns[i].name] = moment[static_cast<Index>(i)];
    curve.controls.push_back(value_controls(model, named));
  }
  return curve;
}

std::vector<RetargetResult::Row> rows_of(const LandmarkTrack& track, const std::vector<std::size_t>& landmarks,
                                         const std::vector<VectorXd>& reached)
{
  std::vector<RetargetResult::Row> rows;
  rows.reserve(landmarks.size());
  for (std::size_t l = 0; l < landmarks.size(); ++l)
  {
    RetargetResult::Row& row = rows.emplace_back();
    row.landmark = track.landmarks[l];
    row.errors.reserve(reached.size());
    double sum = 0;
    for (std::size_t t = 0; t < reached.size(); ++t)
    {
      const auto& place = track.places[t][l];
      const Eigen::Vector3d wanted(place[0], place[1], place[2]);
      const double error = (wanted - reached[t].segment<3>(static_cast<Index>(3 * landmarks[l]))).norm();
      row.motion = std::max(row.motion, wanted.norm());
      row.largest = std::max(row.largest, error);
      row.errors.push_back(error);
      sum += error * error;
    }
    row.mean = std::sqrt(sum / static_cast<double>(reached.size()));
  }
  return rows;
}

double mean_error(const std::vector<RetargetResult::Row>& rows)
{
  double sum = 0;
  for (const RetargetResult::Row& row : rows)
    sum += row.mean * row.mean / static_cast<double>(rows.size());
  return std::sqrt(sum);
}

}  // namespace

std::vector<std::size_t> landmarks_of(const Model& model, const LandmarkTrack& track)
{
  std::vector<std::size_t> out;
  out.reserve(track.landmarks.size());
  for (const std::string& name : track.landmarks)
  {
    const auto found = std::find(model.landmarks.begin(), model.landmarks.end(), name);
    if (found == model.landmarks.end())
      throw Error(fmt::format("the track has a landmark '{}'; those of the model are {}", name,
                              fmt::join(model.landmarks, ", ")));
    out.push_back(static_cast<std::size_t>(found - model.landmarks.begin()));
  }
  return out;
}

LandmarkTrack read_landmark_track(const std::string& path)
{
  static const std::vector<std::string> wanted{ "time_s", "landmark", "forward_mm", "left_mm", "up_mm" };
  CsvReader table(path);
  const auto& header = table.header();
  std::vector<std::size_t> columns;
  columns.reserve(wanted.size());
  for (const std::string& name : wanted)
  {
    const auto found = std::find(header.begin(), header.end(), name);
    if (found == header.end())
      throw Error(fmt::format("{}:1: has no column {}; needed are {}", path, name, fmt::join(wanted, ", ")));
    columns.push_back(static_cast<std::size_t>(found - header.begin()));
  }
  LandmarkTrack track;
  while (table.next())
  {
    const std::string place = table.place();
    const double time = table.number(columns[0]);
    const std::string& landmark = table.fields()[columns[1]];
    if (track.time.empty() || time > track.time.back())
    {
      if (!track.places.empty() && track.places.back().size() != track.landmarks.size())
        throw Error(place + "the time before has fewer landmarks than the first");
      track.time.push_back(time);
      track.places.emplace_back();
    }
    if (time < track.time.back() || time < 0)
      throw Error(place + "time is " + table.fields()[columns[0]] + "; times must ascend from 0");
    auto& places = track.places.back();
    if (track.time.size() == 1)
    {
      if (std::find(track.landmarks.begin(), track.landmarks.end(), landmark) != track.landmarks.end())
        throw Error(place + "landmark '" + landmark + "' is there twice at one time; must be there once");
      track.landmarks.push_back(landmark);
    }
    if (places.size() >= track.landmarks.size() || track.landmarks[places.size()] != landmark)
      throw Error(place + "found landmark '" + landmark + "'; each time must have the landmarks of the first in order");
    std::array<double, 3> moved{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      moved[axis] = millimetre * table.number(columns[2 + axis]);
    places.push_back(moved);
  }
  if (track.time.empty() || track.places.back().size() != track.landmarks.size())
    throw Error(path + ": has no row below its header, or its last time has fewer landmarks than the first");
  return track;
}

RetargetResult retarget(const std::shared_ptr<const Model>& model, const LandmarkTrack& track,
                        const FitRequest& request, const FitSettings& settings)
{
  const std::vector<Unknown> unknowns = checked_unknowns(*model, request.unknowns);
  const auto landmarks = landmarks_of(*model, track);
  ForwardRuns runs(model, settings);
  double seconds = 0;
  const Influence influence = obtain_influence(runs, unknowns, settings, seconds);
  const auto targets = targets_of(track, landmarks, influence.rest.size());

  LandmarkFit problem(*model, influence, unknowns, request.deviation);
  std::vector<VectorXd> values, expected, best;
  values.reserve(targets.size());
  expected.reserve(targets.size());
  VectorXd begin = problem.rest_values();
  for (const VectorXd& moment : targets)
  {
    problem.set_targets(moment);
    begin = problem.solve(begin);
    values.push_back(begin);
    expected.push_back(problem.predicted(begin));
  }
  best = values;
  RetargetResult result;
  result.rows = rows_of(track, landmarks, expected);

  double least = INFINITY;
  for (int run = 0; run < settings.runs; ++run)
  {
    runs.announce(fmt::format("simulation {}", run + 1), 0);
    auto reached = runs.play(curve_of(*model, unknowns, track.time, values), track.time);
    for (VectorXd& places : reached)
      places -= influence.rest;
    const auto rows = rows_of(track, landmarks, reached);
    result.pass_errors.push_back(mean_error(rows));
    if (result.pass_errors.back() < least)
    {
      least = result.pass_errors.back();
      result.rows = rows;
      best = values;
    }
    for (std::size_t t = 0; t < values.size(); ++t)
    {
      if (track.time[t] <= 0)
        continue;  // a motion begins at rest, whatever its first values are
      // Each time is corrected separately, so that effects of inertia do not count as influence.
      LandmarkFit moment(problem);
      moment.set_targets(targets[t]);
      moment.learn(values[t], reached[t]);
      values[t] = moment.solve(values[t]);
    }
  }
  result.names.reserve(unknowns.size());
  for (const Unknown& unknown : unknowns)
    result.names.push_back(unknown.name);
  result.time = track.time;
  result.values.reserve(best.size());
  for (const VectorXd& moment : best)
    result.values.emplace_back(moment.begin(), moment.end());
  return result;
}

Table retarget_table(const RetargetResult& result)
{
  Table table({ "landmark", "motion [mm]", "rms error [mm]", "largest error [mm]" });
  const auto mm = [](double value) { return std::round(1e6 * value) / 1e3; };
  for (const auto& row : result.rows)
    table.add({ row.landmark, mm(row.motion), mm(row.mean), mm(row.largest) });
  return table;
}

Plot retarget_plot(const RetargetResult& result)
{
  Plot plot{ "Distance of the landmarks from their track", "time [s]", "error [mm]" };
  const bool named = result.rows.size() <= 8;  // a longer legend would cover the curves
  for (const auto& row : result.rows)
  {
    Plot::Curve& curve = plot.curves.emplace_back();
    curve.name = named ? row.landmark : "";
    curve.style = Plot::Style::line;
    for (std::size_t t = 0; t < row.errors.size(); ++t)
      curve.add(result.time[t], 1e3 * row.errors[t]);
  }
  Plot::Curve& mean = plot.curves.emplace_back();
  mean.name = "root mean square";
  mean.style = Plot::Style::strong;
  for (std::size_t t = 0; t < result.time.size(); ++t)
  {
    double sum = 0;
    for (const auto& row : result.rows)
      sum += row.errors[t] * row.errors[t] / static_cast<double>(result.rows.size());
    mean.add(result.time[t], 1e3 * std::sqrt(sum));
  }
  return plot;
}

std::string activations_of(const RetargetResult& result)
{
  std::string text = fmt::format("time,{}\n", fmt::join(result.names, ","));
  for (std::size_t t = 0; t < result.time.size(); ++t)
    text += fmt::format("{:.9g},{:.6g}\n", result.time[t], fmt::join(result.values[t], ","));
  return text;
}

}  // namespace frontalis
