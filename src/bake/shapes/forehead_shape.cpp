#include "frontalis/bake/forehead_shape.hpp"

#include "bake/mesh/surface.hpp"
#include "bake/mesh/surface_mesh.hpp"
#include "bake/messages.hpp"

namespace frontalis
{
namespace
{

double bell(double x, double width) { return std::exp(-(x / width) * (x / width)); }

/// A step that is 0 below x = 0, 1 above x = 1 and twice differentiable.
double smooth_step(double x)
{
  const double t = std::min(1.0, std::max(0.0, x));
  return t * t * t * (t * (6 * t - 15) + 10);
}

/// The generated forehead as a map from (s, z, depth) to space. s is the arc length from the midline [m], positive to
/// the subject's left, z the height above the sellion [m], depth a fraction of the soft tissue: 0 at the skin, 1 at the
/// bone.
class ForeheadMap
{
public:
  explicit ForeheadMap(const ForeheadDimensions& dimensions)
      : dimensions_(dimensions),
        // The radius of curvature of an ellipse at its front is half_breadth^2 / depth_axis.
        depth_axis_(dimensions.half_breadth * dimensions.half_breadth / dimensions.front_radius)
  {
    // The normal from bone to skin is not horizontal. The iteration finds the height of the bone below the sellion.
    double z = 0;
    for (int i = 0; i < 20; ++i)
      z -= at(0, z, 0)[2];
    shift_ = -at(0, z, 0)[0];
  }

  const ForeheadDimensions& dimensions() const { return dimensions_; }

  Vector3d at(double s, double z, double depth) const
  {
    constexpr double step = 1e-5;
    const Vector3d across = bone(s + step, z) - bone(s - step, z);
    const Vector3d up = bone(s, z + step) - bone(s, z - step);
    return bone(s, z) + ((1 - depth) * thickness(z)) * across.cross(up).normalized();
  }

  /// Thickness of the soft tissue [m].
  double thickness(double z) const
  {
    const double over = z - dimensions_.brow_height;
    return dimensions_.hairline_thickness +
           (dimensions_.brow_thickness - dimensions_.hairline_thickness) * bell(over, 28e-3);
  }

  /// Heights [m] of the orbital rim, which is lower at the nasal root, and of the hairline, lower at the temples.
  double lower_edge(double s) const
  {
    const double arc = std::abs(s);
    const double brow = dimensions_.brow_height;
    // Height of the nasal root, plus the rise to the orbital rim, minus the fall towards the cheek bone.
    return -2e-3 + (0.55 * brow + 2e-3) * smooth_step((arc - 4e-3) / 20e-3) -
           0.35 * brow * smooth_step((arc - 42e-3) / 30e-3);
  }
  double upper_edge(double s) const
  {
    const double share = std::abs(s) / half_width();
    return dimensions_.brow_height + dimensions_.height * (1 - 0.35 * smooth_step((share - 0.3) / 0.7));
  }
  double half_width() const { return 0.5 * dimensions_.width; }

private:
  Vector3d bone(double s, double z) const
  {
    const ForeheadDimensions& d = dimensions_;
    const double angle = s / d.half_breadth;
    const double lean = std::tan(5 * pi / 180);
    const double above = z - d.brow_height;
    // The profile leans and curves backwards above the brow and is straight below.
    const double setback = above > 0 ? lean * above + above * above / (2 * d.profile_radius) : lean * above;

    // The relief along the horizontal normal: the brow ridge, which is highest above the medial half of the orbit; the
    // glabella; the nasal root; the temples.
    const double arc = std::abs(s);
    const double ridge = d.ridge * bell(above, 9e-3) * (0.45 + 0.55 * bell(arc - 22e-3, 18e-3)) *
                         (1 - smooth_step((arc - 45e-3) / 25e-3));
    const double glabella = d.glabella * bell(z - 0.75 * d.brow_height, 9e-3) * bell(s, 11e-3);
    const double root = 5e-3 * smooth_step((0.7 * d.brow_height - z) / d.brow_height) * bell(s, 20e-3);
    const double temple = d.temple_flattening * smooth_step((arc - 40e-3) / 35e-3);
    const double relief = ridge + glabella - root - temple;

    const Vector3d normal = Vector3d{ std::cos(angle) / depth_axis_, std::sin(angle) / d.half_breadth, 0 }.normalized();
    return Vector3d{ depth_axis_ * std::cos(angle) - setback + shift_, d.half_breadth * std::sin(angle), z } +
           relief * normal;
  }

  ForeheadDimensions dimensions_;
  double depth_axis_;  ///< semi-axis of the horizontal section along x [m]
  double shift_ = 0;   ///< shift along x that puts the sellion on the skin at the origin [m]
};

/// Middle surface of a flat muscle. `place` gives arc length and height [m], `depth` the depth as a proportion of the
/// soft tissue. The parameter a runs from 0 to 1 to the subject's left, b from 0 to 1 upwards or along the fibres.
struct Sheet
{
  std::function<std::array<double, 2>(double, double)> place;
  std::function<double(double, double)> depth;
  double thickness, length_a, length_b;  ///< [m]
};

TriangleMesh thicken(const ForeheadMap& map, const Sheet& sheet, double edge)
{
  const auto count = [&](double length)
  { return 2 * std::max(1, static_cast<std::int32_t>(std::ceil(0.5 * length / edge))); };
  const std::int32_t n = count(sheet.length_a), m = count(sheet.length_b),
                     l = std::max(1, static_cast<std::int32_t>(std::ceil(sheet.thickness / edge)));
  const auto at = [&](std::int32_t i, std::int32_t j, std::int32_t k) -> Vector3d
  {
    const double a = static_cast<double>(i) / n, b = static_cast<double>(j) / m;
    const auto [s, z] = sheet.place(a, b);
    const double offset = (static_cast<double>(k) / l - 0.5) * sheet.thickness / map.thickness(z);
    return map.at(s, z, sheet.depth(a, b) + offset);
  };
  TriangleMesh mesh;
  add_sheet(mesh, n, m, [&](std::int32_t i, std::int32_t j) { return at(i, j, 0); });
  add_sheet(mesh, n, m, [&](std::int32_t i, std::int32_t j) { return at(n - i, j, l); });
  add_sheet(mesh, n, l, [&](std::int32_t i, std::int32_t k) { return at(n - i, 0, k); });
  add_sheet(mesh, n, l, [&](std::int32_t i, std::int32_t k) { return at(i, m, k); });
  add_sheet(mesh, m, l, [&](std::int32_t j, std::int32_t k) { return at(0, j, k); });
  add_sheet(mesh, m, l, [&](std::int32_t j, std::int32_t k) { return at(n, m - j, k); });
  return mesh;
}

double mix(double a, double b, double t) { return a + (b - a) * t; }

/// Distance of the frontalis from the midline [m]: 3 mm at the brow (share = 0), 12 mm at the upper end (share = 1).
double frontalis_inner(double share) { return mix(3e-3, 12e-3, share * share); }

constexpr double frontalis_width = 38e-3;  // [m]

/// The frontalis runs from the skin of the brow, where it is superficial, up to the galea at two thirds of the height.
Sheet frontalis(const ForeheadMap& map, double side)
{
  const ForeheadDimensions& d = map.dimensions();
  const auto place = [&d, side](double a, double b)
  {
    const double inner = frontalis_inner(b);
    const double s = side > 0 ? inner + a * frontalis_width : -inner - (1 - a) * frontalis_width;
    // The insertion follows the brow, which is lower at its lateral end.
    const double out = (std::abs(s) - inner) / frontalis_width;
    const double low = d.brow_height - 2e-3 - 3e-3 * out * out;
    return std::array<double, 2>{ s, mix(low, d.brow_height + 2.0 / 3 * d.height - 6e-3 * out * out, b) };
  };
  const auto depth = [](double, double b) { return mix(0.38, 0.55, std::min(1.0, b / 0.35)); };
  return { place, depth, d.muscle_thickness, frontalis_width, 2.0 / 3 * d.height };
}

/// The corrugator runs from the bone at the medial end of the brow obliquely up and out to the skin over the mid brow.
Sheet corrugator(const ForeheadMap& map, double side)
{
  const ForeheadDimensions& d = map.dimensions();
  const double angle = 20 * pi / 180;
  const double length = 35e-3;
  const auto place = [&d, side, angle, length](double a, double b)
  {
    // along: 0 at the origin (medial), 1 at the insertion (lateral). The muscle fans out.
    const double along = side > 0 ? a : 1 - a;
    const double across = (b - 0.5) * mix(8e-3, 12e-3, along);
    const double s = 4e-3 + along * length * std::cos(angle) - across * std::sin(angle);
    const double z = 0.75 * d.brow_height + along * length * std::sin(angle) + across * std::cos(angle);
    return std::array<double, 2>{ side * s, z };
  };
  const auto depth = [side](double a, double) { return mix(0.9, 0.3, side > 0 ? a : 1 - a); };
  return { place, depth, d.muscle_thickness, length, 12e-3 };
}

/// The procerus runs in the midline from the nasal bone up to the skin between the brows.
Sheet procerus(const ForeheadMap& map)
{
  const ForeheadDimensions& d = map.dimensions();
  const auto place = [](double a, double b) {
    return std::array<double, 2>{ mix(-5e-3, 5e-3, a), mix(-1.5e-3, 23.5e-3, b) };
  };
  const auto depth = [](double, double b) { return mix(0.85, 0.3, b); };
  return { place, depth, d.muscle_thickness, 10e-3, 25e-3 };
}

/// The galea is a tendon sheet from the upper edge of the frontales, and from the gap between them, to the hairline.
Sheet galea(const ForeheadMap& map)
{
  const ForeheadDimensions& d = map.dimensions();
  const auto place = [&map, &d](double a, double b)
  {
    const double half = std::min(52e-3, map.half_width());
    const double s = mix(-half, half, a);
    const double arc = std::abs(s);
    // The lower edge follows the upper edge of the frontales and extends down into the gap between them.
    const double top = d.brow_height + 2.0 / 3 * d.height - 3e-3;
    const double gap = std::max(0.0, 1 - arc / 12e-3);
    const double outer = std::max(0.0, (arc - 12e-3) / frontalis_width);
    const double low = top - 0.4 * d.height * gap * gap * (3 - 2 * gap) - 6e-3 * std::min(1.0, outer * outer);
    // The sheet extends 1 mm beyond the upper edge of the tissue, so that no gap is left there.
    return std::array<double, 2>{ s, mix(low, map.upper_edge(s) + 1e-3, b) };
  };
  const auto depth = [](double, double) { return 0.55; };
  return { place, depth, d.galea_thickness, 104e-3, 0.75 * d.height };
}

Sheet muscle_sheet(const ForeheadMap& map, const std::string& part)
{
  const auto is = [&part](const char* muscle) { return part.rfind(muscle, 0) == 0; };
  const double side = part.find("_left") != std::string::npos ? 1 : -1;
  return is("frontalis")    ? frontalis(map, side)
         : is("corrugator") ? corrugator(map, side)
         : is("procerus")   ? procerus(map)
                            : galea(map);
}

using Field = double ForeheadDimensions::*;

const std::vector<std::pair<std::string, Field>>& fields()
{
  static const std::vector<std::pair<std::string, Field>> list{
    { "height", &ForeheadDimensions::height },
    { "width", &ForeheadDimensions::width },
    { "front_radius", &ForeheadDimensions::front_radius },
    { "half_breadth", &ForeheadDimensions::half_breadth },
    { "brow_height", &ForeheadDimensions::brow_height },
    { "brow_thickness", &ForeheadDimensions::brow_thickness },
    { "hairline_thickness", &ForeheadDimensions::hairline_thickness },
    { "profile_radius", &ForeheadDimensions::profile_radius },
    { "ridge", &ForeheadDimensions::ridge },
    { "glabella", &ForeheadDimensions::glabella },
    { "temple_flattening", &ForeheadDimensions::temple_flattening },
    { "margin", &ForeheadDimensions::margin },
    { "muscle_thickness", &ForeheadDimensions::muscle_thickness },
    { "galea_thickness", &ForeheadDimensions::galea_thickness },
  };
  return list;
}

ForeheadDimensions dimensions_of(const Shape& shape)
{
  ForeheadDimensions dimensions;
  for (const auto& [name, value] : shape.dimensions)
  {
    const auto field =
        std::find_if(fields().begin(), fields().end(), [&n = name](const auto& f) { return f.first == n; });
    if (field == fields().end())
      throw failure("forehead: there is no dimension '{}'; there are {}", name,
                    fmt::join(forehead_dimension_names(), ", "));
    if (!(value > 0) || !(value < 1))
      throw failure("forehead: dimension '{}' is {:g} m; it must be above 0 and below 1 m", name, value);
    dimensions.*field->second = value;
  }
  if (dimensions.width > 2.6 * dimensions.half_breadth)
    throw Error("forehead: 'width' is more than 2.6 times 'half_breadth'; the temples would meet behind the head");
  if (dimensions.profile_radius < 2 * std::max(dimensions.brow_thickness, dimensions.hairline_thickness))
    throw Error("forehead: 'profile_radius' is less than twice the soft tissue's thickness; the skin would fold");
  return dimensions;
}

/// Points of the skin and, below them, of the bone: both have the same rows and columns, so that a rim can join them.
struct SkinGrid
{
  const ForeheadMap& map;
  std::int32_t across, up, through;
  double beyond;  ///< distance by which the grid extends beyond the edges of the skin [m]

  SkinGrid(const ForeheadMap& forehead, double edge, double margin) : map(forehead), beyond(margin)
  {
    const ForeheadDimensions& d = map.dimensions();
    // The number of columns is even, so that a line of points runs along the midline.
    across = 2 * std::max(2, static_cast<std::int32_t>(std::ceil((0.5 * d.width + beyond) / edge)));
    up = std::max(4, static_cast<std::int32_t>(std::ceil((d.height + 0.6 * d.brow_height + 2 * beyond) / edge)));
    through = std::max(1, static_cast<std::int32_t>(std::ceil(0.5 * (d.brow_thickness + d.hairline_thickness) / edge)));
  }

  Vector3d at(std::int32_t i, std::int32_t j, double depth) const
  {
    const double s = (map.half_width() + beyond) * (2.0 * i / across - 1);
    const double low = map.lower_edge(s) - beyond, high = map.upper_edge(s) + beyond;
    return map.at(s, low + (high - low) * j / up, depth);
  }
};

void add_face(TriangleMesh& mesh, const SkinGrid& grid, double depth, bool outward)
{
  add_sheet(mesh, grid.across, grid.up,
            [&](std::int32_t i, std::int32_t j) { return grid.at(outward ? i : grid.across - i, j, depth); });
}

void add_rim(TriangleMesh& mesh, const SkinGrid& grid, bool upper, bool lower, bool lateral)
{
  const double step = 1.0 / grid.through;
  const auto depth = [&](std::int32_t k) { return k == grid.through ? 1 : k * step; };
  if (upper)
    add_sheet(mesh, grid.across, grid.through,
              [&](std::int32_t i, std::int32_t k) { return grid.at(i, grid.up, depth(k)); });
  if (lower)
    add_sheet(mesh, grid.across, grid.through,
              [&](std::int32_t i, std::int32_t k) { return grid.at(grid.across - i, 0, depth(k)); });
  if (lateral)
  {
    add_sheet(mesh, grid.up, grid.through, [&](std::int32_t j, std::int32_t k) { return grid.at(0, j, depth(k)); });
    add_sheet(mesh, grid.up, grid.through,
              [&](std::int32_t j, std::int32_t k) { return grid.at(grid.across, grid.up - j, depth(k)); });
  }
}

}  // namespace

std::vector<std::string> forehead_dimension_names()
{
  std::vector<std::string> names;
  for (const auto& field : fields())
    names.push_back(field.first);
  return names;
}

TriangleMesh make_forehead(const Shape& shape)
{
  const ForeheadDimensions dimensions = dimensions_of(shape);
  const ForeheadMap map(dimensions);
  const double edge = shape.edge_or_default();
  check_edges(edge, dimensions.width + 2 * dimensions.margin);
  const SkinGrid grid(map, edge, 0);
  const std::string& part = shape.part;

  TriangleMesh mesh;
  if (part == "skin")
    add_face(mesh, grid, 0, true);
  else if (part == "skull")
    add_face(mesh, SkinGrid(map, edge, dimensions.margin), 1, true);
  else if (part == "tissue")
  {
    add_face(mesh, grid, 0, true);
    add_face(mesh, grid, 1, false);
    add_rim(mesh, grid, true, true, true);
  }
  else if (part == "rim" || part == "rim_upper" || part == "rim_lower" || part == "rim_lateral")
    add_rim(mesh, grid, part != "rim_lower" && part != "rim_lateral", part != "rim_upper" && part != "rim_lateral",
            part != "rim_upper" && part != "rim_lower");
  else if (std::find(forehead_parts().begin(), forehead_parts().end(), part) != forehead_parts().end())
    mesh = thicken(map, muscle_sheet(map, part), edge);
  else
    throw failure("forehead: there is no part '{}'; there are {}", part, fmt::join(forehead_parts(), ", "));
  return mesh;
}

}  // namespace frontalis
