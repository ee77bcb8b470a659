#include "frontalis/runner/face_frame.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

std::array<float, 3> rounded(const std::array<double, 3>& p)
{
  return { { static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]) } };
}

bool all_finite(const std::vector<std::array<float, 3>>& vectors)
{
  return std::all_of(vectors.begin(), vectors.end(),
                     [](const std::array<float, 3>& v)
                     { return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]); });
}

}  // namespace

void to_face_frame(const Model& model, SkinState& skin)
{
  for (std::array<float, 3>& vertex : skin.vertices)
    vertex = rounded(model.to_face(vertex));
  for (std::array<float, 3>& normal : skin.normals)
    normal = rounded(model.to_face.turned(normal));
  for (std::array<float, 3>& landmark : skin.landmarks)
    landmark = rounded(model.to_face(landmark));
}

bool is_finite(const SkinState& skin)
{
  return all_finite(skin.vertices) && all_finite(skin.normals) && all_finite(skin.landmarks);
}

}  // namespace frontalis
