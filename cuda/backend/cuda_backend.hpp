#pragma once

#include "frontalis/solver/solver.hpp"

#include <memory>
#include <string>

namespace frontalis
{

/// Why no CUDA device can be used here; empty where one can.
std::string missing_cuda_device();

/// Throws Error where no device can be used or its memory is too small.
std::unique_ptr<Solver> make_cuda_solver(std::shared_ptr<const Model> model, const SolverSettings& settings);

}  // namespace frontalis
