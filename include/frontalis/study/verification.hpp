#pragma once

#include "frontalis/scene/scene.hpp"
#include "frontalis/solver/solver.hpp"
#include "frontalis/study/plot.hpp"
#include "frontalis/study/table.hpp"

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace frontalis
{

/// The figures of a verification case.
struct Finding
{
  Checks checks;
  std::vector<std::pair<std::string, Table>> tables;  ///< caption, table
  Plots plots;                                        ///< their titles are their captions
  std::string skipped;                                ///< why nothing was checked; empty: the case ran
};

struct VerificationCase
{
  std::string name;
  bool quick;  ///< whether the case takes at most some seconds and belongs to the short set
  /// `backend` computes the motions; figures of single elements come from the reference backend.
  std::function<void(const Backend& backend, Finding& finding)> run;
};

/// Makes the model of a scene, as bake() does.
using BakeScene = std::function<Model(const Scene&)>;

/// All cases, in the order of the manual. Without a `bake`, those that start from scenes are skipped.
std::vector<VerificationCase> verification_cases(const BakeScene& bake = {});

/// Findings, each with the name of its case.
using Findings = std::vector<std::pair<std::string, Finding>>;
std::string findings_json(const Findings& findings);
/// Writes the manual to `path` (FOLDER/NAME.md) and its plots to FOLDER/NAME/. The texts of the cases are read from
/// FOLDER/NAME/text.md. Throws Error if a file cannot be read or written, or gnuplot is missing.
void write_manual(const Findings& findings, const std::string& path);

}  // namespace frontalis
