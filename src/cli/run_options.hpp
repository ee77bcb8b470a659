#pragma once

#include "cli/frame_folder.hpp"
#include "cli/given_controls.hpp"
#include "cli/model_source.hpp"
#include "cli/movie.hpp"

#include "frontalis/solver/solver.hpp"

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace frontalis
{

/// Options of `frontalis run`.
struct RunOptions
{
  ModelSource source;
  std::string activation, expression, activation_file;
  std::vector<std::string> bones;
  std::vector<std::string> without;
  bool to_equilibrium = false;
  double tolerance = 1e-3;
  double ramp = -1;  ///< duration of the ramp [s]; < 0: 0.1 s, or half of the run if that is less
  bool demo = false;
  double seconds = 1;
  bool seconds_given = false;
  std::string frames, plot;
  MovieOptions movie;
  bool wrinkles = false;
  std::vector<double> wrinkles_in;  ///< smallest left and up, largest left and up [mm]; empty: everywhere
  FrameFiles files;
  double frame_rate = 0;  ///< [1/s]; 0: the model's frame rate
  SolverSettings solver;
  int guard_interval = -1;  ///< steps between checks; 0: no guard; -1: the backend's default
};

void add_run_options(CLI::App& command, RunOptions& options);
/// Throws WrongUsage if options contradict each other or are out of range.
void check_options(const RunOptions& options);
/// The controls that the options ask for. Throws Error if the model lacks what they name.
ControlCurve curve_of(const RunOptions& options, const Model& model);
/// The demo of the model. Unless --seconds was given, sets it to the demo's duration. Throws Error if there is none.
ControlCurve demo_of(RunOptions& options, const Model& model);

}  // namespace frontalis
