#pragma once

#include "frontalis/model/model.hpp"
#include "frontalis/solver/solver_state.hpp"

#include <memory>

namespace frontalis
{

/// Adds fine lines to the frames of a skin that has a film (Model::film).
class FineLines
{
public:
  /// Null if the skin has no film. With `own_thread` a thread of its own finds the heights of the lines; else add_to()
  /// finds them, the same in every run.
  static std::unique_ptr<FineLines> make(std::shared_ptr<const Model> model, bool own_thread);

  ~FineLines();
  FineLines(const FineLines&) = delete;
  FineLines& operator=(const FineLines&) = delete;

  /// Takes the skin of a solver, in the local frame. Places the vertices that the film has added on a smooth surface
  /// through the carried ones, moves them along its normals by the height of the lines, finds the normals anew, and
  /// sets SkinState::line_height. If a thread of its own finds the heights, `wait` tells whether to wait for those of
  /// this skin or to take the latest that are ready.
  void add_to(SkinState& skin, bool wait);

  /// Makes the skin flat, as it is at rest, whatever is being found.
  void reset();

  /// Processor time that the latest heights took [s].
  double seconds() const;

private:
  FineLines(std::shared_ptr<const Model> model, bool own_thread);

  struct Implementation;
  std::unique_ptr<Implementation> self_;
};

}  // namespace frontalis
