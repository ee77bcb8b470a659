#pragma once

#include "frontalis/solver/backend.hpp"
#include "study/verification/verification_cases.hpp"

#include <cmath>
#include <functional>

namespace frontalis
{

/// Calls `verify`, and lists as skipped that a backend does not compute what it needs.
inline void unless_unavailable(Finding& finding, const std::function<void()>& verify)
{
  try
  {
    verify();
  }
  catch (const BackendUnavailable& why)
  {
    if (finding.skipped.find(why.what()) == std::string::npos)
      finding.skipped += (finding.skipped.empty() ? "" : "; ") + std::string(why.what());
  }
}

/// Calls `verify` for each backend of this machine.
inline void on_every_backend(Finding& finding, const std::function<void(const Backend&)>& verify)
{
  for (const Backend& backend : available_backends())
    unless_unavailable(finding, [&] { verify(backend); });
}

inline std::unique_ptr<Solver> make(const Model& model, const Backend& backend, bool ledger = false,
                                    double time_step = 0)
{
  return make_solver(std::make_shared<const Model>(model), { backend, 1, time_step, ledger });
}

inline Vectors displacements(const Solver& solver)
{
  Vectors u;
  solver.displacements(u);
  return u;
}

inline double mean(const Vectors& vectors, std::size_t axis)
{
  double sum = 0;
  for (const Point& v : vectors)
    sum += v[axis];
  return sum / static_cast<double>(vectors.size());
}

inline double relative(double found, double expected) { return 100 * std::abs(found / expected - 1); }

/// Mass [kg] of each node of a model of one material in full voxels.
inline std::vector<double> lumped_masses(const Model& model)
{
  std::vector<double> mass(model.nodes.size(), 0);
  for (const auto& corners : model.voxel_nodes)
    for (const auto node : corners)
      mass[node] += model.materials[0].density * model.spacing[0] * model.spacing[1] * model.spacing[2] / 8;
  return mass;
}

/// Force [N] and moment [N m] on a plate, or the rates of change of the tissue's momentum and angular momentum.
using Wrench = std::array<double, 6>;

inline void add_momentum(Wrench& sum, const Point& place, const Point& momentum)
{
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    const std::size_t j = (axis + 1) % 3, k = (axis + 2) % 3;
    sum[axis] += momentum[axis];
    sum[3 + axis] += place[j] * momentum[k] - place[k] * momentum[j];
  }
}

}  // namespace frontalis
