#include "bake/shapes/head/head.hpp"

#include <Eigen/Dense>

namespace frontalis
{
namespace
{

// Half the distance between the two points, outside and inside, that give the hull's field its slope at a site.
constexpr double slope_distance = 6e-3;  // [m]
// Weight of smoothness: lets the hull miss a site by a few tenths of a millimetre where sites contradict each other.
constexpr double smoothing = 1e-3;
// Radius of the edges between the surfaces that a bone is cut with.
constexpr double rounding = 2e-3;  // [m]

/// Larger of two values, rounded where they are equal.
double smooth_max(double a, double b, double r = rounding)
{
  const double h = std::max(0.0, r - std::abs(a - b)) / r;
  return std::max(a, b) + 0.25 * h * h * r;
}
double smooth_min(double a, double b, double r = rounding) { return -smooth_max(-a, -b, r); }

double ellipsoid(const Vector3d& p, const Vector3d& centre, const Vector3d& axes)
{
  const Vector3d q = (p - centre).cwiseQuotient(axes);
  const double n = q.norm(), g = q.cwiseQuotient(axes).norm();
  return g > 1e-9 ? n * (n - 1) / g : -axes.minCoeff();
}

// Heights of the default head [m]: lower edge of the upper jaw's bone, its teeth, the lower teeth, upper edge of the
// mandible's body. Lips meet at -73.5 mm; upper incisors end 2 mm below, and the rows are 2 mm apart at rest.
constexpr double upper_bone = -65e-3, upper_edge = -75.2e-3, lower_edge = -77e-3, lower_bone = -86.5e-3;

}  // namespace

HeadBones::HeadBones(const HeadTemplate& head, const TriangleTree& skin)
    : eye_(to_vector(head.eye)), eye_radius_(head.eye_radius)
{
  std::vector<double> value;
  const auto add = [&](Vector3d p, double v)
  {
    centres_.push_back(p);
    value.push_back(v);
    if (std::abs(p[1]) < 1e-6)
      return;
    p[1] = -p[1];
    centres_.push_back(p);
    value.push_back(v);
  };
  for (const auto& site : head.depths)
  {
    const ClosestPoint closest = skin.closest(to_vector(site.at));
    const auto [a, b, c] = corners(skin.mesh(), skin.mesh().triangles[closest.triangle]);
    Vector3d inward = to_vector(site.direction);
    if (inward.norm() < 0.5)
      inward = -(b - a).cross(c - a).normalized();
    if (site.at[1] == 0)
      inward[1] = 0;
    inward.normalize();
    Vector3d place = closest.point;
    if (site.at[1] == 0)
      place[1] = 0;
    const Vector3d bone = place + site.depth * inward;
    add(bone, 0);
    add(bone - slope_distance * inward, slope_distance);
    add(bone + slope_distance * inward, -slope_distance);
  }
  // biharmonic radial basis functions with a linear polynomial (Carr et al., SIGGRAPH 2001)
  const auto n = static_cast<Eigen::Index>(centres_.size());
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n + 4, n + 4);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(n + 4);
  for (Eigen::Index i = 0; i < n; ++i)
  {
    for (Eigen::Index j = 0; j < n; ++j)
      a(i, j) = (centres_[i] - centres_[j]).norm();
    a(i, i) -= smoothing;
    a(i, n) = a(n, i) = 1;
    for (int c = 0; c < 3; ++c)
      a(i, n + 1 + c) = a(n + 1 + c, i) = centres_[i][c];
    b[i] = value[i];
  }
  const Eigen::VectorXd x = a.partialPivLu().solve(b);
  weights_.assign(x.data(), x.data() + n);
  linear_ = x.tail<4>();
}

double HeadBones::hull(const Vector3d& p) const
{
  double sum = linear_[0] + linear_.tail<3>().dot(p);
  for (std::size_t i = 0; i < centres_.size(); ++i)
    sum += weights_[i] * (p - centres_[i]).norm();
  return sum;
}

double HeadBones::skull(const Vector3d& p, double hull) const
{
  const Vector3d q{ p[0], std::abs(p[1]), p[2] };
  double f = hull;
  // the base: under the face it ends above the teeth; behind, it rises to the ear and falls to the nape
  const double behind = q[0] < -100e-3 ? -42e-3 + 0.3 * (q[0] + 100e-3) : -34e-3 + 0.133 * (q[0] + 40e-3);
  const double share = std::min(1.0, std::max(0.0, (-38e-3 - q[0]) / 14e-3));
  // the edge between them is steep, and the slope of a field should be near 1
  f = smooth_max(f, 0.5 * (upper_bone + share * (behind - upper_bone) - q[2]));
  // the mouth below the palate
  f = smooth_max(f, -smooth_max(hull + 13e-3, q[2] + 53e-3));
  // orbits, 34 mm wide and 30 mm high at the rim, and the pear-shaped opening of the nose
  f = smooth_max(f, -ellipsoid(q, eye_ + Vector3d(-8e-3, 0.5e-3, 0.5e-3), { 27e-3, 19e-3, 17.5e-3 }));
  const double half_width = 11.5e-3 * std::sqrt(std::max(0.0, std::min(1.0, (-25e-3 - q[2]) / 20e-3)));
  const double pear = smooth_max(smooth_max(q[1] - half_width, -50e-3 - q[2]), -30e-3 - q[0]);
  return smooth_max(f, -smooth_max(pear, q[2] + 25e-3), 3e-3);
}

double HeadBones::mandible(const Vector3d& p, double hull) const
{
  const Vector3d q{ p[0], std::abs(p[1]), p[2] };
  // a horseshoe open to the back, then the ramus
  const double inner = q[1] - 46e-3 * std::sqrt(std::max(0.0, (-16e-3 - q[0]) / 75e-3));
  const double body = smooth_max(hull, smooth_max(q[2] - lower_bone, q[0] > -16e-3 ? -q[0] - 30e-3 : -inner), 5e-3);
  const double floor = smooth_max(body, -(q[2] + 117e-3));
  double f = smooth_max(floor, -85e-3 - q[0]);
  // its upper edge falls from the coronoid process in front to the notch and rises to the condyle
  const double front = q[0] + 52e-3 + 0.2 * (q[2] + 70e-3);
  const double top = q[2] + 37e-3 + 9e-3 * std::sin(pi * std::min(1.0, std::max(0.0, (q[0] + 86e-3) / 28e-3)));
  const double outline = smooth_max(smooth_max(front, -86e-3 - q[0]), smooth_max(top, -98e-3 - q[2]), 4e-3);
  f = smooth_min(f, smooth_max(smooth_max(hull, -(hull + 9e-3)), outline), 6e-3);
  return f;
}

double HeadBones::teeth(const Vector3d& p, double hull, bool upper) const
{
  const Vector3d q{ p[0], std::abs(p[1]), p[2] };
  const double middle = upper ? 0.5 * (upper_bone + upper_edge) : 0.5 * (lower_bone + lower_edge);
  const double half = upper ? 0.5 * (upper_bone - upper_edge) : 0.5 * (lower_edge - lower_bone);
  // one tooth every 7.5 mm around the arch, parted by grooves 0.6 mm deep
  const double around = 34e-3 * std::atan2(q[1], q[0] + 34e-3);
  const double groove = 0.6e-3 * std::pow(std::abs(std::cos(pi * (around / 7.5e-3 + 0.5))), 0.5);
  const double shell = smooth_max(hull + 0.6e-3 - groove, -(hull + 8.5e-3), 1e-3);
  const double row = smooth_max(shell, std::abs(q[2] - middle) - half - 0.8e-3, 1.5e-3);
  return smooth_max(row, -45e-3 - q[0], 1e-3);
}

double HeadBones::part(const std::string& name, const Vector3d& p) const
{
  const double h = hull(p);
  return name == "skull" ? skull(p, h) : name == "mandible" ? mandible(p, h) : teeth(p, h, name == "teeth_upper");
}

double HeadBones::any(const Vector3d& p) const
{
  const double h = hull(p);
  const double eye = (Vector3d(p[0], std::abs(p[1]), p[2]) - eye_).norm() - eye_radius_;
  return std::min({ skull(p, h), mandible(p, h), teeth(p, h, true), teeth(p, h, false), eye });
}

}  // namespace frontalis
