#pragma once

#include "frontalis/model/model.hpp"
#include "frontalis/render/renderer.hpp"
#include "frontalis/solver/solver.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace frontalis
{

/// A linear colour for a number: from dark blue at 0 over green and yellow to red at 1 and above. What is not a number
/// is dark blue too.
std::array<float, 3> false_colour(float value);

/// Computes the colours of a lit skin, one per vertex. rviz does not light a marker that has colours, and its own
/// normals are those of flat triangles, so the colours must include the light. A warm main light comes from above, a
/// cool one from the side, with a soft highlight. Hollows get less light, so that furrows can be seen.
class SkinShading
{
public:
  /// `natural`: the colour of each vertex in plain white light, encoded for displays (skin_appearance() has it).
  SkinShading(const TriangleMesh& mesh, const std::vector<std::array<float, 3>>& natural);

  /// Fills `out` with one colour per vertex: red, green and blue, 0..1, encoded for displays (gamma 2.2). The skin is
  /// in the face frame. `values`: empty for natural skin colours, or one number per vertex, coloured by false_colour().
  void colours(const SkinState& skin, const std::vector<float>& values, std::vector<std::array<float, 3>>& out) const;

private:
  /// Mean normal curvature of each vertex [1/m], positive in hollows. It is the mean over the neighbours of twice a
  /// neighbour's height above the vertex's tangent plane, divided by its squared distance.
  std::vector<float> curvatures(const SkinState& skin) const;

  std::vector<std::int32_t> neighbour_begin_;
  std::vector<std::int32_t> neighbours_;
  std::vector<std::array<float, 3>> albedo_;  // linear, before gamma
};

/// The colours of a mesh at rest, whose axes are those of the face frame, lit as the skin is, so that the two join
/// without a seam. What has the label inside_label is drawn without light.
std::vector<std::array<float, 3>> lit(const RenderMesh& mesh);

}  // namespace frontalis
