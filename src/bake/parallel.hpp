#pragma once

#include "bake/bake_stages.hpp"

#include <cstddef>
#include <functional>

namespace frontalis
{

/// Calls body(0) .. body(count - 1) on all cores. Results must not depend on the order: each index writes its own
/// place. The calling thread tells progress meanwhile. Rethrows the exception of the lowest index that threw.
void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body, BakeStages* stages = nullptr);

/// The same for ranges of `grain` indices at a time: body(begin, end).
void parallel_ranges(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body,
                     BakeStages* stages = nullptr);

}  // namespace frontalis
