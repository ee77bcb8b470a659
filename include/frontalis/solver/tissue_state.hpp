#pragma once

#include "frontalis/model/main_parts.hpp"
#include "frontalis/solver/solver.hpp"

#include <array>
#include <memory>
#include <vector>

namespace frontalis
{

/// State of the tissue inside, in the face frame. Symmetric tensors have the order xx, yy, zz, xy, yz, xz.
struct TissueState
{
  // one per node
  std::vector<std::array<float, 3>> place;         ///< present place [m]
  std::vector<std::array<float, 3>> displacement;  ///< from rest [m]
  // one per voxel, at the centre of its tissue
  std::vector<std::array<float, 6>> strain;  ///< Green-Lagrange strain [-]
  std::vector<std::array<float, 6>> stress;  ///< Cauchy stress of materials and fibres [Pa], without viscous stresses
  std::vector<float> von_mises;              ///< of `stress` [Pa]
  std::vector<float> volume_ratio;           ///< J = det F [-]
  /// present length of the fibres divided by that at rest, of the muscle with the largest share; 1 without muscle
  std::vector<float> fibre_stretch;
};

/// Reads the state of a solver's tissue, in double precision on the host. Layers with `shell: true` are not part of the
/// voxels, so their stress is missing.
class TissueReader
{
public:
  /// The model must outlive this object.
  explicit TissueReader(const Model& model);
  ~TissueReader();
  TissueReader(const TissueReader&) = delete;
  TissueReader& operator=(const TissueReader&) = delete;

  /// `solver` must be one of the same model.
  void read(const Solver& solver, TissueState& out) const;
  const MainParts& parts() const;

private:
  struct Implementation;
  std::unique_ptr<Implementation> self_;
};

}  // namespace frontalis
