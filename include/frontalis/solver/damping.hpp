#pragma once

namespace frontalis
{

class Solver;

/// Sets the mass-proportional damping [1/s] of a solver that make_solver() made, in place of Model::damping. The new
/// value also holds after a reset. Throws Error if it is not finite or below 0.
void set_damping(Solver& solver, double damping);

}  // namespace frontalis
