#pragma once

#include "frontalis/physics/contact.hpp"
#include "frontalis/physics/surface_foot.hpp"

namespace frontalis
{
namespace physics
{

// Ranges over which the force on a point grows from zero to its full value, so that it does not jump. `opposed`: range
// of the cosine between the point's own inward normal and the normal of the surface that it touches; `upright`: range
// of the cosine between that surface normal and the normal of its triangle; `rim`: range of the distance beyond the rim
// of a surface, divided by the height of the triangle at the rim.
constexpr double opposed = 0.25;
constexpr double least_upright = 0.2, upright = 0.4;
constexpr double rim_begin = 0.1, rim_end = 0.3;

/// Constants of a pair that may touch: a point of the tissue and a triangle of another surface of the tissue.
template <class T>
struct TouchingPair
{
  T stiffness;  ///< of the point [N/m]
  T softer[3];  ///< stiffness per area at the triangle's corners, divided by that at the point
  T inner[3];   ///< 0 if the surface ends at the edge opposite to the corner, else 1
  T overlap;    ///< gap at rest, not positive; the depth of contact is measured from it [m]
  T friction;   ///< Coulomb's coefficient
};

/// State of friction of a pair, kept from step to step.
template <class T>
struct PairGrip
{
  T stiffness;       ///< stiffness of the pair when it touched last [N/m]; 0: it does not touch
  T pressed, along;  ///< normal and tangential force, like Grip::normal and Grip::along [N]
  Vec3<T> stretch;   ///< displacement, along the surface, of the spring that makes the point stick [m]
};

template <class T>
struct PairForce
{
  Vec3<T> point;      ///< force on the point [N]
  Vec3<T> corner[3];  ///< forces on the triangle's corners [N]
  Vec3<T> turn[3];    ///< moments on the corners' normals: corner_turn() [N m]
  T stored, lost;     ///< energy stored by contact, dissipated by friction in this step [J]
};

template <class T>
FRONTALIS_LAW T ramp(const T& x)
{
  return Number<T>::min(Number<T>::max(x, Number<T>::of(0)), Number<T>::of(1));
}

/// Stiffness of a pair in contact [N/m], that of its softer side. The stiffness is 0 beyond a rim, and where the
/// surfaces do not face each other. `normal`: outward normal of the tissue at the point.
template <class T>
FRONTALIS_LAW T pair_stiffness(const TouchingPair<T>& pair, const SurfaceFoot<T>& foot, const Vec3<T>& normal)
{
  using N = Number<T>;
  const T upright_share =
      (dot(foot.normal, foot.facet_normal) - N::of(least_upright)) * N::of(1 / (upright - least_upright));
  T share = ramp(N::of(-1 / opposed) * dot(foot.normal, normal)) * ramp(upright_share);
  T per_area = N::of(0), inside = N::of(0);
  for (int i = 0; i < 3; ++i)
  {
    const T beyond_rim = ramp((foot.weight[i] + N::of(rim_end)) * N::of(1 / (rim_end - rim_begin)));
    share = share * N::max(beyond_rim, pair.inner[i]);
    const T weight = N::max(foot.weight[i], N::of(0));
    per_area = per_area + weight * pair.softer[i];
    inside = inside + weight;
  }
  return share * pair.stiffness * N::min(N::of(1), per_area / inside);
}

/// Forces between a point and a triangle, and the update of their grip. `gap`: gap less the pair's overlap;
/// `stiffness`: pair_stiffness(); `slip`: the point's displacement relative to the triangle in this step, used if they
/// touched in the previous step; `response`: friction_response(). Without friction (`rubs` is false) the grip holds the
/// stiffness alone.
template <bool rubs, class T>
FRONTALIS_LAW PairForce<T> touch_pair(const TouchingPair<T>& pair, const SurfaceTriangle<T>& triangle,
                                      const SurfaceFoot<T>& foot, const T& gap, const T& stiffness, const Vec3<T>& slip,
                                      const T& response, PairGrip<T>& grip)
{
  using N = Number<T>;
  const T none = N::of(0);
  const T pressed = none - stiffness * gap;
  PairForce<T> force;
  force.point = pressed * foot.gradient;
  for (int i = 0; i < 3; ++i)
  {
    force.corner[i] = corner_force(triangle, foot, i, pressed);
    force.turn[i] = corner_turn(triangle, foot, i, pressed);
  }
  force.stored = N::of(-0.5) * pressed * gap;
  force.lost = none;
  if constexpr (rubs)
  {
    const auto touches = stiffness > none, touched = grip.stiffness > none;
    const T stays = N::select(touched, N::of(1), none);
    const auto held = touch<T>({ gap, foot.gradient, none, none }, stays * (grip.stretch + slip),
                               { { none, none, none }, grip.pressed, grip.along }, stiffness, pair.friction, response);
    const Vec3<T> along = held.force - force.point;
    force.point = held.force;
    for (int i = 0; i < 3; ++i)
      force.corner[i] = force.corner[i] + corner_drag(foot, i, along);
    force.stored = held.stored;
    // A point that leaves the surface loses the energy of its stretch, as in let_go().
    const T left = N::of(0.5 / sticking_stiffness) * grip.along * grip.along / N::max(grip.stiffness, N::of(1e-20));
    force.lost = N::select(touches, held.lost, left);
    const auto remembers = held.grip.normal > pair.stiffness * N::of(forgotten_depth);
    grip.pressed = N::select(touches, held.grip.normal, N::select(remembers, held.grip.normal, none));
    grip.along = N::select(touches, held.grip.along, none);
    grip.stretch = (N::of(-1 / sticking_stiffness) / N::max(stiffness, N::of(1e-20))) * along;
  }
  grip.stiffness = stiffness;
  return force;
}

}  // namespace physics
}  // namespace frontalis
