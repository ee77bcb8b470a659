#pragma once

#include "frontalis/error.hpp"
#include "frontalis/model/model.hpp"
#include "frontalis/solver/allocation.hpp"
#include "frontalis/solver/reaction.hpp"
#include "frontalis/solver/solver_state.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace frontalis
{

/// Increased whenever the same model and controls give a different motion (other steps, other laws), or Solver::pack()
/// gives different bytes. Stored motions of another generation are refused.
constexpr int motion_generation = 31;

/// A name of backend_names(): "auto" (the GPU if there is one, else the CPU), "reference" (double precision, plain
/// loops; slow, but tests compare the others with it), "cpu" (SIMD, all cores), "cuda".
using Backend = std::string;

/// The values of SolverSettings::backend in this build, "auto" first.
std::vector<Backend> backend_names();
/// Checks and returns the name. Throws Error if it is not in backend_names().
Backend backend_from_name(const std::string& name);
/// The backends that can run on this machine, in the order of preference of "auto".
std::vector<Backend> available_backends();
SkinField skin_field_from_name(const std::string& name);  ///< throws Error unless it is "strain", "stress" or "lines"

struct SolverSettings
{
  Backend backend = "auto";
  int threads = 0;       ///< CPU threads at most; 0: one per core
  double time_step = 0;  ///< [s]; 0: chosen by the solver. Steps above the critical time step are refused
  bool ledger = false;   ///< keep an account of energies (Solver::ledger); makes steps slower
};

/// External inputs of the model: activations of muscles and motions of bones.
struct Controls
{
  std::vector<float> activation;     ///< one per muscle, 0..1
  std::vector<RigidTransform> bone;  ///< one per bone: motion from its rest pose, in the local frame
};

/// Controls at a fraction (0..1) between two controls. Bones rotate through the smallest angle.
Controls interpolate(const Controls& from, const Controls& to, double fraction);

/// The complete state of a motion at one moment. Only the solver that made it can read it.
class Snapshot
{
public:
  virtual ~Snapshot() = default;
};

/// Thrown when the motion is no longer finite.
class Diverged : public Error
{
public:
  using Error::Error;
};

/// Explicit central-difference solver of one model (Miller et al. 2007, total Lagrangian). Not thread-safe.
class Solver
{
public:
  virtual ~Solver() = default;

  /// Returns to rest at time 0 with all controls at zero.
  virtual void reset() = 0;

  /// Advances by exactly `seconds` of simulated time in equal steps of at most the safe time step. Meanwhile
  /// activations and bone poses change linearly to `target`; bones rotate through the smallest angle, at most at a
  /// fifth of the speed of sound in the tissue. `go_on`, called every few dozen steps, ends the motion early by
  /// returning false. Returns whether the motion has reached its end. Throws Error, with the state unchanged, if the
  /// target is not finite, outside 0..1 or of the wrong length; Diverged, after which only reset() and restore() help.
  virtual bool advance(double seconds, const Controls& target, const std::function<bool()>& go_on = {}) = 0;

  /// Throws the Error that advance() would throw: after divergence, or for an invalid duration or target.
  virtual void check(double seconds, const Controls& target) const = 0;

  /// Dynamic relaxation (Underwood 1983): activations are set to `target` at once, bones go there as fast as they may,
  /// and damping is critical for the lowest frequency of the motion. Viscous stresses are fully relaxed meanwhile. The
  /// relaxation ends when the remaining motion, estimated from speed, damping and lowest frequency, is within
  /// `tolerance` of the displacement (mass-weighted norms), or after `seconds` of simulated time. `go_on` is called
  /// with the progress and ends the relaxation by returning false. Throws Error like advance().
  virtual Equilibrium settle(const Controls& target, double tolerance, double seconds,
                             const std::function<bool(const Equilibrium&)>& go_on = {}) = 0;

  /// Saves the state of the motion in `to`, whose memory is reused if it holds a snapshot of this solver.
  virtual void save(std::unique_ptr<Snapshot>& to) = 0;
  /// Restores a snapshot of this solver; the motion then continues with the same bits. Throws Error on a snapshot of
  /// another solver.
  virtual void restore(const Snapshot& snapshot) = 0;
  /// pack() gives the state of save() as bytes, for a solver of an equal model in another process with the same
  /// settings on the same machine. unpack() throws Error on other bytes, and then leaves the state unchanged.
  virtual std::string pack() = 0;
  virtual void unpack(const std::string& bytes) = 0;
  /// Number of steps between two checks of the guard; they take about 100 times as long as monitor() and save().
  virtual int steps_per_check() const = 0;
  /// Limits steps to this fraction (0..1] of the safe time step; initially 1. Throws Error if it is out of range.
  virtual void slow_down(double share) = 0;

  virtual double time() const = 0;       ///< [s] since reset
  virtual double time_step() const = 0;  ///< largest step that the solver would take now [s]
  virtual const Controls& controls() const = 0;
  /// Present activation of each muscle: that of the controls, delayed by the muscle's rise and fall times.
  virtual const std::vector<float>& activation() const = 0;

  /// The effects of the model that are switched on. reset() does not change them.
  virtual EffectSet effects() const = 0;
  /// An effect that is off takes no time; its arrays stay allocated. Switched on again, it starts without its history
  /// (viscous stresses, friction). Restarts the energy ledger. Throws Error if the model lacks the effect, if another
  /// needs it, if it cannot be switched, or if a node is half an edge from the distance at which it would slide.
  virtual void switch_effect(Effect effect, bool on) = 0;
  /// Memory of the solver's arrays, without the model.
  virtual std::vector<Allocation> allocations() const = 0;

  virtual void skin(SkinState& out) = 0;
  /// One number per vertex of the skin, interpolated from the centres of voxels through means at nodes. Memory is
  /// allocated on first use. Throws Error if the scene switched output fields off.
  virtual void skin_field(SkinField field, std::vector<float>& out) = 0;
  virtual Monitor monitor() = 0;
  /// Throws Error if SolverSettings::ledger was not set or the backend keeps no ledger.
  virtual EnergyLedger ledger() = 0;
  /// Forces of the latest step, one per entry of touched_bodies(model); empty if the backend does not compute them.
  virtual std::vector<Reaction> reactions() const { return {}; }
  /// Present poses of the same bodies in the local frame, as many as reactions(); empty if it does not compute them.
  virtual std::vector<RigidTransform> bodies() const { return {}; }
  virtual Profile profile() const = 0;

  /// Nodal displacements [m] in the order of Model::nodes; for tests and studies.
  virtual void displacements(std::vector<std::array<double, 3>>& out) const = 0;
  /// Sets the displacements and zeroes the velocities; for tests and studies.
  virtual void set_displacements(const std::vector<std::array<double, 3>>& in) = 0;
  /// Sets nodal velocities [m/s]; for tests and studies.
  virtual void set_velocities(const std::vector<std::array<double, 3>>& in) = 0;
  /// Internal forces [N] at the present displacements, before constraints.
  virtual void internal_forces(std::vector<std::array<double, 3>>& out) = 0;

  virtual std::string description() const = 0;  ///< backend, instruction set or device, threads
};

/// Makes a solver, which shares ownership of the model. Throws Error if the backend is not available.
std::unique_ptr<Solver> make_solver(std::shared_ptr<const Model> model, const SolverSettings& settings = {});

}  // namespace frontalis
