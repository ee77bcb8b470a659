#include "bake/voxels/block_classifier.hpp"

#include <iterator>

namespace frontalis
{
namespace
{

constexpr std::int32_t block = 16;  // voxels along each edge of a block

template <class Value>
void join(std::vector<Value>& list, const std::vector<Value>& more)
{
  list.insert(list.end(), more.begin(), more.end());
}

}  // namespace

void Shares::add(const std::vector<double>& shares, double whole)
{
  for (std::size_t n = 0; n < shares.size(); ++n)
  {
    if (shares[n] <= 0)
      continue;
    number.push_back(static_cast<std::int16_t>(n));
    share.push_back(static_cast<float>(std::min(1.0, shares[n] / whole)));
  }
  begin.push_back(static_cast<std::int32_t>(number.size()));
}

void Shares::append(const Shares& other)
{
  const auto first = static_cast<std::int32_t>(number.size());
  std::transform(other.begin.begin() + 1, other.begin.end(), std::back_inserter(begin),
                 [first](std::int32_t end) { return first + end; });
  join(number, other.number);
  join(share, other.share);
}

void Voxels::append(const Voxels& other)
{
  join(place, other.place);
  join(fill, other.fill);
  join(centre, other.centre);
  materials.append(other.materials);
  muscles.append(other.muscles);
  for (std::size_t v = 0; v < volume_size.size(); ++v)
  {
    volume_size[v] += other.volume_size[v];
    for (std::size_t b = 0; b < band_size[v].size(); ++b)
      band_size[v][b] += other.band_size[v][b];
  }
}

Voxels voxelise(const Volumes& volumes, const Grid& grid, int samples, double fill_min,
                const std::vector<const PreparedSurface*>& kept_at, BakeMonitor& monitor)
{
  std::array<std::size_t, 3> blocks{};
  for (std::size_t a = 0; a < 3; ++a)
    blocks[a] = (grid.size[a] + block - 1) / block;
  // one list per block, joined in order, so that the result does not depend on the threads
  std::vector<Voxels> parts(blocks[0] * blocks[1] * blocks[2]);
  parallel_for(monitor, parts.size(), 1,
               [&](std::size_t number)
               {
                 VoxelPlace begin{}, end{};
                 std::size_t rest = number;
                 for (std::size_t a = 0; a < 3; ++a)
                 {
                   begin[a] = static_cast<std::int32_t>(rest % blocks[a]) * block;
                   end[a] = std::min(begin[a] + block, grid.size[a]);
                   rest /= blocks[a];
                 }
                 BlockClassifier classifier(volumes, grid, samples, fill_min, kept_at);
                 classifier.visit(begin, end);
                 parts[number] = classifier.take();
               });
  for (std::size_t p = 1; p < parts.size(); ++p)
  {
    parts[0].append(parts[p]);
    parts[p] = Voxels();
  }
  return std::move(parts[0]);
}

}  // namespace frontalis
