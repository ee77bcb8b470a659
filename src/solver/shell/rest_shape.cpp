#include "frontalis/solver/rest_shape.hpp"

#include "solver/skin/bound_points.hpp"

namespace frontalis
{
namespace
{

// Moves bound points by a multiple of their displacements.
void shift(const Model& model, const Binding& binding, const std::vector<std::array<double, 3>>& displacements,
           double factor, std::vector<std::array<double, 3>>& points)
{
  std::vector<double> component[3];
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const auto& u : displacements)
      component[axis].push_back(factor * u[axis]);
  const double* const u[3] = { component[0].data(), component[1].data(), component[2].data() };
  for (std::size_t p = 0; p < points.size(); ++p)
    for (std::size_t axis = 0; axis < 3; ++axis)
      points[p][axis] += bound_displacement(model, binding, p, u)[axis];
}

}  // namespace

void add_creases(Model& model, const std::vector<std::array<double, 3>>& displacements, double set)
{
  for (Shell& shell : model.shells)
    shift(model, shell.binding, displacements, set, shell.surface.vertices);
}

void place_skin_at(Model& model, const std::vector<std::array<double, 3>>& displacements)
{
  shift(model, model.skin_binding, displacements, -1, model.skin.vertices);
  shift(model, model.landmark_binding, displacements, -1, model.landmark_positions);
}

}  // namespace frontalis
