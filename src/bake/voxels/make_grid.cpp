#include "frontalis/error.hpp"
#include "bake/messages.hpp"
#include "bake/voxels/voxelise.hpp"

#include <fstream>

namespace frontalis
{
namespace
{

constexpr double least_voxels = 8;
constexpr double most_voxels = 2.5e8;  // eight node indices per voxel must be below 2^31
// The measured peak is 230 to 270 bytes per voxel for about a million voxels. The rest is for scenes with more muscles.
constexpr double bytes_per_voxel = 400;
constexpr double bytes_per_cell = 0.15, bytes_per_cell_of_gaps = 7;  // Gaps marks and labels every cell
constexpr int samples = 2000;
constexpr double infinite = std::numeric_limits<double>::infinity();

/// Number of voxels with tissue, estimated from the proportion of points in the box that lie in the tissue.
double estimated_voxels(const Volumes& volumes, const Box& box, double cells)
{
  int inside = 0;
  for (int i = 0; i < samples; ++i)
    inside += in_tissue(volumes, spread_point(box, i)) ? 1 : 0;
  return std::max(1.0, static_cast<double>(inside)) / samples * cells;
}

/// The number that follows the word `after` in a file, or the file's first number if `after` is empty. Infinite if
/// missing.
double number_in(const std::string& path, const std::string& after)
{
  std::ifstream file(path);
  std::string word;
  double value = 0;
  while (!after.empty() && file >> word && word != after)
  {
  }
  return file >> value ? value : infinite;
}

/// Memory that this process can still allocate [bytes]: the smaller of the system's available memory and the rest of
/// the control group's limit. Infinite if neither is known.
double available_memory()
{
  const double system = 1024 * number_in("/proc/meminfo", "MemAvailable:");
  double group = infinite;
  for (const std::string folder : { "/sys/fs/cgroup/", "/sys/fs/cgroup/memory/" })
  {
    const double limit =
        std::min(number_in(folder + "memory.max", ""), number_in(folder + "memory.limit_in_bytes", ""));
    const double used =
        std::min(number_in(folder + "memory.current", ""), number_in(folder + "memory.usage_in_bytes", ""));
    if (limit < infinite && used < infinite)
      group = std::min(group, std::max(0.0, limit - used));
  }
  return std::min(system, group);
}

std::string number_text(double count)
{
  return count < 1e6 ? fmt::format("{:.0f}", count) : fmt::format("{:.3g}", count);
}

}  // namespace

Grid make_grid(const Scene& scene, const Volumes& volumes)
{
  const Vector3d spacing = to_vector(scene.accuracy.voxel);
  if (!(spacing.minCoeff() > 0))
    throw failure("{}: voxel edge {:g} m; it must be above 0", scene.file, spacing.minCoeff());
  const Box box = volumes.tissue_box();
  const Vector3d extent = box.sizes();
  const Vector3d cells = (extent.cwiseQuotient(spacing).array() - 1e-6).ceil().max(1);
  const double count = cells.prod();
  const auto edges_text = [&](const Vector3d& edges)
  {
    const Vector3d v = edges / scene.unit;
    return fmt::format("{:.4g} x {:.4g} x {:.4g} {}", v[0], v[1], v[2], unit_text(scene.unit));
  };
  const std::string spans = scene.file + ": the tissue spans " + edges_text(extent) + ", which is ";
  const std::string unit = unit_advice(extent.maxCoeff(), scene.unit);
  const std::string advice = unit.empty()
                                 ? ": check the voxel size, the crop, and the length units of the scene and of "
                                   "its files"
                                 : ": " + unit + "; check the length units of the scene and of its files";
  if (count < least_voxels)
    throw failure("{}{} {} of {}; at least {} are needed{}", spans, number_text(count), count == 1 ? "voxel" : "voxels",
                  edges_text(spacing), least_voxels, advice);

  // Cells along an axis are counted with 32 bits, however few of them are tissue.
  const bool absurd = cells.maxCoeff() > 1e9 || count > 1e15;
  const double voxels = absurd ? count : estimated_voxels(volumes, box, count);
  const bool has_gaps =
      scene.accuracy.gaps == "parted" ||
      std::any_of(scene.volumes.begin(), scene.volumes.end(), [](const Volume& v) { return !v.slits.empty(); });
  const double bytes = bytes_per_voxel * voxels + (bytes_per_cell + (has_gaps ? bytes_per_cell_of_gaps : 0)) * count;
  const double available = available_memory();
  if (voxels > most_voxels || bytes > available)
    throw failure("{}{} voxels of {} and about {:.3g} GB, and {:.3g} GB are free; at most {} voxels are possible{}",
                  spans, number_text(voxels), edges_text(spacing), bytes / 1e9, available / 1e9,
                  number_text(std::min(most_voxels, available * voxels / bytes)), advice);
  Grid grid;
  grid.lower = box.min();
  grid.spacing = spacing;
  for (int a = 0; a < 3; ++a)
    grid.size[a] = static_cast<std::int32_t>(cells[a]);
  return grid;
}

}  // namespace frontalis
