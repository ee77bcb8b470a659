#pragma once

#include "frontalis/model/model.hpp"

#include <vector>

namespace frontalis
{

/// How much of each skin vertex is covered by the hair of a painted eyebrow, 0..1: a band of 8 mm along the line
/// through the landmarks whose names begin with "brow" and end with the same "_left" or "_right", drawn somewhat longer
/// at both ends. Models with fewer than two such landmarks on a side have no brow there. It only makes pictures
/// legible; the tissue knows no hair.
std::vector<float> brow_cover(const Model& model);

}  // namespace frontalis
