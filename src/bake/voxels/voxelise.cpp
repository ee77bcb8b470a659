#include "bake/voxels/voxelise.hpp"

#include "bake/voxels/block_classifier.hpp"
#include "bake/parallel.hpp"

#include <algorithm>

namespace frontalis
{
namespace
{

constexpr std::int32_t block = 16;  // voxels along each edge of a block

}  // namespace

void Voxels::append(const Voxels& other)
{
  const auto mixtures = static_cast<std::uint32_t>(material.size());
  const auto muscles = static_cast<std::uint32_t>(muscle.size());
  const auto join = [](auto& list, const auto& more) { list.insert(list.end(), more.begin(), more.end()); };
  join(place, other.place);
  join(fill, other.fill);
  join(material, other.material);
  join(proportion, other.proportion);
  join(muscle, other.muscle);
  join(weight, other.weight);
  for (std::size_t e = 1; e < other.mixture_begin.size(); ++e)
    mixture_begin.push_back(mixtures + other.mixture_begin[e]);
  for (std::size_t e = 1; e < other.muscle_begin.size(); ++e)
    muscle_begin.push_back(muscles + other.muscle_begin[e]);
  volume_size.resize(std::max(volume_size.size(), other.volume_size.size()), 0);
  for (std::size_t v = 0; v < other.volume_size.size(); ++v)
    volume_size[v] += other.volume_size[v];
  band_size.resize(std::max(band_size.size(), other.band_size.size()));
  for (std::size_t v = 0; v < other.band_size.size(); ++v)
  {
    band_size[v].resize(other.band_size[v].size(), 0);
    for (std::size_t b = 0; b < band_size[v].size(); ++b)
      band_size[v][b] += other.band_size[v][b];
  }
}

Voxels voxelise(const Volumes& volumes, const Grid& grid, int samples, double fill_min, BakeMonitor& monitor)
{
  VoxelPlace blocks{};
  std::size_t count = 1;
  for (int a = 0; a < 3; ++a)
  {
    blocks[a] = (grid.size[a] + block - 1) / block;
    count *= blocks[a];
  }
  // each block gives its own list; they are joined in order, whichever thread made them
  std::vector<Voxels> parts(count);
  parallel_for(monitor, count, 1,
               [&](std::size_t number)
               {
                 const auto index = static_cast<std::int64_t>(number);
                 const std::array<std::int64_t, 3> at{ { index % blocks[0], index / blocks[0] % blocks[1],
                                                         index / blocks[0] / blocks[1] } };
                 VoxelPlace begin{}, end{};
                 for (int a = 0; a < 3; ++a)
                 {
                   begin[a] = static_cast<std::int32_t>(at[a]) * block;
                   end[a] = std::min(begin[a] + block, grid.size[a]);
                 }
                 BlockClassifier classifier(volumes, grid, samples, fill_min);
                 classifier.visit(begin, end);
                 parts[number] = classifier.take();
               });
  Voxels all;
  for (Voxels& part : parts)
  {
    all.append(part);
    part = Voxels();
  }
  return all;
}

}  // namespace frontalis
