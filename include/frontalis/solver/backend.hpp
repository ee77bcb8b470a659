#pragma once

#include "frontalis/solver/solver.hpp"

#include <memory>
#include <string>
#include <vector>

namespace frontalis
{

/// Description of a backend. A backend NAME defines `BackendDescription NAME_backend()` and is listed in `backends` of
/// CMakeLists.txt, from which registered_backends() is generated.
struct BackendDescription
{
  std::string name;
  /// Makes a solver whose description ends with `remark`. Throws BackendUnavailable if the device cannot take the
  /// model, and Error if the model or the settings are invalid.
  std::unique_ptr<Solver> (*make)(std::shared_ptr<const Model> model, const SolverSettings& settings,
                                  const std::string& remark);
  /// Returns why the backend cannot run on this machine; empty if it can. Null: it always can.
  std::string (*missing)() = nullptr;
};

/// The backend cannot run on this machine, or the model is too large for its device.
class BackendUnavailable : public Error
{
public:
  using Error::Error;
};

/// The backends of this build. `auto` takes the first of them that can run.
const std::vector<BackendDescription>& registered_backends();

}  // namespace frontalis
