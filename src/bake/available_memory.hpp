#pragma once

namespace frontalis
{

/// Memory that this process can still take [bytes]: what the system reports as available, or the rest of the control
/// group's limit if that is less. Infinite where neither is known.
double available_memory();

/// The most memory that this process has had so far [bytes].
double peak_memory();

}  // namespace frontalis
