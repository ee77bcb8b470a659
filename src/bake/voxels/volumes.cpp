#include "bake/voxels/volumes.hpp"

#include "bake/messages.hpp"

namespace frontalis
{

Volumes::Volumes(const Scene& scene, const PreparedSurfaces& surfaces, double sample_spacing)
    : scene_(&scene), surfaces_(&surfaces)
{
  for (const Volume& volume : scene.volumes)
  {
    Entry entry;
    entry.volume = &volume;
    if (!volume.material.empty())
      entry.material = index_of(scene.materials, volume.material, place(volume), "material");
    else if (volume.tissue)
      throw Error(place(volume) + ": is tissue but has no material; name one");
    try
    {
      if (!volume.closed_by.empty())
        entry.closed_by = body_of(volume.closed_by);
      for (const std::string& name : volume.inside)
        entry.inside.push_back(body_of({ name }));
      for (const std::string& name : volume.outside)
        entry.outside.push_back(body_of({ name }));
      entry.hiding = entry.outside.size();
      for (const std::string& name : volume.without)
        entry.outside.push_back(body_of({ name }));
      if (!volume.within.empty())
        entry.within = depth_field_below(volume.within, { volume.depth_min, volume.depth_max });
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
    const std::string place = place_in_scene(scene, "muscle", muscle);
    const std::string& volume = muscle.volume.empty() ? muscle.name : muscle.volume;
    int& taken = entries_[index_of(scene.volumes, volume, place, "volume")].muscle;
    if (taken >= 0)
      throw failure("{}: volume '{}' already belongs to muscle '{}'; give each muscle its own volume", place, volume,
                    scene.muscles[taken].name);
    taken = static_cast<int>(m);
  }
  add_layers(scene, sample_spacing);
  for (DepthField& field : depth_fields_)
    std::sort(field.thresholds.begin(), field.thresholds.end());
}

void Volumes::add_layers(const Scene& scene, double sample_spacing)
{
  // Layers of one volume and surface lie one below the other. A thin layer or a shell forms no band; the next band
  // begins where the last band ends.
  struct Stack
  {
    double bottom = 0, next_band = 0;
  };
  std::map<std::pair<std::string, std::string>, Stack> stacks;
  for (const Layer& layer : scene.layers)
  {
    const std::string name = place_in_scene(scene, "layer", layer);
    const PreparedSurface* below = &named_surface(*surfaces_, layer.surface, name);
    Entry& entry = entries_[index_of(scene.volumes, layer.volume, name, "volume")];
    const int material = index_of(scene.materials, layer.material, name, "material");
    if (!(layer.thickness > 0))
      throw failure("{}: thickness is {:g} m; it must be above 0", name, layer.thickness);
    Stack& stack = stacks[{ layer.volume, layer.surface }];
    stack.bottom += layer.thickness;
    if (layer.shell)
      continue;
    if (layer.thickness < sample_spacing)
    {
      thin_layers_.push_back({ below, entry.volume->crop, layer.thickness, material, layer.name });
      continue;
    }
    const std::size_t field = depth_field_below(layer.surface, { stack.next_band, stack.bottom });
    entry.bands.push_back({ field, stack.next_band, stack.bottom, material, &layer });
    stack.next_band = stack.bottom;
  }
}

std::size_t Volumes::body_of(const std::vector<std::string>& names)
{
  const auto known = std::find(body_names_.begin(), body_names_.end(), names);
  if (known != body_names_.end())
    return known - body_names_.begin();
  std::vector<const PreparedSurface*> parts;
  parts.reserve(names.size());
  for (const std::string& name : names)
    parts.push_back(&named_surface(*surfaces_, name, "volume"));
  if (parts.size() > 1)
    joined_.push_back(
        std::make_unique<PreparedSurface>(fmt::format("{}", fmt::join(names, " + ")), join_surfaces(parts)));
  body_names_.push_back(names);
  bodies_.push_back(parts.size() > 1 ? joined_.back().get() : parts.front());
  return bodies_.size() - 1;
}

std::size_t Volumes::depth_field_below(const std::string& name, const std::array<double, 2>& thresholds)
{
  const PreparedSurface* surface = &named_surface(*surfaces_, name, "volume");
  auto field = std::find_if(depth_fields_.begin(), depth_fields_.end(),
                            [surface](const DepthField& known) { return known.surface == surface; });
  if (field == depth_fields_.end())
    field = depth_fields_.insert(field, DepthField{ surface, {} });
  field->thresholds.insert(field->thresholds.end(), thresholds.begin(), thresholds.end());
  return field - depth_fields_.begin();
}

std::string Volumes::place(const Volume& volume) const { return place_in_scene(*scene_, "volume", volume); }

Box Volumes::bounds_of(const Entry& entry) const
{
  struct Bound
  {
    std::string what;
    Box box;
    const PreparedSurface* surface = nullptr;
    bool of_many = false;  // a surface of which one is enough
  };
  std::vector<Bound> given{ { "its crop is", to_box(entry.volume->crop) } };
  const auto add_surface = [&given](const std::string& text, const PreparedSurface& surface, double reach, bool of_many)
  {
    const Vector3d margin = Vector3d::Constant(reach);
    given.push_back({ fmt::format("{} '{}' is", text, surface.name()),
                      Box(surface.box().min() - margin, surface.box().max() + margin), &surface, of_many });
  };
  if (entry.closed_by)
    add_surface("what closes it,", body(*entry.closed_by), 0, false);
  for (const std::size_t b : entry.inside)
    add_surface("surface", body(b), 0, true);
  if (entry.within)
    add_surface("the range of depths below surface", *depth_fields_[*entry.within].surface, entry.reach(), false);

  // A point lies in one of the surfaces that the volume is inside of, and within all other bounds.
  Box bounds = to_box(entry.volume->crop), inside;
  for (const Bound& bound : given)
    if (bound.of_many)
      inside.extend(bound.box);
    else
      bounds = bounds.intersection(bound.box);
  if (!entry.inside.empty())
    bounds = bounds.intersection(inside);
  if (!bounds.min().allFinite() || !bounds.max().allFinite())
    throw Error(place(*entry.volume) + ": has no bounds; give 'inside', 'closed_by' or 'within'");
  for (int a = 0; a < 3; ++a)
  {
    if (bounds.min()[a] < bounds.max()[a])
      continue;
    std::vector<std::string> ranges;
    std::string advice;
    for (const Bound& bound : given)
    {
      const double lower = bound.box.min()[a], upper = bound.box.max()[a];
      const auto text = [&](double x) { return std::isfinite(x) ? fmt::format("{:.4g}", x / scene_->unit) : "any"; };
      if (std::isfinite(lower) || std::isfinite(upper))
        ranges.push_back(fmt::format("{} {} to {}", bound.what, text(lower), text(upper)));
      const double extent = bound.surface == nullptr ? 0 : bound.surface->box().sizes().maxCoeff();
      const std::string unit = unit_advice(extent, scene_->unit);
      if (extent > 0 && advice.empty() && !unit.empty())
        advice =
            fmt::format("surface '{}' spans {}: {}; ", bound.surface->name(), length_text(extent, scene_->unit), unit);
    }
    throw failure(
        "{}: is empty: along {}, in {}, {}, which leaves nothing; {}check the crop, and the length units and "
        "axes of the scene and of its files",
        place(*entry.volume), "xyz"[a], unit_text(scene_->unit), fmt::join(ranges, ", "), advice);
  }
  return bounds;
}

Box Volumes::tissue_box() const
{
  Box all;
  for (const Entry& entry : entries_)
    if (entry.volume->tissue)
      all.extend(bounds_of(entry));
  if (all.isEmpty())
    throw Error(scene_->file + ": no volume is tissue; set 'tissue: true' in one");
  return all;
}

}  // namespace frontalis
