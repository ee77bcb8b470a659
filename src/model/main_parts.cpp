#include "frontalis/model/main_parts.hpp"

#include <algorithm>

namespace frontalis
{
namespace
{

// Index of the largest positive value among the entries [begin, end); -1 if no value is positive.
std::int32_t largest(const std::vector<float>& values, std::int32_t begin, std::int32_t end)
{
  const auto found = std::max_element(values.begin() + begin, values.begin() + end);
  return begin<end&& * found> 0 ? static_cast<std::int32_t>(found - values.begin()) : -1;
}

}  // namespace

MainParts::MainParts(const Model& model) : material(model.voxels.size(), -1), fibres(model.voxels.size(), -1)
{
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    const auto part = largest(model.mixture_proportion, model.mixture_begin[e], model.mixture_begin[e + 1]);
    if (part >= 0)
      material[e] = model.mixture_material[part];
    fibres[e] = largest(model.fibre_weight, model.fibre_begin[e], model.fibre_begin[e + 1]);
  }
}

}  // namespace frontalis
