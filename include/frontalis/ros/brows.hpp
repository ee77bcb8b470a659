#pragma once

#include "frontalis/model/model.hpp"

#include <vector>

namespace frontalis
{

/// The share of each skin vertex that the hair of a painted eyebrow covers, 0..1. The brow of a side is a band, 8 mm
/// wide at its inner end, along the line through the landmarks whose names begin with "brow" and end with "_left" or
/// "_right", and about 1 cm longer at both ends. A side with fewer than two such landmarks has no brow. Brows show in
/// pictures how the skin moves; they have no effect on the tissue.
std::vector<float> brow_cover(const Model& model);

}  // namespace frontalis
