#include "bake/fibres/fibres.hpp"

namespace frontalis
{
namespace
{

constexpr double end_share = 0.15;  // length of a muscle's end divided by that of its fibres

}  // namespace

MuscleEndNodes origin_nodes(std::size_t muscle, const MuscleFibres& fibres, const std::vector<bool>& near,
                            const LocalFrame& frame, const Model& model)
{
  std::vector<std::pair<std::size_t, double>> voxels;  // voxels of the muscle, with their coordinates along the fibres
  double first = 1e300, last = -1e300;
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
    for (std::int32_t f = model.fibre_begin[e]; f < model.fibre_begin[e + 1]; ++f)
      if (static_cast<std::size_t>(model.fibre_muscle[f]) == muscle)
      {
        const double place = fibres.along(frame.voxel_centre(model, e));
        voxels.emplace_back(e, place);
        first = std::min(first, place);
        last = std::max(last, place);
      }
  std::array<std::vector<std::size_t>, 2> ends;
  std::array<double, 2> corners{ 1, 1 };
  for (const auto& [e, place] : voxels)
    for (int end = 0; end < 2; ++end)
      if (std::abs(place - (end == 0 ? first : last)) <= end_share * (last - first))
        for (const std::int32_t node : model.voxel_nodes[e])
        {
          ++corners[end];
          if (near[node])
            ends[end].push_back(node);
        }
  if (fibres.from_origin && !ends[0].empty())
    return { ends[0], true };
  // Fractions are compared, not numbers, because the other end may be wider and so have more nodes near the bone.
  const auto share = [&](int end) { return static_cast<double>(ends[end].size()) / corners[end]; };
  const int end = share(0) >= share(1) ? 0 : 1;
  return { ends[end], end == 0 };
}

}  // namespace frontalis
