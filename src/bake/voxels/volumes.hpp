#pragma once

#include "bake/mesh/surface.hpp"

namespace frontalis
{

/// The volumes of a scene, with the names in the scene file resolved to indices and surfaces.
class Volumes
{
public:
  /// A surface below which depths are measured, and the depths at which a volume or a layer begins or ends [m].
  struct DepthField
  {
    const PreparedSurface* surface = nullptr;
    std::vector<double> thresholds;  ///< ascending
  };
  /// A layer that is thick enough to be sampled: its material lies at depths `from` to `to` [m].
  struct Band
  {
    std::size_t depth_field = 0;
    double from = 0, to = 0;
    int material = 0;
    const Layer* layer = nullptr;
  };
  /// A layer that is thinner than the distance between samples.
  struct ThinLayer
  {
    const PreparedSurface* surface = nullptr;
    Region crop;
    double thickness = 0;
    int material = 0;
    std::string name;
  };
  /// A volume of the scene. Its surfaces are given as bodies: regions enclosed by one surface, or by several together.
  struct Entry
  {
    const Volume* volume = nullptr;
    std::optional<std::size_t> closed_by;  ///< index of a body
    std::vector<std::size_t> inside;       ///< indices of bodies
    std::vector<std::size_t> outside;      ///< indices of bodies: those of `outside`, then those of `without`
    std::size_t hiding = 0;                ///< how many of these bodies, the first ones, hide the points behind them
    std::optional<std::size_t> within;     ///< index of a depth field
    int material = -1;                     ///< index; -1: none
    int muscle = -1;                       ///< index; -1: none
    std::vector<Band> bands;

    /// Largest distance of its points from the surface of the depth field [m].
    double reach() const { return std::max(volume->depth_max, -volume->depth_min); }
    /// Whether the volume excludes points if an `outside` body lies between them and the surface of the depth field.
    bool needs_sight() const { return within && hiding > 0; }
    /// Whether condition(index) is true for any of the bodies that hide points; see `hiding`.
    template <class Condition>
    bool any_hiding(const Condition& condition) const
    {
      return std::any_of(outside.begin(), outside.begin() + static_cast<std::ptrdiff_t>(hiding), condition);
    }
  };

  /// Layers thinner than `sample_spacing` [m] are thin layers. Throws Error if a volume, layer or muscle refers to an
  /// element that does not exist.
  Volumes(const Scene& scene, const PreparedSurfaces& surfaces, double sample_spacing);

  const std::vector<Entry>& entries() const { return entries_; }
  std::size_t bodies() const { return bodies_.size(); }
  const PreparedSurface& body(std::size_t index) const { return *bodies_[index]; }
  const std::vector<DepthField>& depth_fields() const { return depth_fields_; }
  const std::vector<ThinLayer>& thin_layers() const { return thin_layers_; }

  /// The box around all tissue, in scene coordinates [m]. Throws Error if a tissue volume has no bounds.
  Box tissue_box() const;

  /// The beginning of a message about a volume: see place_in_scene().
  std::string place(const Volume& volume) const;

private:
  /// Bounds of a tissue volume. Throws Error if it has none or they are empty.
  Box bounds_of(const Entry& entry) const;
  /// Index of the body that the named surfaces enclose. Bodies and depth fields are made on first use.
  std::size_t body_of(const std::vector<std::string>& names);
  /// Index of the depth field of a surface, to which the thresholds are added.
  std::size_t depth_field_below(const std::string& name, const std::array<double, 2>& thresholds);
  void add_layers(const Scene& scene, double sample_spacing);

  const Scene* scene_;
  const PreparedSurfaces* surfaces_;
  PreparedSurfaces joined_;
  std::vector<std::vector<std::string>> body_names_;
  std::vector<const PreparedSurface*> bodies_;
  std::vector<DepthField> depth_fields_;
  std::vector<Entry> entries_;
  std::vector<ThinLayer> thin_layers_;
};

/// Tells whether a point lies in a volume, or the first of the volume's conditions that fails.
enum class Membership
{
  inside,
  cropped,   ///< outside the volume's crop
  beyond,    ///< outside the surfaces that enclose the volume
  excluded,  ///< inside an `outside` or `without` surface
  wrong_depth,
  hidden  ///< an `outside` surface lies between the point and the surface from which its depth is measured
};

/// Membership of a single point. Slow, but independent of the optimised sampling of voxels, so that it can check that.
Membership membership(const Volumes& volumes, const Volumes::Entry& entry, const Vector3d& p);
/// Whether a point lies in a volume that is tissue.
bool in_tissue(const Volumes& volumes, const Vector3d& p);

/// Throws Error if the holes of a volume's surface do harm: for more than a tenth of the points inside, the winding
/// number is below 3/4, because a hole is near. The error has the length and position of the hole in front of which
/// most of these points lie. Pinholes, gaps and holes far from the volume (the neck of a head whose forehead is baked)
/// are harmless.
void check_openings(const Scene& scene, const Volumes& volumes);

}  // namespace frontalis
