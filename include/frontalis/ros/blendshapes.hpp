#pragma once

#include "frontalis/solver/solver.hpp"

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace frontalis
{

/// A table of names, each of which moves muscles and action units by shares.
class BlendshapeTable
{
public:
  /// Reads a YAML file (config/blendshapes.yaml; empty: no names) and keeps what the model has. Throws an Error that
  /// names the file and the key if a row is not a mapping of names to numbers from 0 to 1.
  BlendshapeTable(const std::string& file, const Model& model);

  /// Number of names.
  std::size_t size() const { return rows_.size(); }
  /// The pose of the face, in the local frame: the sum of the shares of the named blendshapes, limited to 0..1. Names
  /// that move nothing of the model are added to `lacking`. Throws an Error if a name is not in the table or is there
  /// twice, or a weight is not within 0..1.
  Controls pose(const Model& model, const std::vector<std::string>& names, const std::vector<double>& weights,
                std::set<std::string>& lacking) const;

private:
  struct Row
  {
    std::vector<std::pair<std::size_t, double>> muscles;  ///< index and share
    std::vector<std::pair<std::string, double>> units;
  };
  std::map<std::string, Row> rows_;
};

}  // namespace frontalis
