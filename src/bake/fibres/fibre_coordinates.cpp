#include "frontalis/error.hpp"
#include "bake/fibres/grid_field.hpp"

#include <numeric>

namespace frontalis
{
namespace
{

CornerField corners_of(const MuscleGrid& grid, const Eigen::VectorXd& nodal)
{
  CornerField field;
  for (const auto& nodes : grid.cell_nodes)
  {
    std::array<double, 8> values{};
    for (std::size_t b = 0; b < 8; ++b)
      values[b] = nodal(nodes[b]);
    field.push_back(values);
  }
  return field;
}

/// Harmonic field around the hole, in revolutions: the azimuth plus a correction that minimises its energy.
CornerField around(const MuscleGrid& grid, const RingHole& hole, const GridField& field)
{
  const Vector3d aside = std::abs(hole.axis[0]) < 0.6 ? Vector3d::UnitX() : Vector3d::UnitY();
  const Vector3d x = hole.axis.cross(aside).normalized(), y = hole.axis.cross(x);
  std::vector<double> revolutions;
  for (std::size_t n = 0; n < grid.nodes.size(); ++n)
  {
    const Vector3d d = grid.node_position(n) - hole.centre;
    revolutions.push_back(std::atan2(d.dot(y), d.dot(x)) / (2 * pi));
  }
  CornerField azimuth;
  for (const auto& nodes : grid.cell_nodes)
  {
    std::array<double, 8> values{};
    const double first = revolutions[nodes[0]];
    for (std::size_t b = 0; b < 8; ++b)
    {
      const double difference = revolutions[nodes[b]] - first;
      values[b] = first + difference - std::round(difference);
    }
    azimuth.push_back(values);
  }
  const CornerField correction = corners_of(grid, field.balance(azimuth));
  for (std::size_t c = 0; c < azimuth.size(); ++c)
    for (std::size_t b = 0; b < 8; ++b)
      azimuth[c][b] += correction[c][b];
  return azimuth;
}

/// Nodes at an end of the muscle: those that are at most 0.75 cell edges farther from the end than the nearest node.
std::vector<std::int32_t> nodes_at(const MuscleGrid& grid, const std::function<double(const Vector3d&)>& distance)
{
  std::vector<double> distances;
  for (std::size_t n = 0; n < grid.nodes.size(); ++n)
    distances.push_back(distance(grid.node_position(n)));
  const double near = std::max(0.0, *std::min_element(distances.begin(), distances.end())) + 0.75 * grid.edge;
  std::vector<std::int32_t> nodes;
  for (std::size_t n = 0; n < grid.nodes.size(); ++n)
    if (distances[n] <= near)
      nodes.push_back(static_cast<std::int32_t>(n));
  return nodes;
}

Eigen::VectorXd between_ends(const MuscleGrid& grid, const FibreGuide& guide, const GridField& field)
{
  const auto origin = nodes_at(grid, guide.origin), insertion = nodes_at(grid, guide.insertion);
  std::vector<std::int32_t> shared;
  std::set_intersection(origin.begin(), origin.end(), insertion.begin(), insertion.end(), std::back_inserter(shared));
  if (!shared.empty())
    throw Error("its origin and insertion are at the same place; they must be different");
  std::vector<std::pair<std::int32_t, double>> fixed;
  fixed.reserve(origin.size() + insertion.size());
  for (const std::int32_t n : origin)
    fixed.emplace_back(n, 0.0);
  for (const std::int32_t n : insertion)
    fixed.emplace_back(n, 1.0);
  return field.between(fixed);
}

double at(const std::array<double, 8>& corners, const std::array<double, 8>& weights)
{
  return std::inner_product(weights.begin(), weights.end(), corners.begin(), 0.0);
}

/// Starting fields for subspace iteration: functions of low order, which overlap with every slow mode.
Eigen::MatrixXd starting_fields(const MuscleGrid& grid)
{
  Eigen::MatrixXd fields(grid.nodes.size(), 6);
  Vector3d mean{ 0, 0, 0 };
  for (std::size_t n = 0; n < grid.nodes.size(); ++n)
    mean += (1.0 / static_cast<double>(grid.nodes.size())) * grid.node_position(n);
  for (std::size_t n = 0; n < grid.nodes.size(); ++n)
  {
    const Vector3d p = grid.node_position(n) - mean;
    fields.row(n) << p[0], p[1], p[2], p.norm(), p[0] * p[1] / (p.norm() + grid.edge),
        p[1] * p[2] / (p.norm() + grid.edge);
  }
  return fields;
}

}  // namespace

FibreCoordinates fibre_coordinates(const MuscleGrid& grid, const FibreGuide& guide)
{
  const double reach = std::max(2 * grid.edge, 0.04 * grid.box().diagonal().norm());
  const auto shown = surface_directions(grid, reach);

  FibreCoordinates result;
  result.distinctness = std::numeric_limits<double>::infinity();
  CornerField along;
  std::vector<SurfaceDirection> trusted = shown;
  std::vector<Vector3d> gradients(grid.cells.size());
  for (int turn = 0; turn < 2; ++turn)
  {
    const GridField field(grid, conductivities(trusted));
    if (guide.ring)
      along = around(grid, *guide.ring, field);
    else if (guide.origin)
      along = corners_of(grid, between_ends(grid, guide, field));
    else
    {
      const auto modes = field.slowest_modes(starting_fields(grid));
      along = corners_of(grid, modes.fields.col(0));
      if (turn == 0)
        result.distinctness = std::sqrt(modes.values(1) / modes.values(0));
    }
    for (std::size_t c = 0; c < along.size(); ++c)
      gradients[c] = gradient(grid, along[c]);
    trusted = blend(grid, reach, shown, gradients);
  }

  // Heat is conducted almost only along the fibres, so that the slowest mode varies across them and hardly along them.
  std::vector<Vector3d> fibres;
  fibres.reserve(trusted.size());
  for (const SurfaceDirection& fibre : trusted)
    fibres.push_back(fibre.direction);
  const GridField field(grid, fibres, 1e-4);
  const CornerField across = corners_of(grid, field.slowest_modes(starting_fields(grid)).fields.col(0));

  const DistanceTable length(grid, along, guide.ring.has_value()), width(grid, across, false);
  result.length = length.length();
  result.width = width.length();
  const auto coordinates = [&](std::size_t cell, const std::array<double, 8>& weights)
  {
    const double u = at(along[cell], weights);
    return std::array<double, 2>{ length(guide.ring ? u - std::floor(u) : u) / result.length,
                                  width(at(across[cell], weights)) / result.width };
  };
  std::array<double, 8> middle{};
  middle.fill(0.125);
  for (std::size_t c = 0; c < grid.cells.size(); ++c)
    result.cells.push_back(coordinates(c, middle));
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  for (const MuscleGrid::Sample& sample : grid.samples)
    result.samples.push_back(sample.cell < 0 ? std::array<double, 2>{ none, none }
                                             : coordinates(sample.cell, grid.weights(sample.cell, sample.point)));
  // The coordinates are stretched so that fibres end where the muscle ends and follow its sides.
  if (!guide.ring)
  {
    // Near an end, which may be cut obliquely, the limits found 1.5 widths away from the end are used.
    stretch(grid, 1, false, std::min(0.45, 1.5 * result.width / result.length), result);
    stretch(grid, 0, false, 0, result);
  }
  stretch(grid, 1, guide.ring.has_value(), 0, result);
  return result;
}

}  // namespace frontalis
