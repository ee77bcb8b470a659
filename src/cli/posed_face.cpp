#include "cli/posed_face.hpp"

#include "cli/command.hpp"

#include "frontalis/error.hpp"
#include "frontalis/runner/face_frame.hpp"
#include "frontalis/runner/named_controls.hpp"

#include <utility>

namespace frontalis
{

PosedFace::PosedFace(std::shared_ptr<const Model> model, const SolverSettings& settings)
    : model_(std::move(model)), solver_(make_solver(model_, settings)), guard_(*solver_, model_)
{
  if (model_->skin.vertices.empty())
    throw Error("the model has no skin; bake it again from a scene whose 'skin' has a surface");
  read_skin(rest_);
}

void PosedFace::read_skin(SkinState& skin)
{
  solver_->skin(skin);
  if (fine_lines_)
    fine_lines_->add_settled(skin);
  to_face_frame(*model_, skin);
}

const SkinState& PosedFace::take(const Controls& pose, double seconds, const std::function<void(double done)>& watch)
{
  constexpr int slices = 12;
  const auto go_on = [] { return !interrupt_requested(); };
  solver_->reset();
  guard_.restart();
  const ControlCurve curve{ { 0, seconds * 2 / 3 }, { rest_controls(*model_), pose } };
  for (int slice = 1; slice <= slices; ++slice)
  {
    if (!guard_.advance_checked(seconds / slices / model_->time_scaling, curve.at(seconds * slice / slices), go_on))
      throw Interrupted();
    watch(double(slice) / slices);
  }
  read_skin(skin_);
  if (!is_finite(skin_))
    throw Error("the skin has coordinates that are not finite");
  return skin_;
}

}  // namespace frontalis
