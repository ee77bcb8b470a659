#include "bake/voxels/volumes.hpp"

#include "frontalis/error.hpp"

#include <algorithm>
#include <map>

namespace frontalis
{
namespace
{

template <class Named>
int index_of(const std::vector<Named>& list, const std::string& name)
{
  for (std::size_t i = 0; i < list.size(); ++i)
  {
    if (list[i].name == name)
      return static_cast<int>(i);
  }
  return -1;
}

}  // namespace

Volumes::Volumes(const Scene& scene, const std::vector<std::unique_ptr<PreparedSurface>>& surfaces,
                 double sample_spacing)
    : scene_(&scene), surfaces_(&surfaces)
{
  for (const Volume& volume : scene.volumes)
  {
    Entry entry;
    entry.volume = &volume;
    if (!volume.material.empty())
    {
      entry.material = index_of(scene.materials, volume.material);
      if (entry.material < 0)
        throw Error(place(volume) + ": there is no material '" + volume.material + "'");
    }
    else if (volume.tissue)
      throw Error(place(volume) + ": is tissue but has no material; name one");
    try
    {
      if (!volume.closed_by.empty())
        entry.closed_by = solid(volume.closed_by);
      for (const std::string& name : volume.inside)
        entry.inside.push_back(solid({ name }));
      for (const std::string& name : volume.outside)
        entry.outside.push_back(solid({ name }));
      entry.hiding = entry.outside.size();
      for (const std::string& name : volume.without)
        entry.outside.push_back(solid({ name }));
      if (!volume.within.empty())
      {
        entry.within = depth(volume.within);
        auto& thresholds = depths_[static_cast<std::size_t>(entry.within)].thresholds;
        thresholds.push_back(volume.depth_min);
        thresholds.push_back(volume.depth_max);
      }
    }
    catch (const Error& error)
    {
      throw Error(place(volume) + ": " + error.what());
    }
    entries_.push_back(entry);
  }
  for (std::size_t m = 0; m < scene.muscles.size(); ++m)
  {
    const SceneMuscle& muscle = scene.muscles[m];
    const int volume = index_of(scene.volumes, muscle.volume.empty() ? muscle.name : muscle.volume);
    if (volume < 0)
      throw Error(scene.file + ":" + std::to_string(muscle.line) + ": muscle '" + muscle.name +
                  "': there is no volume '" + muscle.volume + "'");
    int& taken = entries_[static_cast<std::size_t>(volume)].muscle;
    if (taken >= 0)
      throw Error(scene.file + ":" + std::to_string(muscle.line) + ": muscle '" + muscle.name + "': volume '" +
                  muscle.volume + "' is muscle '" + scene.muscles[static_cast<std::size_t>(taken)].name +
                  "' already; give each its own");
    taken = static_cast<int>(m);
  }
  add_layers(scene, sample_spacing);
  for (Depth& d : depths_)
    std::sort(d.thresholds.begin(), d.thresholds.end());
}

void Volumes::add_layers(const Scene& scene, double sample_spacing)
{
  // layers of one volume and surface lie one below the other; a thin one leaves its depth to the next that is sampled
  std::map<std::pair<std::string, std::string>, std::pair<double, double>>
      reached;  // depth below, start of the next band
  for (const Layer& layer : scene.layers)
  {
    const std::string name = scene.file + ":" + std::to_string(layer.line) + ": layer '" + layer.name + "'";
    const int volume = index_of(scene.volumes, layer.volume);
    const int material = index_of(scene.materials, layer.material);
    const PreparedSurface* below = &named_surface(*surfaces_, layer.surface, name);
    if (volume < 0)
      throw Error(name + ": there is no volume '" + layer.volume + "'");
    if (material < 0)
      throw Error(name + ": there is no material '" + layer.material + "'");
    if (!(layer.thickness > 0))
      throw Error(name + ": thickness is " + std::to_string(layer.thickness) + " m; it must be above 0");
    auto& [bottom, band_begin] =
        reached.emplace(std::make_pair(layer.volume, layer.surface), std::make_pair(0.0, 0.0)).first->second;
    bottom += layer.thickness;
    Entry& entry = entries_[static_cast<std::size_t>(volume)];
    if (layer.thickness < sample_spacing)
    {
      thin_layers_.push_back({ below, entry.volume->crop, layer.thickness, material, layer.name });
      continue;
    }
    const int at = depth(layer.surface);
    auto& thresholds = depths_[static_cast<std::size_t>(at)].thresholds;
    thresholds.push_back(band_begin);
    thresholds.push_back(bottom);
    entry.bands.push_back({ at, band_begin, bottom, material, &layer });
    band_begin = bottom;
  }
}

int Volumes::solid(const std::vector<std::string>& names)
{
  const auto known = std::find(solid_names_.begin(), solid_names_.end(), names);
  if (known != solid_names_.end())
    return static_cast<int>(known - solid_names_.begin());
  std::vector<const PreparedSurface*> parts;
  std::string together;
  for (const std::string& name : names)
  {
    parts.push_back(&named_surface(*surfaces_, name, "volume"));
    together += (together.empty() ? "" : " + ") + name;
  }
  const PreparedSurface* body = parts.front();
  if (parts.size() > 1)
  {
    joined_.push_back(std::make_unique<PreparedSurface>(together, join_surfaces(parts), parts.front()->line()));
    body = joined_.back().get();
  }
  solid_names_.push_back(names);
  solids_.push_back({ body });
  return static_cast<int>(solids_.size()) - 1;
}

int Volumes::depth(const std::string& name)
{
  const PreparedSurface* below = &named_surface(*surfaces_, name, "volume");
  for (std::size_t d = 0; d < depths_.size(); ++d)
  {
    if (depths_[d].surface == below)
      return static_cast<int>(d);
  }
  depths_.push_back({ below, {} });
  return static_cast<int>(depths_.size()) - 1;
}

std::string Volumes::place(const Volume& volume) const
{
  return scene_->file + ":" + std::to_string(volume.line) + ": volume '" + volume.name + "'";
}

Box Volumes::tissue_box() const
{
  Box all;
  for (const Entry& entry : entries_)
  {
    if (!entry.volume->tissue)
      continue;
    Region bounds = entry.volume->crop;
    const auto narrow = [&bounds](const Box& box, double by)
    {
      for (std::size_t a = 0; a < 3; ++a)
      {
        bounds.lower[a] = std::max(bounds.lower[a], box.lower[a] - by);
        bounds.upper[a] = std::min(bounds.upper[a], box.upper[a] + by);
      }
    };
    if (entry.closed_by >= 0)
      narrow(solids_[static_cast<std::size_t>(entry.closed_by)].surface->box(), 0);
    Box inside;
    for (const int s : entry.inside)
      inside.include(solids_[static_cast<std::size_t>(s)].surface->box());
    if (!entry.inside.empty())
      narrow(inside, 0);
    if (entry.within >= 0)
      narrow(depths_[static_cast<std::size_t>(entry.within)].surface->box(), entry.volume->depth_max);
    for (std::size_t a = 0; a < 3; ++a)
    {
      if (!std::isfinite(bounds.lower[a]) || !std::isfinite(bounds.upper[a]))
        throw Error(place(*entry.volume) + ": has no bounds; give 'inside', 'closed_by' or 'within'");
      if (bounds.lower[a] >= bounds.upper[a])
        throw Error(place(*entry.volume) + ": is empty: its surfaces, depths and crop have no place in common along " +
                    std::string(1, static_cast<char>('x' + a)) +
                    "; a surface is flat there, or a crop or a length unit is wrong");
    }
    Box box;
    box.lower = bounds.lower;
    box.upper = bounds.upper;
    all.include(box);
  }
  if (all.empty())
    throw Error(scene_->file + ": no volume is tissue; say 'tissue: true' in one");
  return all;
}

}  // namespace frontalis
