#include "solver/stepping/sliver_hourglass.hpp"

#include "frontalis/physics/hourglass.hpp"
#include "frontalis/physics/time_step.hpp"
#include "solver/stepping/discretisation.hpp"

#include <algorithm>
#include <limits>
#include <set>

namespace frontalis
{

double least_hourglass(const Model& model)
{
  const auto& h = model.spacing;
  // A model may have further materials, such as those of a film on the skin.
  const std::set<int> present(model.mixture_material.begin(), model.mixture_material.end());
  double young = std::numeric_limits<double>::infinity();
  for (const int m : present)
    young = std::min(
        young, physics::young_modulus(shear_at_rest(model.materials[m]), double(model.materials[m].parameters[1])));
  return 3 * physics::hourglass_stiffness(young, h[0] * h[1] * h[2], std::max({ h[0], h[1], h[2] }));
}

}  // namespace frontalis
