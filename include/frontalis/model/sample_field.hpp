#pragma once

#include "frontalis/model/model.hpp"

#include <functional>

namespace frontalis
{

/// Distance of a point from a surface [m]. The nearest point of the surface is hypot(value, past_rim) away.
struct SurfaceDistance
{
  SurfaceDistance(double signed_distance, double past = 0) : value(signed_distance), past_rim(past) {}
  /// signed distance; past the rim of an open surface, signed distance from the tangent plane at the rim
  double value;
  double past_rim;  ///< how far the point is past the rim of an open surface; 0 beside or above the surface
};
/// The distance of a point in local coordinates.
using Distance = std::function<SurfaceDistance(const std::array<double, 3>&)>;

/// Calls body(0) .. body(count - 1), in any order or in parallel.
using Loop = std::function<void(std::size_t count, const std::function<void(std::size_t)>& body)>;
void one_by_one(std::size_t count, const std::function<void(std::size_t)>& body);

/// Edge of a cube that contains a cluster of points, in spacings. Most distances are requested for clusters of points,
/// beginning with the middle point of the cluster.
constexpr double cluster_extent = 9.01;

/// Distance that sliding nodes may go from where nodes rest [m], unless a program gives another one. It is greater than
/// motions of skin.
constexpr double usual_travel = 20e-3;

/// Samples a distance every `spacing` [m] in all bricks (physics/distance_field.hpp) that sliding nodes can reach. A
/// node can reach a brick within `travel` [m] of its rest position. A brick gets samples if its distances from
/// the surface include one between the smallest and the largest distance at rest of the nodes that reach it, with a
/// margin of one spacing. Bricks past the rim are left out.
SampledField sample_field(const std::vector<std::array<double, 3>>& rest, const Distance& distance, double spacing,
                          double travel, const Loop& loop = one_by_one);

/// Samples a distance in all bricks within `reach` [m] of a surface, or within `inside` [m] on its inner side if that
/// is more. `lower`, `upper`: corners of a box around the surface.
SampledField sample_band(const std::array<double, 3>& lower, const std::array<double, 3>& upper,
                         const Distance& distance, double spacing, double reach, const Loop& loop = one_by_one,
                         double inside = 0);

/// The field of a sphere [m].
SampledField sphere_field(const std::array<double, 3>& centre, double radius);

physics::DistanceField view(const SampledField& field);

/// Value of the field at p [m]; NaN if no samples are stored there.
double level_at(const SampledField& field, const std::array<double, 3>& p);
/// Whether samples are stored within `way` [m] of the point p [m].
bool has_samples_near(const SampledField& field, const std::array<double, 3>& p, double way);

/// For models made by programs: adds a surface without friction that does not move, and lets the given nodes slide
/// along it, each at its distance at rest. Returns the index of the surface.
std::int32_t slide_on(Model& model, const std::string& name, SampledField field,
                      const std::vector<std::int32_t>& nodes);
/// Like the function above, for a surface that is given by its distance function, which is sampled here.
std::int32_t slide_on(Model& model, const std::string& name, const Distance& distance,
                      const std::vector<std::int32_t>& nodes, double spacing = 0.5e-3, double travel = usual_travel);

}  // namespace frontalis
