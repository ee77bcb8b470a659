#include "cli/reactions.hpp"

#include "frontalis/error.hpp"
#include "frontalis/model/body_shape.hpp"
#include "frontalis/study/plot.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace frontalis
{

void print_reactions(const Model& model, const std::vector<BodyFrame>& bodies)
{
  const std::vector<BodyShape> shapes = body_shapes(model);
  for (std::size_t c = 0; c < bodies.size(); ++c)
  {
    if (shapes[c].only_shown)
      continue;
    const auto& [force, moment] = bodies[c].reaction;
    fmt::print(
        "reaction           {}: {:+.4g} N forward, {:+.4g} N left, {:+.4g} N up; moment {:+.4g}, {:+.4g}, {:+.4g} "
        "N m\n",
        shapes[c].name, force[0], force[1], force[2], moment[0], moment[1], moment[2]);
  }
}

std::string reaction_rows(const Model& model, int frame, double time, const std::vector<BodyFrame>& bodies)
{
  std::string rows;
  const std::vector<BodyShape> shapes = body_shapes(model);
  for (std::size_t c = 0; c < bodies.size(); ++c)
  {
    if (shapes[c].only_shown)
      continue;
    const auto& [force, moment] = bodies[c].reaction;
    rows += fmt::format("{},{:.6f},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n", frame, time, shapes[c].name,
                        force[0], force[1], force[2], moment[0], moment[1], moment[2]);
  }
  return rows;
}

ReactionPlot::ReactionPlot(std::string path, const Model& model) : path_(std::move(path)), model_(model)
{
  const std::vector<BodyShape> shapes = body_shapes(model);
  if (std::all_of(shapes.begin(), shapes.end(), [](const BodyShape& shape) { return shape.only_shown; }))
    throw Error("--plot draws the forces on bodies that tissue touches; the model has none");
}

void ReactionPlot::add(double time, const std::vector<BodyFrame>& bodies)
{
  time_.push_back(time);
  bodies_.push_back(bodies);
}

void ReactionPlot::write() const
{
  Plot plot;
  plot.title = "Force on bodies that tissue touches";
  plot.x_label = "simulated time [s]";
  plot.y_label = "force [N]";
  plot.key = "below";
  const std::vector<BodyShape> shapes = body_shapes(model_);
  for (std::size_t c = 0; c < shapes.size(); ++c)
  {
    if (shapes[c].only_shown)
      continue;
    const std::string& name = shapes[c].name;
    Plot::Curve curves[] = { { name + ": magnitude", {}, {}, Plot::Style::strong },
                             { "forward", {}, {}, Plot::Style::line },
                             { "left", {}, {}, Plot::Style::line },
                             { "up", {}, {}, Plot::Style::line } };
    for (std::size_t frame = 0; frame < time_.size(); ++frame)
    {
      const auto& force = bodies_[frame].empty() ? std::array<double, 3>{} : bodies_[frame][c].reaction.force;
      curves[0].add(time_[frame], std::hypot(force[0], force[1], force[2]));
      for (std::size_t axis = 0; axis < 3; ++axis)
        curves[axis + 1].add(time_[frame], force[axis]);
    }
    plot.curves.insert(plot.curves.end(), std::begin(curves), std::end(curves));
  }
  write_plot(plot, path_);
}

}  // namespace frontalis
