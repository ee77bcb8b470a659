#include "solver/shell/shell_energy.hpp"

#include "solver/contact/body_motion.hpp"
#include "solver/skin/bound_points.hpp"

namespace frontalis
{

template <class Real>
void add_shell_energies(const Model& model, const ShellMesh& mesh, const Real* const u[3],
                        std::vector<std::array<double, 3>>& forces, EnergyLedger& ledger)
{
  using Vector = physics::Vec3<double>;
  std::vector<Vector> moved, on_vertex(mesh.binding.voxel.size());
  moved.reserve(on_vertex.size());
  for (std::size_t v = 0; v < on_vertex.size(); ++v)
    moved.push_back(vector_of(bound_displacement(model, mesh.binding, v, u)));
  for (const ShellMesh::Triangle& triangle : mesh.triangles)
  {
    Vector of_triangle[6];
    for (std::size_t i = 0; i < 6; ++i)
      of_triangle[i] = moved[triangle.vertex[i]];
    const auto now = physics::shell_forces(triangle.rest, of_triangle);
    ledger["shell"] += now.membrane + now.bending;
    for (std::size_t i = 0; i < 6; ++i)
      on_vertex[triangle.vertex[i]] = on_vertex[triangle.vertex[i]] + now.force[i];
  }
  if (!forces.empty())
    spread_forces(model, mesh.binding, on_vertex, forces);
}

template void add_shell_energies(const Model&, const ShellMesh&, const float* const[3],
                                 std::vector<std::array<double, 3>>&, EnergyLedger&);
template void add_shell_energies(const Model&, const ShellMesh&, const double* const[3],
                                 std::vector<std::array<double, 3>>&, EnergyLedger&);

}  // namespace frontalis
