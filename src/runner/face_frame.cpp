#include "frontalis/runner/face_frame.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace frontalis
{
namespace
{

// the rotation of `map` applied to a vector, plus `translated` times its translation: 1 for points, 0 for directions
std::array<float, 3> transformed(const RigidTransform& map, const std::array<float, 3>& p, double translated)
{
  std::array<float, 3> result{};
  for (std::size_t i = 0; i < 3; ++i)
    result[i] = static_cast<float>(map.rotation[3 * i] * p[0] + map.rotation[3 * i + 1] * p[1] +
                                   map.rotation[3 * i + 2] * p[2] + translated * map.translation[i]);
  return result;
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
    vertex = transformed(model.to_face, vertex, 1);
  for (std::array<float, 3>& normal : skin.normals)
    normal = transformed(model.to_face, normal, 0);
  for (std::array<float, 3>& landmark : skin.landmarks)
    landmark = transformed(model.to_face, landmark, 1);
}

bool is_finite(const SkinState& skin)
{
  return all_finite(skin.vertices) && all_finite(skin.normals) && all_finite(skin.landmarks);
}

}  // namespace frontalis
