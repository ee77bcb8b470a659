#include "frontalis/model/sample_field.hpp"

#include "model/limit_slope.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace frontalis
{
namespace
{

using Point = std::array<double, 3>;
using physics::DistanceField;

// Range of distances [m] for which a brick must have samples.
struct Band
{
  double least = 1e300, largest = -1e300;
  bool home = false;  // whether a node rests in the brick
};

// Whether the distance is in the band anywhere in a cube. The cube is halved down to the edge `smallest` [m].
bool reaches(const Distance& distance, const Band& band, const Point& middle, double edge, double smallest)
{
  const SurfaceDistance d = distance(middle);
  const double radius = 0.5 * std::sqrt(3.0) * edge;
  // Within the cube the nearest point may jump to the rim and back, and the sign of the distance and past_rim with it.
  // The unsigned distance, however, changes by at most `radius`.
  const bool beside_band = d.value < band.least - radius || d.value > band.largest + radius;
  const bool too_far =
      std::hypot(d.value, d.past_rim) > std::max(std::abs(band.least), std::abs(band.largest)) + radius;
  if (too_far || (beside_band && d.past_rim == 0))
    return false;
  if (edge <= smallest)
    return !beside_band && d.past_rim <= radius;
  if (d.value >= band.least && d.value <= band.largest && d.past_rim == 0)
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

// Calls visit(index in the table) for the bricks within the distance `way` [m] of a point.
template <class Visit>
void visit_bricks(const SampledField& field, const Point& p, double way, const Visit& visit)
{
  const double edge = DistanceField::brick_edge * field.spacing;
  std::int32_t first[3], last[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    // The bounds of a cell are half a spacing from its sample.
    const double x = p[axis] - field.origin[axis] + 0.5 * field.spacing;
    const double count = field.bricks[axis];
    first[axis] = static_cast<std::int32_t>(std::clamp(std::floor((x - way) / edge), 0.0, count));
    last[axis] = static_cast<std::int32_t>(std::clamp(std::floor((x + way) / edge), -1.0, count - 1));
  }
  for (std::int32_t k = first[2]; k <= last[2]; ++k)
    for (std::int32_t j = first[1]; j <= last[1]; ++j)
      for (std::int32_t i = first[0]; i <= last[0]; ++i)
        visit((static_cast<std::size_t>(k) * field.bricks[1] + j) * field.bricks[0] + i);
}

// A field without samples whose table covers the box from `lower` to `upper`.
SampledField empty_field(const Point& lower, const Point& upper, double spacing)
{
  SampledField field;
  field.spacing = spacing;
  field.origin = lower;
  for (int axis = 0; axis < 3; ++axis)
    field.bricks[axis] =
        1 + static_cast<std::int32_t>((upper[axis] - lower[axis] + spacing) / (DistanceField::brick_edge * spacing));
  field.table.resize(static_cast<std::size_t>(field.bricks[0]) * field.bricks[1] * field.bricks[2], -1);
  return field;
}

// Index in the table of the brick that is `way` bricks along each axis from the brick with the index `place`; -1 if
// there is none.
std::ptrdiff_t neighbour(const SampledField& field, std::size_t place, const std::array<int, 3>& way)
{
  const std::size_t row = place / field.bricks[0];
  const std::array<std::size_t, 3> at{ { place % field.bricks[0], row % field.bricks[1], row / field.bricks[1] } };
  std::ptrdiff_t index = 0;
  for (int axis = 2; axis >= 0; --axis)
  {
    const auto b = static_cast<std::ptrdiff_t>(at[axis]) + way[axis];
    if (b < 0 || b >= field.bricks[axis])
      return -1;
    index = index * field.bricks[axis] + b;
  }
  return index;
}

constexpr int width = DistanceField::brick_row;

// Calls visit(sample, way) for all samples of a brick. `way` points, in bricks, to the brick that owns the cell around
// the sample.
template <class Visit>
void visit_samples(const Visit& visit)
{
  const auto side = [](int at) { return at == 0 ? -1 : at == width - 1 ? 1 : 0; };
  for (int k = 0; k < width; ++k)
    for (int j = 0; j < width; ++j)
      for (int i = 0; i < width; ++i)
        visit((k * width + j) * width + i, std::array<int, 3>{ { side(i), side(j), side(k) } });
}

// Samples each brick that has a point whose distance is in the brick's band. A sample that several bricks share is
// computed once.
void fill(SampledField& field, const std::vector<Band>& bands, const Distance& distance, const Loop& loop)
{
  const double spacing = field.spacing, edge = DistanceField::brick_edge * spacing;
  std::vector<std::size_t> places;
  for (std::size_t b = 0; b < bands.size(); ++b)
    if (bands[b].least < bands[b].largest)
      places.push_back(b);
  // The point at lattice coordinates (i, j, k) of a brick; they need not be whole numbers.
  const auto point_of = [&](std::size_t place, double i, double j, double k)
  {
    const std::size_t row = place / field.bricks[0];
    const auto along = [&](int axis, std::size_t brick, double at)
    { return field.origin[axis] + (static_cast<double>(DistanceField::brick_edge * brick) + at - 1) * spacing; };
    return Point{ { along(0, place % field.bricks[0], i), along(1, row % field.bricks[1], j),
                    along(2, row / field.bricks[1], k) } };
  };
  constexpr double middle = 0.5 * (width - 1);
  std::vector<char> wanted(places.size());
  loop(places.size(),
       [&](std::size_t n)
       {
         const Band& band = bands[places[n]];
         wanted[n] =
             band.home || reaches(distance, band, point_of(places[n], middle, middle, middle), edge, spacing) ? 1 : 0;
       });
  std::vector<std::size_t> stored;  // indices into the table
  for (std::size_t n = 0; n < places.size(); ++n)
    if (wanted[n] != 0)
    {
      field.table[places[n]] = static_cast<std::int32_t>(stored.size());
      stored.push_back(places[n]);
    }
  field.samples.resize(stored.size() * DistanceField::brick_size);
  const auto owner = [&](std::size_t brick, const std::array<int, 3>& way)
  {
    const std::ptrdiff_t place = neighbour(field, stored[brick], way);
    return place < 0 ? -1 : field.table[place];
  };
  loop(stored.size(),
       [&](std::size_t n)
       {
         float* const samples = field.samples.data() + n * DistanceField::brick_size;
         distance(point_of(stored[n], middle, middle, middle));  // a cluster of points begins with its middle
         visit_samples(
             [&](int s, const std::array<int, 3>& way)
             {
               const bool own = way == std::array<int, 3>{ { 0, 0, 0 } };
               const int i = s % width, j = s / width % width, k = s / (width * width);
               if (own || owner(n, way) < 0)
                 samples[s] = static_cast<float>(distance(point_of(stored[n], i, j, k)).value);
             });
       });
  for (std::size_t n = 0; n < stored.size(); ++n)
    visit_samples(
        [&](int s, const std::array<int, 3>& way)
        {
          const std::int32_t from = owner(n, way);
          if (way == std::array<int, 3>{ { 0, 0, 0 } } || from < 0)
            return;
          const int back = DistanceField::brick_edge * ((way[2] * width + way[1]) * width + way[0]);
          field.samples[n * DistanceField::brick_size + s] =
              field.samples[static_cast<std::size_t>(from) * DistanceField::brick_size + s - back];
        });
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
  if (rest.empty())
    return empty_field({}, {}, spacing);
  std::vector<double> level(rest.size());
  loop(rest.size(), [&](std::size_t n) { level[n] = distance(rest[n]).value; });
  Point lower{}, upper{};
  for (int axis = 0; axis < 3; ++axis)
  {
    const auto range = std::minmax_element(rest.begin(), rest.end(),
                                           [&](const Point& a, const Point& b) { return a[axis] < b[axis]; });
    lower[axis] = (*range.first)[axis] - travel;
    upper[axis] = (*range.second)[axis] + travel;
  }
  SampledField field = empty_field(lower, upper, spacing);
  std::vector<Band> bands(field.table.size());
  for (std::size_t n = 0; n < rest.size(); ++n)
  {
    visit_bricks(field, rest[n], travel,
                 [&](std::size_t brick)
                 {
                   bands[brick].least = std::min(bands[brick].least, level[n] - spacing);
                   bands[brick].largest = std::max(bands[brick].largest, level[n] + spacing);
                 });
    visit_bricks(field, rest[n], 0, [&](std::size_t brick) { bands[brick].home = true; });
  }
  fill(field, bands, distance, loop);
  // The distance from an open sheet jumps where the nearest point jumps from one place to another.
  limit_slope(field);
  return field;
}

SampledField sample_band(const Point& lower, const Point& upper, const Distance& distance, double spacing, double reach,
                         const Loop& loop, double inside)
{
  const double margin = reach + 2 * spacing;
  Point from = lower, to = upper;
  for (int axis = 0; axis < 3; ++axis)
  {
    from[axis] -= margin;
    to[axis] += margin;
  }
  SampledField field = empty_field(from, to, spacing);
  fill(field, std::vector<Band>(field.table.size(), { -std::max(margin, inside), margin, false }), distance, loop);
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

bool has_samples_near(const SampledField& field, const Point& p, double way)
{
  bool any = field.radius > 0;
  visit_bricks(field, p, way, [&](std::size_t brick) { any = any || field.table[brick] >= 0; });
  return any;
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
  rest.reserve(nodes.size());
  for (const auto node : nodes)
    rest.push_back(rest_position(model, node));
  return slide_on(model, name, sample_field(rest, distance, spacing, travel), nodes);
}

}  // namespace frontalis
