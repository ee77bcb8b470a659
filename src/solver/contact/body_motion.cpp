#include "solver/contact/body_motion.hpp"

#include <cmath>

namespace frontalis
{
namespace
{

using Vector = physics::Vec3<double>;

// Assumed upper limit of how far tissue moves out of the box of its grid [m].
constexpr double farthest_outside = 0.1;

}  // namespace

void add_vector(std::array<double, 3>& sum, const Vector& v)
{
  sum[0] += v.x;
  sum[1] += v.y;
  sum[2] += v.z;
}

void add_reaction(Reaction& sum, const Vector& arm, const Vector& force)
{
  add_vector(sum.force, -1.0 * force);
  add_vector(sum.moment, cross(force, arm));
}

double longest_way(const RigidTransform& from, const RigidTransform& to, const std::array<double, 3>& far_corner)
{
  if (from == to)
    return 0;
  double turned = 0;
  for (std::size_t i = 0; i < 9; ++i)
    turned += (to.rotation[i] - from.rotation[i]) * (to.rotation[i] - from.rotation[i]);
  return farthest_way(from, to, far_corner) + std::sqrt(turned) * farthest_outside;
}

BodyMotion motion_between(const RigidTransform& from, const RigidTransform& to)
{
  BodyMotion motion{ vector_of(to.translation) - vector_of(from.translation), { 0, 0, 0 } };
  // The vector of a small rotation is the skew part of to * from^T.
  double* const turn[3] = { &motion.turn.x, &motion.turn.y, &motion.turn.z };
  for (int axis = 0; axis < 3; ++axis)
    for (int k = 0; k < 3; ++k)
    {
      const int i = (axis + 1) % 3, j = (axis + 2) % 3;
      *turn[axis] +=
          0.5 * (to.rotation[3 * j + k] * from.rotation[3 * i + k] - to.rotation[3 * i + k] * from.rotation[3 * j + k]);
    }
  return motion;
}

double work_between(const Reaction& before, const Reaction& after, const BodyMotion& motion)
{
  return -0.5 * (dot(vector_of(before.force) + vector_of(after.force), motion.shift) +
                 dot(vector_of(before.moment) + vector_of(after.moment), motion.turn));
}

}  // namespace frontalis
