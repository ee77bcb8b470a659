#pragma once

#include "bodies_touch.hpp"
#include "tissue_contact_model.hpp"

namespace frontalis
{
namespace test
{

// the backends that compute contact of tissue with itself
inline std::vector<Backend> host_backends()
{
  auto backends = available_backends();
  backends.erase(std::remove(backends.begin(), backends.end(), "cuda"), backends.end());
  return backends;
}

class TissuesTouch : public BodiesTouch
{
};

/// The nodes of the upper of two blocks have this displacement along z [m], the others none.
inline Vectors lowered(const Model& model, double way)
{
  Vectors u(model.nodes.size());
  for (std::size_t n = 0; n < u.size(); ++n)
    u[n][2] = 2 * model.nodes[n][2] > model.size[2] ? way : 0;
  return u;
}

}  // namespace test
}  // namespace frontalis

#define FRONTALIS_HOST_BACKENDS(suite)                                                           \
  INSTANTIATE_TEST_SUITE_P(Backends, suite, testing::ValuesIn(frontalis::test::host_backends()), \
                           frontalis::test::backend_name)
