#include "frontalis/solver/rigid_motion.hpp"

#include "frontalis/solver/solver.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{

bool is_rigid_motion(const RigidTransform& pose)
{
  const auto& r = pose.rotation;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
    {
      const double product = r[3 * i] * r[3 * j] + r[3 * i + 1] * r[3 * j + 1] + r[3 * i + 2] * r[3 * j + 2];
      if (!(std::abs(product - (i == j)) < 1e-6) || !std::isfinite(pose.translation[i]))
        return false;
    }
  return r[0] * (r[4] * r[8] - r[5] * r[7]) - r[1] * (r[3] * r[8] - r[5] * r[6]) + r[2] * (r[3] * r[7] - r[4] * r[6]) >
         0;
}

RigidTransform interpolate(const RigidTransform& from, const RigidTransform& to, double fraction)
{
  if (from == to)
    return to;  // the formula would move it by rounding errors
  // Finds the axis and angle of the rotation from `from` to `to`. Rodrigues' formula then applies the fraction of the
  // angle.
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
  if (angle > 3)
  {
    // Close to half a turn the sine is small. There the axis follows from the symmetric part of r minus the cosine
    // times the identity, which is a multiple of axis * axis^T.
    int k = 0;
    for (int i = 1; i < 3; ++i)
      k = r[i][i] > r[k][k] ? i : k;
    double squared = 0, along_sine = 0;
    for (int i = 0; i < 3; ++i)
    {
      axis[i] = 0.5 * (r[i][k] + r[k][i]) - (i == k ? std::cos(angle) : 0);
      squared += axis[i] * axis[i];
      along_sine += axis[i] * sine[i];
    }
    for (double& x : axis)
      x /= std::copysign(std::sqrt(squared), along_sine);
  }
  else if (twice_sine > 0)
    for (int i = 0; i < 3; ++i)
      axis[i] = sine[i] / twice_sine;
  const double part = angle * fraction, c = std::cos(part), s = std::sin(part);
  const double cross[3][3] = { { 0, -axis[2], axis[1] }, { axis[2], 0, -axis[0] }, { -axis[1], axis[0], 0 } };
  double turn[3][3], shift[3], along = 0;
  for (int i = 0; i < 3; ++i)
  {
    shift[i] = to.translation[i];
    for (int j = 0; j < 3; ++j)
    {
      turn[i][j] = c * (i == j) + s * cross[i][j] + (1 - c) * axis[i] * axis[j];
      shift[i] -= r[i][j] * from.translation[j];
    }
    along += axis[i] * shift[i];
  }
  // The part of the relative translation along the axis is multiplied by the fraction; the rest turns about the screw's
  // axis.
  const double chord = angle > 1e-9 ? std::sin(part / 2) / std::sin(angle / 2) : fraction;
  const double ahead = chord * std::cos((angle - part) / 2), aside = chord * std::sin((angle - part) / 2);
  for (int i = 0; i < 3; ++i)
  {
    result.translation[i] = fraction * along * axis[i] + ahead * (shift[i] - along * axis[i]);
    for (int j = 0; j < 3; ++j)
    {
      result.translation[i] += turn[i][j] * from.translation[j] - aside * cross[i][j] * shift[j];
      result.rotation[3 * i + j] = 0;
      for (int k = 0; k < 3; ++k)
        result.rotation[3 * i + j] += turn[i][k] * a[3 * k + j];
    }
  }
  return result;
}

Controls interpolate(const Controls& from, const Controls& to, double fraction)
{
  Controls result = to;
  for (std::size_t m = 0; m < result.activation.size(); ++m)
    result.activation[m] = from.activation[m] + static_cast<float>(fraction) * (to.activation[m] - from.activation[m]);
  for (std::size_t b = 0; b < result.bone.size(); ++b)
    result.bone[b] = interpolate(from.bone[b], to.bone[b], fraction);
  return result;
}

RigidTransform composed(const RigidTransform& then, const RigidTransform& first)
{
  RigidTransform both;
  for (int i = 0; i < 3; ++i)
  {
    both.translation[i] = then.translation[i];
    for (int k = 0; k < 3; ++k)
      both.translation[i] += then.rotation[3 * i + k] * first.translation[k];
    for (int j = 0; j < 3; ++j)
    {
      both.rotation[3 * i + j] = 0;
      for (int k = 0; k < 3; ++k)
        both.rotation[3 * i + j] += then.rotation[3 * i + k] * first.rotation[3 * k + j];
    }
  }
  return both;
}

RigidTransform inverse(const RigidTransform& pose)
{
  RigidTransform back;
  for (int i = 0; i < 3; ++i)
  {
    back.translation[i] = 0;
    for (int j = 0; j < 3; ++j)
    {
      back.rotation[3 * i + j] = pose.rotation[3 * j + i];
      back.translation[i] -= pose.rotation[3 * j + i] * pose.translation[j];
    }
  }
  return back;
}

RigidTransform rigid_motion(const std::array<double, 3>& rotation, const std::array<double, 3>& translation)
{
  // Rodrigues' formula gives the matrix of a rotation vector.
  const double angle = std::sqrt(rotation[0] * rotation[0] + rotation[1] * rotation[1] + rotation[2] * rotation[2]);
  RigidTransform motion;
  motion.translation = translation;
  if (!(angle > 0))
    return motion;
  const double x = rotation[0] / angle, y = rotation[1] / angle, z = rotation[2] / angle;
  const double c = std::cos(angle), s = std::sin(angle), d = 1 - c;
  motion.rotation = { { c + d * x * x, d * x * y - s * z, d * x * z + s * y, d * x * y + s * z, c + d * y * y,
                        d * y * z - s * x, d * x * z - s * y, d * y * z + s * x, c + d * z * z } };
  return motion;
}

double farthest_way(const RigidTransform& from, const RigidTransform& to, const std::array<double, 3>& corner)
{
  double farthest = 0;
  for (std::size_t c = 0; c < 8; ++c)
  {
    double squared = 0;
    for (std::size_t i = 0; i < 3; ++i)
    {
      double change = to.translation[i] - from.translation[i];
      for (std::size_t j = 0; j < 3; ++j)
        if ((c >> j & 1) != 0)
          change += (to.rotation[3 * i + j] - from.rotation[3 * i + j]) * corner[j];
      squared += change * change;
    }
    farthest = std::max(farthest, std::sqrt(squared));
  }
  return farthest;
}

double fastest_way(const RigidTransform& from, const RigidTransform& to, const std::array<double, 3>& corner)
{
  // The path is divided into pieces so short that a chord differs from its arc by at most 1 % in half a turn.
  constexpr int pieces = 8;
  double fastest = 0;
  RigidTransform before = from;
  for (int piece = 1; piece <= pieces; ++piece)
  {
    const RigidTransform now = interpolate(from, to, static_cast<double>(piece) / pieces);
    fastest = std::max(fastest, pieces * farthest_way(before, now, corner));
    before = now;
  }
  return fastest;
}

}  // namespace frontalis
