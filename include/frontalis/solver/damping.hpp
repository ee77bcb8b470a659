#pragma once

namespace frontalis
{

class Solver;

/// Changes the damping of a solver of make_solver() from now on, also after a reset: proportional to mass [1/s], in
/// place of Model::damping. Throws Error if it is not finite or below 0.
void set_damping(Solver& solver, double damping);

}  // namespace frontalis
