#pragma once

#include "cli/model_source.hpp"

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
  std::string backend = "auto";
  int threads = 0;
  bool quick = false;
};

#ifdef FRONTALIS_WITH_BAKE

/// What is studied: a scene, or a body with a closed form.
struct AccuracySubject
{
  std::string name;
  AccuracyPlan plan;
  ModelMaker maker;
};

/// Throws Error, WrongUsage. `options.folder` gets its default.
AccuracySubject accuracy_subject(AccuracyOptions& options);

#endif

}  // namespace frontalis
