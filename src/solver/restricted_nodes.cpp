#include "restricted_nodes.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

using Point = SurfaceTree::Point;

template <class Entry>
auto range(std::vector<Entry>& entries, std::int32_t first, std::int32_t last)
{
  const auto before = [](const Entry& entry, std::int32_t node) { return entry.node < node; };
  return std::make_pair(std::lower_bound(entries.begin(), entries.end(), first, before),
                        std::lower_bound(entries.begin(), entries.end(), last, before));
}

template <class Entry>
void sort_by_node(std::vector<Entry>& entries)
{
  std::stable_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.node < b.node; });
}

std::array<double, 3> rest_position(const Model& model, std::int32_t node)
{
  const auto& n = model.nodes[node];
  return { { n[0] * model.spacing[0], n[1] * model.spacing[1], n[2] * model.spacing[2] } };
}

}  // namespace

RigidTransform interpolate(const RigidTransform& from, const RigidTransform& to, double fraction)
{
  // rotation from `from` to `to` as axis and angle, then Rodrigues' formula for the part of it
  const auto& a = from.rotation;
  const auto& b = to.rotation;
  double r[3][3];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      r[i][j] = b[3 * i] * a[3 * j] + b[3 * i + 1] * a[3 * j + 1] + b[3 * i + 2] * a[3 * j + 2];
  const double sine[3] = { r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1] };
  const double twice_sine = std::sqrt(sine[0] * sine[0] + sine[1] * sine[1] + sine[2] * sine[2]);
  const double angle = std::atan2(twice_sine, r[0][0] + r[1][1] + r[2][2] - 1);
  RigidTransform result;
  double axis[3] = { 1, 0, 0 };
  if (twice_sine > 1e-12)
    for (int i = 0; i < 3; ++i)
      axis[i] = sine[i] / twice_sine;
  else if (angle > 1)
  {
    // half a turn: the axis is a column of r + 1
    int k = 0;
    for (int i = 1; i < 3; ++i)
      k = r[i][i] > r[k][k] ? i : k;
    double length = 0;
    for (int i = 0; i < 3; ++i)
    {
      axis[i] = r[i][k] + (i == k ? 1 : 0);
      length += axis[i] * axis[i];
    }
    for (double& x : axis)
      x /= std::sqrt(length);
  }
  const double part = angle * fraction, c = std::cos(part), s = std::sin(part);
  const double cross[3][3] = { { 0, -axis[2], axis[1] }, { axis[2], 0, -axis[0] }, { -axis[1], axis[0], 0 } };
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
    {
      double sum = 0;
      for (int k = 0; k < 3; ++k)
        sum += (c * (i == k) + s * cross[i][k] + (1 - c) * axis[i] * axis[k]) * a[3 * k + j];
      result.rotation[3 * i + j] = sum;
    }
  for (int i = 0; i < 3; ++i)
    result.translation[i] = from.translation[i] + fraction * (to.translation[i] - from.translation[i]);
  return result;
}

template <class Real>
RestrictedNodes<Real>::RestrictedNodes(const Model& model)
    : model_(model), rigid_(model.rigid), prescribed_(model.prescribed)
{
  for (const auto& surface : model.constraint_surfaces)
    trees_.push_back(std::make_unique<SurfaceTree>(surface.mesh));
  for (const auto& node : model.sliding)
  {
    const auto rest = rest_position(model, node.node);
    sliding_.push_back({ node.node, node.surface, node.distance, { rest[0], rest[1], rest[2] }, {} });
  }
  sort_by_node(rigid_);
  sort_by_node(prescribed_);
  sort_by_node(sliding_);
  for (const auto& s : sliding_)
    planes_.push_back({ s.node, { 0, 0, 0 }, 0, { 0, 0, 0 }, -1 });
}

template <class Real>
void RestrictedNodes<Real>::reset()
{
  for (auto& plane : planes_)
    plane.slip_squared = -1;
}

template <class Real>
void RestrictedNodes<Real>::renew(Plane& plane, Sliding& s, const Point& u)
{
  const Point p = s.rest + u;
  // the latest foot is on the surface: nothing farther can be the closest
  const double reach = plane.slip_squared < 0 ? 1e3 : norm(p - s.foot) * (1 + 1e-9) + 1e-12;
  const SurfaceTree::Closest c = trees_[s.surface]->closest(p, reach);
  if (c.triangle < 0)
    return;
  const Point away = p - c.point;
  const double distance = std::sqrt(c.squared_distance);
  // sign by the pseudonormal, and the pseudonormal itself where the point lies on the surface
  const Point normal = distance < 1e-7 ? c.normal : (dot(away, c.normal) < 0 ? -1 / distance : 1 / distance) * away;
  s.foot = c.point;
  const double part[3] = { normal.x, normal.y, normal.z }, moved[3] = { u.x, u.y, u.z };
  for (int axis = 0; axis < 3; ++axis)
  {
    plane.normal[axis] = static_cast<Real>(part[axis]);
    plane.reference[axis] = static_cast<Real>(moved[axis]);
  }
  plane.offset = static_cast<Real>(s.distance - dot(normal, s.rest - c.point));
  plane.slip_squared = static_cast<Real>(c.slip * c.slip);
}

template <class Real>
void RestrictedNodes<Real>::apply(std::int32_t first, std::int32_t last, Real* const u[3], Real* const v[3],
                                  const Real* const before[3], const Drive& drive)
{
  const auto slides = range(planes_, first, last);
  for (auto plane = slides.first; plane != slides.second; ++plane)
  {
    const auto n = plane->node;
    const Real x = u[0][n], y = u[1][n], z = u[2][n];
    const Real dx = x - plane->reference[0], dy = y - plane->reference[1], dz = z - plane->reference[2];
    if (dx * dx + dy * dy + dz * dz > plane->slip_squared)
      renew(*plane, sliding_[plane - planes_.begin()], { double(x), double(y), double(z) });
    const Real* normal = plane->normal;
    const Real error = normal[0] * x + normal[1] * y + normal[2] * z - plane->offset;
    const Real speed = normal[0] * v[0][n] + normal[1] * v[1][n] + normal[2] * v[2][n];
    for (int axis = 0; axis < 3; ++axis)
    {
      u[axis][n] -= error * normal[axis];
      v[axis][n] -= speed * normal[axis];
    }
  }

  const auto prescriptions = range(prescribed_, first, last);
  for (auto p = prescriptions.first; p != prescriptions.second; ++p)
  {
    const Load& load = model_.loads[p->load];
    const double now = load.ramp > 0 ? std::min(drive.time / load.ramp, 1.0) : 1.0;
    for (int axis = 0; axis < 3; ++axis)
      if (load.fixed[axis])
      {
        u[axis][p->node] = static_cast<Real>(load.value[axis] * now);
        v[axis][p->node] = (u[axis][p->node] - before[axis][p->node]) / static_cast<Real>(drive.dt);
      }
  }

  const auto rigids = range(rigid_, first, last);
  for (auto r = rigids.first; r != rigids.second; ++r)
  {
    if (r->bone < 0)
    {
      for (int axis = 0; axis < 3; ++axis)
        u[axis][r->node] = v[axis][r->node] = 0;
      continue;
    }
    const auto rest = rest_position(model_, r->node);
    const RigidTransform& pose = drive.bone[r->bone];
    for (int axis = 0; axis < 3; ++axis)
    {
      double x = pose.translation[axis] - rest[axis];
      for (int j = 0; j < 3; ++j)
        x += pose.rotation[3 * axis + j] * rest[j];
      u[axis][r->node] = static_cast<Real>(x);
      v[axis][r->node] = (u[axis][r->node] - before[axis][r->node]) / static_cast<Real>(drive.dt);
    }
  }
}

template class RestrictedNodes<float>;
template class RestrictedNodes<double>;

}  // namespace frontalis
