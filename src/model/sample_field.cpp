#include "frontalis/model/sample_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace frontalis
{
namespace
{

using Point = std::array<double, 3>;
using physics::DistanceField;

// Distances that samples must cover [m].
struct Band
{
  double least, largest;
};

// Whether the distance is in the band somewhere in a cube, found by halving it down to `smallest` [m].
bool reaches(const Distance& distance, const Band& band, const Point& middle, double edge, double smallest)
{
  const double d = distance(middle), radius = 0.5 * std::sqrt(3.0) * edge;
  if (d < band.least - radius || d > band.largest + radius)
    return false;
  if (edge <= smallest || (d >= band.least && d <= band.largest))
    return true;
  for (int part = 0; part < 8; ++part)
  {
    Point p = middle;
    for (int axis = 0; axis < 3; ++axis)
      p[axis] += (part >> axis & 1 ? 0.25 : -0.25) * edge;
    if (reaches(distance, band, p, 0.5 * edge, smallest))
      return true;
  }
  return false;
}

Point rest_position(const Model& model, std::int32_t node)
{
  const auto& n = model.nodes[node];
  return { { n[0] * model.spacing[0], n[1] * model.spacing[1], n[2] * model.spacing[2] } };
}

// Bricks of the table within `travel` of a point.
std::vector<bool> bricks_near(const std::vector<Point>& points, double travel, const SampledField& field)
{
  const double edge = DistanceField::brick_edge * field.spacing;
  std::vector<bool> near(field.table.size(), false);
  for (const Point& p : points)
  {
    std::array<std::int32_t, 3> first{}, last{};
    for (int axis = 0; axis < 3; ++axis)
    {
      // a cell begins half a spacing before its sample
      const double x = p[axis] - field.origin[axis] + 0.5 * field.spacing;
      first[axis] = std::max(0, static_cast<std::int32_t>(std::floor((x - travel) / edge)));
      last[axis] = std::min(field.bricks[axis] - 1, static_cast<std::int32_t>(std::floor((x + travel) / edge)));
    }
    for (std::int32_t k = first[2]; k <= last[2]; ++k)
      for (std::int32_t j = first[1]; j <= last[1]; ++j)
        std::fill_n(near.begin() + (static_cast<std::ptrdiff_t>(k) * field.bricks[1] + j) * field.bricks[0] + first[0],
                    last[0] - first[0] + 1, true);
  }
  return near;
}

}  // namespace

void one_by_one(std::size_t count, const std::function<void(std::size_t)>& body)
{
  for (std::size_t n = 0; n < count; ++n)
    body(n);
}

SampledField sample_field(const std::vector<Point>& rest, const Distance& distance, double spacing, double travel,
                          const Loop& loop)
{
  SampledField field;
  field.spacing = spacing;
  if (rest.empty())
    return field;
  std::vector<double> level(rest.size());
  loop(rest.size(), [&](std::size_t n) { level[n] = distance(rest[n]); });
  const Band band{ *std::min_element(level.begin(), level.end()) - 2 * spacing,
                   *std::max_element(level.begin(), level.end()) + 2 * spacing };
  const double edge = DistanceField::brick_edge * spacing;
  for (int axis = 0; axis < 3; ++axis)
  {
    const auto range = std::minmax_element(rest.begin(), rest.end(),
                                           [&](const Point& a, const Point& b) { return a[axis] < b[axis]; });
    field.origin[axis] = (*range.first)[axis] - travel;
    field.bricks[axis] =
        1 + static_cast<std::int32_t>(((*range.second)[axis] + travel - field.origin[axis] + spacing) / edge);
  }
  field.table.resize(static_cast<std::size_t>(field.bricks[0]) * field.bricks[1] * field.bricks[2], -1);

  const std::vector<bool> near = bricks_near(rest, travel, field);
  std::vector<std::size_t> places;
  for (std::size_t b = 0; b < near.size(); ++b)
    if (near[b])
      places.push_back(b);
  std::vector<std::vector<float>> samples(places.size());
  loop(places.size(),
       [&](std::size_t n)
       {
         const std::size_t row = places[n] / field.bricks[0];
         const std::array<std::size_t, 3> brick{ { places[n] % field.bricks[0], row % field.bricks[1],
                                                   row / field.bricks[1] } };
         Point first{}, middle{};
         for (int axis = 0; axis < 3; ++axis)
         {
           first[axis] = field.origin[axis] + static_cast<double>(brick[axis]) * edge - spacing;
           middle[axis] = first[axis] + 0.5 * (edge + spacing);
         }
         if (!reaches(distance, band, middle, edge, spacing))
           return;
         samples[n].reserve(DistanceField::brick_size);
         for (int s = 0; s < DistanceField::brick_size; ++s)
         {
           constexpr int width = DistanceField::brick_row;
           const std::array<int, 3> at{ { s % width, s / width % width, s / (width * width) } };
           samples[n].push_back(static_cast<float>(
               distance({ { first[0] + at[0] * spacing, first[1] + at[1] * spacing, first[2] + at[2] * spacing } })));
         }
       });
  std::int32_t stored = 0;
  for (std::size_t n = 0; n < places.size(); ++n)
  {
    if (samples[n].empty())
      continue;
    field.table[places[n]] = stored++;
    field.samples.insert(field.samples.end(), samples[n].begin(), samples[n].end());
  }
  return field;
}

SampledField sphere_field(const Point& centre, double radius)
{
  SampledField field;
  field.origin = centre;
  field.radius = radius;
  return field;
}

DistanceField view(const SampledField& field)
{
  DistanceField view;
  std::copy(field.origin.begin(), field.origin.end(), view.origin);
  std::copy(field.bricks.begin(), field.bricks.end(), view.bricks);
  view.spacing = field.spacing;
  view.radius = field.radius;
  view.table = field.table.data();
  view.samples = field.samples.data();
  return view;
}

double level_at(const SampledField& field, const Point& p)
{
  const DistanceField of = view(field);
  physics::FieldValue<double> value{};
  const bool found = physics::sample(of, physics::field_point(of, { p[0], p[1], p[2] }), value);
  return found ? value.value : std::numeric_limits<double>::quiet_NaN();
}

std::int32_t slide_on(Model& model, const std::string& name, SampledField field, const std::vector<std::int32_t>& nodes)
{
  const auto surface = static_cast<std::int32_t>(model.constraint_surfaces.size());
  for (const auto node : nodes)
    model.sliding.push_back({ node, surface, level_at(field, rest_position(model, node)) });
  ConstraintSurface added;
  added.name = name;
  added.field = std::move(field);
  model.constraint_surfaces.push_back(std::move(added));
  return surface;
}

std::int32_t slide_on(Model& model, const std::string& name, const Distance& distance,
                      const std::vector<std::int32_t>& nodes, double spacing, double travel)
{
  std::vector<Point> rest;
  for (const auto node : nodes)
    rest.push_back(rest_position(model, node));
  return slide_on(model, name, sample_field(rest, distance, spacing, travel), nodes);
}

}  // namespace frontalis
