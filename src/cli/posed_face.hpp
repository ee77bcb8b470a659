#pragma once

#include "frontalis/solver/fine_lines.hpp"
#include "frontalis/solver/guard.hpp"

#include <functional>
#include <memory>

namespace frontalis
{

/// A face that takes one pose after the other, each from rest, so that no pose depends on earlier ones.
class PosedFace
{
public:
  /// Throws Error if the model has no skin, and the errors of make_solver().
  PosedFace(std::shared_ptr<const Model> model, const SolverSettings& settings);

  /// The skin at rest, in the face frame.
  const SkinState& rest() const { return rest_; }
  /// Moves linearly to the pose during the first two thirds of `seconds`, which are on the clock of the activations,
  /// and holds it for the last third. Returns the skin at the end, in the face frame. `watch` is called with the
  /// completed fraction. Throws Unstable if the guard stops the motion, Error if the skin is not finite, and
  /// Interrupted after Ctrl-C.
  const SkinState& take(const Controls& pose, double seconds, const std::function<void(double done)>& watch);
  /// The solver in the pose that was taken last.
  const Solver& solver() const { return *solver_; }
  /// Controls and activations at the end of the latest take().
  const Controls& controls() const { return solver_->controls(); }
  const std::vector<float>& activation() const { return solver_->activation(); }

private:
  void read_skin(SkinState& skin);

  std::shared_ptr<const Model> model_;
  std::unique_ptr<Solver> solver_;
  Guard guard_;
  std::unique_ptr<FineLines> fine_lines_ = FineLines::make(model_, false);  ///< null: the skin has no fine lines
  SkinState rest_, skin_;
};

}  // namespace frontalis
