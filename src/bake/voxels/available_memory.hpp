#pragma once

namespace frontalis
{

/// Memory that this process may still take [bytes]: what the system calls available, or what a control group leaves, if
/// that is less. Infinite where neither is known.
double available_memory();

/// The most memory that this process has had so far [bytes].
double peak_memory();

}  // namespace frontalis
