#include "frontalis/study/dense_block.hpp"

namespace frontalis
{

Model dense_block(std::int32_t x, std::int32_t y, std::int32_t z)
{
  Model model;
  model.size = { { x, y, z } };
  Material tissue;
  tissue.name = "hypodermis";
  tissue.density = 11000;
  const double young = 34e3, nu = 0.49;
  tissue.parameters[0] = young / (2 * (1 + nu));
  tissue.parameters[1] = young / (3 * (1 - 2 * nu));
  model.materials.push_back(tissue);
  const std::size_t count = static_cast<std::size_t>(x) * static_cast<std::size_t>(y) * static_cast<std::size_t>(z);
  model.voxels.reserve(count);
  for (std::int32_t k = 0; k < z; ++k)
    for (std::int32_t j = 0; j < y; ++j)
      for (std::int32_t i = 0; i < x; ++i)
        model.voxels.push_back({ { i, j, k } });
  model.fill.assign(count, 1);
  model.mixture_material.assign(count, 0);
  model.mixture_proportion.assign(count, 1);
  model.mixture_begin.resize(count + 1);
  for (std::size_t e = 0; e <= count; ++e)
    model.mixture_begin[e] = static_cast<std::int32_t>(e);
  model.fibre_begin.assign(count + 1, 0);
  build_nodes(model);
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
    if (model.nodes[n][0] == 0)
      model.rigid.push_back({ static_cast<std::int32_t>(n), -1 });
  // gravity that shears a block of any size by about 5 %, so that all move and none collapses
  model.gravity = { { 0, 0, -0.05 * tissue.parameters[0] / (tissue.density * x * model.spacing[0]) } };
  return model;
}

}  // namespace frontalis
