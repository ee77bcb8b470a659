#include "bake/fibres/fibres.hpp"
#include "bake/messages.hpp"
#include "bake/voxels/model_stages.hpp"

namespace frontalis
{
namespace
{

constexpr std::size_t grain = 1024;
constexpr double least_sine = 1e-3;  // of the angle between fibres and normal; below it they have no common plane

/// The shortest rotation from unit vector `from` to `to`. If they are opposite, rotates about `axis`, normal to `from`.
Eigen::Quaterniond shortest_rotation(const Vector3d& from, const Vector3d& to, const Vector3d& axis)
{
  if (from.dot(to) < -1 + 1e-9)
    return Eigen::Quaterniond(Eigen::AngleAxisd(pi, axis));
  return Eigen::Quaterniond::FromTwoVectors(from, to);
}

/// The directions at `angle` [rad] to both sides of the part of `fibre` that is perpendicular to `normal`, or of any
/// direction that is, if `fibre` is parallel to `normal`.
std::array<Vector3d, 2> families_about(const Vector3d& fibre, const Vector3d& normal, double angle)
{
  Vector3d along = fibre - fibre.dot(normal) * normal;
  along = along.norm() > least_sine ? along.normalized() : normal.unitOrthogonal();
  const Vector3d aside = std::sin(angle) * normal.cross(along);
  return { std::cos(angle) * along + aside, std::cos(angle) * along - aside };
}

/// The material with the largest proportion in voxel e among those whose fibres follow a surface; -1 if there is none.
int main_material(const Scene& scene, const Model& model, std::size_t e)
{
  int main = -1;
  float largest = 0;
  for (std::int32_t m = model.mixture_begin[e]; m < model.mixture_begin[e + 1]; ++m)
  {
    const std::int16_t material = model.mixture_material[m];
    if (scene.materials[material].along.empty() || model.mixture_proportion[m] <= largest)
      continue;
    largest = model.mixture_proportion[m];
    main = material;
  }
  return main;
}

}  // namespace

void turn_families(const Scene& scene, const PreparedSurfaces& surfaces, const std::vector<MuscleFibres>& fibres,
                   const LocalFrame& frame, Model& model, BakeMonitor& monitor)
{
  const std::size_t voxels = model.voxels.size();
  std::vector<const PreparedSurface*> along;
  std::vector<const MuscleFibres*> about;
  for (const SceneMaterial& material : scene.materials)
  {
    const std::string place = scene.file + ": material '" + material.name + "'";
    along.push_back(material.along.empty() ? nullptr : &named_surface(surfaces, material.along, place));
    about.push_back(material.about.empty() ? nullptr
                                           : &fibres[index_of(scene.muscles, material.about, place, "muscle")]);
  }
  std::vector<int> main(voxels);
  std::vector<Vector3d> normal(voxels, Vector3d::Zero());
  parallel_for(monitor, voxels, grain,
               [&](std::size_t e)
               {
                 main[e] = main_material(scene, model, e);
                 if (main[e] < 0)
                   return;
                 const PreparedSurface& surface = *along[main[e]];
                 normal[e] = surface.pseudonormal(surface.tree().closest(frame.voxel_centre(model, e)));
               });

  // per material: normal of the plane of its fibre families; sum of its cosines with the surface's normals
  std::vector<Vector3d> across(scene.materials.size(), Vector3d::Zero());
  std::vector<double> agreement(across.size(), 0);
  for (std::size_t m = 0; m < across.size(); ++m)
    if (const auto& [first, second] = scene.materials[m].families; along[m] != nullptr)
      across[m] = to_vector(first).cross(to_vector(second)).normalized();
  for (std::size_t e = 0; e < voxels; ++e)
    if (main[e] >= 0)
      agreement[main[e]] += across[main[e]].dot(normal[e]);
  if (std::all_of(main.begin(), main.end(), [](int m) { return m < 0; }))
    return;
  model.material_directions.assign(voxels, {});
  std::vector<char> upright(voxels, 0);
  parallel_for(monitor, voxels, grain,
               [&](std::size_t e)
               {
                 const int m = main[e];
                 if (m < 0)
                   return;
                 std::array<Vector3d, 2> families;
                 if (about[m] != nullptr)
                 {
                   const Vector3d fibre = about[m]->at(frame.voxel_centre(model, e));
                   upright[e] = fibre.cross(normal[e]).norm() > least_sine ? 0 : 1;
                   families = families_about(fibre, normal[e], scene.materials[m].angle);
                 }
                 else
                 {
                   const auto& [first, second] = scene.materials[m].families;
                   const Vector3d from = std::copysign(1.0, agreement[m]) * across[m];
                   const Eigen::Quaterniond rotation = shortest_rotation(from, normal[e], to_vector(first));
                   families = { rotation * to_vector(first), rotation * to_vector(second) };
                 }
                 for (std::size_t family = 0; family < 2; ++family)
                   Eigen::Map<Eigen::Vector3f>(&model.material_directions[e][3 * family]) =
                       frame.turn(families[family].normalized().eval()).cast<float>();
               });
  for (std::size_t m = 0; m < about.size(); ++m)
  {
    std::size_t count = 0;
    for (std::size_t e = 0; e < voxels; ++e)
      count += main[e] == static_cast<int>(m) ? upright[e] : 0;
    if (count > 0)
      monitor.found(
          "material '{}': in {} voxels the fibres of muscle '{}' are normal to surface '{}'; the families "
          "there lie about any direction in that surface",
          scene.materials[m].name, count, scene.materials[m].about, scene.materials[m].along);
  }
}

}  // namespace frontalis
