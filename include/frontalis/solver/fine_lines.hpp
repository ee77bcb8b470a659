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
  /// Returns null if the skin has no film. With `own_thread`, a separate thread finds the heights of the lines; without
  /// it, add_to() finds them, with the same result in every run.
  static std::unique_ptr<FineLines> make(std::shared_ptr<const Model> model, bool own_thread);

  ~FineLines();
  FineLines(const FineLines&) = delete;
  FineLines& operator=(const FineLines&) = delete;

  /// Adds lines to the skin of a solver, in the local frame. Moves the vertices along the normals by the height of the
  /// lines, finds the normals anew, and sets SkinState::line_height. With a separate thread, `wait` tells whether to
  /// wait for the heights of this skin or to use the latest that are ready.
  void add_to(SkinState& skin, bool wait);

  /// Like add_to(), for a skin that stands still: lines grow from the flat skin until they are in equilibrium, so that
  /// they do not depend on earlier skins. Only without a separate thread.
  void add_settled(SkinState& skin);

  /// Makes the skin flat and discards heights that are still being computed.
  void reset();

  /// Processor time spent on the latest heights [s].
  double seconds() const;

private:
  FineLines(std::shared_ptr<const Model> model, bool own_thread);

  struct Implementation;
  std::unique_ptr<Implementation> self_;
};

}  // namespace frontalis
