#pragma once

#include "frontalis/physics/number.hpp"

namespace frontalis
{
namespace physics
{

/// A triangle of a thin layer at rest, with the three vertices opposite to its edges: vertex 3 + i lies beyond the edge
/// opposite to corner i. Lengths are relative to corner 0, so that single precision suffices.
template <class T>
struct ShellTriangle
{
  Vec3<T> from_corner[5];  ///< vertices 1 to 5 relative to corner 0 [m]
  T metric[3];          ///< inverse of the matrix of scalar products of the two edges from corner 0: 11, 12, 22 [1/m2]
  T inverse_area;       ///< 1 over twice the area [1/m2]
  T shear, dilatation;  ///< Lame's constants in plane stress, times thickness and area [J]
  T height[3];          ///< of vertices 3..5 above the triangle's plane [m]
  T bending[6];         ///< matrix of the bending energy as a form of heights: 11, 12, 13, 22, 23, 33 [J/m2]
};

template <class T>
struct ShellReaction
{
  Vec3<T> force[6];     ///< on the six vertices [N]
  T membrane, bending;  ///< energies [J]
};

/// Forces on the vertices of a triangle that have the displacements `u` [m].
///
/// Membrane: with the singular values s1, s2 of the triangle's deformation gradient,
///   E = t A (mu ((s1 - 1)^2 + (s2 - 1)^2) + lambda/2 (s1 + s2 - 2)^2),
/// where lambda is Lame's first constant of plane stress. This is the energy of linear elasticity in Biot's strain,
/// which is exact for small strains and any rotation. No deformed state is stiffer than the state at rest, so that the
/// bound of the time step at rest holds. Only the trace of C = F^T F and the ratio J of areas are needed, because (s1 +
/// s2)^2 = tr C + 2 J.
///
/// Bending: the heights of the three outer vertices above the triangle's plane determine the quadratic surface through
/// all six vertices, and so the triangle's curvature (ShellMesh has the matrix). Heights are used rather than angles
/// between triangles, because their forces are along the triangle's normal, need no normals of neighbours, and give the
/// energy of a constant curvature exactly on any mesh. In a fold by the angle a, sin a takes the place of a.
template <class T>
FRONTALIS_LAW ShellReaction<T> shell_forces(const ShellTriangle<T>& rest, const Vec3<T>* u)
{
  using N = Number<T>;
  Vec3<T> at[5];
  FRONTALIS_UNROLL
  for (int i = 0; i < 5; ++i)
    at[i] = rest.from_corner[i] + (u[i + 1] - u[0]);
  const Vec3<T>&a = at[0], &b = at[1];
  const Vec3<T> area = cross(a, b);
  const T length = N::sqrt(N::max(dot(area, area), N::of(1e-30)));
  const T inverse = T(1) / length;
  const Vec3<T> normal = inverse * area;

  const Vec3<T> along_a = rest.metric[0] * a + rest.metric[1] * b, along_b = rest.metric[1] * a + rest.metric[2] * b;
  const Vec3<T> across_a = cross(b, normal), across_b = cross(normal, a);  // gradients of the doubled area
  const T trace = dot(along_a, a) + dot(along_b, b);
  const T ratio = length * rest.inverse_area;
  const T sum = N::sqrt(trace + N::of(2) * ratio);
  const T dilated = sum - N::of(2);
  const T per_sum = rest.dilatation * dilated - N::of(2) * rest.shear;  // dE / d(s1 + s2)
  const T along_sum = per_sum / sum;
  const T per_trace = rest.shear + N::of(0.5) * along_sum;
  const T per_area = rest.inverse_area * along_sum;

  ShellReaction<T> out;
  out.membrane = rest.shear * (trace - N::of(2) * sum + N::of(2)) + N::of(0.5) * rest.dilatation * dilated * dilated;
  out.force[1] = N::of(-2) * per_trace * along_a - per_area * across_a;
  out.force[2] = N::of(-2) * per_trace * along_b - per_area * across_b;

  T change[3], moment[3], on_a = N::of(0), on_b = N::of(0), on_all = N::of(0);
  FRONTALIS_UNROLL
  for (int i = 0; i < 3; ++i)
    change[i] = dot(at[i + 2], normal) - rest.height[i];
  const T* const m = rest.bending;
  moment[0] = m[0] * change[0] + m[1] * change[1] + m[2] * change[2];
  moment[1] = m[1] * change[0] + m[3] * change[1] + m[4] * change[2];
  moment[2] = m[2] * change[0] + m[4] * change[1] + m[5] * change[2];
  FRONTALIS_UNROLL
  for (int i = 0; i < 3; ++i)
  {
    // An outer vertex pulls at the corners in proportion to its barycentric coordinates.
    on_a = on_a + (inverse * dot(at[i + 2], across_a)) * moment[i];
    on_b = on_b + (inverse * dot(at[i + 2], across_b)) * moment[i];
    on_all = on_all + moment[i];
    out.force[i + 3] = T(-1) * moment[i] * normal;
  }
  out.bending = N::of(0.5) * (moment[0] * change[0] + moment[1] * change[1] + moment[2] * change[2]);
  out.force[0] = T(-1) * (out.force[1] + out.force[2]) + (on_all - on_a - on_b) * normal;
  out.force[1] = out.force[1] + on_a * normal;
  out.force[2] = out.force[2] + on_b * normal;
  return out;
}

}  // namespace physics
}  // namespace frontalis
