#include "bake/shapes/head/head.hpp"

namespace frontalis
{
namespace
{

// A site is a place on the skin where the depth of the bone is known. The hull's field is given at the bone's point and
// at two further points, one outside and one inside of it at this distance, which set the slope of the field.
constexpr double slope_distance = 6e-3;  // [m]
// Weight of smoothness. Where sites contradict each other, the hull may miss a site by a few tenths of a millimetre.
constexpr double smoothing = 1e-3;

}  // namespace

HeadBones::HeadBones(const HeadTemplate& head, const TriangleTree& skin, double tissue)
    : eye_(to_vector(head.eye)),
      eye_radius_(head.eye_radius),
      bones_(head.bones.begin(), head.bones.end()),
      bodies_(head.bodies.begin(), head.bodies.end())
{
  std::vector<Vector3d> places;
  std::vector<double> value;
  const auto add = [&](Vector3d p, double v)
  {
    places.push_back(p);
    value.push_back(v);
    if (std::abs(p[1]) < 1e-6)
      return;
    p[1] = -p[1];
    places.push_back(p);
    value.push_back(v);
  };
  for (const auto& site : head.depths)
  {
    const ClosestPoint closest = skin.closest(to_vector(site.at));
    const auto [a, b, c] = corners(skin.mesh(), skin.mesh().triangles[closest.triangle]);
    Vector3d inward = to_vector(site.direction);
    // Sites with a direction are those of the teeth and the chin. Their depth does not follow the amount of tissue.
    const bool normal = inward.norm() < 0.5;
    if (normal)
      inward = -(b - a).cross(c - a).normalized();
    if (site.at[1] == 0)
      inward[1] = 0;
    inward.normalize();
    Vector3d place = closest.point;
    if (site.at[1] == 0)
      place[1] = 0;
    const Vector3d bone = place + (normal ? tissue : 1) * site.depth * inward;
    add(bone, 0);
    add(bone - slope_distance * inward, slope_distance);
    add(bone + slope_distance * inward, -slope_distance);
  }
  hull_.emplace(std::move(places), value, RadialField::Polynomial::linear, smoothing);
}

HeadBones::Bone::Bone(const std::vector<HeadTemplate::BoneStep>& from)
{
  for (const auto& step : from)
    steps.push_back({ step.kind, { step.solids.begin(), step.solids.end() }, step.round });
}

double HeadBones::Bone::operator()(const Vector3d& p, double hull) const
{
  using Kind = HeadTemplate::BoneStep::Kind;
  const Vector3d left{ p[0], std::abs(p[1]), p[2] };
  double f = 1;  // far from any bone [m]
  for (const Step& step : steps)
  {
    double shared = -1;
    for (const HeadSolid& solid : step.solids)
      shared = smooth_max(shared, solid(left, hull), step.round);
    f = step.kind == Kind::add   ? smooth_min(f, shared, step.round)
        : step.kind == Kind::cut ? smooth_max(f, -shared, step.round)
                                 : smooth_max(f, shared, step.round);
  }
  return f;
}

double HeadBones::part(const std::string& name, const Vector3d& p) const
{
  const auto bone = bones_.find(name);
  return bone != bones_.end() ? bone->second(p, hull(p)) : bodies_.at(name)(p, hull(p));
}

double HeadBones::any(const Vector3d& p) const
{
  const double h = hull(p);
  double least = (Vector3d(p[0], std::abs(p[1]), p[2]) - eye_).norm() - eye_radius_;
  for (const auto& [name, bone] : bones_)
    least = std::min(least, bone(p, h));
  return least;
}

}  // namespace frontalis
