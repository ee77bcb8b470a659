#pragma once

#include "bake/voxels/gaps.hpp"

namespace frontalis
{

struct MuscleFibres;

/// Number, from 1, of the flap (Model::Flap) to which a voxel of the model belongs; 0: it is in no flap.
inline int flap_of(const Model& model, std::size_t voxel)
{
  const auto above = [&](const Model::Flap& flap) { return flap.first > model.voxels[voxel][2]; };
  return static_cast<int>(std::find_if(model.flaps.begin(), model.flaps.end(), above) - model.flaps.begin());
}

/// Conversion between scene and local coordinates: local axis a is scene axis (first + a) mod 3; the origin is a node
/// of the grid.
struct LocalFrame
{
  int first = 0;
  Vector3d origin{ 0, 0, 0 };  ///< scene coordinates [m]
  const Gaps* gaps = nullptr;  ///< null: the model has no gaps

  int scene_axis(int local) const { return (first + local) % 3; }
  /// Local components of a vector given by its scene components.
  template <class T>
  std::array<T, 3> turn(const std::array<T, 3>& scene) const
  {
    return { scene[scene_axis(0)], scene[scene_axis(1)], scene[scene_axis(2)] };
  }
  Vector3d turn(const Vector3d& scene) const
  {
    return { scene[scene_axis(0)], scene[scene_axis(1)], scene[scene_axis(2)] };
  }
  Vector3d to_local(const Vector3d& scene) const { return turn(Vector3d(scene - origin)); }
  TriangleMesh to_local(TriangleMesh mesh) const
  {
    for (Vector3& v : mesh.vertices)
      v = to_array(to_local(to_vector(v)));
    return mesh;
  }
  /// Scene coordinates [m] of a point in local coordinates [m].
  Vector3d to_scene(const Vector3d& local) const
  {
    Vector3d p = origin;
    for (int a = 0; a < 3; ++a)
      p[scene_axis(a)] += local[a];
    return p;
  }
  /// Scene coordinates of the point (i, j, k) of the model's grid, in voxel edges from the origin.
  Vector3d grid_point(const Model& model, double i, double j, double k) const
  {
    return to_scene(to_vector(model.spacing).cwiseProduct(Vector3d(i, j, k)));
  }
  /// The box around all voxels, in the scene [m]. The axes of the grid are those of the scene in another order.
  Box grid_box(const Model& model) const
  {
    return Box(grid_point(model, 0, 0, 0)).extend(grid_point(model, model.size[0], model.size[1], model.size[2]));
  }
  /// Index of the voxel to whose tissue a point near a gap belongs; -1 for a point that is not near a gap. `local`: the
  /// point in local coordinates [m].
  std::int32_t owner(const Model& model, const VoxelIndex& index, const Vector3d& local, const Vector3d& inside) const;
  Vector3d voxel_centre(const Model& model, std::size_t e) const
  {
    const auto v = rest_place(model, model.voxels[e]);
    return grid_point(model, v[0] + 0.5, v[1] + 0.5, v[2] + 0.5);
  }
};

// The stages of the bake that fill the model, in the order of the calls.

/// Chooses as local x the axis along which rows of voxels are longest, sorts the voxels, and fills the model's grid,
/// nodes, flaps (Model::Flap) and the joints of their nodes, mixtures and muscle weights. add_fibres() fills the fibre
/// directions.
LocalFrame assemble_voxels(const Grid& grid, const Voxels& voxels, Model& model);

/// Copies frames, gravity, materials, muscles, accuracy and presets from the scene into the model.
void copy_settings(const Scene& scene, const LocalFrame& frame, Model& model);
/// Copies the poses of bones in expressions, action units and the demo. The model must have its bones.
void copy_poses(const Scene& scene, Model& model);

/// Lowers the weights of muscles where the scene weakens them, and adds to the report what is left of each. This is the
/// last stage, because other parts of the report describe muscles at full strength. Throws Error if a weakness at a
/// place weakens nothing.
void weaken_muscles(const Scene& scene, const LocalFrame& frame, Model& model, BakeReport* report);

/// Finds rigid, sliding and prescribed nodes and fills bones, constraint surfaces and loads of kind displacement.
/// A surface restricts the nodes at most `within` in front of it and at most two voxels behind it. Its front is the
/// side with most of the tissue that is at most two voxels away. If several constraints apply to a node, rigid takes
/// precedence over prescribed, and prescribed over sliding; of several rigid constraints the first applies, of several
/// sliding surfaces the nearest. Throws Error for a constraint near which there is no node. Warns of one that restricts
/// no node because others do, of tissue of which no node is free, and of muscles that are held at their insertion.
void restrict_nodes(const Scene& scene, const PreparedSurfaces& surfaces, const std::vector<MuscleFibres>& fibres,
                    const LocalFrame& frame, Model& model, BakeMonitor& monitor);

/// Index of a bone in the model, which is added if it is new; -1 without a name.
std::int32_t bone_of(const std::string& name, Model& model);

/// Nodes at an end of a muscle.
struct MuscleEndNodes
{
  std::vector<std::size_t> nodes;
  bool at_origin = false;  ///< of the end at which the coordinate along the fibres begins
};

/// Chooses among the nodes `near` a bone those at which a muscle originates. They are corners of the muscle's voxels in
/// one of its ends, which are 15 % of the fibres' length: the origin where it is known and has near nodes, otherwise
/// the end with the larger proportion of near nodes. Without nodes if neither end has a near node.
MuscleEndNodes origin_nodes(std::size_t muscle, const MuscleFibres& fibres, const std::vector<bool>& near,
                            const LocalFrame& frame, const Model& model);

/// Whether a constraint attaches tissue at its surfaces: with `boundary: true`, without friction, and without a
/// `within` of its own, which restricts the nodes themselves. It does so too where the effect `attachment` is switched
/// off: the same nodes are then restricted, but held or sliding where they are.
bool attaches(const Scene& scene, const SceneConstraint& constraint);

/// The surfaces of all constraints that attach tissue.
std::vector<const PreparedSurface*> attaching_surfaces(const Scene& scene, const PreparedSurfaces& surfaces);

/// Turns rigid and sliding nodes of constraints that attach tissue into attached nodes, unless the effect `attachment`
/// is switched off. The master of a node is a free node above the surface, near the point of the surface that is
/// closest to the node. If there is none, the tissue is too thin: nodes up to half an edge above the surface stay
/// restricted, and the others become free.
void attach_nodes(const Scene& scene, const PreparedSurfaces& surfaces, const LocalFrame& frame, Model& model,
                  BakeMonitor& monitor);

/// Makes the joints of flaps agree with the restrictions of their nodes. Joined nodes rest at the same place and are
/// therefore restricted alike, unless the tissue on the two sides of a gap is attached to a bone differently.
/// Restrictions by effects in `switched_off` do not count, because the bake leaves them out.
void settle_joints(const EffectSet& switched_off, Model& model);

/// Removes loose components of voxels. Common faces connect voxels, common edges or corners do not. Keeps the largest
/// component, and all others that have a restricted node and at least a hundredth as many voxels as the largest.
void remove_islands(Model& model, BakeMonitor& monitor);

/// Mixes the material of each layer that is too thin to be sampled into the voxels through which its surface passes.
/// Area in voxels that were left out is added to the voxel below. All these voxels get the same proportion of the
/// layer's material, because a voxel with little tissue and more of a stiff layer would shorten the time step. The
/// volume of the layer is preserved.
void add_thin_layers(const Volumes& volumes, const LocalFrame& frame, Model& model, BakeMonitor& monitor);

/// Fills the model's directions of materials whose fibre families follow a surface. Families about a muscle's fibres
/// lie on either side of these in each voxel, parallel to the surface at the point closest to the voxel's centre.
/// Others are turned by the shortest rotation from the normal of their plane to the surface's normal there. The sign of
/// the plane's normal is chosen to agree with the surface's normals in most voxels. In a voxel with several such
/// materials, the one with the largest proportion is used.
void turn_families(const Scene& scene, const PreparedSurfaces& surfaces, const std::vector<MuscleFibres>& fibres,
                   const LocalFrame& frame, Model& model, BakeMonitor& monitor);

/// A mesh in local coordinates, and its vertices bound to voxels.
struct BoundMesh
{
  TriangleMesh mesh;
  Binding binding;
  std::size_t triangles = 0;    ///< number of triangles inside the crop
  std::size_t too_far = 0;      ///< number of those triangles with a vertex too far from every voxel
  Vector3d unbound{ 0, 0, 0 };  ///< one such vertex, scene coordinates [m]
};
/// Largest distance of a bound point from its voxel [m].
double extrapolation_of(const Scene& scene, const Model& model);
/// Binds those triangles of a surface in scene coordinates that lie in the crop and whose vertices can all be bound.
BoundMesh bind_mesh(const TriangleMesh& whole, const Region& crop, const LocalFrame& frame, const Model& model,
                    double extrapolation, BakeMonitor& monitor);

/// Gives the model the films of the scene's skin, and halves the edges of `surface`, in scene coordinates, until they
/// resolve their lines.
void add_films(const Scene& scene, TriangleMesh& surface, Model& model, BakeMonitor& monitor);

/// Fills the model's skin, landmarks and loads and binds their points to voxels. Throws Error if no triangle of a load
/// can be bound, a vertex of the skin is too far from all voxels, or a landmark is too far from the skin.
void bind_surfaces(const Scene& scene, const PreparedSurfaces& surfaces, const LocalFrame& frame, Model& model,
                   BakeMonitor& monitor);

/// Volumes of the muscles that surfaces bound, in the order of the model's muscles.
std::vector<BakeReport::MuscleVolume> measure_muscles(const Volumes& volumes, const std::vector<MuscleFibres>& fibres,
                                                      const Model& model, BakeMonitor& monitor);

}  // namespace frontalis
