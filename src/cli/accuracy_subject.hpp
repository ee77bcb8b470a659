#pragma once

#include "cli/model_source.hpp"
#include "cli/solver_options.hpp"

#include <string>
#include <vector>

#ifdef FRONTALIS_WITH_BAKE
#include "frontalis/study/accuracy.hpp"
#endif

namespace frontalis
{

struct AccuracyOptions
{
  ModelSource source;
  std::vector<std::string> knobs;
  std::vector<double> voxels;
  std::string expression;
  double ramp = 0, hold = 0;
  double budget = 0;
  double tolerance = 0, time = 0;
  std::string folder, save;
  SolverOptions solver;
  bool quick = false;
};

#ifdef FRONTALIS_WITH_BAKE

/// The subject of a study: a scene, or a body with a closed form.
struct AccuracySubject
{
  std::string name;
  AccuracyPlan plan;
  ModelMaker maker;
};

/// Sets `options.folder` to its default if it is empty. Throws Error, WrongUsage.
AccuracySubject accuracy_subject(AccuracyOptions& options);

#endif

}  // namespace frontalis
