#pragma once

#include "bake/fibres/nurbs_volume.hpp"
#include "bake/mesh/surface_mesh.hpp"
#include "frontalis/scene/geometry.hpp"
#include "frontalis/scene/tissue.hpp"

#include <functional>

namespace frontalis
{

/// The middle surface of a muscle through curves. The curves lie across the fibres, from the origin to the insertion,
/// or are loops along them, from the inner to the outer one (a ring). Positions on it are given by the shares u of the
/// way along the fibres and s of the way across them, each from 0 to 1.
class MuscleSheet
{
public:
  MuscleSheet(std::vector<std::vector<Vector3>> curves, bool ring) : curves_(std::move(curves)), ring_(ring) {}

  Vector3d at(double u, double s) const;
  /// Interpolates `values`, one per curve, at the position (u, s).
  double between(const std::vector<double>& values, double u, double s) const;
  /// Position between the curves, from 0 to the number of curves - 1.
  double position(double u, double s) const;
  /// Thickness divided by the mean thickness in the middle: edges and ends are thin.
  double relative_thickness(double u, double s) const;
  /// The control net whose points are `sides(u, s)`, one on each side of the middle surface. They are at most 5 mm
  /// apart along the surface, and there are at least 12 of them along the fibres and 13 across them.
  ControlNet net(const std::function<std::array<Vector3d, 2>(double u, double s)>& sides) const;

private:
  std::vector<std::vector<Vector3>> curves_;
  bool ring_;
};

/// The control net of a shape of the kind `muscle`.
ControlNet curved_muscle_net(const Shape& shape);

/// The NURBS volume of a control net.
NurbsVolume volume_of(const ControlNet& net);

/// Surface of the NURBS volume of a control net, with edges of about `edge` [m]: all of it, which is closed, or one
/// side alone, for a volume without a thickness.
TriangleMesh net_surface(const ControlNet& net, double edge, bool closed = true);

}  // namespace frontalis
