#pragma once

#include "bake/mesh/surface.hpp"

#include <memory>
#include <string>
#include <vector>

namespace frontalis
{

/// What a scene's volumes are made of, resolved: numbers in place of names.
class Volumes
{
public:
  /// A body that points are inside or outside of: one surface, or several that close it together.
  struct Solid
  {
    const PreparedSurface* surface = nullptr;
  };
  /// A surface below which depths count, and the depths at which something changes, ascending [m].
  struct Depth
  {
    const PreparedSurface* surface = nullptr;
    std::vector<double> thresholds;
  };
  /// Part of a stack of layers that is sampled: material at depths from `from` to `to` below the depth's surface.
  struct Band
  {
    int depth = 0;
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
  struct Entry
  {
    const Volume* volume = nullptr;
    int closed_by = -1;        ///< solid
    std::vector<int> inside;   ///< solids
    std::vector<int> outside;  ///< solids: those of `outside`, then those of `without`
    std::size_t hiding = 0;    ///< how many of these, the first, hide what lies behind them
    int within = -1;           ///< depth
    int material = -1;
    int muscle = -1;
    std::vector<Band> bands;

    /// Depths are counted on the near side of the `outside` surfaces only.
    bool asks_sight() const { return within >= 0 && hiding > 0; }
  };

  /// Throws Error naming what a volume, layer or muscle refers to that is not there.
  Volumes(const Scene& scene, const std::vector<std::unique_ptr<PreparedSurface>>& surfaces, double sample_spacing);

  const std::vector<Entry>& entries() const { return entries_; }
  const std::vector<Solid>& solids() const { return solids_; }
  const std::vector<Depth>& depths() const { return depths_; }
  const std::vector<ThinLayer>& thin_layers() const { return thin_layers_; }

  /// Box that holds all tissue, in scene coordinates [m]. Throws Error where a tissue volume has no bounds.
  Box tissue_box() const;

  /// "FILE:LINE: volume 'NAME'" for messages.
  std::string place(const Volume& volume) const;

private:
  int solid(const std::vector<std::string>& names);
  int depth(const std::string& name);
  void add_layers(const Scene& scene, double sample_spacing);

  const Scene* scene_;
  const std::vector<std::unique_ptr<PreparedSurface>>* surfaces_;
  std::vector<std::unique_ptr<PreparedSurface>> joined_;
  std::vector<std::vector<std::string>> solid_names_;
  std::vector<Solid> solids_;
  std::vector<Depth> depths_;
  std::vector<Entry> entries_;
  std::vector<ThinLayer> thin_layers_;
};

}  // namespace frontalis
