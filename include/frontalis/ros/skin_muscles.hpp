#pragma once

#include "frontalis/model/model.hpp"

#include <cstdint>
#include <vector>

namespace frontalis
{

/// The muscles below each vertex of the skin at rest, for colours that show activations on the skin.
class SkinMuscles
{
public:
  /// `depth`: how far below the skin muscles are looked for, along its normal [m].
  explicit SkinMuscles(const Model& model, double depth = 12e-3);

  /// Per vertex of the skin the mean activation of the muscles below it, weighted by how much of each is there; 0 where
  /// there is none. `activation`: one per muscle.
  std::vector<float> activation(const std::vector<float>& activation) const;

private:
  struct Share
  {
    std::size_t muscle;
    float weight;
  };
  std::vector<std::size_t> begin_;  // of each vertex's entries in shares_, and the end
  std::vector<Share> shares_;       // the weights of a vertex add up to 1
};

}  // namespace frontalis
