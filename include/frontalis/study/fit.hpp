#pragma once

#include "frontalis/solver/solver.hpp"
#include "frontalis/study/table.hpp"

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace frontalis
{

// The inverse of a simulation: which activations of muscles, or motions of bones, bring landmarks to given places.

/// What a fit may choose: an activation (0..1), or a part of a bone's motion such as BONE.x [mm] or BONE.rx [degrees],
/// with the names and units of value_controls().
struct Unknown
{
  std::string name;
  double lower = 0, upper = 1;
};

/// Where a landmark should be.
struct LandmarkTarget
{
  std::string landmark;
  std::array<double, 3> place{};  ///< face frame [m]; NaN: this coordinate is free
  bool moved = true;              ///< `place` is the displacement from rest
};

struct FitRequest
{
  std::vector<LandmarkTarget> targets;
  double deviation = 1e-4;        ///< standard deviation of every given coordinate [m]
  std::vector<Unknown> unknowns;  ///< none: all muscles
};

/// Reads the targets of a fit (doc/fitting.md). Throws Error with the file's line.
FitRequest read_fit_request(const std::string& path);

/// The muscles and bones that a file or a command names are known to the model, and within their limits; throws Error.
/// Without any, all muscles of the model are taken.
std::vector<Unknown> checked_unknowns(const Model& model, const std::vector<Unknown>& unknowns);

struct FitSettings
{
  SolverSettings solver;
  std::string cache;  ///< folder that keeps the influence of each model by the hash of its scene; empty: none
  int runs = 5;       ///< most simulations that refine the answer; 0: the answer of the measured influence is returned
  std::function<void(const std::string& stage, double done)> watch{};  ///< may throw, which ends the work
};

struct FittedUnknown
{
  Unknown unknown;
  double value = 0;
  double deviation = 0;     ///< standard deviation that follows from the targets' and from a weak preference for rest
  bool determined = false;  ///< the standard deviation is at most 5 % of the range
  std::string like;         ///< the unknown that can replace it best, that of the largest correlation; empty: none
  double correlation = 0;   ///< with that one, -1..1
};

struct FittedLandmark
{
  LandmarkTarget target;
  std::array<double, 3> expected{};  ///< displacement from rest that the measured influence predicts, face frame [m]
  std::array<double, 3> reached{};   ///< the same as simulated; NaN if nothing was simulated
  double error = 0;  ///< distance from the target in its given coordinates [m]: simulated, else predicted
};

struct FitResult
{
  std::vector<FittedUnknown> unknowns;
  std::vector<std::vector<double>> covariance;  ///< of the unknowns
  std::vector<FittedLandmark> landmarks;
  std::vector<double> errors;     ///< root mean square of the landmarks' errors after each simulation [m]
  double influence_seconds = 0;   ///< wall time of measuring the influence; 0: it was known
  double linear_seconds = 0;      ///< wall time of the answer from it
  double refinement_seconds = 0;  ///< wall time of the simulations that refine it
};

/// Finds the unknowns that bring landmarks closest to their targets, in equilibrium; muscles and bones that are no
/// unknowns stay at rest. The influence of each unknown is measured at two of its values, once per model, and the
/// squared errors over their standard deviations are minimised within the limits of the unknowns. Simulations then
/// replace what the influence predicts by what the face does. Throws Error if the request does not fit the model, or if
/// the face finds no equilibrium, and what FitSettings::watch throws.
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
  std::vector<std::vector<std::array<double, 3>>> places;  ///< per time and landmark: displacement, face frame [m]
};

/// Reads a table (CSV) with the columns time_s, landmark, forward_mm, left_mm and up_mm, such as landmarks.csv of
/// `frontalis run --frames`. Throws Error with the file's line, also unless each time has the same landmarks.
LandmarkTrack read_landmark_track(const std::string& path);

struct RetargetResult
{
  std::vector<std::string> names;           ///< of the unknowns
  std::vector<double> time;                 ///< [s]
  std::vector<std::vector<double>> values;  ///< per time and unknown
  std::vector<double> pass_errors;          ///< root mean square over landmarks and times after each simulation [m]
  struct Row
  {
    std::string landmark;
    double motion = 0;   ///< largest displacement in the track [m]
    double mean = 0;     ///< root mean square of the error [m]
    double largest = 0;  ///< largest error [m]
  };
  std::vector<Row> rows;  ///< per landmark of the track, of the best pass
};

/// A track of activations or bones under which a simulated face follows a track of landmarks. Each moment is fitted by
/// the measured influence; `settings.runs` simulations of the whole track correct it for inertia, delays of muscles and
/// joint action of several muscles. The best of them is returned. Throws as fit() does.
RetargetResult retarget(const std::shared_ptr<const Model>& model, const LandmarkTrack& track,
                        const FitRequest& request, const FitSettings& settings);

Table retarget_table(const RetargetResult& result);
/// A table (CSV) for `frontalis run --activations`.
std::string activations_of(const RetargetResult& result);

}  // namespace frontalis
