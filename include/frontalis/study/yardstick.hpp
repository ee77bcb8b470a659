#pragma once

namespace frontalis
{

// Yardsticks of the machine, to compare figures of the solver with in the same run.

/// Bytes per second that large copies read and write, all threads together; median of several.
double copy_bandwidth(int threads);

/// Element updates per second of a bare loop: a dense block of edge^3 equal neo-Hookean voxels on plain arrays,
/// hourglass stiffness and central differences, no muscles, constraints or checks, on the widest instruction set;
/// median of several.
double bare_loop(int edge, int threads, double seconds);

}  // namespace frontalis
