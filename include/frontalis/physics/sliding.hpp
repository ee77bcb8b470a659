#pragma once

#include "frontalis/physics/field_spline.hpp"
#include "frontalis/physics/mutation.hpp"

namespace frontalis
{
namespace physics
{

/// Shortest gradient of a distance field that a sliding node follows. Gradients are shorter on ridges and in furrows
/// that are narrow compared with the node's distance from the surface. There the node keeps its latest tangent plane,
/// as it does where no samples are stored.
constexpr double least_gradient = 0.05;

/// Tangent plane of a level set near a point: a node moves by -distance * normal to be on it.
template <class T>
struct LevelPlane
{
  Vec3<T> normal;  ///< unit vector towards larger distances from the surface
  T distance;      ///< distance of the point from the level set along the normal, to first order [m]
  T slip;          ///< how far the node may move before the plane's error exceeds plane_error, to second order [m]
  SymmetricMatrix<T> bend{};  ///< the field's Hessian divided by the length of its gradient [1/m]
};

/// Finds the tangent plane of the set on which the field is `level` [m], from the field at a point where its gradient
/// has the length `slope`, not 0.
template <class T>
FRONTALIS_LAW LevelPlane<T> level_plane(const FieldValue<T>& field, const T& level, const T& slope)
{
  using N = Number<T>;
  const T scale = T(1) / slope;
  return { scale * field.gradient, scale * (field.value - level),
           N::min(N::sqrt(N::of(2 * plane_error) * slope / N::max(field.curvature, N::of(1e-6))), field.reach),
           scaled(scale, field.hessian) };
}
/// Returns false, and leaves `plane` unchanged, if the gradient is too short.
template <class T>
FRONTALIS_LAW bool level_plane(const FieldValue<T>& field, const T& level, LevelPlane<T>& plane)
{
  const T slope = norm(field.gradient);
  if (!(slope > Number<T>::of(least_gradient)))
    return false;
  plane = level_plane(field, level, slope);
  return true;
}

/// After a step, a sliding node is at most this distance [m] away from its tangent plane. A smaller error is halved in
/// each step. Errors arise when the tangent plane of a node is replaced; removing an error within a single step would
/// add half the tissue's stiffness times the squared error to the energy and excite vibrations. The value keeps nodes
/// within 5 um of their level, because a plane that is kept for some steps has an error too: plane_error and, where the
/// curvature grows along the node's path, about as much again.
constexpr double error_left = 3.5e-6;

/// Slides a node on the plane normal . u = offset (unit normal): removes the velocity along the normal (Lapeer et al.
/// 2019) and most of the distance from the plane. Returns the removed normal velocity. Multiplied by the node's mass,
/// it is the impulse of the constraint in this step, without the correction of the distance.
template <class T>
FRONTALIS_LAW T slide(const Vec3<T>& normal, const T& offset, Vec3<T>& u, Vec3<T>& v)
{
  using N = Number<T>;
  const T error = dot(normal, u) - offset;
  const T speed = dot(normal, v);
  const T left = N::max(N::min(N::of(0.5) * error, N::of(error_left)), N::of(-error_left));
  u = u - (error - left) * normal;
  v = v - speed * normal;
  return speed;
}

/// When the tangent plane of a node on a smooth surface is replaced, turns the node's velocity with the normal, so that
/// the node keeps its speed; a projection would brake it. If the normals differ by more than 0.3 rad the surface has an
/// edge there, and the velocity is not changed.
template <class T>
FRONTALIS_LAW Vec3<T> turned_with_normal(const Vec3<T>& from, const Vec3<T>& to, const Vec3<T>& v)
{
  using N = Number<T>;
  const T cosine = dot(from, to);
  const Vec3<T> sum = from + to;
  const Vec3<T> turned = v - (dot(sum, v) / N::max(cosine + N::of(1), N::of(1))) * sum + (N::of(2) * dot(from, v)) * to;
  const auto smooth = cosine > N::of(0.955);
  return { N::select(smooth, turned.x, v.x), N::select(smooth, turned.y, v.y), N::select(smooth, turned.z, v.z) };
}

/// Fraction of its tangential speed that a sliding node loses to Coulomb friction in one step, in which the constraint
/// removed the given normal speed; 1 if the node sticks. The mass cancels.
template <class T>
FRONTALIS_LAW T friction_loss(const T& coefficient, const T& normal_speed, const T& tangential_speed)
{
  using N = Number<T>;
  if (mutation::no_friction)
    return N::of(0);
  const T allowed = coefficient * N::max(normal_speed, -normal_speed);
  return N::select(tangential_speed > allowed, allowed / N::max(tangential_speed, allowed), N::of(1));
}

/// Fraction of a change of the surface's reaction that friction adopts in a step of dt [s]: friction follows the
/// reaction with a delay of 1 ms. Without a delay, the sliding of an elastic body is ill-posed, and friction would feed
/// its vibrations. The delay is the law of Prakash & Clifton in its simplest form (Cochard & Rice 2000).
template <class T>
FRONTALIS_LAW T friction_response(const T& dt)
{
  return dt / (dt + Number<T>::of(1e-3));
}

}  // namespace physics
}  // namespace frontalis
