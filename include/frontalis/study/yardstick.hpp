#pragma once

namespace frontalis
{

/// What this machine does by itself, to be put beside the solver's figures of the same run.
/// Bytes a second that large copies read and write, all threads together; median of several.
double copy_bandwidth(int threads);

/// Element updates a second of the bare loop: a dense block of edge^3 equal neo-Hookean voxels on plain arrays,
/// hourglass stiffness and central differences, no muscles, constraints or checks, on the widest instruction set;
/// median of several.
double bare_loop(int edge, int threads, double seconds);

}  // namespace frontalis
