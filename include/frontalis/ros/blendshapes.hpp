#pragma once

#include "frontalis/model/model.hpp"

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace frontalis
{

/// A table of names, each of which moves muscles by shares.
class BlendshapeTable
{
public:
  /// Reads a YAML file (config/blendshapes.yaml; empty: no names) and keeps the muscles that the model has. Throws an
  /// Error that names the file and the key if a row is not a mapping of names to numbers from 0 to 1.
  BlendshapeTable(const std::string& file, const Model& model);

  /// Number of names.
  std::size_t size() const { return rows_.size(); }
  /// Activations, 0..1, of the muscles that the named blendshapes move: the sums of their shares. Names that move no
  /// muscle of the model are added to `lacking`. Throws an Error if a name is not in the table or is there twice, or a
  /// weight is not within 0..1.
  std::map<std::string, double> activation(const std::vector<std::string>& names, const std::vector<double>& weights,
                                           std::set<std::string>& lacking) const;

private:
  std::map<std::string, std::vector<std::pair<std::string, double>>> rows_;
};

}  // namespace frontalis
