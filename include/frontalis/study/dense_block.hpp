#pragma once

#include "frontalis/model/model.hpp"

namespace frontalis
{

/// A dense block of x * y * z equal neo-Hookean voxels (hypodermis, edge 1 mm), the face x = 0 held, under gravity
/// along -z.
Model dense_block(std::int32_t x, std::int32_t y, std::int32_t z);

}  // namespace frontalis
