#pragma once

#include "frontalis/error.hpp"
#include "frontalis/model/model.hpp"
#include "frontalis/solver/allocation.hpp"
#include "frontalis/solver/energy_ledger.hpp"
#include "frontalis/solver/solver_state.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace frontalis
{

/// Raised whenever the same model and controls give another motion than before (other steps, other laws), or
/// Solver::pack() gives other bytes: motions that were kept by another generation are refused.
constexpr int motion_generation = 10;

/// A name of backend_names(): "auto" (the GPU where there is one, else the CPU), "reference" (double precision, plain
/// loops: slow on purpose, the oracle of every test), "cpu" (SIMD, all cores), "cuda".
using Backend = std::string;

/// What SolverSettings::backend can ask for in this build, "auto" first.
std::vector<Backend> backend_names();
/// The name itself; throws Error where it is none of backend_names().
Backend backend_from_name(const std::string& name);
/// The backends that can run on this machine, in the order in which "auto" prefers them.
std::vector<Backend> available_backends();
SkinField skin_field_from_name(const std::string& name);  ///< "strain" or "stress"; throws Error naming them

struct SolverSettings
{
  Backend backend = "auto";
  int threads = 0;       ///< CPU threads; 0: one per core
  double time_step = 0;  ///< [s]; 0: found by the solver. One above the critical time step is refused
  bool ledger = false;   ///< keep account of energies (Solver::ledger); makes steps slower
};

/// What moves the model from outside.
struct Controls
{
  std::vector<float> activation;     ///< one per muscle, 0..1
  std::vector<RigidTransform> bone;  ///< one per bone: motion from its rest pose, in the local frame
};

/// Controls at a fraction of the way between two; bones turn about the shortest axis.
Controls interpolate(const Controls& from, const Controls& to, double fraction);

/// All that the motion depends on at one moment. Its contents are known to the solver alone that made it.
class Snapshot
{
public:
  virtual ~Snapshot() = default;
};

/// The motion is no longer finite.
class Diverged : public Error
{
public:
  using Error::Error;
};

/// Explicit central-difference solver of one model (Miller et al. 2007, total Lagrangian). For one caller at a time.
class Solver
{
public:
  virtual ~Solver() = default;

  /// Back to rest at time 0 with all controls at zero.
  virtual void reset() = 0;

  /// Advances by exactly `seconds` of simulated time in equal steps of at most the safe time step; activations and bone
  /// poses go linearly (poses: rotation about the shortest axis) from where they are to `target` over that time.
  /// Throws Error, with the state untouched, on a target that is not finite, out of 0..1 or of the wrong length; throws
  /// Diverged, after which only reset() and restore() help.
  virtual void advance(double seconds, const Controls& target) = 0;

  /// Throws Error where advance() would: a state that diverged, a bad duration or target.
  virtual void check(double seconds, const Controls& target) const = 0;

  /// Dynamic relaxation (Underwood 1983): controls go to `target` at once, and the motion is damped critically for the
  /// lowest frequency that it shows. It ends when the motion that is left, estimated from speed, damping and lowest
  /// frequency, stays within `tolerance` of the displacement (norms weighted by mass), or after `seconds` of
  /// simulation. Viscous stresses are fully relaxed meanwhile. `go_on` is told how far it is; false ends it. Throws
  /// Error as advance().
  virtual Equilibrium settle(const Controls& target, double tolerance, double seconds,
                             const std::function<bool(const Equilibrium&)>& go_on = {}) = 0;

  /// Saves what the motion depends on now in `to`, whose memory is used again if it holds a snapshot of this solver.
  virtual void save(std::unique_ptr<Snapshot>& to) = 0;
  /// Back to a snapshot of this solver; from there the motion goes on with the same bits. Throws Error on a snapshot of
  /// another solver.
  virtual void restore(const Snapshot& snapshot) = 0;
  /// The same as bytes, for a solver that another process makes of an equal model, on the same machine and with the
  /// same settings. unpack() throws Error on what is no such motion, and leaves the state as it was.
  virtual std::string pack() = 0;
  virtual void unpack(const std::string& bytes) = 0;
  /// Number of steps that take about a hundred times as long as monitor() and save() do.
  virtual int steps_per_check() const = 0;
  /// Steps take at most this share (0..1] of the safe time step from now on; 1 at first. Throws Error.
  virtual void slow_down(double share) = 0;

  virtual double time() const = 0;       ///< [s] since reset
  virtual double time_step() const = 0;  ///< [s] the largest step that would be taken now
  virtual const Controls& controls() const = 0;
  /// Activation of each muscle now: what the controls ask for, after the muscles' rise and fall times.
  virtual const std::vector<float>& activation() const = 0;

  /// Those of the model's effects that run now. reset() leaves them as they are.
  virtual EffectSet effects() const = 0;
  /// An effect that is off takes no time and keeps its memory; one that comes back has forgotten its history (viscous
  /// stresses, friction). Time step and ledger begin anew. Throws Error where the model does not have the effect, where
  /// another needs it, or where it cannot be switched while running.
  virtual void switch_effect(Effect effect, bool on) = 0;
  /// What the solver's arrays hold now, the model not counted.
  virtual std::vector<Allocation> allocations() const = 0;

  virtual void skin(SkinState& out) = 0;
  /// One number per vertex of the skin, from the voxels' centres through means at their nodes. Nothing is stored for it
  /// until it is asked for first. Throws Error where the scene switched output fields off.
  virtual void skin_field(SkinField field, std::vector<float>& out) = 0;
  virtual Monitor monitor() = 0;
  /// Throws Error where SolverSettings::ledger was not asked for or the backend keeps none.
  virtual EnergyLedger ledger() = 0;
  virtual Profile profile() const = 0;

  /// Nodal displacements [m] in the order of Model::nodes; for tests and studies.
  virtual void displacements(std::vector<std::array<double, 3>>& out) const = 0;
  /// Sets the displacements and zeroes the velocities; for tests and studies.
  virtual void set_displacements(const std::vector<std::array<double, 3>>& in) = 0;
  /// Nodal velocities [m/s]; for tests and studies.
  virtual void set_velocities(const std::vector<std::array<double, 3>>& in) = 0;
  /// Internal forces [N] at the present displacements (elastic, hourglass, fibres), before constraints.
  virtual void internal_forces(std::vector<std::array<double, 3>>& out) = 0;

  virtual std::string description() const = 0;  ///< backend, instruction set or device, threads
};

/// Makes a solver; the model is kept alive by it. Throws Error where the backend is not available here.
std::unique_ptr<Solver> make_solver(std::shared_ptr<const Model> model, const SolverSettings& settings = {});

}  // namespace frontalis
