#include "bake/voxels/local_frame.hpp"
#include "bake/voxels/voxel_index.hpp"

#include <cmath>
#include <cstdio>
#include <vector>

namespace frontalis
{
namespace
{

using Polygon = std::vector<Vector3>;

/// Keeps the part of the polygon where sign * p[axis] <= sign * limit.
void clip(Polygon& polygon, Polygon& scratch, std::size_t axis, double limit, double sign)
{
  scratch.clear();
  for (std::size_t v = 0; v < polygon.size(); ++v)
  {
    const Vector3 &p = polygon[v], &q = polygon[(v + 1) % polygon.size()];
    const double dp = sign * (limit - p[axis]), dq = sign * (limit - q[axis]);
    if (dp >= 0)
      scratch.push_back(p);
    if ((dp >= 0) != (dq >= 0))
      scratch.push_back(p + (dp / (dp - dq)) * (q - p));
  }
  polygon.swap(scratch);
}

double area(const Polygon& polygon)
{
  Vector3 sum{ 0, 0, 0 };
  for (std::size_t v = 2; v < polygon.size(); ++v)
    sum = sum + cross(polygon[v - 1] - polygon[0], polygon[v] - polygon[0]);
  return 0.5 * norm(sum);
}

/// Area of a surface in each voxel of the model.
class AreaInVoxels
{
public:
  AreaInVoxels(const Model& model, const LocalFrame& frame, const Region& crop)
      : model_(model), index_(model.voxels, model.size), area_(model.voxels.size(), 0)
  {
    crop_.lower = frame.to_local(crop.lower);
    crop_.upper = frame.to_local(crop.upper);
  }

  void add(const Vector3& a, const Vector3& b, const Vector3& c)
  {
    const Vector3 normal = cross(b - a, c - a);
    Polygon whole{ a, b, c };
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      clip(whole, scratch_, axis, crop_.lower[axis], -1);
      clip(whole, scratch_, axis, crop_.upper[axis], 1);
    }
    add_along(whole, 0, normal, { 0, 0, 0 });
  }

  const std::vector<double>& area() const { return area_; }

private:
  void add_along(const Polygon& polygon, std::size_t axis, const Vector3& normal, std::array<std::int32_t, 3> place)
  {
    if (polygon.size() < 3)
      return;
    if (axis == 3)
    {
      give(place, normal, frontalis::area(polygon));
      return;
    }
    double low = 1e300, high = -1e300;
    for (const Vector3& p : polygon)
    {
      low = std::min(low, p[axis]);
      high = std::max(high, p[axis]);
    }
    const double edge = model_.spacing[axis];
    // a face of the surface that lies on a face between two voxels belongs to the one below it
    const double below = high - low < 1e-9 * edge ? (normal[axis] > 0 ? -1e-6 : (normal[axis] < 0 ? 1e-6 : 0)) : 0;
    const auto first = static_cast<std::int32_t>(std::max(-1.0, std::floor(low / edge + below)));
    const auto last = static_cast<std::int32_t>(std::min(model_.size[axis] + 0.0, std::floor(high / edge + below)));
    Polygon part, scratch;
    for (std::int32_t at = first; at <= last; ++at)
    {
      place[axis] = at;
      if (first == last)
      {
        add_along(polygon, axis + 1, normal, place);
        return;
      }
      part = polygon;
      clip(part, scratch, axis, at * edge, -1);
      clip(part, scratch, axis, (at + 1) * edge, 1);
      add_along(part, axis + 1, normal, place);
    }
  }

  void give(std::array<std::int32_t, 3> place, const Vector3& normal, double amount)
  {
    // where the voxel was dropped, the one below it, two at most, carries the layer
    std::size_t axis = 0;
    for (std::size_t a = 1; a < 3; ++a)
    {
      if (std::abs(normal[a]) > std::abs(normal[axis]))
        axis = a;
    }
    for (int step = 0; step < 3; ++step)
    {
      const std::int32_t e = index_.find(place);
      if (e >= 0)
      {
        area_[static_cast<std::size_t>(e)] += amount;
        return;
      }
      place[axis] += normal[axis] > 0 ? -1 : 1;
    }
  }

  const Model& model_;
  VoxelIndex index_;
  std::vector<double> area_;
  Region crop_;
  Polygon scratch_;
};

}  // namespace

void add_thin_layers(const Volumes& volumes, const LocalFrame& frame, Model& model, BakeStages& stages)
{
  if (volumes.thin_layers().empty())
    return;
  // share of each thin layer in each voxel
  std::vector<std::vector<float>> shares;
  const double voxel_volume = model.spacing[0] * model.spacing[1] * model.spacing[2];
  for (const Volumes::ThinLayer& layer : volumes.thin_layers())
  {
    AreaInVoxels areas(model, frame, layer.crop);
    const TriangleMesh mesh = frame.to_local(layer.surface->mesh());
    for (const Triangle& t : mesh.triangles)
      areas.add(mesh.vertices[static_cast<std::size_t>(t[0])], mesh.vertices[static_cast<std::size_t>(t[1])],
                mesh.vertices[static_cast<std::size_t>(t[2])]);
    // one share for all outer voxels, so that the layer's volume is right and no sliver of a voxel becomes stiffer than
    // the others and rules the time step
    double wanted = 0, tissue = 0;
    std::size_t voxels = 0;
    const auto is_outer = [&](std::size_t e) { return areas.area()[e] > 0; };
    for (std::size_t e = 0; e < model.voxels.size(); ++e)
    {
      if (!is_outer(e))
        continue;
      wanted += areas.area()[e] * layer.thickness;
      tissue += static_cast<double>(model.fill[e]) * voxel_volume;
      ++voxels;
    }
    const double given = tissue > 0 ? std::min(wanted / tissue, 0.9) : 0;
    std::vector<float> share(model.voxels.size());
    for (std::size_t e = 0; e < share.size(); ++e)
      share[e] = is_outer(e) ? static_cast<float>(given) : 0;
    char text[256];
    std::snprintf(text, sizeof(text), "layer '%s': too thin to sample; combined into %zu outer voxels, %.4g mm3%s",
                  layer.name.c_str(), voxels, 1e9 * given * tissue,
                  given * tissue < 0.99 * wanted ? " (capped: it would fill them)" : "");
    stages.found(text);
    shares.push_back(std::move(share));
  }

  std::vector<std::int32_t> begin{ 0 };
  std::vector<std::int16_t> material;
  std::vector<float> proportion;
  std::vector<double> mixture(model.materials.size());
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    std::fill(mixture.begin(), mixture.end(), 0);
    for (auto m = static_cast<std::size_t>(model.mixture_begin[e]);
         m < static_cast<std::size_t>(model.mixture_begin[e + 1]); ++m)
      mixture[static_cast<std::size_t>(model.mixture_material[m])] += static_cast<double>(model.mixture_proportion[m]);
    for (std::size_t l = 0; l < shares.size(); ++l)
    {
      const auto share = static_cast<double>(shares[l][e]);
      for (double& part : mixture)
        part *= 1 - share;
      mixture[static_cast<std::size_t>(volumes.thin_layers()[l].material)] += share;
    }
    for (std::size_t m = 0; m < mixture.size(); ++m)
    {
      if (mixture[m] <= 0)
        continue;
      material.push_back(static_cast<std::int16_t>(m));
      proportion.push_back(static_cast<float>(mixture[m]));
    }
    begin.push_back(static_cast<std::int32_t>(material.size()));
  }
  model.mixture_begin = std::move(begin);
  model.mixture_material = std::move(material);
  model.mixture_proportion = std::move(proportion);
}

}  // namespace frontalis
