#include "bake/voxels/bind_points.hpp"

#include "bake/mesh/cut_mesh.hpp"
#include "frontalis/error.hpp"
#include "bake/length_text.hpp"
#include "bake/parallel.hpp"

#include <cmath>

namespace frontalis
{
namespace
{

constexpr std::size_t grain = 1024;
constexpr double farthest_landmark = 20e-3;

struct BoundMesh
{
  TriangleMesh mesh;
  Binding binding;
  std::size_t triangles = 0;   ///< inside the crop
  std::size_t too_far = 0;     ///< of those, with a vertex too far from every voxel
  Vector3 unbound{ 0, 0, 0 };  ///< such a vertex, scene coordinates
};

BoundMesh bind_mesh(const TriangleMesh& whole, const Region& crop, const LocalFrame& frame, const PointBinder& binder,
                    BakeStages& stages)
{
  const TriangleMesh surface = cut_mesh(whole, crop);
  const std::size_t count = surface.vertices.size();
  std::vector<std::int32_t> voxel(count, -1);
  std::vector<std::array<float, 3>> coordinates(count);
  parallel_ranges(
      count, grain,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t v = begin; v < end; ++v)
        {
          if (!binder.bind(frame.to_local(surface.vertices[v]), voxel[v], coordinates[v]))
            voxel[v] = -1;
        }
      },
      &stages);

  BoundMesh bound;
  std::vector<bool> keep(surface.triangles.size());
  for (std::size_t t = 0; t < keep.size(); ++t)
  {
    bool near = true;
    for (const std::int32_t v : surface.triangles[t])
    {
      if (voxel[static_cast<std::size_t>(v)] >= 0)
        continue;
      bound.unbound = surface.vertices[static_cast<std::size_t>(v)];
      near = false;
    }
    keep[t] = near;
    bound.too_far += near ? 0 : 1;
  }
  bound.triangles = surface.triangles.size();
  std::vector<std::int32_t> vertex_of;
  bound.mesh = frame.to_local(keep_triangles(surface, keep, &vertex_of));
  for (const std::int32_t v : vertex_of)
  {
    bound.binding.voxel.push_back(voxel[static_cast<std::size_t>(v)]);
    bound.binding.coordinates.push_back(coordinates[static_cast<std::size_t>(v)]);
  }
  return bound;
}

void bind_landmarks(const Scene& scene, const LocalFrame& frame, const PointBinder& binder, Model& model)
{
  const TriangleTree tree(model.skin);
  for (const SceneLandmark& landmark : scene.landmarks)
  {
    const std::string place = scene.file + ":" + std::to_string(landmark.line) + ": landmark '" + landmark.name + "'";
    const ClosestPoint closest = tree.closest(frame.to_local(landmark.position));
    if (closest.triangle < 0)
      throw Error(place + ": there is no published skin that it could lie on");
    if (closest.distance > farthest_landmark)
      throw Error(place + ": lies " + length_text(closest.distance, scene.unit) + " from the published skin; at most " +
                  length_text(farthest_landmark, scene.unit) +
                  " are allowed: check its coordinates and the skin's crop");
    std::int32_t voxel = -1;
    std::array<float, 3> coordinates{};
    if (!binder.bind(closest.point, voxel, coordinates))
      throw Error(place + ": no voxel is near enough to carry it; raise the skin's 'extrapolation'");
    model.landmarks.push_back(landmark.name);
    model.landmark_positions.push_back(closest.point);
    model.landmark_binding.voxel.push_back(voxel);
    model.landmark_binding.coordinates.push_back(coordinates);
  }
}

}  // namespace

PointBinder::PointBinder(const Model& model, double extrapolation)
    : model_(model), index_(model.voxels, model.size), extrapolation_(extrapolation)
{
}

bool PointBinder::bind(const Vector3& local, std::int32_t& voxel, std::array<float, 3>& coordinates) const
{
  std::array<std::int32_t, 3> cell{};
  for (std::size_t a = 0; a < 3; ++a)
    cell[a] = static_cast<std::int32_t>(std::floor(std::max(-1e6, std::min(1e6, local[a] / model_.spacing[a]))));
  voxel = index_.find(cell);
  if (voxel < 0)
  {
    // rings of cells around it, until no nearer voxel can come
    const double edge = std::min({ model_.spacing[0], model_.spacing[1], model_.spacing[2] });
    const auto rings = static_cast<std::int32_t>(std::ceil(extrapolation_ / edge)) + 1;
    double best = extrapolation_ * extrapolation_ * (1 + 1e-12);
    for (std::int32_t ring = 1; ring <= rings && (ring - 1) * edge * (ring - 1) * edge <= best; ++ring)
    {
      for (std::int32_t k = -ring; k <= ring; ++k)
      {
        for (std::int32_t j = -ring; j <= ring; ++j)
        {
          const bool whole = std::abs(k) == ring || std::abs(j) == ring;
          for (std::int32_t i = -ring; i <= ring; i += whole ? 1 : 2 * ring)
          {
            const std::array<std::int32_t, 3> place{ { cell[0] + i, cell[1] + j, cell[2] + k } };
            const std::int32_t candidate = index_.find(place);
            if (candidate < 0)
              continue;
            Box box;
            for (std::size_t a = 0; a < 3; ++a)
            {
              box.lower[a] = place[a] * model_.spacing[a];
              box.upper[a] = (place[a] + 1) * model_.spacing[a];
            }
            const double squared = box.squared_distance(local);
            if (squared < best || (squared == best && (voxel < 0 || candidate < voxel)))
            {
              best = squared;
              voxel = candidate;
            }
          }
        }
      }
    }
  }
  if (voxel < 0)
    return false;
  for (std::size_t a = 0; a < 3; ++a)
    coordinates[a] =
        static_cast<float>(local[a] / model_.spacing[a] - model_.voxels[static_cast<std::size_t>(voxel)][a]);
  return true;
}

void bind_surfaces(const Scene& scene, const std::vector<std::unique_ptr<PreparedSurface>>& surfaces,
                   const LocalFrame& frame, Model& model, BakeStages& stages)
{
  const double edge = std::max({ model.spacing[0], model.spacing[1], model.spacing[2] });
  const double extrapolation = scene.skin.extrapolation > 0 ? scene.skin.extrapolation : 2 * edge;
  const PointBinder binder(model, extrapolation);

  if (!scene.skin.surface.empty())
  {
    const PreparedSurface& skin = named_surface(surfaces, scene.skin.surface, scene.file + ": skin");
    BoundMesh bound = bind_mesh(skin.mesh(), scene.skin.crop, frame, binder, stages);
    if (bound.mesh.triangles.empty())
      throw Error(scene.file + ": skin: no triangle of surface '" + scene.skin.surface +
                  "' lies in the crop and within " + length_text(extrapolation, scene.unit) +
                  " of the tissue; check its crop and the tissue volumes");
    if (bound.too_far > 0)
      throw Error(scene.file + ": skin: " + std::to_string(bound.too_far) + " of " + std::to_string(bound.triangles) +
                  " triangles of surface '" + scene.skin.surface +
                  "' in the crop have a vertex that no voxel can carry, the one at " +
                  place_text(bound.unbound, scene.unit) + " say: it is farther than " +
                  length_text(extrapolation, scene.unit) +
                  " from the tissue; crop the skin to the tissue, or raise its 'extrapolation'");
    model.skin = std::move(bound.mesh);
    model.skin_binding = std::move(bound.binding);
  }
  bind_landmarks(scene, frame, binder, model);

  for (const SceneLoad& load : scene.loads)
  {
    Load out;
    out.name = load.name;
    out.ramp = load.ramp;
    out.value = frame.turn(load.value);
    if (load.kind == SceneLoad::Kind::displacement)
    {
      out.kind = Load::Kind::displacement;
      out.fixed = frame.turn(load.fixed);
    }
    else
    {
      const std::string place = scene.file + ":" + std::to_string(load.line) + ": load '" + load.name + "'";
      BoundMesh bound =
          bind_mesh(named_surface(surfaces, load.surface, place).mesh(), load.crop, frame, binder, stages);
      if (bound.mesh.triangles.empty())
        throw Error(place + ": no triangle of surface '" + load.surface + "' lies in its crop and within " +
                    length_text(extrapolation, scene.unit) + " of the tissue");
      if (bound.too_far > 0)
        stages.found("load '" + load.name + "': " + std::to_string(bound.too_far) +
                     " triangles left out, too far from the tissue");
      out.kind = load.kind == SceneLoad::Kind::pressure ? Load::Kind::pressure : Load::Kind::traction;
      if (out.kind == Load::Kind::pressure)
        out.value = load.value;
      out.mesh = std::move(bound.mesh);
      out.binding = std::move(bound.binding);
    }
    model.loads.push_back(std::move(out));
  }
}

}  // namespace frontalis
