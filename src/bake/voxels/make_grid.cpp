#include "bake/voxels/available_memory.hpp"
#include "frontalis/error.hpp"
#include "bake/length_text.hpp"
#include "bake/voxels/spread_points.hpp"
#include "bake/voxels/volume_probe.hpp"
#include "bake/voxels/voxelise.hpp"

#include <cmath>
#include <cstdio>

namespace frontalis
{
namespace
{

constexpr double least_voxels = 8;
constexpr double most_voxels = 2.5e8;  // eight numbers a voxel, counted in 32 bits
// bakes of about a million voxels peak at 230 to 270 bytes a voxel (doc/performance.md); more muscles take more
constexpr double bytes_a_voxel = 400;
constexpr double bytes_a_cell = 0.15;
constexpr int samples = 2000;

/// Voxels that will hold tissue: the proportion of points in the box that do, with the layer of voxels that the
/// boundary cuts.
double estimated_voxels(const Volumes& volumes, const Box& box, double cells)
{
  int tissue = 0;
  for (int i = 0; i < samples; ++i)
  {
    const Vector3 p = spread_point(box, i);
    for (const Volumes::Entry& entry : volumes.entries())
    {
      if (entry.volume->tissue && standing(volumes, entry, p) == Standing::inside)
      {
        ++tissue;
        break;
      }
    }
  }
  return std::max(1.0, static_cast<double>(tissue)) / samples * cells;
}

/// "; with 'unit: mm' ...": the length unit by which the tissue would have the size of a face or a part of one.
std::string unit_advice(double extent, double unit)
{
  for (const double other : { 1e-3, 1.0, 1e-2, 1e-6, 0.0254 })
  {
    const double size = extent / unit * other;
    if (other != unit && size > 0.02 && size < 0.6)
      return ": with 'unit: " + unit_text(other) + "' it would span " + length_text(size, 1e-3) +
             ", as a face does; check the length units of the scene and of its files";
  }
  return ": check the voxel size, the crop, and the length units of the scene and of its files";
}

std::string count_text(double count)
{
  char text[32];
  std::snprintf(text, sizeof(text), count < 1e6 ? "%.0f" : "%.3g", count);
  return text;
}

}  // namespace

Grid make_grid(const Scene& scene, const Volumes& volumes)
{
  const Vector3& spacing = scene.accuracy.voxel;
  const Box box = volumes.tissue_box();
  const Vector3 extent = box.upper - box.lower;
  Vector3 cells{};
  double count = 1;
  for (std::size_t a = 0; a < 3; ++a)
  {
    if (!(spacing[a] > 0))
      throw Error(scene.file + ": voxel edge " + std::to_string(spacing[a]) + " m; it must be above 0");
    cells[a] = std::max(1.0, std::ceil(extent[a] / spacing[a] - 1e-6));
    count *= cells[a];
  }
  const auto sizes = [&](const Vector3& v)
  {
    char text[128];
    std::snprintf(text, sizeof(text), "%.4g x %.4g x %.4g %s", v[0] / scene.unit, v[1] / scene.unit, v[2] / scene.unit,
                  unit_text(scene.unit).c_str());
    return std::string(text);
  };
  const std::string spans = scene.file + ": the tissue spans " + sizes(extent) + ", which is ";
  const double largest = std::max({ extent[0], extent[1], extent[2] });
  if (count < least_voxels)
    throw Error(spans + count_text(count) + (count == 1 ? " voxel of " : " voxels of ") + sizes(spacing) +
                "; at least 8 are wanted" + unit_advice(largest, scene.unit));

  // rows of cells are counted in 32 bits; beyond that nothing need be sampled
  const bool absurd = *std::max_element(cells.begin(), cells.end()) > 1e9 || count > 1e15;
  const double voxels = absurd ? count : estimated_voxels(volumes, box, count);
  const double bytes = bytes_a_voxel * voxels + bytes_a_cell * count;
  const double available = available_memory();
  if (voxels > most_voxels || bytes > available)
  {
    char memory[96];
    std::snprintf(memory, sizeof(memory), "about %.3g GB, and %.3g GB are free", bytes / 1e9, available / 1e9);
    throw Error(spans + count_text(voxels) + " voxels of " + sizes(spacing) + " and " + memory + "; at most " +
                count_text(std::min(most_voxels, available / bytes_a_voxel)) + " voxels can be had" +
                unit_advice(largest, scene.unit));
  }
  Grid grid;
  grid.lower = box.lower;
  grid.spacing = spacing;
  for (std::size_t a = 0; a < 3; ++a)
    grid.size[a] = static_cast<std::int32_t>(cells[a]);
  return grid;
}

}  // namespace frontalis
