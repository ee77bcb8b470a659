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

// Models that are made in code, for studies and tests. Positions are at rest, in the model's local frame [m].

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
  std::function<double(const Voxel&)> fill{};   ///< proportion of tissue; 0: no voxel; not set: 1 everywhere
  std::function<int(const Voxel&)> material{};  ///< index of the voxel's material; not set: 0
};

/// The model of a box, and of a box of full cubic voxels of one material. Throws Error like build_nodes().
Model voxel_model(const VoxelBox& box);
Model voxel_model(const Voxel& size, double edge, const Material& material);
/// A block of x * y * z equal neo-Hookean voxels (hypodermis, edge 1 mm), fixed at x = 0, with gravity along -z.
Model dense_block(std::int32_t x, std::int32_t y, std::int32_t z);

/// VoxelBox::fill of a shape: the fraction of samples^3 points that are inside, or 0 if that is below `fill_min`. The
/// default values are those of the bake.
std::function<double(const Voxel&)> sampled_fill(const Point& spacing, const Condition& inside, int samples = 4,
                                                 double fill_min = 0.2);
/// Sets the mixture of each voxel: materials and their proportions.
using Mixture = std::vector<std::pair<int, float>>;
void mix(Model& model, const std::function<Mixture(std::size_t voxel)>& mixture);

/// A fibre in a voxel: index of its muscle, unit vector, fraction of the voxel.
struct Fibre
{
  int muscle;
  std::array<float, 3> direction;
  float weight = 1;
};
void add_muscles(Model& model, const std::vector<Muscle>& muscles,
                 const std::function<std::vector<Fibre>(std::size_t voxel)>& fibres);
/// Gives every voxel e a fibre of one muscle along the unit vector direction(e).
void add_muscle(Model& model, const Muscle& muscle, const std::function<std::array<float, 3>(std::size_t)>& direction);
std::array<float, 3> along_x(std::size_t voxel);  ///< a direction for add_muscle()

/// Displacements [m] that deform the whole model by one deformation gradient (row-major) and move it by `shift` [m].
Vectors affine_displacements(const Model& model, const std::array<double, 9>& gradient, const Point& shift = {});

/// Nodes whose position at rest fulfils a condition, ascending.
std::vector<std::int32_t> nodes_where(const Model& model, const Condition& condition);
/// Makes the nodes that fulfil a condition rigid: fixed, or moved by the named bone, which is added if it is new.
void hold(Model& model, const Condition& condition, const std::string& bone = {});
/// Prescribes components of the displacement [m] of nodes. The displacement grows linearly during `ramp` [s].
void prescribe(Model& model, const std::vector<std::int32_t>& nodes, const std::array<bool, 3>& components,
               const Point& displacement = {}, double ramp = 0);
/// Keeps the nodes of the planes x = 0, y = 0 and z = 0 in their planes, because the model is an eighth of a symmetric
/// body.
void hold_mirror_planes(Model& model);

/// Triangulates point(s, t), with s and t from 0 to 1, in rows x columns rectangles. Leaves out triangles without area.
TriangleMesh grid_mesh(int rows, int columns, const std::function<Point(double s, double t)>& point);
/// Binds each point to the voxel that contains it, or otherwise to the nearest voxel.
Binding bind_points(const Model& model, const Vectors& points);
/// Adds a pressure [Pa] that acts on a mesh against its normals.
void add_pressure(Model& model, double pressure, const TriangleMesh& mesh);

}  // namespace frontalis
