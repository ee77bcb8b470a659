#pragma once

#include "frontalis/byte_archive.hpp"
#include "solver/stepping/discretisation.hpp"

#include <cstdint>
#include <vector>

namespace frontalis
{

/// Share of a node in the kinetic energy of a mode. Nodes with less than the least share are not listed.
struct ModeShare
{
  std::int32_t node;
  float share;
};
constexpr float least_mode_share = 1.0F / 4096;

/// What a search knows of a mode: a mixture of modes with frequencies nearby.
struct FoundMode
{
  double frequency_squared;       ///< [1/s2]
  std::vector<ModeShare> shares;  ///< in ascending order of nodes
};

/// A node whose mass has changed.
struct AddedMass
{
  std::int64_t node;   // as wide as the others, so that no byte of the struct is undefined
  double before, now;  ///< [kg]
};

/// Adds mass to nodes while a motion distorts voxels so far that they alone would shorten the time step
/// (MassScalingSettings::in_motion); finite element codes know this as conventional mass scaling. A search for the
/// highest frequency tells which nodes move in the fastest mode. Raising a mass never raises a frequency, so that the
/// time step remains stable whatever is added. No node gets more than ten times its mass, and all of them together no
/// more than 1 % of the model's.
class MassInMotion
{
public:
  MassInMotion(const Model& model, const Discretisation& discretisation);

  /// Whether a frequency [1/s2] that a search found shortens the time step, and mass may be added. `added`: since rest.
  bool limits(double frequency_squared, const std::vector<AddedMass>& added) const;
  /// Adds mass until these modes allow the time step, as far as their shares tell. Returns what it has added, and
  /// includes it in `added`.
  std::vector<AddedMass> raise(const std::vector<FoundMode>& modes, std::vector<double>& node_mass,
                               std::vector<AddedMass>& added) const;
  double allowed() const { return allowed_; }
  /// Takes back a tenth of what was added, if much was, so that mass which earlier poses needed is there for later
  /// ones. Returns what has changed.
  std::vector<AddedMass> fade(std::vector<double>& node_mass, std::vector<AddedMass>& added) const;
  /// Proportion of the model's mass.
  double proportion(const std::vector<AddedMass>& added) const;

private:
  double allowed_;     // squared frequency [1/s2]; infinite if no mass is added in motion
  double total_mass_;  // at rest [kg]
};

std::vector<std::int32_t> nodes_of(const std::vector<AddedMass>& added);

}  // namespace frontalis
