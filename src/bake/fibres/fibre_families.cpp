#include "bake/fibres/fibre_families.hpp"

#include "frontalis/error.hpp"
#include "bake/parallel.hpp"

namespace frontalis
{
namespace
{

constexpr std::size_t grain = 1024;

/// x turned by the shortest rotation from `from` to `to` (lengths 1); `axis`, across `from`, is for opposite ones.
Vector3 turned(const Vector3& x, const Vector3& from, const Vector3& to, const Vector3& axis)
{
  const double cosine = dot(from, to);
  if (cosine < -1 + 1e-9)
    return 2 * dot(axis, x) * axis - x;
  const Vector3 v = cross(from, to);
  return x + cross(v, x) + (1 / (1 + cosine)) * cross(v, cross(v, x));
}

/// The material that rules voxel e among those whose families follow a surface; -1: none.
int ruling_material(const Scene& scene, const Model& model, std::size_t e)
{
  int ruling = -1;
  float largest = 0;
  for (auto m = static_cast<std::size_t>(model.mixture_begin[e]);
       m < static_cast<std::size_t>(model.mixture_begin[e + 1]); ++m)
  {
    const std::int16_t material = model.mixture_material[m];
    if (scene.materials[static_cast<std::size_t>(material)].along.empty() || model.mixture_proportion[m] <= largest)
      continue;
    largest = model.mixture_proportion[m];
    ruling = material;
  }
  return ruling;
}

}  // namespace

void turn_families(const Scene& scene, const std::vector<std::unique_ptr<PreparedSurface>>& surfaces,
                   const LocalFrame& frame, Model& model, BakeStages& stages)
{
  const std::size_t voxels = model.voxels.size();
  std::vector<const PreparedSurface*> along;
  for (const SceneMaterial& material : scene.materials)
    along.push_back(material.along.empty()
                        ? nullptr
                        : &named_surface(surfaces, material.along, scene.file + ": material '" + material.name + "'"));
  std::vector<int> ruling(voxels);
  std::vector<Vector3> normal(voxels, { 0, 0, 0 });
  parallel_ranges(
      voxels, grain,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t e = begin; e < end; ++e)
        {
          ruling[e] = ruling_material(scene, model, e);
          if (ruling[e] < 0)
            continue;
          Vector3 p = frame.origin;
          for (std::size_t a = 0; a < 3; ++a)
            p[frame.scene_axis(a)] += (model.voxels[e][a] + 0.5) * model.spacing[a];
          const PreparedSurface& surface = *along[static_cast<std::size_t>(ruling[e])];
          normal[e] = surface.pseudonormal(surface.tree().closest(p));
        }
      },
      &stages);

  std::vector<Vector3> across(scene.materials.size());
  std::vector<double> agreement(across.size(), 0);
  for (std::size_t m = 0; m < across.size(); ++m)
    if (along[m] != nullptr)
      across[m] = normalised(cross(scene.materials[m].families[0], scene.materials[m].families[1]));
  bool any = false;
  for (std::size_t e = 0; e < voxels; ++e)
    if (ruling[e] >= 0)
    {
      agreement[static_cast<std::size_t>(ruling[e])] += dot(across[static_cast<std::size_t>(ruling[e])], normal[e]);
      any = true;
    }
  if (!any)
    return;
  model.material_directions.assign(voxels, {});
  for (std::size_t e = 0; e < voxels; ++e)
  {
    if (ruling[e] < 0)
      continue;
    const auto m = static_cast<std::size_t>(ruling[e]);
    const auto& families = scene.materials[m].families;
    const Vector3 from = agreement[m] < 0 ? -1 * across[m] : across[m];
    for (std::size_t family = 0; family < 2; ++family)
    {
      const Vector3 direction = frame.turn(normalised(turned(families[family], from, normal[e], families[0])));
      for (std::size_t a = 0; a < 3; ++a)
        model.material_directions[e][3 * family + a] = static_cast<float>(direction[a]);
    }
  }
}

}  // namespace frontalis
