#pragma once

#include "frontalis/model/model.hpp"
#include "frontalis/solver/bound_displacement.hpp"
#include "frontalis/solver/solver.hpp"
#include "frontalis/solver/surface_normals.hpp"
#include "solver/skin/film_vertices.hpp"

#include <array>

namespace frontalis
{

/// Skin vertices, their normals and the landmarks at the present displacements.
template <class Real>
void skin_state(const Model& model, const Real* const u[3], SkinState& out)
{
  const auto place =
      [&](const std::vector<std::array<double, 3>>& rest, std::size_t count, const Binding& binding, auto& positions)
  {
    positions.resize(count);
    for (std::size_t p = 0; p < count; ++p)
    {
      const auto moved = bound_displacement(model, binding, p, u);
      for (int axis = 0; axis < 3; ++axis)
        positions[p][axis] = static_cast<float>(rest[p][axis] + moved[axis]);
    }
  };
  const std::size_t middles = model.film.parents.size();
  place(model.skin.vertices, model.skin.vertices.size() - middles, model.skin_binding, out.vertices);
  place(model.landmark_positions, model.landmark_positions.size(), model.landmark_binding, out.landmarks);
  if (middles > 0)
    place_film_vertices(model, out);
  else
    surface_normals(model.skin.triangles, out.vertices, out.normals);
}

}  // namespace frontalis
