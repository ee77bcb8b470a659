#pragma once

#include "frontalis/solver/solver.hpp"
#include "frontalis/study/plot.hpp"
#include "frontalis/study/table.hpp"

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace frontalis
{

// The inverse of a simulation: which activations of muscles, or motions of bones, bring landmarks to given places.

/// A quantity that a fit may choose: an activation (0..1), or a component of a bone's motion such as BONE.x [mm] or
/// BONE.rx [degrees], with the names and units of value_controls().
struct Unknown
{
  std::string name;
  double lower = 0, upper = 1;
};

/// The place to which a fit should bring a landmark.
struct LandmarkTarget
{
  std::string landmark;
  std::array<double, 3> place{};  ///< face frame [m]; NaN: this coordinate is free
  bool moved = true;              ///< whether `place` is the displacement from rest
};

struct FitRequest
{
  std::vector<LandmarkTarget> targets;
  double deviation = 1e-4;        ///< standard deviation of every given coordinate [m]
  std::vector<Unknown> unknowns;  ///< empty: all muscles
};

/// Reads the targets of a fit (doc/fitting.md). Throws Error with the file's line.
FitRequest read_fit_request(const std::string& path);

/// Returns the unknowns, or all muscles of the model if the list is empty. Throws Error if the model lacks a muscle or
/// bone, or a limit is not allowed.
std::vector<Unknown> checked_unknowns(const Model& model, const std::vector<Unknown>& unknowns);

struct FitSettings
{
  SolverSettings solver;
  std::string cache;  ///< folder that stores the influence of each model by the hash of its scene; empty: none
  int runs = 5;       ///< largest number of simulations that refine the answer; 0: no refinement
  /// called with the stage and its completed fraction; may throw, which ends the work
  std::function<void(const std::string& stage, double done)> watch{};
};

struct FittedUnknown
{
  Unknown unknown;
  double value = 0;
  double deviation = 0;     ///< standard deviation, from those of the targets and a weak preference for rest
  bool determined = false;  ///< whether the standard deviation is at most 5 % of the range
  std::string like;         ///< the unknown that can replace this one best (largest correlation); empty: none
  double correlation = 0;   ///< correlation with the unknown `like`, -1..1
};

struct FittedLandmark
{
  LandmarkTarget target;
  std::array<double, 3> expected{};  ///< displacement from rest that the measured influence predicts, face frame [m]
  std::array<double, 3> reached{};   ///< simulated displacement from rest; NaN if nothing was simulated
  double error = 0;  ///< distance from the target in its given coordinates [m]: simulated, else predicted
};

struct FitResult
{
  std::vector<FittedUnknown> unknowns;
  std::vector<std::vector<double>> covariance;  ///< covariance of the unknowns
  std::vector<FittedLandmark> landmarks;
  std::vector<double> errors;     ///< root mean square of the landmarks' errors after each simulation [m]
  double influence_seconds = 0;   ///< wall time of measuring the influence; 0: it was in the cache
  double linear_seconds = 0;      ///< wall time of finding the answer from the influence
  double refinement_seconds = 0;  ///< wall time of the simulations that refine the answer
};

/// Finds values of the unknowns that bring landmarks closest to their targets in equilibrium; other muscles and bones
/// stay at rest. The displacements that each unknown causes (its influence) are measured at two of its values, once per
/// model. The sum of squares of the errors divided by their standard deviations is then minimised within the limits of
/// the unknowns, and simulations correct the predicted displacements.
/// Throws Error if the request does not fit the model, or if the face finds no equilibrium. Passes on what
/// FitSettings::watch throws.
FitResult fit(const std::shared_ptr<const Model>& model, const FitRequest& request, const FitSettings& settings);

Table unknowns_table(const FitResult& result);
Table landmarks_table(const FitResult& result);
std::string json_of(const FitResult& result);
/// A table (CSV) of one row at time 0, for `frontalis run --activations`.
std::string activations_of(const FitResult& result);

/// Recorded motion of landmarks.
struct LandmarkTrack
{
  std::vector<std::string> landmarks;
  std::vector<double> time;                                ///< ascending from 0 [s]
  std::vector<std::vector<std::array<double, 3>>> places;  ///< displacement per time and landmark, face frame [m]
};

/// Reads a table (CSV) with the columns time_s, landmark, forward_mm, left_mm and up_mm, such as landmarks.csv of
/// `frontalis run --frames`. Throws Error with the file's line, also if the landmarks differ between times.
LandmarkTrack read_landmark_track(const std::string& path);

struct RetargetResult
{
  std::vector<std::string> names;           ///< names of the unknowns
  std::vector<double> time;                 ///< [s]
  std::vector<std::vector<double>> values;  ///< value per time and unknown
  /// root mean square over landmarks and times, after each simulation of the track [m]
  std::vector<double> pass_errors;
  struct Row
  {
    std::string landmark;
    double motion = 0;           ///< largest displacement in the track [m]
    double mean = 0;             ///< root mean square of the error [m]
    double largest = 0;          ///< largest error [m]
    std::vector<double> errors;  ///< at each time [m]
  };
  std::vector<Row> rows;  ///< errors of the best simulation, per landmark of the track
};

/// Finds a track of activations or bones under which a simulated face follows a track of landmarks. Each time is fitted
/// with the measured influence. Then `settings.runs` simulations of the whole track correct the values for inertia,
/// delays of muscles and the joint action of several muscles. Returns the simulation with the smallest error. Throws
/// the errors of fit().
RetargetResult retarget(const std::shared_ptr<const Model>& model, const LandmarkTrack& track,
                        const FitRequest& request, const FitSettings& settings);

Table retarget_table(const RetargetResult& result);
/// The errors of all landmarks over time.
Plot retarget_plot(const RetargetResult& result);
/// Converts to a table (CSV) for `frontalis run --activations`.
std::string activations_of(const RetargetResult& result);

}  // namespace frontalis
