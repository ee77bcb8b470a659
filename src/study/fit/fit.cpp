#include "frontalis/study/fit.hpp"

#include "study/fit/landmark_fit.hpp"

#include "frontalis/study/step_time.hpp"
#include "frontalis/suggestion.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <string>

namespace frontalis
{
namespace
{

using Eigen::Index;
using Eigen::VectorXd;

constexpr double determined_share = 0.05;  // largest standard deviation of a determined unknown, divided by its range
// Refinement ends if all unknowns change by less than this fraction of their range.
constexpr double smallest_change = 1e-3;

std::size_t index_of_landmark(const Model& model, const std::string& name)
{
  const auto found = std::find(model.landmarks.begin(), model.landmarks.end(), name);
  if (found == model.landmarks.end())
    throw Error(fmt::format("no landmark is called '{}'; the landmarks are {}", name,
                            list_with_suggestion(name, model.landmarks)));
  return static_cast<std::size_t>(found - model.landmarks.begin());
}

// The displacements from rest that the request gives; NaN for coordinates that it does not give.
VectorXd target_vector(const Model& model, const FitRequest& request, const VectorXd& rest)
{
  VectorXd out = VectorXd::Constant(rest.size(), NAN);
  std::set<std::string> named;
  for (const LandmarkTarget& target : request.targets)
  {
    if (!named.insert(target.landmark).second)
      throw Error(fmt::format("landmark '{}' has two targets", target.landmark));
    const auto first = static_cast<Index>(3 * index_of_landmark(model, target.landmark));
    for (Index axis = 0; axis < 3; ++axis)
      out[first + axis] = target.place[static_cast<std::size_t>(axis)] - (target.moved ? 0 : rest[first + axis]);
  }
  return out;
}

std::array<double, 3> place_in(const VectorXd& places, std::size_t landmark)
{
  const auto first = static_cast<Index>(3 * landmark);
  return { { places[first], places[first + 1], places[first + 2] } };
}

// Distance in the coordinates that the target gives [m].
double distance_between(const std::array<double, 3>& a, const std::array<double, 3>& b)
{
  double sum = 0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (const double d = a[axis] - b[axis]; !std::isnan(d))
      sum += d * d;
  return std::sqrt(sum);
}

std::map<std::string, double> by_name(const std::vector<Unknown>& unknowns, const VectorXd& values)
{
  std::map<std::string, double> out;
  for (std::size_t i = 0; i < unknowns.size(); ++i)
    out[unknowns[i].name] = values[static_cast<Index>(i)];
  return out;
}

std::vector<FittedUnknown> fitted_unknowns(const std::vector<Unknown>& unknowns, const VectorXd& values,
                                           const Eigen::MatrixXd& covariance)
{
  std::vector<FittedUnknown> out;
  out.reserve(unknowns.size());
  for (Index i = 0; i < values.size(); ++i)
  {
    FittedUnknown& row = out.emplace_back();
    row.unknown = unknowns[static_cast<std::size_t>(i)];
    row.value = values[i];
    row.deviation = std::sqrt(covariance(i, i));
    row.determined = row.deviation <= determined_share * (row.unknown.upper - row.unknown.lower);
    for (Index other = 0; other < values.size(); ++other)
    {
      const double correlation = covariance(i, other) / std::sqrt(covariance(i, i) * covariance(other, other));
      if (other != i && std::abs(correlation) > std::abs(row.correlation))
      {
        row.correlation = correlation;
        row.like = unknowns[static_cast<std::size_t>(other)].name;
      }
    }
  }
  return out;
}

std::vector<FittedLandmark> fitted_landmarks(const Model& model, const FitRequest& request, const VectorXd& targets,
                                             const VectorXd& expected, const VectorXd& reached)
{
  std::vector<FittedLandmark> out;
  out.reserve(request.targets.size());
  for (const LandmarkTarget& target : request.targets)
  {
    const std::size_t landmark = index_of_landmark(model, target.landmark);
    FittedLandmark& row = out.emplace_back();
    row.target = target;
    row.expected = place_in(expected, landmark);
    row.reached.fill(NAN);
    if (reached.size() > 0)
      row.reached = place_in(reached, landmark);
    row.error = distance_between(place_in(targets, landmark), reached.size() > 0 ? row.reached : row.expected);
  }
  return out;
}

double root_mean_square(const std::vector<FittedLandmark>& rows)
{
  double sum = 0;
  for (const FittedLandmark& row : rows)
    sum += row.error * row.error / static_cast<double>(rows.size());
  return std::sqrt(sum);
}

}  // namespace

std::vector<Unknown> checked_unknowns(const Model& model, const std::vector<Unknown>& unknowns)
{
  std::vector<Unknown> out = unknowns;
  if (out.empty())
    std::transform(model.muscles.begin(), model.muscles.end(), std::back_inserter(out),
                   [](const Muscle& muscle) { return Unknown{ muscle.name }; });
  if (out.empty())
    throw Error("nothing to fit: the model has no muscles, and no bone is named as unknown, such as BONE.x: [-5, 5]");
  std::map<std::string, double> seen;
  for (const Unknown& unknown : out)
  {
    if (!seen.emplace(unknown.name, 0).second)
      throw Error("unknown '" + unknown.name + "' is there twice; must be there once");
    if (!(unknown.lower < unknown.upper) || !std::isfinite(unknown.upper - unknown.lower))
      throw Error(fmt::format("limits of '{}': found {} and {}; the first must be below the second", unknown.name,
                              unknown.lower, unknown.upper));
    for (const double limit : { unknown.lower, unknown.upper })
      value_controls(model, { { unknown.name, limit } });
  }
  return out;
}

FitResult fit(const std::shared_ptr<const Model>& model, const FitRequest& request, const FitSettings& settings)
{
  const std::vector<Unknown> unknowns = checked_unknowns(*model, request.unknowns);
  target_vector(*model, request, VectorXd::Zero(static_cast<Index>(3 * model->landmarks.size())));
  ForwardRuns runs(model, settings);
  FitResult result;
  const Influence influence = obtain_influence(runs, unknowns, settings, result.influence_seconds);

  double begin = wall_seconds();
  LandmarkFit problem(*model, influence, unknowns, request.deviation);
  const VectorXd targets = target_vector(*model, request, influence.rest);
  problem.set_targets(targets);
  VectorXd values = problem.solve(problem.rest_values());
  VectorXd expected = problem.predicted(values), reached;
  result.linear_seconds = wall_seconds() - begin;

  begin = wall_seconds();
  VectorXd next = values;
  double least = INFINITY;
  for (int run = 0; run < settings.runs; ++run)
  {
    runs.announce("refining", static_cast<double>(run) / settings.runs);
    // Later simulations start at the equilibrium of the one before, which is close to theirs.
    const VectorXd found = runs.settle(by_name(unknowns, next), run == 0) - influence.rest;
    result.errors.push_back(root_mean_square(fitted_landmarks(*model, request, targets, found, found)));
    if (const double cost = problem.cost(next, found); cost < least)
    {
      least = cost;
      values = next;
      expected = problem.predicted(next);
      reached = found;
    }
    problem.learn(next, found);
    const VectorXd before = next;
    next = problem.solve(values);
    double change = 0;
    for (Index i = 0; i < next.size(); ++i)
    {
      const Unknown& unknown = unknowns[static_cast<std::size_t>(i)];
      change = std::max(change, std::abs(next[i] - before[i]) / (unknown.upper - unknown.lower));
    }
    if (change < smallest_change)
      break;
  }
  result.refinement_seconds = settings.runs > 0 ? wall_seconds() - begin : 0;

  const Eigen::MatrixXd covariance = problem.covariance(values);
  result.unknowns = fitted_unknowns(unknowns, values, covariance);
  result.covariance.reserve(unknowns.size());
  for (Index i = 0; i < covariance.rows(); ++i)
    result.covariance.emplace_back(covariance.row(i).begin(), covariance.row(i).end());
  result.landmarks = fitted_landmarks(*model, request, targets, expected, reached);
  return result;
}

Table unknowns_table(const FitResult& result)
{
  Table table({ "unknown", "value", "sd", "verdict", "like", "correlation" });
  const auto rounded = [](double value) { return std::round(1e4 * value) / 1e4; };
  for (const FittedUnknown& row : result.unknowns)
    table.add({ row.unknown.name, rounded(row.value), rounded(row.deviation),
                std::string(row.determined ? "determined" : "open"), row.like, rounded(row.correlation) });
  return table;
}

Table landmarks_table(const FitResult& result)
{
  Table table({ "landmark", "forward [mm]", "left [mm]", "up [mm]", "error [mm]" });
  const auto mm = [](double value) { return std::round(1e6 * value) / 1e3; };
  for (const FittedLandmark& row : result.landmarks)
  {
    const auto& at = std::isnan(row.reached[0]) ? row.expected : row.reached;
    table.add({ row.target.landmark, mm(at[0]), mm(at[1]), mm(at[2]), mm(row.error) });
  }
  return table;
}

std::string json_of(const FitResult& result)
{
  nlohmann::ordered_json json{ { "influence_s", result.influence_seconds },
                               { "linear_s", result.linear_seconds },
                               { "refinement_s", result.refinement_seconds },
                               { "errors_m", result.errors },
                               { "covariance", result.covariance } };
  for (const FittedUnknown& row : result.unknowns)
    json["unknowns"].push_back({ { "name", row.unknown.name },
                                 { "value", row.value },
                                 { "sd", row.deviation },
                                 { "determined", row.determined },
                                 { "like", row.like },
                                 { "correlation", row.correlation } });
  for (const FittedLandmark& row : result.landmarks)
    json["landmarks"].push_back({ { "name", row.target.landmark },
                                  { "expected_m", row.expected },
                                  { "reached_m", row.reached },
                                  { "error_m", row.error } });
  return json_text(json);
}

std::string activations_of(const FitResult& result)
{
  std::string header = "time", row = "0";
  for (const FittedUnknown& fitted : result.unknowns)
  {
    header += "," + fitted.unknown.name;
    row += fmt::format(",{:.6g}", fitted.value);
  }
  return header + "\n" + row + "\n";
}

}  // namespace frontalis
