#pragma once

#include "frontalis/model/model.hpp"

#include <vector>

namespace frontalis
{

/// First-order response of muscles to the activations asked for: da/dt = (e - a) / time, with the muscle's rise or fall
/// time (as in Zajac 1989, Crit. Rev. Biomed. Eng. 17:359), no faster than the model's slew limit.
class MuscleResponse
{
public:
  explicit MuscleResponse(const Model& model) : model_(model) {}

  /// Takes activations on by `seconds`, over which those asked for go linearly from one to another.
  void advance(const std::vector<float>& asked_from, const std::vector<float>& asked_to, double seconds,
               std::vector<float>& activation) const;

private:
  const Model& model_;
};

}  // namespace frontalis
