#include "bake/shapes/head/head.hpp"
#include "bake/voxels/model_stages.hpp"
#include "bake/voxels/voxel_index.hpp"

#include "bake/mesh/halve_edges.hpp"
#include "bake/messages.hpp"

namespace frontalis
{
namespace
{

constexpr std::size_t points_per_task = 1024;
constexpr double farthest_landmark = 20e-3;  // largest distance from the skin [m]
constexpr double distant_landmark = 5e-3;    // distance from the skin above which it warns [m]
constexpr double deep = 0.5e-3;              // depth below a surface at which the side of a gap is certain [m]

/// Finds the voxel that moves a point: the one that contains it, or the nearest one within the extrapolation distance.
class PointBinder
{
public:
  PointBinder(const Model& model, const LocalFrame& frame, double extrapolation)
      : model_(model), frame_(frame), index_(model), extrapolation_(extrapolation)
  {
  }

  /// Binds a point. Returns false if no voxel is near enough. Coordinates in a voxel run from 0 to 1 along each of its
  /// edges. `inwards`: unit vector into the tissue, which decides on which side of a gap the point is.
  bool bind(const Vector3d& local, const Vector3d& inwards, std::int32_t& voxel,
            std::array<float, 3>& coordinates) const
  {
    const double edge = model_.spacing[0];
    voxel = frame_.owner(model_, index_, local + 0.02 * edge * inwards, local + std::min(0.25 * edge, deep) * inwards);
    if (voxel >= 0)
    {
      set_coordinates(local, voxel, coordinates);
      return true;
    }
    const VoxelPlace cell = cell_of(local);
    voxel = index_.find(cell);
    if (voxel < 0)
      voxel = nearest(local, inwards, cell);
    if (voxel >= 0)
      set_coordinates(local, voxel, coordinates);
    return voxel >= 0;
  }

  /// Whether tissue lies behind a point of a surface. `inwards`: as in bind().
  bool has_tissue_behind(const Vector3d& local, const Vector3d& inwards) const
  {
    const double edge = model_.spacing[0];
    return index_.find(cell_of(local + 0.02 * edge * inwards)) >= 0 ||
           index_.find(cell_of(local + 0.5 * edge * inwards)) >= 0;
  }

private:
  VoxelPlace cell_of(const Vector3d& local) const
  {
    VoxelPlace cell{};
    for (int a = 0; a < 3; ++a)
      cell[a] = static_cast<std::int32_t>(std::floor(std::max(-1e6, std::min(1e6, local[a] / model_.spacing[a]))));
    return cell;
  }

  void set_coordinates(const Vector3d& local, std::int32_t voxel, std::array<float, 3>& coordinates) const
  {
    const VoxelPlace place = rest_place(model_, model_.voxels[voxel]);
    for (int a = 0; a < 3; ++a)
      coordinates[a] = static_cast<float>(local[a] / model_.spacing[a] - place[a]);
  }

  /// Searches cubic shells of cells around a cell, until no further shell can contain a nearer voxel. Voxels on the
  /// side to which the surface's normal points are taken only if there are no others, because they are the tissue
  /// beyond a gap, such as the other lip.
  std::int32_t nearest(const Vector3d& local, const Vector3d& inwards, const VoxelPlace& cell) const
  {
    const Vector3d spacing = to_vector(model_.spacing);
    const double edge = spacing.minCoeff();
    const auto shells = static_cast<std::int32_t>(std::ceil(extrapolation_ / edge)) + 1;
    std::int32_t voxel = -1, beyond = -1;
    double best = extrapolation_ * extrapolation_ * (1 + 1e-12), best_beyond = best;
    for (std::int32_t shell = 1; shell <= shells && (shell - 1) * edge * (shell - 1) * edge <= best; ++shell)
      for (std::int32_t k = -shell; k <= shell; ++k)
        for (std::int32_t j = -shell; j <= shell; ++j)
        {
          const bool face = std::abs(k) == shell || std::abs(j) == shell;
          for (std::int32_t i = -shell; i <= shell; i += face ? 1 : 2 * shell)
          {
            const VoxelPlace place{ { cell[0] + i, cell[1] + j, cell[2] + k } };
            const std::int32_t candidate = index_.find(place);
            if (candidate < 0)
              continue;
            const Vector3d lower(place[0], place[1], place[2]), upper = lower + Vector3d::Ones();
            const double squared =
                Box(lower.cwiseProduct(spacing), upper.cwiseProduct(spacing)).squaredExteriorDistance(local);
            const bool is_beyond = inwards.dot((lower + upper).cwiseProduct(spacing) / 2 - local) < 0;
            double& least = is_beyond ? best_beyond : best;
            std::int32_t& chosen = is_beyond ? beyond : voxel;
            if (squared < least || (squared == least && (chosen < 0 || candidate < chosen)))
            {
              least = squared;
              chosen = candidate;
            }
          }
        }
    return voxel >= 0 ? voxel : beyond;
  }

  const Model& model_;
  const LocalFrame& frame_;
  VoxelIndex index_;
  double extrapolation_;
};

/// Whether tissue surrounds a surface, such as that of a hollow, whose normals then point into the tissue.
bool is_surrounded(const Scene& scene, const std::string& surface)
{
  const auto names = [&](const std::vector<std::string>& list)
  { return std::find(list.begin(), list.end(), surface) != list.end(); };
  bool surrounded = false, surrounds = false;
  for (const Volume& volume : scene.volumes)
  {
    surrounded = surrounded || (volume.tissue && (names(volume.outside) || names(volume.without)));
    surrounds = surrounds || (volume.tissue && names(volume.inside));
  }
  return surrounded && !surrounds;
}

/// Normal of a triangle into the tissue, local axes, twice as long as its area.
Vector3d inward_normal(const TriangleMesh& surface, const Triangle& t, const LocalFrame& frame)
{
  const auto v = corners(surface, t);
  return frame.turn(Vector3d((v[2] - v[0]).cross(v[1] - v[0])));
}

/// Unit vectors at the vertices of a surface, local axes, opposite to its normals.
std::vector<Vector3d> inward_normals(const TriangleMesh& surface, const LocalFrame& frame)
{
  std::vector<Vector3d> normals(surface.vertices.size(), Vector3d::Zero());
  for (const Triangle& t : surface.triangles)
    for (const std::int32_t c : t)
      normals[c] += inward_normal(surface, t, frame);
  for (Vector3d& normal : normals)
    normal.normalize();
  return normals;
}

/// The triangles of a load near the tissue that are clear of the surfaces of SceneLoad::clear_of, with edges of at most
/// `longest` [m].
TriangleMesh clear_mesh(const SceneLoad& load, const PreparedSurfaces& surfaces, const Box& tissue, double longest,
                        const std::string& place)
{
  const Box box = to_box(load.crop).intersection(tissue);
  TriangleMesh mesh = cut_mesh(refined(named_surface(surfaces, load.surface, place).mesh(), box, longest), load.crop);
  for (const std::string& name : load.clear_of)
  {
    const TriangleTree& other = named_surface(surfaces, name, place).tree();
    std::vector<bool> keep;
    for (const Triangle& t : mesh.triangles)
      keep.push_back(std::all_of(t.begin(), t.end(),
                                 [&](std::int32_t v)
                                 { return other.closest(vertex(mesh, v)).distance >= load.clearance; }));
    mesh = keep_triangles(mesh, keep);
  }
  return mesh;
}

/// The triangles of a load that have tissue behind them, with normals out of the tissue. Others lie in bone or in a
/// cavity; their part of the load would act on the nearest tissue, however little that is.
TriangleMesh loaded_mesh(const Scene& scene, const SceneLoad& load, TriangleMesh surface, const LocalFrame& frame,
                         const PointBinder& binder)
{
  if (is_surrounded(scene, load.surface))
    for (Triangle& t : surface.triangles)
      std::swap(t[1], t[2]);
  std::vector<bool> keep;
  for (const Triangle& t : surface.triangles)
  {
    const auto v = corners(surface, t);
    keep.push_back(binder.has_tissue_behind(frame.to_local(Vector3d((v[0] + v[1] + v[2]) / 3)),
                                            inward_normal(surface, t, frame).normalized()));
  }
  return keep_triangles(surface, keep);
}

BoundMesh bind_mesh(const TriangleMesh& whole, const Region& crop, const LocalFrame& frame, const PointBinder& binder,
                    BakeMonitor& monitor)
{
  const TriangleMesh surface = cut_mesh(whole, crop);
  const std::size_t count = surface.vertices.size();
  std::vector<std::int32_t> voxel(count, -1);
  std::vector<std::array<float, 3>> coordinates(count);
  const std::vector<Vector3d> inwards = inward_normals(surface, frame);
  parallel_for(monitor, count, points_per_task,
               [&](std::size_t v)
               { binder.bind(frame.to_local(to_vector(surface.vertices[v])), inwards[v], voxel[v], coordinates[v]); });

  BoundMesh bound;
  std::vector<bool> keep(surface.triangles.size(), true);
  for (std::size_t t = 0; t < keep.size(); ++t)
  {
    for (const std::int32_t v : surface.triangles[t])
    {
      if (voxel[v] >= 0)
        continue;
      bound.unbound = vertex(surface, v);
      keep[t] = false;
    }
    bound.too_far += keep[t] ? 0 : 1;
  }
  bound.triangles = surface.triangles.size();
  std::vector<std::int32_t> vertex_of;
  bound.mesh = frame.to_local(keep_triangles(surface, keep, &vertex_of));
  for (const std::int32_t v : vertex_of)
  {
    bound.binding.voxel.push_back(voxel[v]);
    bound.binding.coordinates.push_back(coordinates[v]);
  }
  return bound;
}

void bind_landmarks(const Scene& scene, const LocalFrame& frame, const PointBinder& binder, Model& model,
                    BakeMonitor& monitor)
{
  const TriangleTree tree(model.skin);
  for (const SceneLandmark& landmark : scene.landmarks)
  {
    const std::string place = place_in_scene(scene, "landmark", landmark);
    const Vector3d position =
        landmark.head ? head_of(*landmark.head)->place(landmark.point) : to_vector(landmark.position);
    const ClosestPoint closest = tree.closest(frame.to_local(position));
    if (landmark.head && closest.distance > farthest_landmark)
      continue;
    if (closest.triangle < 0)
      throw Error(place + ": there is no published skin on which it could lie");
    if (closest.distance > farthest_landmark)
      throw failure(
          "{}: lies {} from the published skin; at most {} are allowed: check its coordinates and the skin's crop",
          place, length_text(closest.distance, scene.unit), length_text(farthest_landmark, scene.unit));
    if (!landmark.head && closest.distance > distant_landmark)
      monitor.warn("{} lies {} from the published skin and was moved to it: check its coordinates", place,
                   length_text(closest.distance, scene.unit));
    std::int32_t voxel = -1;
    std::array<float, 3> coordinates{};
    const auto corner = corners(model.skin, model.skin.triangles[closest.triangle]);
    const Vector3d inwards = (corner[2] - corner[0]).cross(corner[1] - corner[0]).normalized();
    if (!binder.bind(closest.point, inwards, voxel, coordinates))
      throw Error(place + ": no voxel is near enough to carry it; raise the skin's 'extrapolation'");
    model.landmarks.push_back(landmark.name);
    model.landmark_positions.push_back(to_array(closest.point));
    model.landmark_binding.voxel.push_back(voxel);
    model.landmark_binding.coordinates.push_back(coordinates);
  }
}

}  // namespace

double extrapolation_of(const Scene& scene, const Model& model)
{
  const double edge = std::max({ model.spacing[0], model.spacing[1], model.spacing[2] });
  return scene.skin.extrapolation > 0 ? scene.skin.extrapolation : 2 * edge;
}

BoundMesh bind_mesh(const TriangleMesh& whole, const Region& crop, const LocalFrame& frame, const Model& model,
                    double extrapolation, BakeMonitor& monitor)
{
  return bind_mesh(whole, crop, frame, PointBinder(model, frame, extrapolation), monitor);
}

namespace
{

/// Tells that a point lies inside a surface that bounds the tissue from within, such as a bone that pokes through the
/// skin; otherwise returns an empty text.
std::string text_of_body_around(const Scene& scene, const PreparedSurfaces& surfaces, const Vector3d& point)
{
  for (const Volume& volume : scene.volumes)
    for (const auto* const names : { &volume.outside, &volume.without })
      for (const std::string& name : *names)
        for (const auto& surface : surfaces)
          if (volume.tissue && surface->name() == name && surface->tree().winding_number(point) > 0.5)
            return fmt::format(" and lies inside of surface '{}', which may be misplaced", name);
  return "";
}

}  // namespace

void bind_surfaces(const Scene& scene, const PreparedSurfaces& surfaces, const LocalFrame& frame, Model& model,
                   BakeMonitor& monitor)
{
  const double extrapolation = extrapolation_of(scene, model);
  const PointBinder binder(model, frame, extrapolation);
  Box tissue = frame.grid_box(model);
  tissue = Box(tissue.min().array() - extrapolation, tissue.max().array() + extrapolation);

  if (!scene.skin.surface.empty())
  {
    const PreparedSurface& skin = named_surface(surfaces, scene.skin.surface, scene.file + ": skin");
    TriangleMesh surface = cut_mesh(skin.mesh(), scene.skin.crop);
    if (!scene.films.empty())
      add_films(scene, surface, model, monitor);
    BoundMesh bound = bind_mesh(surface, Region(), frame, binder, monitor);
    if (bound.mesh.triangles.empty())
      throw failure(
          "{}: skin: no triangle of surface '{}' lies in the crop and within {} of the tissue; check its crop and the "
          "tissue volumes",
          scene.file, scene.skin.surface, length_text(extrapolation, scene.unit));
    if (bound.too_far > 0)
      throw failure(
          "{}: skin: {} of {} triangles of surface '{}' in the crop have a vertex that no voxel can carry, for example "
          "at {}: it is farther than {} from the tissue{}; crop the skin to the tissue, remove pieces of it that lie "
          "apart, or raise its 'extrapolation'",
          scene.file, bound.too_far, bound.triangles, scene.skin.surface, place_text(bound.unbound, scene.unit),
          length_text(extrapolation, scene.unit), text_of_body_around(scene, surfaces, bound.unbound));
    model.skin = std::move(bound.mesh);
    model.skin_binding = std::move(bound.binding);
  }
  bind_landmarks(scene, frame, binder, model, monitor);

  for (const SceneLoad& load : scene.loads)
  {
    Load out;
    out.name = load.name;
    out.ramp = load.ramp / scene.time.scaling;
    if (load.activated)
      out.activation = index_of(model.muscles, load.name, place_in_scene(scene, "load", load), "muscle");
    out.value = frame.turn(load.value);
    if (load.kind == SceneLoad::Kind::displacement)
    {
      out.kind = Load::Kind::displacement;
      out.fixed = frame.turn(load.fixed);
    }
    else
    {
      const std::string place = place_in_scene(scene, "load", load);
      const TriangleMesh surface =
          clear_mesh(load, surfaces, tissue, *std::min_element(model.spacing.begin(), model.spacing.end()), place);
      BoundMesh bound = bind_mesh(loaded_mesh(scene, load, surface, frame, binder), Region(), frame, binder, monitor);
      const std::size_t left_out = surface.triangles.size() - bound.mesh.triangles.size();
      if (bound.mesh.triangles.empty())
        throw failure("{}: no triangle of surface '{}' in its crop{} has tissue behind it", place, load.surface,
                      load.clear_of.empty() ? "" : " and clear of the surfaces of 'clear_of'");
      if (left_out > 0)
        monitor.found("load '{}': {} of {} triangles left out, because no tissue is behind them", load.name, left_out,
                      surface.triangles.size());
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
