#include "frontalis/bake/forehead_shape.hpp"

#include "bake/shapes/forehead_bone.hpp"
#include "bake/shapes/forehead_muscles.hpp"
#include "frontalis/error.hpp"
#include "bake/shapes/sheet_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace frontalis
{
namespace
{

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
      throw Error(fmt::format("forehead: there is no dimension '{}'; there are {}", name,
                              fmt::join(forehead_dimension_names(), ", ")));
    if (!(value > 0) || !(value < 1))
      throw Error(fmt::format("forehead: dimension '{}' is {:g} m; it must be above 0 and below 1 m", name, value));
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
  double beyond;  ///< by which it reaches beyond the edges [m]

  SkinGrid(const ForeheadMap& forehead, double edge, double margin) : map(forehead), beyond(margin)
  {
    const ForeheadDimensions& d = map.dimensions();
    // an even number of columns, so that one runs along the midline
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
  const double edge = shape.edge > 0 ? shape.edge : 1.75e-3;
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
    mesh = make_forehead_muscle(map, part, edge);
  else
    throw Error(fmt::format("forehead: there is no part '{}'; there are {}", part, fmt::join(forehead_parts(), ", ")));
  return mesh;
}

}  // namespace frontalis
