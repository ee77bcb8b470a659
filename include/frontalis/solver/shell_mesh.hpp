#pragma once

#include "frontalis/model/model.hpp"
#include "frontalis/physics/shell.hpp"

#include <array>
#include <vector>

namespace frontalis
{

/// The layers of a model that are shells, made ready for the law of physics/shell.hpp. Their membranes are free of
/// stress at the positions that the voxels give them at rest, and they are free of bending moments in the shape of
/// Shell::surface.
struct ShellMesh
{
  struct Triangle
  {
    /// The corners, then the vertices beyond the edges opposite to them; corner 0 takes the place of a missing vertex.
    std::array<std::int32_t, 6> vertex;
    physics::ShellTriangle<double> rest;
    /// Bounds of the largest eigenvalues of the stiffness [N/m]: `membrane`, on the three corners, at any deformation;
    /// `bending`, on all six vertices, at rest.
    double membrane, bending;

    bool has_beyond(std::size_t edge) const { return vertex[3 + edge] != vertex[0]; }
  };

  explicit ShellMesh(const Model& model);

  std::vector<Triangle> triangles;
  Binding binding;  ///< binding of the vertices, sorted by voxel

private:
  void add(const Model& model, const Shell& shell);
};

/// Makes a triangle from the rest positions of its vertices [m]. `beyond[i]`: whether there is a vertex 3 + i beyond
/// edge i; if not, no bending moment passes through the edge.
///
/// A surface z = 1/2 (k11 x^2 + k22 y^2 + k12 x y) over the triangle's plane gives the outer vertices the heights T k,
/// hence k = T^-1 times the change of heights. The energy is 1/2 A k^T C k, C = D [1 nu 0; nu 1 0; 0 0 (1 - nu) / 2]
/// and D = E t^3 / (12 (1 - nu^2)), as in a plate (Timoshenko & Woinowsky-Krieger, Theory of Plates and Shells). Where
/// the six vertices lie close to a conic, T is nearly singular; Tikhonov's regularisation then limits its inverse. The
/// energy of a constant curvature is exact on any mesh, but the forces of a uniform moment cancel at vertices only
/// where triangles are regular. ShellMesh then changes the energies so that they cancel elsewhere, too
/// (doc/wrinkles.md).
ShellMesh::Triangle shell_triangle(const std::array<physics::Vec3<double>, 6>& x, const std::array<bool, 3>& beyond,
                                   double thickness, double young, double poisson);

/// Adds forces on bound points [N] to those on nodes, through the transposed binding.
void spread_forces(const Model& model, const Binding& binding, const std::vector<physics::Vec3<double>>& on_points,
                   std::vector<std::array<double, 3>>& on_nodes);

}  // namespace frontalis
