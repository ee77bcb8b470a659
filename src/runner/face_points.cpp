#include "face_points.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{

void transform(const RigidTransform& map, bool with_translation, Points& points)
{
  for (auto& p : points)
  {
    const std::array<float, 3> q = p;
    for (int i = 0; i < 3; ++i)
      p[i] = static_cast<float>(map.rotation[3 * i] * q[0] + map.rotation[3 * i + 1] * q[1] +
                                map.rotation[3 * i + 2] * q[2] + (with_translation ? map.translation[i] : 0));
  }
}

bool finite(const Points& points)
{
  return std::all_of(points.begin(), points.end(),
                     [](const auto& p) { return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]); });
}

}  // namespace frontalis
