#pragma once

#include "frontalis/study/accuracy.hpp"

#include <string>
#include <vector>

namespace frontalis
{

/// A body for a study of accuracy whose settled deformation is known. The plan has the closed form, the voxel edges
/// that fit the body and the knobs that can be varied.
struct ClosedForm
{
  std::string name;
  AccuracyPlan plan;
  ModelMaker maker;
};

/// "cantilever": a square bar in plane strain whose ends are displaced like those of a beam under a force at its end:
/// Timoshenko & Goodier, Theory of Elasticity, article 21, in the form of Augarde & Deeks, Finite Elements in Analysis
/// and Design 44 (2008) 595. "stretched_block": neo-Hookean, drawn to 1.3 of its length with free sides. "active_bar":
/// the same, free, contracted by a muscle without tension-length relation. The stretches of both follow from the
/// derivatives of mu/2 (J^(-2/3) I1 - 3) + kappa/2 (J - 1)^2; they are uniform, so that voxels represent them exactly.
std::vector<ClosedForm> closed_forms();

}  // namespace frontalis
