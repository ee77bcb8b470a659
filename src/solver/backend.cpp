#include "frontalis/error.hpp"
#include "solver/cpu/cpu_solver.hpp"
#include "solver/reference/reference_solver.hpp"

#include <cmath>

#if defined(FRONTALIS_WITH_CUDA)
#include "cuda/backend/cuda_backend.hpp"
#endif

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

namespace
{

// why this model cannot run on a GPU here; empty where it can
std::string missing_gpu([[maybe_unused]] const Model& model)
{
#if defined(FRONTALIS_WITH_CUDA)
  return missing_cuda_device();
#else
  return "this build has no CUDA solver";
#endif
}

std::unique_ptr<Solver> make_gpu_solver([[maybe_unused]] const std::shared_ptr<const Model>& model,
                                        [[maybe_unused]] const SolverSettings& settings)
{
  const std::string missing = missing_gpu(*model);
  if (!missing.empty())
    throw Error("backend cuda: " + missing + "; allowed here are auto, reference, cpu");
#if defined(FRONTALIS_WITH_CUDA)
  return make_cuda_solver(model, settings);
#else
  return nullptr;
#endif
}

}  // namespace

std::vector<Backend> available_backends()
{
  std::vector<Backend> backends{ Backend::reference, Backend::cpu };
  if (missing_gpu({}).empty())
    backends.push_back(Backend::cuda);
  return backends;
}

std::unique_ptr<Solver> make_solver(std::shared_ptr<const Model> model, const SolverSettings& settings)
{
  switch (settings.backend)
  {
    case Backend::reference:
      return make_reference_solver(std::move(model), settings);
    case Backend::cuda:
      return make_gpu_solver(model, settings);
    case Backend::cpu:
      return make_cpu_solver(std::move(model), settings);
    default:
    {
      const std::string missing = missing_gpu(*model);
      return missing.empty() ? make_gpu_solver(model, settings)
                             : make_cpu_solver(std::move(model), settings, "no GPU: " + missing);
    }
  }
}

}  // namespace frontalis
