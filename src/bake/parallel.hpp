#pragma once

#include "bake/bake_monitor.hpp"

#include <cstddef>
#include <functional>

namespace frontalis
{

/// Calls body(0) .. body(count - 1) on all cores, about `grain` of them per task. Calls must not depend on each other:
/// each writes only what belongs to its index. The calling thread reports progress meanwhile; where the monitor throws,
/// no further task begins and its exception is rethrown. If calls throw, the exception of the lowest index is rethrown.
void parallel_for(BakeMonitor& monitor, std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t)>& body);

}  // namespace frontalis
