#pragma once

#include "bodies_touch.hpp"
#include "tissue_contact_model.hpp"

namespace frontalis
{
namespace test
{

class TissuesTouch : public BodiesTouch
{
};

/// Displacements that move the upper of two blocks by `way` [m] along z.
inline Vectors lowered(const Model& model, double way)
{
  Vectors u(model.nodes.size());
  for (std::size_t n = 0; n < u.size(); ++n)
    u[n][2] = 2 * model.nodes[n][2] > model.size[2] ? way : 0;
  return u;
}

}  // namespace test
}  // namespace frontalis
