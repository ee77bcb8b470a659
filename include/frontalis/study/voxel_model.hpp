#pragma once

#include "frontalis/model/model.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace frontalis
{

// Models made in code, for studies and tests. Coordinates are those of the model's local frame, at rest [m].

using Point = std::array<double, 3>;
using Vectors = std::vector<Point>;
using Voxel = std::array<std::int32_t, 3>;  ///< indices (i,j,k) in the grid
using Condition = std::function<bool(const Point&)>;

/// A neo-Hookean material of Young's modulus [Pa], Poisson's ratio and density [kg/m3].
Material neo_hookean(double young, double poisson, double density = 1000);
double shear_modulus(double young, double poisson);
double bulk_modulus(double young, double poisson);

struct VoxelBox
{
  Voxel size{ { 1, 1, 1 } };
  Point spacing{ { 1e-3, 1e-3, 1e-3 } };  ///< [m]
  std::vector<Material> materials;
  std::function<double(const Voxel&)> fill{};   ///< proportion of tissue, 0: there is no voxel; empty: all are whole
  std::function<int(const Voxel&)> material{};  ///< index of the voxel's material; empty: the first
};

/// The model of a box, and of a box of whole cubic voxels of one material. Throws Error as build_nodes does.
Model voxel_model(const VoxelBox& box);
Model voxel_model(const Voxel& size, double edge, const Material& material);
/// A dense block of x * y * z equal neo-Hookean voxels (hypodermis, edge 1 mm), the face x = 0 held, under gravity
/// along -z.
Model dense_block(std::int32_t x, std::int32_t y, std::int32_t z);

/// Proportion of a voxel that is inside a shape, from samples^3 points; 0 below `fill_min`. The defaults are those of a
/// bake.
std::function<double(const Voxel&)> sampled_fill(const Point& spacing, const Condition& inside, int samples = 4,
                                                 double fill_min = 0.2);
/// Sets the mixture of each voxel: materials and their proportions.
using Mixture = std::vector<std::pair<int, float>>;
void mix(Model& model, const std::function<Mixture(std::size_t voxel)>& mixture);

/// A fibre of a voxel: muscle, direction of length 1, share of the voxel.
struct Fibre
{
  int muscle;
  std::array<float, 3> direction;
  float weight = 1;
};
void add_muscles(Model& model, const std::vector<Muscle>& muscles,
                 const std::function<std::vector<Fibre>(std::size_t voxel)>& fibres);
/// Gives every voxel fibres of one muscle; direction(e) is theirs in voxel e, of length 1.
void add_muscle(Model& model, const Muscle& muscle, const std::function<std::array<float, 3>(std::size_t)>& direction);
std::array<float, 3> along_x(std::size_t voxel);  ///< a direction for add_muscle()

/// Displacements [m] that deform the whole model by one gradient (row by row) and move it by `shift` [m].
Vectors affine_displacements(const Model& model, const std::array<double, 9>& gradient, const Point& shift = {});

/// Nodes for which a condition on their position holds, ascending.
std::vector<std::int32_t> nodes_where(const Model& model, const Condition& condition);
/// Makes such nodes rigid: still, or moved by the bone of that name.
void hold(Model& model, const Condition& condition, const std::string& bone = {});
/// Prescribes components of the displacement [m] of nodes, reached linearly over `ramp` [s].
void prescribe(Model& model, const std::vector<std::int32_t>& nodes, const std::array<bool, 3>& components,
               const Point& displacement = {}, double ramp = 0);
/// Keeps the nodes of the planes x = 0, y = 0 and z = 0 in their planes, as where a body is mirrored in all three.
void hold_mirror_planes(Model& model);

/// The triangles of a grid of points, point(s, t) with s and t from 0 to 1 in so many rows and columns; triangles
/// without area are left out.
TriangleMesh grid_mesh(int rows, int columns, const std::function<Point(double s, double t)>& point);
/// Binds points to the voxel that they are in, or to the nearest one.
Binding bind_points(const Model& model, const Vectors& points);
/// Adds a pressure [Pa] that acts on a mesh against its normals.
void add_pressure(Model& model, double pressure, const TriangleMesh& mesh);

}  // namespace frontalis
