#pragma once

#include "frontalis/solver/solver.hpp"

#include <memory>
#include <string>
#include <vector>

namespace frontalis
{

/// What a backend tells of itself. A backend NAME defines `BackendDescription NAME_backend()` and stands in the list
/// `backends` of CMakeLists.txt, from which registered_backends() is made; nothing else names it.
struct BackendDescription
{
  std::string name;
  /// Makes a solver whose description ends with `remark`. Throws BackendUnavailable where the device cannot take the
  /// model, and Error where the model or the settings are at fault.
  std::unique_ptr<Solver> (*make)(std::shared_ptr<const Model> model, const SolverSettings& settings,
                                  const std::string& remark);
  /// Why the backend cannot run on this machine, empty where it can; null: it always can.
  std::string (*missing)() = nullptr;
};

/// This machine, or a model that is too large for its device, keeps a backend from running.
class BackendUnavailable : public Error
{
public:
  using Error::Error;
};

/// The backends of this build. `auto` takes the first of them that can run.
const std::vector<BackendDescription>& registered_backends();

}  // namespace frontalis
