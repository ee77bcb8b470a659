#pragma once

#include "frontalis/solver/solver.hpp"

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace frontalis
{

/// A table of blendshapes. Each moves some muscles and action units by given shares of their full activation.
class BlendshapeTable
{
public:
  /// Reads a YAML file (config/blendshapes.yaml; empty: no blendshapes) and leaves out what the model lacks. Throws an
  /// Error that names file and key if a row is not a mapping of names to numbers from 0 to 1.
  BlendshapeTable(const std::string& file, const Model& model);

  /// Number of blendshapes.
  std::size_t size() const { return rows_.size(); }
  /// The pose of the face, in the local frame: the sum of the weighted shares of the named blendshapes, limited to
  /// 0..1. Adds blendshapes that move nothing of the model to `lacking`. Throws an Error if a name is not in the table
  /// or is given twice, or a weight is not within 0..1.
  Controls pose(const Model& model, const std::vector<std::string>& names, const std::vector<double>& weights,
                std::set<std::string>& lacking) const;

private:
  struct Row
  {
    std::vector<std::pair<std::size_t, double>> muscles;  ///< index of a muscle, and its share
    std::vector<std::pair<std::string, double>> units;
  };
  std::map<std::string, Row> rows_;
};

}  // namespace frontalis
