#include "frontalis/error.hpp"
#include "frontalis/physics/number.hpp"
#include "frontalis/render/renderer.hpp"

#include <fmt/core.h>

#include <cmath>

namespace frontalis
{

PinholeCamera camera_with(int width, int height, double field_of_view)
{
  constexpr int largest = 8192;
  constexpr double half_turn = physics::pi;
  if (width < 1 || height < 1 || width > largest || height > largest)
    throw Error(fmt::format("a camera of {} x {} pixels; sizes must be from 1 to {}", width, height, largest));
  if (!(field_of_view > 0) || !(field_of_view < half_turn))
    throw Error(fmt::format("a field of view of {:g} degrees; must be greater than 0 and less than 180",
                            field_of_view * 180 / half_turn));
  PinholeCamera camera;
  camera.width = width;
  camera.height = height;
  camera.fx = camera.fy = 0.5 * width / std::tan(0.5 * field_of_view);
  camera.cx = 0.5 * (width - 1);
  camera.cy = 0.5 * (height - 1);
  return camera;
}

RigidTransform look_at(const std::array<double, 3>& position, const std::array<double, 3>& target, double roll)
{
  const std::array<double, 3> way{ target[0] - position[0], target[1] - position[1], target[2] - position[2] };
  const double length = std::hypot(way[0], way[1], way[2]), level = std::hypot(way[0], way[1]);
  if (!(level > 1e-9 * length) || !std::isfinite(length))
    throw Error("a camera must look at another point than its own place, and not straight up or down");
  // The camera's z axis points ahead. `right` and `down` are its other two axes before it is rolled.
  const std::array<double, 3> z{ way[0] / length, way[1] / length, way[2] / length };
  const std::array<double, 3> right{ way[1] / level, -way[0] / level, 0 };
  const std::array<double, 3> down{ z[1] * right[2] - z[2] * right[1], z[2] * right[0] - z[0] * right[2],
                                    z[0] * right[1] - z[1] * right[0] };
  RigidTransform to_camera;
  for (std::size_t i = 0; i < 3; ++i)
  {
    to_camera.rotation[i] = std::cos(roll) * right[i] + std::sin(roll) * down[i];
    to_camera.rotation[3 + i] = std::cos(roll) * down[i] - std::sin(roll) * right[i];
    to_camera.rotation[6 + i] = z[i];
  }
  const std::array<double, 3> turned = to_camera.turned(position);
  to_camera.translation = { -turned[0], -turned[1], -turned[2] };
  return to_camera;
}

}  // namespace frontalis
