#pragma once

#include "frontalis/model/model.hpp"
#include "frontalis/solver/bound_displacement.hpp"
#include "frontalis/solver/solver.hpp"
#include "frontalis/solver/surface_normals.hpp"

#include <array>

namespace frontalis
{

/// Skin vertices, their normals and the landmarks at the present displacements.
template <class Real>
void skin_state(const Model& model, const Real* const u[3], SkinState& out)
{
  const auto place = [&](const std::vector<std::array<double, 3>>& rest, const Binding& binding, auto& positions)
  {
    positions.resize(rest.size());
    for (std::size_t p = 0; p < rest.size(); ++p)
    {
      const auto moved = bound_displacement(model, binding, p, u);
      for (int axis = 0; axis < 3; ++axis)
        positions[p][axis] = static_cast<float>(rest[p][axis] + moved[axis]);
    }
  };
  place(model.skin.vertices, model.skin_binding, out.vertices);
  place(model.landmark_positions, model.landmark_binding, out.landmarks);
  surface_normals(model.skin.triangles, out.vertices, out.normals);
}

}  // namespace frontalis
