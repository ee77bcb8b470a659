#include "frontalis/error.hpp"
#include "stepping_solver.hpp"

namespace frontalis
{

Backend backend_from_name(const std::string& name)
{
  for (const Backend backend : { Backend::automatic, Backend::reference, Backend::cpu, Backend::cuda })
    if (name == name_of(backend))
      return backend;
  throw Error("backend \"" + name + "\": allowed are auto, reference, cpu, cuda");
}

std::string name_of(Backend backend)
{
  switch (backend)
  {
    case Backend::reference:
      return "reference";
    case Backend::cpu:
      return "cpu";
    case Backend::cuda:
      return "cuda";
    default:
      return "auto";
  }
}

std::unique_ptr<Solver> make_solver(std::shared_ptr<const Model> model, const SolverSettings& settings)
{
  switch (settings.backend)
  {
    case Backend::reference:
      return make_reference_solver(std::move(model), settings);
    case Backend::cuda:
      throw Error("backend cuda: this build has no CUDA solver; allowed are auto, reference, cpu");
    default:
      return make_cpu_solver(std::move(model), settings);
  }
}

}  // namespace frontalis
