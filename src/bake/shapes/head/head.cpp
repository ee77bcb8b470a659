#include "bake/shapes/head/head.hpp"
#include "bake/shapes/muscle_net.hpp"

#include "bake/messages.hpp"
#include "bake/mesh/surface.hpp"

#include <mutex>

namespace frontalis
{
namespace
{

constexpr double skull_edge = 2e-3;  // [m]
// A layer of hair on the part of the skin that is inside a body of the template: its height, and the distance from the
// border over which it rises to this height.
struct HairLayer
{
  const char* body;
  double height, rise;  // [m]
};
constexpr HairLayer hair_layers[] = { { "hair", 3.5e-3, 14e-3 }, { "hair_top", 9e-3, 34e-3 } };
// Slope of the surface of hair against the skin, on both sides of the hairline. It is constant there, so that the line
// in which the two surfaces meet is as smooth as the hairline and does not run from vertex to vertex.
constexpr double hair_slope = 0.35;
constexpr double hair_rise = 3e-3;  // [m] over which hair rises with this slope
// By which the surface of hair goes on, under the skin, beyond the hairline [m]: its edge must stay below skin that
// moves, by 1.5 mm inwards as the brows rise.
constexpr double hair_margin = 5.5e-3;
constexpr double hairline_wave = 1e-3;  // [m] by which locks shift the hairline
constexpr double lock_height = 0.12;    // height of a lock divided by the thickness of the hair

// Least volume ratio of the skin at given dimensions. Heads that are folded or nearly so are refused.
constexpr double least_volume_ratio = 0.05;
constexpr int default_levels = 2;  // subdivisions of the skin from which depths are measured

/// Steps of subdivision after which edges are at most `edge` long on average.
int levels_for(const PolygonMesh& cage, double edge)
{
  double sum = 0, count = 0;
  for (const auto& face : cage.faces)
    for (std::size_t c = 0; c < face.size(); ++c, ++count)
      sum += (cage.vertices[face[c]] - cage.vertices[face[(c + 1) % face.size()]]).norm();
  return std::min(5, std::max(1, static_cast<int>(std::ceil(std::log2(sum / count / edge) - 0.2))));
}

/// Locks of hair that run from the crown of the head: a sum of waves across them, -1 to 1, equal on both sides.
double lock_at(const Vector3d& p)
{
  const Vector3d middle(-95e-3, 0, 10e-3), crown = Vector3d(-0.5, 0, 0.87).normalized();
  const Vector3d from = (p - middle).normalized();
  const double polar = std::acos(std::clamp(from.dot(crown), -1.0, 1.0));
  const Vector3d across(crown[2], 0, -crown[0]);
  const double around = std::atan2(std::abs(from[1]), from.dot(across));
  return 0.5 * std::sin(23 * around + 3 * std::sin(5 * polar)) + 0.3 * std::sin(41 * around - 4 * std::sin(3 * polar)) +
         0.2 * std::sin(67 * around + 7 * polar);
}

/// The part of a skin that hair covers, raised by the thickness of the hair. `inside`: signed distance from a body.
TriangleMesh hair_on(const TriangleMesh& skin,
                     const std::function<double(const std::string& body, const Vector3d&)>& inside)
{
  TriangleMesh mesh = skin;
  const std::vector<Vector3d> normals = vertex_normals(skin);
  std::vector<bool> covered(skin.vertices.size());
  for (std::size_t v = 0; v < covered.size(); ++v)
  {
    const Vector3d p = to_vector(skin.vertices[v]);
    const double lock = lock_at(p);
    double height = 0;
    for (const HairLayer& layer : hair_layers)
    {
      const double deep = hairline_wave * lock - inside(layer.body, p);
      const double share = std::clamp(deep / layer.rise, 0.0, 1.0);
      height += layer.height * share * share * (3 - 2 * share) * (1 + lock_height * lock);
      if (&layer == hair_layers)
      {
        covered[v] = deep > -hair_margin;
        height += hair_slope * std::clamp(deep, -hair_margin, hair_rise);
      }
    }
    mesh.vertices[v] = to_array(p + height * normals[v]);
  }
  std::vector<bool> keep;
  keep.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles)
    keep.push_back(covered[t[0]] && covered[t[1]] && covered[t[2]]);
  return keep_triangles(mesh, keep);
}

}  // namespace

Head::Head(std::shared_ptr<const HeadTemplate> head, const std::map<std::string, double>& dimensions, double tissue)
    : head_(std::move(head))
{
  cage_ = with_mirror_image(read_polygons(head_->cage, head_->unit), 1, &mirror_);
  default_skin_ = subdivide(cage_, default_levels);
  normals_ = vertex_normals(default_skin_);
  tree_.emplace(default_skin_);
  for (const auto& [name, v] : head_->landmarks)
  {
    if (v >= static_cast<int>(mirror_.size()))
      throw failure("{}: landmark '{}' is vertex {}; {} has {}", head_->file, name, v + 1, head_->cage, mirror_.size());
    landmarks_[name] = vertex(default_skin_, v);
    if (mirror_[v] == v)
      landmarks_[name][1] = 0;
  }
  warp_.emplace(*head_, landmarks_, dimensions);
  check_folds(dimensions);
  bones_.emplace(*head_, *tree_, tissue);
  if (tissue != 1)
    usual_bones_.emplace(*head_, *tree_);
}

void Head::check_folds(const std::map<std::string, double>& dimensions) const
{
  double least = 1;
  Vector3d where = Vector3d::Zero();
  for (const Vector3& vertex : default_skin_.vertices)
  {
    const double ratio = warp_->volume_ratio(to_vector(vertex));
    if (ratio < least)
    {
      least = ratio;
      where = (*warp_)(to_vector(vertex));
    }
  }
  if (least > least_volume_ratio)
    return;
  throw failure("head: {} fold the skin at ({:.0f}, {:.0f}, {:.0f}) mm; take values nearer to the means",
                words_for(dimensions), 1e3 * where[0], 1e3 * where[1], 1e3 * where[2]);
}

Vector3d Head::bone_shift(const Vector3d& p) const
{
  constexpr double step = 0.5e-3;  // [m]
  if (!usual_bones_)
    return Vector3d::Zero();
  Vector3d slope;
  for (int a = 0; a < 3; ++a)
    slope[a] = usual_bones_->hull(p + step * Vector3d::Unit(a)) - usual_bones_->hull(p - step * Vector3d::Unit(a));
  return (usual_bones_->hull(p) - bones_->hull(p)) * slope.normalized();
}

double Head::deeper(const Vector3d& skin, double depth) const
{
  constexpr double thin =
      6e-3;  // [m] above bone; below thinner tissue, and on the conjunctiva in the orbit, less changes
  if (!usual_bones_)
    return 0;
  const double usual = usual_bones_->hull(skin);
  return (bones_->hull(skin) - usual) * std::max(0.0, std::min(usual, depth)) / std::max(usual, thin);
}

TriangleMesh Head::skin(const std::string& name, double edge) const
{
  // `face` is the part with a dermis; `visible` also has the linings of nostrils and lips; `skin` is the whole surface,
  // closed by the mouth and by the sacs behind the lids; `mucosa` lines the mouth, behind the red of the lips
  std::vector<std::string> groups;
  if (name != "skin")
    groups = { "face", "scalp", "neck", "ear", "lid", "lid_margin", "lips" };
  if (name == "mucosa")
    groups = { "mucosa", "mouth" };
  if (name == "visible")
    groups.insert(groups.end(), { "nostril", "mucosa" });
  TriangleMesh mesh = subdivide(cage_, levels_for(cage_, edge), groups);
  if (!groups.empty())
    mesh = keep_triangles(mesh, std::vector<bool>(mesh.triangles.size(), true));
  if (name == "hair")
    mesh = hair_on(mesh, [&](const std::string& body, const Vector3d& p) { return bones_->part(body, p); });
  for (Vector3& p : mesh.vertices)
    p = to_array((*warp_)(to_vector(p)));
  return mesh;
}

TriangleMesh Head::eye(bool left, double edge) const
{
  Shape sphere;
  sphere.kind = Shape::Kind::sphere;
  Vector3d centre = (*warp_)(to_vector(head_->eye));
  centre[1] = left ? centre[1] : -centre[1];
  sphere.centre = to_array(centre);
  sphere.radius = head_->eye_radius;
  sphere.edge = std::min(edge, 1e-3);
  return make_shape(sphere);
}

TriangleMesh Head::bone(const std::string& name, double edge) const
{
  // bones lie inside the skin, so that the skin's box encloses them
  Box half = bounding_box(default_skin_);
  half.min()[1] = 0;
  TriangleMesh mesh = isosurface([&](const Vector3d& p) { return bones_->part(name, p); }, half, edge, true);
  for (Vector3& p : mesh.vertices)
  {
    const bool middle = p[1] == 0;
    p = to_array((*warp_)(to_vector(p)));
    if (middle)
      p[1] = 0;
  }
  return mesh;
}

TriangleMesh Head::part(const std::string& name, double wanted_edge) const
{
  const double edge = wanted_edge > 0 ? wanted_edge : name == "skull" ? skull_edge : Shape::default_edge;
  if (name == "skin" || name == "face" || name == "visible" || name == "mucosa" ||
      (name == "hair" && bones_->has("hair_top")))
    return skin(name, edge);
  if (name == "eye_left" || name == "eye_right")
    return eye(name == "eye_left", edge);
  if (bones_->has(name))
    return bone(name, edge);
  if (const auto muscle = net(name))
    return net_surface(*muscle, edge);
  throw failure("head: there is no part '{}'; there are {}", name, fmt::join(head_->parts(), ", "));
}

Vector3d Head::landmark(const std::string& name, bool right) const
{
  const auto found = landmarks_.find(name);
  if (found == landmarks_.end())
    throw failure("head: there is no landmark '{}'", name);
  Vector3d p = found->second;
  p[1] = right ? -p[1] : p[1];
  return (*warp_)(p);
}

Vector3d Head::place(const HeadTemplate::Point& point) const
{
  for (const auto& [name, v] : head_->landmarks)
    if (v == point.vertex)
      return landmark(name, point.right);
  Vector3d p = tree_->closest(to_vector(point.at)).point;
  p[1] = point.at[1] == 0 ? 0 : point.right ? -p[1] : p[1];
  return moved(p);
}

double Head::dimension(const std::string& name) const
{
  for (const auto& d : head_->dimensions)
    if (d.name == name)
      return (landmark(d.from) - (d.to.empty() ? landmark(d.from, true) : landmark(d.to))).norm();
  throw failure("head: there is no dimension '{}'", name);
}

Head::Below Head::below(const Vector3d& p) const
{
  constexpr double most = 20e-3, step = 0.25e-3;  // [m]
  const ClosestPoint closest = tree_->closest(p);
  Below found;
  found.skin = closest.point;
  // interpolate the corners' normals, because the mean varies smoothly
  const Triangle& t = default_skin_.triangles[closest.triangle];
  const auto [a, b, c] = corners(default_skin_, t);
  found.normal = ((b - closest.point).cross(c - closest.point).norm() * normals_[t[0]] +
                  (c - closest.point).cross(a - closest.point).norm() * normals_[t[1]] +
                  (a - closest.point).cross(b - closest.point).norm() * normals_[t[2]])
                     .normalized();
  // go down to the bone, or to the mucosa that lines lids and mouth
  const Vector3d start = found.skin - step * found.normal;
  found.thickness = 2 * step;
  while (found.thickness < most)
  {
    const Vector3d at = found.skin - found.thickness * found.normal;
    if (bones_->any(at) < 0 || tree_->crossed_by(start, at))
      break;
    found.thickness += step;
  }
  return found;
}

ControlNet Head::known_net(const HeadTemplate::Muscle& muscle) const
{
  {
    const std::lock_guard<std::mutex> lock(nets_mutex_);
    const auto known = nets_.find(muscle.name);
    if (known != nets_.end())
      return known->second;
  }
  ControlNet net = left_net(muscle);
  const std::lock_guard<std::mutex> lock(nets_mutex_);
  nets_[muscle.name] = net;
  return net;
}

std::optional<ControlNet> Head::net(const std::string& part) const
{
  for (const auto& muscle : head_->muscles)
  {
    const bool left = muscle.sided && part == muscle.name + "_left";
    const bool right = muscle.sided && part == muscle.name + "_right";
    if (!left && !right && (muscle.sided || part != muscle.name))
      continue;
    ControlNet net = known_net(muscle);
    for (Vector3& p : net.points)
    {
      if (right)
        p[1] = -p[1];
      p = to_array((*warp_)(to_vector(p)));
    }
    return net;
  }
  return std::nullopt;
}

std::shared_ptr<const Head> head_of(const Shape& shape)
{
  // a scene has about sixty parts of one head, so the head of the last call is kept
  static std::mutex mutex;
  static std::shared_ptr<const HeadTemplate> last_template;
  static std::map<std::string, double> last_dimensions;
  static double last_tissue = 1;
  static std::shared_ptr<const Head> last;
  const std::lock_guard<std::mutex> lock(mutex);
  if (!last || last_template != shape.head || last_dimensions != shape.dimensions || last_tissue != shape.tissue)
  {
    last = std::make_shared<Head>(shape.head, shape.dimensions, shape.tissue);
    last_template = shape.head;
    last_dimensions = shape.dimensions;
    last_tissue = shape.tissue;
  }
  return last;
}

TriangleMesh make_head(const Shape& shape) { return head_of(shape)->part(shape.part, shape.edge); }

std::optional<ControlNet> head_muscle_net(const Shape& shape) { return head_of(shape)->net(shape.part); }

}  // namespace frontalis
