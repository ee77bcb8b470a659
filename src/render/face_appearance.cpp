#include "frontalis/render/face_appearance.hpp"

#include "frontalis/model/body_shape.hpp"
#include "frontalis/runner/named_controls.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

using Point = std::array<float, 3>;

constexpr Point skin_colour{ { 0.87F, 0.66F, 0.55F } }, lip_colour{ { 0.74F, 0.39F, 0.37F } },
    brow_colour{ { 0.27F, 0.18F, 0.13F } };
constexpr double lip_border = 1.5e-3;  // [m] over which skin turns into lip
constexpr double farthest = 40e-3;     // [m] from a part's landmarks; skin farther away belongs to no part
constexpr float hairy = 0.3F;          // what hair covers by more than this is labelled as brow

// Parts of the skin: a vertex belongs to the part that has the closest landmark. Lips and brows are painted.
struct Part
{
  const char* name;
  std::vector<std::string> landmarks;
};
const std::vector<Part>& parts()
{
  static const std::vector<Part> all{ { "skin", {} },
                                      { "forehead",
                                        { "glabella", "brow_medial_left", "brow_medial_right", "brow_mid_left",
                                          "brow_mid_right", "brow_left", "brow_right" } },
                                      { "nose", { "sellion", "nose_tip", "ala_left", "ala_right", "subnasale" } },
                                      { "mouth",
                                        { "upper_lip", "lower_lip", "mouth_corner_left", "mouth_corner_right" } },
                                      { "chin", { "chin" } },
                                      { "lip_upper", {} },
                                      { "lip_lower", {} },
                                      { "brow_left", {} },
                                      { "brow_right", {} },
                                      { "lids_left", { "lid_upper_left", "lid_lower_left" } },
                                      { "lids_right", { "lid_upper_right", "lid_lower_right" } },
                                      { "cheek_left", { "malar_left", "cheek_left" } },
                                      { "cheek_right", { "malar_right", "cheek_right" } } };
  return all;
}

template <class Condition>
std::uint8_t label_of(const Condition& condition)
{
  const auto found = std::find_if(parts().begin(), parts().end(), condition);
  return static_cast<std::uint8_t>(skin_label + (found == parts().end() ? 0 : found - parts().begin()));
}

std::uint8_t label_of_part(const std::string& name)
{
  return label_of([&](const Part& part) { return part.name == name; });
}

// label of the part that has a landmark; that of skin if none has it
std::uint8_t label_of_landmark(const std::string& landmark)
{
  return label_of([&](const Part& part)
                  { return std::count(part.landmarks.begin(), part.landmarks.end(), landmark) > 0; });
}

Point blend(const Point& a, const Point& b, double share)
{
  const auto s = static_cast<float>(share);
  return { { a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1]), a[2] + s * (b[2] - a[2]) } };
}

}  // namespace

std::vector<std::string> label_names()
{
  std::vector<std::string> names{ "background", "inside", "eye", "body" };
  for (const Part& part : parts())
    names.emplace_back(part.name);
  return names;
}

SkinAppearance skin_appearance(const std::vector<std::string>& landmarks, const std::vector<Point>& places,
                               const std::vector<Point>& vertices)
{
  const auto find = [&](const std::string& name)
  {
    const auto found = std::find(landmarks.begin(), landmarks.end(), name);
    return found == landmarks.end() ? nullptr : &places[static_cast<std::size_t>(found - landmarks.begin())];
  };
  const Point *upper = find("upper_lip"), *lower = find("lower_lip"), *corner = find("mouth_corner_left"),
              *chin = find("chin");
  const bool has_mouth = upper && lower && corner && chin;
  SkinAppearance appearance{ std::vector<Point>(vertices.size(), skin_colour),
                             std::vector<std::uint8_t>(vertices.size(), skin_label), std::nullopt };
  if (has_mouth)
  {
    // large enough to be all that is seen through a mouth that is wide open, and behind its front teeth
    const double height = double((*corner)[2]) - (*chin)[2], radius = 1.55 * height;
    appearance.mouth = RenderBall{
      { double((*corner)[0]) - radius - height / 2, 0, (*corner)[2] - height / 5 }, radius, inside_colour, inside_label
    };
  }
  std::vector<std::uint8_t> part(landmarks.size());
  std::transform(landmarks.begin(), landmarks.end(), part.begin(), label_of_landmark);
  const std::vector<float> hair = brow_cover(landmarks, places, vertices);
  for (std::size_t v = 0; v < vertices.size(); ++v)
  {
    const Point& p = vertices[v];
    double closest = farthest;
    for (std::size_t l = 0; l < landmarks.size(); ++l)
      if (const double away = std::hypot(p[0] - places[l][0], p[1] - places[l][1], p[2] - places[l][2]);
          part[l] != skin_label && away < closest)
      {
        closest = away;
        appearance.labels[v] = part[l];
      }
    // lips are arcs from corner to corner, as high as the landmarks in their middle are
    if (has_mouth && p[0] > (*corner)[0] - 2e-3 && std::abs(p[1]) < (*corner)[1])
    {
      const double bow = 1 - std::pow(p[1] / (*corner)[1], 2), from_corner = double(p[2]) - (*corner)[2];
      const double reach = bow * ((from_corner > 0 ? (*upper)[2] : (*lower)[2]) - double((*corner)[2]));
      const double inside = (std::abs(reach) - std::abs(from_corner)) / lip_border;
      appearance.colours[v] = blend(skin_colour, lip_colour, std::clamp(inside + 0.5, 0.0, 1.0));
      if (inside > 0)
        appearance.labels[v] = label_of_part(from_corner > 0 ? "lip_upper" : "lip_lower");
    }
    appearance.colours[v] = blend(appearance.colours[v], brow_colour, hair[v]);
    if (hair[v] > hairy)
      appearance.labels[v] = label_of_part(p[1] < 0 ? "brow_right" : "brow_left");
  }
  return appearance;
}

std::vector<Eyeball> eyeballs(const Model& model, const std::function<RigidTransform(std::size_t bone)>& motion)
{
  // A white ball with the cap of a brown one, the iris, and on it the cap of a black one, the pupil. Radii of the
  // balls, and of the circles in which they meet the ball before, over that of the eyeball: an iris of 11.7 mm and a
  // pupil of 4.4 mm on a ball of 24.2 mm. The caps are flatter than a cornea, whose radius is 7.8 mm: tissue slides on
  // the white ball, and a cornea would show through closed lids.
  struct Cap
  {
    double radius, rim;
    Point colour;
  };
  constexpr std::array<Cap, 3> caps{ { { 1, 0, { { 0.92F, 0.90F, 0.87F } } },
                                       { 0.8, 0.483, { { 0.30F, 0.20F, 0.12F } } },
                                       { 0.65, 0.18, { { 0.02F, 0.02F, 0.02F } } } } };
  std::vector<Eyeball> out;
  for (const ConstraintSurface& eye : model.constraint_surfaces)
  {
    const auto bone = static_cast<std::size_t>(eye.bone);
    if (eye.bone < 0 || eye.field.radius <= 0 || bone >= model.bones.size() ||
        model.bones[bone].compare(0, 3, "eye") != 0)
      continue;
    const std::array<double, 3> centre = model.to_face(eye.field.origin);
    const RigidTransform pose = motion(bone);
    Eyeball& ball = out.emplace_back();
    ball.bone = bone;
    double ahead = 0, radius = 1;  // of the ball before
    for (std::size_t n = 0; n < caps.size(); ++n)
    {
      const Cap& cap = caps[n];
      const auto from_rim = [&](double r) { return std::sqrt(r * r - cap.rim * cap.rim); };
      ahead += from_rim(radius) - from_rim(cap.radius);
      radius = cap.radius;
      ball.balls[n] = { pose(std::array<double, 3>{ { centre[0] + ahead * eye.field.radius, centre[1], centre[2] } }),
                        cap.radius * eye.field.radius, cap.colour, eye_label };
    }
  }
  return out;
}

// behind the eyeball, and towards the midline, where lids leave a gap at the inner corner
RenderBall socket_of(const RenderBall& eyeball)
{
  const auto& [x, y, z] = eyeball.centre;
  const double r = eyeball.radius;
  return { { x - 0.55 * r, y - std::copysign(0.2 * r, y), z }, 1.3 * r, inside_colour, inside_label };
}

FaceAppearance::FaceAppearance(const Model& model, const SkinState& rest)
    : model_(model), appearance_(skin_appearance(model.landmarks, rest.landmarks, rest.vertices))
{
  const auto named = [&](const std::string& name)
  { return std::find(model.landmarks.begin(), model.landmarks.end(), name) - model.landmarks.begin(); };
  const auto corner = static_cast<std::size_t>(named("mouth_corner_left"));
  const std::vector<Eyeball> eyes = eyeballs(model, [](std::size_t) { return RigidTransform(); });
  const std::vector<BodyShape> bodies = body_shapes(model);
  for (std::size_t b = 0; b < bodies.size() && b < model.contacts.size(); ++b)
  {
    const std::int32_t bone = model.contacts[b].bone;
    const auto is_ball = [&](const Eyeball& eye) { return static_cast<std::int32_t>(eye.bone) == bone; };
    if (bodies[b].surface == nullptr || std::any_of(eyes.begin(), eyes.end(), is_ball))
      continue;
    TriangleMesh surface = *bodies[b].surface;
    for (auto& p : surface.vertices)
      p = model.to_face(p);
    Body& body = bodies_.emplace_back();
    body.bone = bone;
    if (bodies[b].name.compare(0, 5, "teeth") == 0 && corner < model.landmarks.size())
    {
      body.mesh = painted_teeth(surface, bone >= 0, rest.landmarks[corner][2]);
      continue;
    }
    body.mesh.triangles = surface.triangles;
    body.mesh.vertices.reserve(surface.vertices.size());
    for (const auto& p : surface.vertices)
      body.mesh.vertices.push_back({ static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]) });
    body.mesh.colours.assign(surface.vertices.size(), body_colour);
    body.mesh.labels.assign(surface.vertices.size(), body_label);
  }
}

RenderScene FaceAppearance::scene(const SkinState& skin, const Controls& controls) const
{
  RenderScene scene;
  scene.meshes.push_back(
      { skin.vertices, model_.skin.triangles, skin.normals, appearance_.colours, appearance_.labels });
  const auto motion = [&](std::size_t bone) { return motion_in_face(model_, controls.bone[bone]); };
  if (appearance_.mouth)
    scene.balls.push_back(*appearance_.mouth);
  for (const Eyeball& eye : eyeballs(model_, motion))
  {
    scene.balls.push_back(socket_of(eye.balls[0]));
    scene.balls.insert(scene.balls.end(), eye.balls.begin(), eye.balls.end());
  }
  for (const Body& body : bodies_)
  {
    RenderMesh& mesh = scene.meshes.emplace_back(body.mesh);
    if (body.bone < 0)
      continue;
    const RigidTransform pose = motion(static_cast<std::size_t>(body.bone));
    for (auto& v : mesh.vertices)
    {
      const std::array<double, 3> now = pose(std::array<double, 3>{ { double(v[0]), double(v[1]), double(v[2]) } });
      v = { static_cast<float>(now[0]), static_cast<float>(now[1]), static_cast<float>(now[2]) };
    }
  }
  return scene;
}

}  // namespace frontalis
