#pragma once

#include "discretisation.hpp"
#include "frontalis/solver/solver.hpp"
#include "restricted_nodes.hpp"

#include <memory>

namespace frontalis
{

/// Part of an advance in equal steps; activations and poses go linearly from begin to end over it.
struct StepPlan
{
  int steps = 0;
  double dt = 0;
  double time = 0;  ///< at its begin
  Controls begin, end;

  double fraction(int step) const { return (step + 1.0) / steps; }
  void activation(int step, float* out) const;
  Drive drive(int step) const;
};

/// What the backends on the host share: time, controls, the choice of the time step, the monitor.
class SteppingSolver : public Solver
{
public:
  SteppingSolver(std::shared_ptr<const Model> model, const SolverSettings& settings);

  void reset() override;
  void advance(double seconds, const Controls& target) override;
  double time() const override { return time_; }
  double time_step() const override { return safe_time_step(); }
  const Controls& controls() const override { return controls_; }
  Monitor monitor() override;
  Profile profile() const override { return profile_; }

protected:
  /// Runs the plan's steps; returns the largest frequency bound squared [1/s2] at its last step, NaN included.
  virtual double run(const StepPlan& plan) = 0;
  /// Most steps between two looks at how far the voxels have stiffened.
  virtual int steps_a_plan() const { return 32; }
  virtual void rest() = 0;  ///< displacements and velocities to zero
  virtual void velocities(std::vector<std::array<double, 3>>& out) const = 0;

  /// Chooses the time step anew after displacements were set from outside.
  void renew_time_step();

  /// Damped central difference: v = keep * v + gain * force / mass.
  double keep(double dt) const;
  double gain(double dt) const;

  std::shared_ptr<const Model> model_;
  Discretisation discretisation_;
  Profile profile_;

private:
  void check(double seconds, const Controls& target) const;
  double safe_time_step() const;

  double forced_time_step_ = 0;
  double time_ = 0;
  double frequency_squared_ = 0;
  bool failed_ = false;
  Controls controls_;
};

/// Controls at rest: no activation, bones in place.
Controls rest_controls(const Model& model);

std::unique_ptr<Solver> make_reference_solver(std::shared_ptr<const Model> model, const SolverSettings& settings);
/// `remark` is added to its description.
std::unique_ptr<Solver> make_cpu_solver(std::shared_ptr<const Model> model, const SolverSettings& settings,
                                        const std::string& remark = {});

}  // namespace frontalis
