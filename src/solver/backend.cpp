#include "frontalis/solver/backend.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <mutex>

namespace frontalis
{
namespace
{

std::string missing_of(const BackendDescription& backend)
{
  return backend.missing == nullptr ? std::string() : backend.missing();
}

// Makes a solver of the first backend that can run. If that is not the preferred backend, a message tells why, once per
// process.
std::unique_ptr<Solver> make_preferred(const std::shared_ptr<const Model>& model, const SolverSettings& settings)
{
  std::string remark;
  for (const BackendDescription& backend : registered_backends())
  {
    std::string fault;
    if (const std::string missing = missing_of(backend); !missing.empty())
      fault = fmt::format("backend {}: {}", backend.name, missing);
    else
      try
      {
        auto solver = backend.make(model, settings, remark);
        static std::once_flag warned;
        if (!remark.empty())
          std::call_once(warned,
                         [&] { fmt::print(stderr, "warning: backend {} is used ({})\n", backend.name, remark); });
        return solver;
      }
      catch (const BackendUnavailable& error)
      {
        fault = error.what();
      }
    remark += (remark.empty() ? "" : "; ") + fault;
  }
  throw BackendUnavailable(remark);
}

}  // namespace

std::vector<Backend> backend_names()
{
  std::vector<Backend> names{ "auto" };
  for (const BackendDescription& backend : registered_backends())
    names.push_back(backend.name);
  return names;
}

Backend backend_from_name(const std::string& name)
{
  const std::vector<Backend> names = backend_names();
  if (std::find(names.begin(), names.end(), name) == names.end())
    throw Error(fmt::format("backend \"{}\": this build has {}", name, fmt::join(names, ", ")));
  return name;
}

std::vector<Backend> available_backends()
{
  std::vector<Backend> names;
  for (const BackendDescription& backend : registered_backends())
    if (missing_of(backend).empty())
      names.push_back(backend.name);
  return names;
}

std::unique_ptr<Solver> make_solver(std::shared_ptr<const Model> model, const SolverSettings& settings)
{
  const Backend name = backend_from_name(settings.backend);
  if (name == "auto")
    return make_preferred(model, settings);
  const auto& all = registered_backends();
  const BackendDescription& backend =
      *std::find_if(all.begin(), all.end(), [&](const BackendDescription& one) { return one.name == name; });
  const std::string missing = missing_of(backend);
  if (!missing.empty())
    throw BackendUnavailable(
        fmt::format("backend {}: {}; available are auto, {}", name, missing, fmt::join(available_backends(), ", ")));
  return backend.make(std::move(model), settings, {});
}

}  // namespace frontalis
