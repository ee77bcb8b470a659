#include "frontalis/render/renderer.hpp"

#include "frontalis/error.hpp"

#include <embree3/rtcore.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

namespace frontalis
{
namespace
{

using Vector = std::array<double, 3>;

constexpr double hidden_by = 2e-3;      // [m] a surface hides a landmark if it is in front of it by more than this
constexpr double shadow_offset = 5e-4;  // [m] above the surface, so that triangles do not shade their neighbours

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector minus(const Vector& a, const Vector& b) { return { a[0] - b[0], a[1] - b[1], a[2] - b[2] }; }
Vector along(const Vector& a, double t, const Vector& d)
{
  return { a[0] + t * d[0], a[1] + t * d[1], a[2] + t * d[2] };
}
Vector cross(const Vector& a, const Vector& b)
{
  return { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0] };
}
Vector unit(const Vector& v)
{
  const double length = std::sqrt(dot(v, v));
  return length > 0 ? Vector{ v[0] / length, v[1] / length, v[2] / length } : v;
}
template <class From>
Vector wide(const From& v)
{
  return { double(v[0]), double(v[1]), double(v[2]) };
}
std::array<float, 3> narrow(const Vector& v)
{
  return { static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]) };
}

// One thread builds the tree of boxes, so that equal scenes have equal trees and equal ties between triangles.
RTCDevice device()
{
  static const std::unique_ptr<RTCDeviceTy, decltype(&rtcReleaseDevice)> made(rtcNewDevice("threads=1"),
                                                                              rtcReleaseDevice);
  if (!made)
    throw Error("Embree cannot be started on this machine");
  return made.get();
}

void check(const RenderMesh& mesh)
{
  const std::size_t count = mesh.vertices.size();
  if (mesh.colours.size() != count || mesh.labels.size() != count ||
      (!mesh.normals.empty() && mesh.normals.size() != count))
    throw Error("a mesh to be drawn must have one colour, label and normal per vertex");
  for (const auto& triangle : mesh.triangles)
    for (const std::int32_t corner : triangle)
      if (corner < 0 || static_cast<std::size_t>(corner) >= count)
        throw Error("a mesh to be drawn has a triangle with a vertex that does not exist");
}

}  // namespace

std::vector<std::array<float, 3>> normals_of(const RenderMesh& mesh)
{
  // Areas may cancel where sheets touch; the normal there is that of one triangle.
  std::vector<Vector> sums(mesh.vertices.size()), latest(mesh.vertices.size(), Vector{ 0, 0, 1 });
  for (const auto& t : mesh.triangles)
  {
    const Vector a = wide(mesh.vertices[t[0]]);
    const Vector area = cross(minus(wide(mesh.vertices[t[1]]), a), minus(wide(mesh.vertices[t[2]]), a));
    for (const std::int32_t corner : t)
    {
      sums[corner] = along(sums[corner], 1, area);
      if (dot(area, area) > 0)
        latest[corner] = area;
    }
  }
  std::vector<std::array<float, 3>> normals;
  normals.reserve(sums.size());
  for (std::size_t v = 0; v < sums.size(); ++v)
    normals.push_back(narrow(unit(dot(sums[v], sums[v]) > 0 ? sums[v] : latest[v])));
  return normals;
}

namespace
{

// a ray from a point in a direction, which need not have length 1
void set(RTCRay& ray, const Vector& from, const Vector& direction, double far)
{
  ray.org_x = static_cast<float>(from[0]);
  ray.org_y = static_cast<float>(from[1]);
  ray.org_z = static_cast<float>(from[2]);
  ray.dir_x = static_cast<float>(direction[0]);
  ray.dir_y = static_cast<float>(direction[1]);
  ray.dir_z = static_cast<float>(direction[2]);
  ray.tnear = 0;
  ray.tfar = static_cast<float>(far);
  ray.time = 0;
  ray.mask = ~0U;
  ray.id = 0;
  ray.flags = 0;
}

/// What a ray meets first, in the frame of the camera.
struct Hit
{
  double depth = 0;
  Vector point, facet;  ///< facet: normal of the triangle itself, towards the camera
  Vector normal;        ///< of the smooth surface
  std::array<float, 3> colour;
  std::uint8_t label = background_label;
};

}  // namespace

struct Renderer::Implementation
{
  RenderScene scene;  // in the frame of the camera
  PinholeCamera camera;
  std::unique_ptr<RTCSceneTy, decltype(&rtcReleaseScene)> tree{ rtcNewScene(device()), rtcReleaseScene };

  void attach(RTCGeometryType type, RTCFormat format, const void* vertices, std::size_t stride, std::size_t count,
              const RenderMesh* mesh);
  bool is_hidden(const Vector& from, const Vector& direction, double far) const;
  std::optional<Hit> trace(double u, double v) const;
  Hit meets_triangle(const Vector& direction, const RenderMesh& mesh, std::size_t triangle, double guess) const;
  Hit meets_ball(const Vector& direction, const RenderBall& ball, double guess) const;
  Vector shaded(const Hit& hit, const Light& light, const Vector& key) const;
};

void Renderer::Implementation::attach(RTCGeometryType type, RTCFormat format, const void* vertices, std::size_t stride,
                                      std::size_t count, const RenderMesh* mesh)
{
  RTCGeometry geometry = rtcNewGeometry(device(), type);
  // An empty mesh is attached too, so that the number of a geometry is the index of its mesh.
  if (count > 0)
    std::memcpy(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, format, stride, count), vertices,
                stride * count);
  if (mesh != nullptr && !mesh->triangles.empty())
    std::memcpy(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t),
                                        mesh->triangles.size()),
                mesh->triangles.data(), 3 * sizeof(std::uint32_t) * mesh->triangles.size());
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(tree.get(), geometry);
  rtcReleaseGeometry(geometry);
}

bool Renderer::Implementation::is_hidden(const Vector& from, const Vector& direction, double far) const
{
  RTCRay ray;
  set(ray, from, direction, far);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(tree.get(), &context, &ray);
  return ray.tfar < 0;
}

// Embree, in single precision, finds the triangle; its place on the ray is found again in double precision. On a
// triangle seen nearly edge-on, rounding can put that place anywhere on the ray, so it is kept between the corners.
Hit Renderer::Implementation::meets_triangle(const Vector& direction, const RenderMesh& mesh, std::size_t triangle,
                                             double guess) const
{
  const auto& t = mesh.triangles[triangle];
  const Vector a = wide(mesh.vertices[t[0]]), ab = minus(wide(mesh.vertices[t[1]]), a),
               ac = minus(wide(mesh.vertices[t[2]]), a);
  const Vector area = cross(ab, ac);
  const double approach = dot(area, direction);
  Hit hit;
  const auto [near, far] = std::minmax({ a[2], a[2] + ab[2], a[2] + ac[2] });
  hit.depth = std::clamp(approach == 0 ? guess : dot(area, a) / approach, near, far);
  hit.point = along({}, hit.depth, direction);
  const Vector in = minus(hit.point, a);
  const double square = dot(area, area);
  const double v = std::clamp(dot(cross(in, ac), area) / square, 0.0, 1.0),
               w = std::clamp(dot(cross(ab, in), area) / square, 0.0, 1.0 - v), u = 1 - v - w;
  const bool front = approach < 0;
  for (std::size_t c = 0; c < 3; ++c)
  {
    hit.colour[c] =
        static_cast<float>(u * mesh.colours[t[0]][c] + v * mesh.colours[t[1]][c] + w * mesh.colours[t[2]][c]);
    hit.normal[c] = u * mesh.normals[t[0]][c] + v * mesh.normals[t[1]][c] + w * mesh.normals[t[2]][c];
  }
  if (!front)
    hit.colour = inside_colour;
  hit.normal = unit(front ? hit.normal : Vector{ -hit.normal[0], -hit.normal[1], -hit.normal[2] });
  hit.facet = unit(front ? area : Vector{ -area[0], -area[1], -area[2] });
  hit.label = front ? mesh.labels[t[u >= v && u >= w ? 0 : v >= w ? 1 : 2]] : std::uint8_t{ inside_label };
  return hit;
}

Hit Renderer::Implementation::meets_ball(const Vector& direction, const RenderBall& ball, double guess) const
{
  const double a = dot(direction, direction), b = dot(direction, ball.centre);
  const double root = b * b - a * (dot(ball.centre, ball.centre) - ball.radius * ball.radius);
  Hit hit;
  hit.depth = root > 0 ? (b - std::sqrt(root)) / a : guess;
  // The depth is negative if the camera is inside the ball.
  if (hit.depth < 0)
    hit.depth = guess;
  hit.point = along({}, hit.depth, direction);
  hit.normal = hit.facet = unit(minus(hit.point, ball.centre));
  hit.colour = ball.colour;
  hit.label = ball.label;
  return hit;
}

std::optional<Hit> Renderer::Implementation::trace(double u, double v) const
{
  // with a direction of z = 1, the distance along the ray is the depth
  const Vector direction{ (u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1 };
  RTCRayHit found;
  set(found.ray, {}, direction, std::numeric_limits<float>::infinity());
  found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(tree.get(), &context, &found);
  if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID)
    return std::nullopt;
  return found.hit.geomID < scene.meshes.size()
             ? meets_triangle(direction, scene.meshes[found.hit.geomID], found.hit.primID, found.ray.tfar)
             : meets_ball(direction, scene.balls[found.hit.primID], found.ray.tfar);
}

// `key`: unit vector towards the main light. All vectors are in the frame of the camera.
Vector Renderer::Implementation::shaded(const Hit& hit, const Light& light, const Vector& key) const
{
  if (hit.label == inside_label)
    return wide(hit.colour);
  const double facing = dot(hit.normal, key);
  const bool lit =
      facing > 0 && !is_hidden(along(hit.point, shadow_offset, hit.facet), key, std::numeric_limits<float>::infinity());
  const Vector fill = unit(camera.to_camera.turned(light.fill)), viewer = unit(along({}, -1, hit.point));
  const double matt = light.ambient + (lit ? light.key_strength * facing : 0) +
                      light.fill_strength * std::max(dot(hit.normal, fill), 0.0);
  // an eye is moist: its highlight is small and bright
  const bool moist = hit.label == eye_label;
  const double mirrored = std::max(dot(hit.normal, unit(along(key, 1, viewer))), 0.0);
  const double shine = lit ? light.highlight * (moist ? 5 * std::pow(mirrored, 300) : std::pow(mirrored, 24)) : 0;
  return { hit.colour[0] * matt + shine, hit.colour[1] * matt + shine, hit.colour[2] * matt + shine };
}

Renderer::Renderer(const RenderScene& scene, const PinholeCamera& camera) : self_(std::make_unique<Implementation>())
{
  self_->scene = scene;
  self_->camera = camera;
  const RigidTransform& pose = camera.to_camera;
  rtcSetSceneFlags(self_->tree.get(), RTC_SCENE_FLAG_ROBUST);
  for (RenderMesh& mesh : self_->scene.meshes)
  {
    check(mesh);
    if (mesh.normals.empty())
      mesh.normals = normals_of(mesh);
    for (auto& vertex : mesh.vertices)
      vertex = narrow(pose(vertex));
    for (auto& normal : mesh.normals)
      normal = narrow(pose.turned(normal));
    self_->attach(RTC_GEOMETRY_TYPE_TRIANGLE, RTC_FORMAT_FLOAT3, mesh.vertices.data(), sizeof mesh.vertices[0],
                  mesh.vertices.size(), &mesh);
  }
  std::vector<std::array<float, 4>> balls;
  balls.reserve(scene.balls.size());
  for (RenderBall& ball : self_->scene.balls)
  {
    ball.centre = pose(ball.centre);
    const auto centre = narrow(ball.centre);
    balls.push_back({ centre[0], centre[1], centre[2], static_cast<float>(ball.radius) });
  }
  self_->attach(RTC_GEOMETRY_TYPE_SPHERE_POINT, RTC_FORMAT_FLOAT4, balls.data(), sizeof(std::array<float, 4>),
                balls.size(), nullptr);
  rtcCommitScene(self_->tree.get());
}

Renderer::~Renderer() = default;

Images Renderer::images(const Light& light, int samples) const
{
  const PinholeCamera& camera = self_->camera;
  const std::size_t pixels = static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  Images out;
  out.colour.resize(pixels);
  out.depth.resize(pixels);
  out.label.resize(pixels);
  out.normal.resize(pixels);
  const Vector key = unit(camera.to_camera.turned(light.key));
  const Vector across = unit(cross(key, std::abs(key[0]) < 0.5 ? Vector{ 1, 0, 0 } : Vector{ 0, 1, 0 }));
  const Vector up = cross(key, across);
  const Vector background = wide(light.background);
  // each ray of a pixel has a place of its own in the pixel and on the main light
  const auto place = [samples](int sample) { return (sample + 0.5) / samples - 0.5; };
  const auto draw_row = [&](int row)
  {
    for (int column = 0; column < camera.width; ++column)
    {
      const std::size_t pixel = std::size_t(row) * std::size_t(camera.width) + std::size_t(column);
      const std::optional<Hit> centre = self_->trace(column, row);
      if (centre)
      {
        out.depth[pixel] = static_cast<float>(centre->depth);
        out.label[pixel] = centre->label;
        out.normal[pixel] = narrow(centre->normal);
      }
      Vector sum{};
      for (int y = 0; y < samples; ++y)
        for (int x = 0; x < samples; ++x)
        {
          const auto hit = samples == 1 ? centre : self_->trace(column + place(x), row + place(y));
          const Vector towards = along(along(key, light.width * place(y), across), light.width * place(x), up);
          sum = along(sum, 1, hit ? self_->shaded(*hit, light, unit(towards)) : background);
        }
      for (std::size_t c = 0; c < 3; ++c)
        out.colour[pixel][c] =
            static_cast<std::uint8_t>(std::lround(255 * std::clamp(sum[c] / (double(samples) * samples), 0.0, 1.0)));
    }
  };
  tbb::parallel_for(0, camera.height, draw_row);
  return out;
}

bool Renderer::sees(const Vector& point) const
{
  const Vector p = self_->camera.to_camera(point);
  const double distance = std::sqrt(dot(p, p));
  if (!(p[2] > 0))
    return false;
  const auto [u, v] = self_->camera.project(p);
  const bool inside = u >= -0.5 && v >= -0.5 && u < self_->camera.width - 0.5 && v < self_->camera.height - 0.5;
  return inside && !self_->is_hidden({}, p, std::max(0.0, 1 - hidden_by / distance));
}

}  // namespace frontalis
