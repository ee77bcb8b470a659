#pragma once

#include "frontalis/model/model.hpp"
#include "frontalis/runner/face_frame.hpp"
#include "frontalis/solver/guard.hpp"
#include "frontalis/study/wrinkles.hpp"

#include <optional>
#include <string>

namespace frontalis
{

struct RunSummary
{
  std::string backend;
  double seconds = 0;    ///< simulated time, on the clock of the activations [s]
  double wall = 0;       ///< wall time without building the model and the solver [s]
  double time_step = 0;  ///< [s]
  int frames = 0;
  double fine_lines = 0;    ///< processor time of finding fine lines, in all frames [s]
  bool complete = true;     ///< false: the run was interrupted or stopped
  std::string failure;      ///< why it was stopped; empty: it was not stopped
  Monitor monitor;          ///< at the end of the run
  double peak_kinetic = 0;  ///< [J]
  double peak_internal = 0;
  double worst_jacobian = 1;  ///< of the whole run
  Profile profile;
  std::optional<GuardCounts> guard;        ///< empty: the motion was not guarded
  std::optional<EnergyLedger> ledger;      ///< at the end of the run, if a ledger was kept
  std::vector<BodyFrame> bodies;           ///< at the end of the run, one per body that tissue touches
  std::optional<Equilibrium> equilibrium;  ///< empty: the run did not settle
  std::optional<Wrinkles> wrinkles;        ///< at the end of the run, if they were to be measured
  SkinState rest;                          ///< face frame
  SkinState end;                           ///< face frame
};

/// Prints backend, voxels, nodes and time step, before the run.
void print_set_up(const Model& model, const RunSummary& summary);

/// Prints the motion of the landmarks, the energies and the speed.
void print_result(const Model& model, const RunSummary& summary);

/// The result as JSON.
std::string json_of(const Model& model, const RunSummary& summary);

}  // namespace frontalis
