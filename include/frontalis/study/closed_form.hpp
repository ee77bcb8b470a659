#pragma once

#include "frontalis/study/accuracy.hpp"

#include <string>
#include <vector>

namespace frontalis
{

/// A body made in code whose deformation at rest is known, for a study of accuracy: its plan has the closed form, the
/// edges that fit the body, and the knobs that it can turn.
struct ClosedForm
{
  std::string name, title;
  AccuracyPlan plan;
  ModelMaker maker;
};

/// "cantilever": a square bar in plane strain, displaced at both ends as a beam bent by a force at its end is:
/// Timoshenko & Goodier, Theory of Elasticity, article 21, in the form of Augarde & Deeks, Finite Elements in Analysis
/// and Design 44 (2008) 595. "stretched_block": neo-Hookean, drawn to 1.3 of its length with free sides. "active_bar":
/// the same, free, drawn together by a muscle without tension-length relation. The stretches of both are where the
/// derivatives of mu/2 (J^(-2/3) I1 - 3) + kappa/2 (J - 1)^2 balance; uniform, so that voxels represent them exactly.
std::vector<ClosedForm> closed_forms();

}  // namespace frontalis
