#include "bake/messages.hpp"
#include "bake/voxels/model_stages.hpp"
#include "bake/voxels/voxel_index.hpp"

#include <numeric>

namespace frontalis
{
namespace
{

using Polygon = std::vector<Vector3d>;

constexpr double most_of_voxel = 0.9;  // largest proportion of a voxel that a thin layer may fill

/// Keeps the part of a polygon from `low` to `high` along an axis.
void clip(Polygon& polygon, Polygon& scratch, int axis, double low, double high)
{
  for (const auto& [limit, sign] : { std::make_pair(low, -1.0), std::make_pair(high, 1.0) })
  {
    scratch.clear();
    for (std::size_t v = 0; v < polygon.size(); ++v)
    {
      const Vector3d &p = polygon[v], &q = polygon[(v + 1) % polygon.size()];
      const double dp = sign * (limit - p[axis]), dq = sign * (limit - q[axis]);
      if (dp >= 0)
        scratch.push_back(p);
      if ((dp >= 0) != (dq >= 0))
        scratch.push_back(p + (dp / (dp - dq)) * (q - p));
    }
    polygon.swap(scratch);
  }
}

double area(const Polygon& polygon)
{
  Vector3d sum{ 0, 0, 0 };
  for (std::size_t v = 2; v < polygon.size(); ++v)
    sum += (polygon[v - 1] - polygon[0]).cross(polygon[v] - polygon[0]);
  return 0.5 * sum.norm();
}

/// Area of a surface in each voxel of the model.
class AreaInVoxels
{
public:
  AreaInVoxels(const Model& model, const LocalFrame& frame, const Region& crop)
      : model_(model),
        frame_(frame),
        index_(model),
        area_(model.voxels.size(), 0),
        crop_(frame.to_local(to_vector(crop.lower)), frame.to_local(to_vector(crop.upper)))
  {
  }

  void add(const std::array<Vector3d, 3>& v)
  {
    Polygon whole(v.begin(), v.end());
    for (int axis = 0; axis < 3; ++axis)
      clip(whole, scratch_, axis, crop_.min()[axis], crop_.max()[axis]);
    add_along(whole, 0, (v[1] - v[0]).cross(v[2] - v[0]), { 0, 0, 0 });
  }

  const std::vector<double>& area() const { return area_; }

private:
  /// Cuts a polygon at the grid planes normal to `axis` and to the following axes, and adds the area of each piece to
  /// its voxel. `place` has the voxel's indices along the preceding axes.
  void add_along(const Polygon& polygon, int axis, const Vector3d& normal, VoxelPlace place)
  {
    if (polygon.size() < 3)
      return;
    if (axis == 3)
    {
      const double amount = frontalis::area(polygon);
      const Vector3d middle =
          std::accumulate(polygon.begin(), polygon.end(), Vector3d(Vector3d::Zero())) / polygon.size();
      const Vector3d inside = middle - 0.02 * model_.spacing[0] * normal.normalized();
      if (const std::int32_t e = amount > 0 ? frame_.owner(model_, index_, inside, inside) : -1; e >= 0)
        area_[e] += amount;
      else
        give(place, normal, amount);
      return;
    }
    Box box;
    for (const Vector3d& p : polygon)
      box.extend(p);
    const double low = box.min()[axis], high = box.max()[axis];
    const double edge = model_.spacing[axis];
    // a polygon in the plane between two voxels belongs to the voxel on its inner side
    const double below = high - low < 1e-9 * edge ? (normal[axis] > 0 ? -1e-6 : (normal[axis] < 0 ? 1e-6 : 0)) : 0;
    const auto first = static_cast<std::int32_t>(std::max(-1.0, std::floor(low / edge + below)));
    const auto last = static_cast<std::int32_t>(std::min(model_.size[axis] + 0.0, std::floor(high / edge + below)));
    Polygon part, scratch;
    for (std::int32_t at = first; at <= last; ++at)
    {
      place[axis] = at;
      if (first == last)
        return add_along(polygon, axis + 1, normal, place);
      part = polygon;
      clip(part, scratch, axis, at * edge, (at + 1) * edge);
      add_along(part, axis + 1, normal, place);
    }
  }

  /// Adds area to a voxel or, if the model has no such voxel, to the first of the next two inwards that exists.
  void give(VoxelPlace place, const Vector3d& normal, double amount)
  {
    Eigen::Index axis = 0;
    normal.cwiseAbs().maxCoeff(&axis);
    for (int step = 0; step<3; ++step, place[axis] += normal[axis]> 0 ? -1 : 1)
      if (const std::int32_t e = index_.find(place); e >= 0)
      {
        area_[e] += amount;
        return;
      }
  }

  const Model& model_;
  const LocalFrame& frame_;
  VoxelIndex index_;
  std::vector<double> area_;
  Box crop_;
  Polygon scratch_;
};

}  // namespace

void add_thin_layers(const Volumes& volumes, const LocalFrame& frame, Model& model, BakeMonitor& monitor)
{
  if (volumes.thin_layers().empty())
    return;
  // proportion of each thin layer in each voxel
  std::vector<std::vector<float>> shares;
  const double voxel_volume = model.spacing[0] * model.spacing[1] * model.spacing[2];
  for (const Volumes::ThinLayer& layer : volumes.thin_layers())
  {
    AreaInVoxels areas(model, frame, layer.crop);
    const TriangleMesh mesh = frame.to_local(layer.surface->mesh());
    for (const Triangle& t : mesh.triangles)
      areas.add(corners(mesh, t));
    double wanted = 0, tissue = 0;
    std::size_t voxels = 0;
    for (std::size_t e = 0; e < model.voxels.size(); ++e)
    {
      if (areas.area()[e] <= 0)
        continue;
      wanted += areas.area()[e] * layer.thickness;
      tissue += static_cast<double>(model.fill[e]) * voxel_volume;
      ++voxels;
    }
    const double given = tissue > 0 ? std::min(wanted / tissue, most_of_voxel) : 0;
    std::vector<float> share(model.voxels.size());
    for (std::size_t e = 0; e < share.size(); ++e)
      share[e] = areas.area()[e] > 0 ? static_cast<float>(given) : 0;
    monitor.found("layer '{}': too thin to sample; mixed into {} outer voxels, {:.4g} mm3{}", layer.name, voxels,
                  1e9 * given * tissue, given * tissue < 0.99 * wanted ? " (limited, because it would fill them)" : "");
    shares.push_back(std::move(share));
  }

  Shares mixed;
  std::vector<double> mixture(model.materials.size());
  for (std::size_t e = 0; e < model.voxels.size(); ++e)
  {
    std::fill(mixture.begin(), mixture.end(), 0);
    for (std::int32_t m = model.mixture_begin[e]; m < model.mixture_begin[e + 1]; ++m)
      mixture[model.mixture_material[m]] += static_cast<double>(model.mixture_proportion[m]);
    for (std::size_t l = 0; l < shares.size(); ++l)
    {
      const auto share = static_cast<double>(shares[l][e]);
      for (double& part : mixture)
        part *= 1 - share;
      mixture[volumes.thin_layers()[l].material] += share;
    }
    mixed.add(mixture, 1);
  }
  model.mixture_begin = std::move(mixed.begin);
  model.mixture_material = std::move(mixed.number);
  model.mixture_proportion = std::move(mixed.share);
}

}  // namespace frontalis
