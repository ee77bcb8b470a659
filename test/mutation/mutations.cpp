#include "frontalis/physics/mutation.hpp"

#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace frontalis
{
namespace mutation
{
namespace
{

bool wanted(const char* name)
{
  const char* const variable = std::getenv("FRONTALIS_MUTATION");
  const bool found = variable != nullptr && std::strcmp(variable, name) == 0;
  if (found)
    std::fprintf(stderr, "mutated: %s\n", name);
  return found;
}

}  // namespace

const bool blind_guard = wanted("guard");
const bool time_step_of_rest = wanted("time_step");
const bool laws_not_continued = wanted("material");
const bool no_friction = wanted("friction");
const bool lost_corner = wanted("patches");
const bool no_gpu_gravity = wanted("gpu_gravity");

}  // namespace mutation
}  // namespace frontalis
