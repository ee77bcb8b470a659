#pragma once

#include "frontalis/model/model.hpp"
#include "frontalis/solver/solver.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace frontalis
{

/// Colours of a lit skin, one a vertex. rviz drops a marker's lighting once it has colours, and its own normals are
/// flat, so the light is baked in here: wrapped diffuse light of a warm key light from above and a cool fill light from
/// the side, a soft highlight, and less light in hollows, which lets furrows be seen.
class SkinShading
{
public:
  /// Keeps the neighbours of each vertex. `hair` is the proportion of each vertex that hair covers, 0..1 (see
  /// brow_cover); empty: none.
  explicit SkinShading(const TriangleMesh& mesh, std::vector<float> hair = {});

  /// Fills `out` with red, green, blue in 0..1 (display values), one a vertex. Vertices and unit normals in the face
  /// frame [m].
  void colours(const SkinState& skin, std::vector<std::array<float, 3>>& out) const;

private:
  std::vector<std::int32_t> neighbour_begin_;
  std::vector<std::int32_t> neighbours_;
  std::vector<float> hair_;
};

}  // namespace frontalis
