#pragma once

#include "bake/mesh/surface.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

namespace frontalis
{

/// The volumes of a scene, with the names in the scene file resolved to indices and surfaces.
class Volumes
{
public:
  /// A surface below which depths are measured, and the depths at which something changes, ascending [m].
  struct DepthField
  {
    const PreparedSurface* surface = nullptr;
    std::vector<double> thresholds;
  };
  /// A layer that is thick enough to be sampled: its material lies at depths `from` to `to` [m].
  struct Band
  {
    std::size_t depth_field = 0;
    double from = 0, to = 0;
    int material = 0;
    const Layer* layer = nullptr;
  };
  /// A layer too thin for sampling.
  struct ThinLayer
  {
    const PreparedSurface* surface = nullptr;
    Region crop;
    double thickness = 0;
    int material = 0;
    std::string name;
  };
  /// A volume. A body is what points lie inside or outside of: one surface, or several that close it together.
  struct Entry
  {
    const Volume* volume = nullptr;
    std::optional<std::size_t> closed_by;  ///< body
    std::vector<std::size_t> inside;       ///< bodies
    std::vector<std::size_t> outside;      ///< bodies: those of `outside`, then those of `without`
    std::size_t hiding = 0;                ///< the number of bodies of `outside`, which hide what lies behind them
    std::optional<std::size_t> within;     ///< depth field
    int material = -1;
    int muscle = -1;
    std::vector<Band> bands;

    /// Whether a point belongs to the volume only where no `outside` body lies between it and the surface from which
    /// its depth is measured.
    bool needs_sight() const { return within && hiding > 0; }
    /// Whether `condition` is true of any of the hiding bodies.
    template <class Condition>
    bool any_hiding(const Condition& condition) const
    {
      return std::any_of(outside.begin(), outside.begin() + static_cast<std::ptrdiff_t>(hiding), condition);
    }
  };

  /// Layers thinner than `sample_spacing` are thin layers. Throws Error if a volume, layer or muscle refers to
  /// something that is not there.
  Volumes(const Scene& scene, const PreparedSurfaces& surfaces, double sample_spacing);

  const std::vector<Entry>& entries() const { return entries_; }
  std::size_t bodies() const { return bodies_.size(); }
  const PreparedSurface& body(std::size_t index) const { return *bodies_[index]; }
  const std::vector<DepthField>& depth_fields() const { return depth_fields_; }
  const std::vector<ThinLayer>& thin_layers() const { return thin_layers_; }

  /// The box around all tissue, in scene coordinates [m]. Throws Error if a tissue volume has no bounds.
  Box tissue_box() const;

  /// The beginning of error messages about a volume.
  std::string place(const Volume& volume) const;

private:
  /// Bounds of a tissue volume. Throws Error if it has none or nothing lies within them.
  Box bounds_of(const Entry& entry) const;
  /// Index of the body that these surfaces form. Bodies and depth fields are made on first use.
  std::size_t body_of(const std::vector<std::string>& names);
  std::size_t depth_field_below(const std::string& name);
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

}  // namespace frontalis
