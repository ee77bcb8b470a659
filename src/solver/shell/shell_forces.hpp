#pragma once

#include "solver/cpu/shell_kernel.hpp"
#include "frontalis/solver/shell_mesh.hpp"
#include "solver/stepping/node_part.hpp"

#include <array>
#include <vector>

namespace frontalis
{

/// Computes the forces of layers that are shells. They act on the nodes of the voxels that carry the shells' vertices.
/// In prepare_step() threads find the displacements of the vertices, in before_step() each finds the forces of its part
/// of the triangles. In add_forces() each thread adds up the forces on the vertices in its voxels, and passes them on
/// to the nodes of its planes through the transposed binding, both in a fixed order.
template <class Real>
class ShellForces : public NodePart<Real>
{
public:
  ShellForces(const Model& model, const ShellKernels<Real>& kernels);

  void run(EffectSet running) override { runs_ = running.has(Effect::shell); }
  void reset() override {}
  void list_arrays(ArrayList& list) override;
  bool idle() const override { return !runs_ || blocks_.empty(); }
  bool pushes() const override { return true; }
  bool prepares() const override { return true; }
  void prepare_step(const NodeShare& share, const Real* const u[3]) override;
  void before_step(const NodeShare& share, const Real* const u[3], const ConstraintStep& step) override;
  void add_forces(const NodeShare& share, const ForceSink<Real>& sink) override;
  void add_energies(const Real* const u[3], const std::vector<RigidTransform>& bones, bool open,
                    std::vector<std::array<double, 3>>& forces, EnergyLedger& ledger) override;

private:
  using Block = ShellBlock<Real>;
  using Vertices = ShellVertices<Real>;
  using Sums = WeightedSums<Real>;
  using Vectors = std::vector<ShellVector<Real>>;
  // Forces on vertices and on nodes that one thread adds up [N].
  struct Work
  {
    Vectors on_vertex, on_node;
  };

  // Where ShellKernels::place() and forces() write the vector of item i of a list.
  std::int32_t place_of(std::size_t i) const;
  void add_blocks();

  const Model& model_;
  ShellMesh mesh_;
  ShellKernels<Real> kernels_;
  bool runs_ = true;
  std::vector<Vertices> vertices_;
  std::vector<Block> blocks_;
  // first vertex in each plane of voxels; the last entry is the number of vertices
  std::vector<std::int32_t> plane_vertices_;
  std::vector<std::int32_t> nodes_;  // nodes that carry vertices, ascending
  Sums on_vertex_;                   // forces on vertices from those of triangles
  Sums on_node_;                     // forces on nodes_ from those on vertices
  // Values of the present step:
  Vectors u_;               // displacements of vertices, see ShellKernels [m]
  Vectors forces_;          // see ShellKernels [N]
  std::vector<Work> work_;  // one per thread
};

}  // namespace frontalis
