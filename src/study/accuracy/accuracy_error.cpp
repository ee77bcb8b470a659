// Finds differences between skins, and their order of convergence in the voxel edge.

#include "study/accuracy/accuracy_run.hpp"

#include "frontalis/error.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace frontalis
{
namespace
{

using Position = std::array<float, 3>;
using Points = std::vector<Position>;

// Difference between the displacements of point p in two motions [m].
double displacement_difference(const Points& a, const Points& a_rest, const Points& b, const Points& b_rest,
                               std::size_t p)
{
  double square = 0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double d =
        (static_cast<double>(a[p][axis]) - a_rest[p][axis]) - (static_cast<double>(b[p][axis]) - b_rest[p][axis]);
    square += d * d;
  }
  return std::sqrt(square);
}

constexpr double reach = 3;  // radius beyond which the Gaussian is cut off, in standard deviations

using Cube = std::array<std::int64_t, 3>;

Cube cube_of(const Position& p, double edge)
{
  const auto along = [=](float x) { return static_cast<std::int64_t>(std::floor(x / edge)); };
  return { { along(p[0]), along(p[1]), along(p[2]) } };
}

}  // namespace

std::vector<SkinError> skin_errors(const VariantMotion& found, const VariantMotion& exact)
{
  if (found.area.size() != exact.area.size() || found.phases.size() != exact.phases.size())
    throw Error(
        fmt::format("its skin has {} vertices, that of the reference {}: crop the skin to where every setting has "
                    "voxels",
                    found.area.size(), exact.area.size()));
  std::vector<SkinError> errors;
  for (std::size_t p = 0; p < found.phases.size(); ++p)
  {
    double sum = 0, area = 0, largest = 0;
    for (std::size_t v = 0; v < found.area.size(); ++v)
    {
      const double d = displacement_difference(found.phases[p].vertices, found.phases[0].vertices,
                                               exact.phases[p].vertices, exact.phases[0].vertices, v);
      sum += exact.area[v] * d * d;
      area += exact.area[v];
      largest = std::max(largest, d);
    }
    errors.push_back({ area > 0 ? std::sqrt(sum / area) : 0, largest });
  }
  return errors;
}

SkinError worst(const std::vector<SkinError>& errors)
{
  SkinError all{ 0, 0 };
  for (const SkinError& error : errors)
    all = { std::max(all.rms, error.rms), std::max(all.largest, error.largest) };
  return all;
}

double landmark_error(const VariantMotion& found, const VariantMotion& exact)
{
  if (found.phases.empty() || found.phases[0].landmarks.empty())
    return NAN;
  double largest = 0;
  for (std::size_t p = 0; p < found.phases.size(); ++p)
    for (std::size_t l = 0; l < found.phases[p].landmarks.size(); ++l)
      largest = std::max(largest, displacement_difference(found.phases[p].landmarks, found.phases[0].landmarks,
                                                          exact.phases[p].landmarks, exact.phases[0].landmarks, l));
  return largest;
}

double motion_size(const VariantMotion& motion)
{
  VariantMotion still = motion;
  std::fill(still.phases.begin(), still.phases.end(), motion.phases[0]);
  return worst(skin_errors(motion, still)).rms;
}

VariantMotion settled_part(const VariantMotion& motion)
{
  VariantMotion part = motion;
  part.phases = { motion.phases.front(), motion.phases.back() };
  return part;
}

VariantMotion exact_motion(const VariantMotion& like, const std::function<Vector3(const Vector3&)>& displacement)
{
  VariantMotion exact = settled_part(like);
  exact.phases.back() = exact.phases.front();
  for (auto* const places : { &exact.phases.back().vertices, &exact.phases.back().landmarks })
    for (auto& place : *places)
    {
      const auto moved = displacement({ { place[0], place[1], place[2] } });
      for (int axis = 0; axis < 3; ++axis)
        place[axis] += static_cast<float>(moved[axis]);
    }
  return exact;
}

double observed_order(const std::array<double, 3>& edges, double coarse, double fine)
{
  // The order p solves coarse / fine = (h1^p - h2^p) / (h2^p - h3^p), whose right side increases with p.
  const auto excess = [&](double p)
  {
    return (std::pow(edges[0], p) - std::pow(edges[1], p)) * fine -
           (std::pow(edges[1], p) - std::pow(edges[2], p)) * coarse;
  };
  constexpr double low = 1e-3, high = 8;
  return excess(low) < 0 && excess(high) > 0 ? zero_between(low, high, excess) : NAN;
}

double richardson(double before, double finest, double difference, double order)
{
  return difference / (std::pow(before / finest, is_credible(order) ? order : least_credible_order) - 1);
}

SkinAverage::SkinAverage(const VariantMotion& reference, double deviation) : weights_(reference.area.size())
{
  const auto& rest = reference.phases.at(0).vertices;
  // The cubes are as large as the cut-off radius, so that all neighbours of a vertex are in its cube or the 26 around
  // it.
  std::map<Cube, std::vector<std::size_t>> cubes;
  for (std::size_t v = 0; v < weights_.size(); ++v)
    cubes[cube_of(rest[v], reach * deviation)].push_back(v);
  for (std::size_t v = 0; v < weights_.size(); ++v)
  {
    const Cube middle = cube_of(rest[v], reach * deviation);
    float sum = 0;
    for (int i = 0; i < 27; ++i)
    {
      const auto found = cubes.find({ { middle[0] + i % 3 - 1, middle[1] + i / 3 % 3 - 1, middle[2] + i / 9 - 1 } });
      if (found == cubes.end())
        continue;
      for (const std::size_t other : found->second)
      {
        double square = 0;
        for (int axis = 0; axis < 3; ++axis)
          square += std::pow((static_cast<double>(rest[v][axis]) - rest[other][axis]) / deviation, 2);
        if (square > reach * reach)
          continue;
        weights_[v].emplace_back(other, static_cast<float>(std::exp(-0.5 * square)) * reference.area[other]);
        sum += weights_[v].back().second;
      }
    }
    for (auto& weight : weights_[v])
      weight.second = sum > 0 ? weight.second / sum : static_cast<float>(weight.first == v);
  }
  reference_ = of(reference);
}

VariantMotion SkinAverage::of(const VariantMotion& motion) const
{
  VariantMotion averaged = motion;
  const auto& rest = motion.phases[0].vertices;
  for (std::size_t p = 1; p < motion.phases.size(); ++p)
    for (std::size_t v = 0; v < weights_.size(); ++v)
    {
      auto place = rest[v];
      for (const auto& [other, weight] : weights_[v])
        for (int axis = 0; axis < 3; ++axis)
          place[axis] += weight * (motion.phases[p].vertices[other][axis] - rest[other][axis]);
      averaged.phases[p].vertices[v] = place;
    }
  return averaged;
}

SkinError SkinAverage::error(const VariantMotion& motion) const { return worst(skin_errors(of(motion), reference_)); }

}  // namespace frontalis
