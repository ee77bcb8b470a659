#pragma once

#include "frontalis/runner/face_frame.hpp"
#include "frontalis/runner/named_controls.hpp"
#include "frontalis/solver/guard.hpp"
#include "frontalis/study/fit.hpp"

#include <Eigen/Core>

#include <array>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace frontalis
{

// Vectors of places have x, y and z of each landmark of the model, in this order, in the face frame [m].

/// Values of unknowns by their names.
using NamedValues = std::map<std::string, double>;

/// The simulations of a fit.
class ForwardRuns
{
public:
  /// `controls`: what unknowns of given values do to the model; those that are not named are at rest.
  ForwardRuns(std::shared_ptr<const Model> model, const FitSettings& settings,
              std::function<Controls(const Model&, const NamedValues&)> controls = value_controls);

  /// Names the stage of the fit to which the next simulations belong.
  void announce(const std::string& stage, double done);
  /// Places of the landmarks in equilibrium. The face starts at rest, or else where the simulation before has left it.
  /// Throws Error if no equilibrium is found.
  Eigen::VectorXd settle(const NamedValues& values, bool from_rest = true);
  /// Places of the landmarks at each of the given times, under controls that change linearly between knots. The face
  /// starts at rest.
  std::vector<Eigen::VectorXd> play(const ControlCurve& curve, const std::vector<double>& times);

  /// The bones, and the forces of the tissue on them.
  std::vector<BodyFrame> bones() { return bones_in_face_frame(*solver_, *model_, true); }

  const Model& model() const { return *model_; }

private:
  Eigen::VectorXd places();  // present places of the landmarks

  std::shared_ptr<const Model> model_;
  std::function<Controls(const Model&, const NamedValues&)> controls_;
  std::function<void(const std::string&, double)> watch_;
  std::string stage_;
  double done_ = 0;
  std::unique_ptr<Solver> solver_;
  Guard guard_;
};

/// The displacements of landmarks that each unknown causes by itself, measured at two of its values.
struct Influence
{
  struct Column
  {
    std::array<double, 2> at{};                ///< values of the unknown at which it is measured
    std::array<Eigen::VectorXd, 2> displaced;  ///< displacements from `rest`
  };
  Eigen::VectorXd rest;  ///< places in equilibrium with all unknowns at rest
  std::map<std::string, Column> columns;
};

/// Reads the influence of the unknowns from the model's file in the folder `settings.cache`. Measures missing unknowns
/// and adds them to the file, if the folder can be written. `seconds` receives the wall time of the measurement.
Influence obtain_influence(ForwardRuns& runs, const std::vector<Unknown>& unknowns, const FitSettings& settings,
                           double& seconds);

/// Indices of the track's landmarks in the model. Throws Error if the model lacks one.
std::vector<std::size_t> landmarks_of(const Model& model, const LandmarkTrack& track);

/// The value of an unknown at rest: the tone of a muscle, or 0 for a bone.
double rest_value(const Model& model, const std::string& unknown);

/// The displacement of landmarks as the sum of the displacements that each unknown causes by itself. Each of these is a
/// parabola through rest and the two measured values.
class InfluenceLaw
{
public:
  InfluenceLaw(const Model& model, const Influence& influence, const std::vector<Unknown>& unknowns);

  Eigen::VectorXd displacement(const Eigen::VectorXd& values) const;
  Eigen::MatrixXd derivative(const Eigen::VectorXd& values) const;
  const Eigen::VectorXd& rest_values() const { return rest_; }

private:
  Eigen::VectorXd rest_;
  Eigen::MatrixXd linear_, quadratic_;  // one column per unknown
};

}  // namespace frontalis
