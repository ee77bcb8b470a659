#pragma once

namespace frontalis
{

/// Present energies and their sources [J], since reset or since displacements or velocities were set.
struct EnergyLedger
{
  double initial = 0;  ///< kinetic, internal and hourglass energy and that of contact at the start
  double kinetic = 0;  ///< 1/2 m v(n - 1/2) . v(n + 1/2), which central differences conserve
  double internal = 0;
  double hourglass = 0;
  double viscous = 0;         ///< absorbed by viscous stresses
  double damping = 0;         ///< lost
  double friction = 0;        ///< lost
  double muscle = 0;          ///< work done by fibres, active and passive
  double load = 0;            ///< work done by surface loads
  double gravity = 0;         ///< work done
  double contact = 0;         ///< work done by the motion of bodies that tissue touches
  double contact_stored = 0;  ///< stored by the stiffness of contact
  double constraint = 0;      ///< work done by bones, prescribed motion and sliding surfaces, without friction
  double largest = 0;         ///< largest magnitude of the terms above so far

  /// Energy that the terms do not explain; it tends to 0 with the time step.
  double imbalance() const
  {
    return kinetic + internal + hourglass + contact_stored + viscous + damping + friction - muscle - load - gravity -
           contact - constraint - initial;
  }
};

}  // namespace frontalis
