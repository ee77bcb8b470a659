#include "frontalis/render/face_appearance.hpp"

#include "frontalis/physics/number.hpp"
#include "frontalis/runner/named_controls.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace frontalis
{
namespace
{

using Point = std::array<float, 3>;

constexpr Point skin_colour{ { 0.87F, 0.66F, 0.55F } }, lip_colour{ { 0.74F, 0.39F, 0.37F } },
    tongue_colour{ { 0.69F, 0.37F, 0.36F } }, brow_colour{ { 0.25F, 0.17F, 0.12F } },
    hair_colour{ { 0.29F, 0.20F, 0.145F } }, corner_colour{ { 0.60F, 0.40F, 0.36F } },
    white_colour{ { 0.90F, 0.88F, 0.85F } }, metal_colour{ { 0.52F, 0.55F, 0.59F } };
// Lashes cover the edges of the lids, which are parabolas as seen from the front. Lengths are divided by the eyeball's
// radius.
struct Lashes
{
  double height;           // height of the middle of the lid's edge above the eyeball's centre
  double width, softness;  // of the band along the edge
  double density;
};
constexpr Lashes upper_lashes{ 0.33, 0.15, 0.06, 0.85 }, lower_lashes{ -0.42, 0.07, 0.06, 0.35 };
constexpr double half_fissure = 1.25, lash_reach = 0.22;  // half the length of the fissure; distance from the eyeball
constexpr double hair_thins_from = 2.5e-3, hair_thins_to = 9e-3;  // [m] from the border of its surface
constexpr double lip_border = 1.5e-3;                             // [m] over which skin turns into lip
constexpr double farthest = 40e-3;  // [m] from a part's landmarks; skin farther away belongs to no part
constexpr float hairy = 0.3F;       // skin of which hair covers a larger fraction than this has the label of the brow

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
                                      { "cheek_right", { "malar_right", "cheek_right" } },
                                      { "hair", {} } };
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

// whether a shown surface is the core of a robot, which looks like metal
bool is_core(const std::string& name) { return name.compare(0, 4, "core") == 0; }

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

BodyAppearance body_appearance(const std::string& name, bool only_shown, const TriangleMesh& surface)
{
  const bool is_hair = only_shown && name == "hair", is_tongue = only_shown && name == "tongue";
  const bool is_mouth = only_shown && name == "mouth", is_metal = only_shown && is_core(name),
             is_gum = !only_shown && name.compare(0, 4, "gums") == 0;
  const bool is_skin = only_shown && !is_hair && !is_tongue && !is_mouth && !is_metal;
  BodyAppearance look;
  look.label = is_hair    ? label_of_part(name)
               : is_mouth ? std::uint8_t{ inside_label }
                          : static_cast<std::uint8_t>(is_skin ? skin_label : body_label);
  look.colour = is_hair     ? hair_colour
                : is_tongue ? tongue_colour
                : is_mouth  ? inside_colour
                : is_metal  ? metal_colour
                : is_gum    ? gum_colour
                : is_skin   ? skin_colour
                            : teeth_colour;
  look.colours.assign(surface.vertices.size(), look.colour);
  if (!is_hair)
    return look;
  // An edge that belongs to only one triangle is on the border.
  std::set<std::array<std::int32_t, 2>> open;
  for (const auto& t : surface.triangles)
    for (std::size_t c = 0; c < 3; ++c)
      if (open.erase({ { t[(c + 1) % 3], t[c] } }) == 0)
        open.insert({ { t[c], t[(c + 1) % 3] } });
  for (std::size_t v = 0; v < surface.vertices.size(); ++v)
  {
    double closest = hair_thins_to;
    const auto& p = surface.vertices[v];
    for (const auto& edge : open)
      if (const auto& q = surface.vertices[static_cast<std::size_t>(edge[0])]; std::abs(p[0] - q[0]) < closest)
        closest = std::min(closest, std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]));
    const double share = std::clamp((closest - hair_thins_from) / (hair_thins_to - hair_thins_from), 0.0, 1.0);
    look.colours[v] = blend(skin_colour, hair_colour, share * (2 - share));
  }
  return look;
}

SkinAppearance skin_appearance(const std::vector<std::string>& landmarks, const std::vector<Point>& places,
                               const std::vector<Point>& vertices, const std::vector<RenderBall>& eyes)
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
    // The ball fills the view into a wide open mouth, and lies behind teeth and tongue.
    const double height = double((*corner)[2]) - (*chin)[2];
    appearance.mouth = RenderBall{
      { (*corner)[0] - 3.2 * height, 0, (*corner)[2] - 0.5 * height }, 1.2 * height, inside_colour, inside_label
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
    // The border of each lip is an arc from corner to corner, as high as the landmark in the middle of the lip.
    if (has_mouth && p[0] > (*corner)[0] - 2e-3 && std::abs(p[1]) < (*corner)[1])
    {
      const double bow = 1 - std::pow(p[1] / (*corner)[1], 2), from_corner = double(p[2]) - (*corner)[2];
      const double reach = bow * ((from_corner > 0 ? (*upper)[2] : (*lower)[2]) - double((*corner)[2]));
      const double inside = (std::abs(reach) - std::abs(from_corner)) / lip_border;
      appearance.colours[v] = blend(skin_colour, lip_colour, std::clamp(inside + 0.5, 0.0, 1.0));
      if (inside > 0)
        appearance.labels[v] = label_of_part(from_corner > 0 ? "lip_upper" : "lip_lower");
    }
    appearance.colours[v] = blend(appearance.colours[v], brow_colour, double(hair[v]));
    for (const RenderBall& eye : eyes)
    {
      const double r = eye.radius, x = (p[0] - eye.centre[0]) / r, y = (p[1] - eye.centre[1]) / r,
                   z = (p[2] - eye.centre[2]) / r;
      if (x < 0.25 || std::hypot(x, y, z) > 1 + lash_reach)
        continue;
      const Lashes& lashes = z > 0 ? upper_lashes : lower_lashes;
      const double edge = lashes.height * std::max(0.0, 1 - std::pow(y / half_fissure, 2));
      const double inside = (lashes.width - std::abs(z - edge)) / lashes.softness;
      appearance.colours[v] = blend(appearance.colours[v], brow_colour, lashes.density * std::clamp(inside, 0.0, 1.0));
    }
    if (hair[v] > hairy)
      appearance.labels[v] = label_of_part(p[1] < 0 ? "brow_right" : "brow_left");
  }
  return appearance;
}

namespace
{

/// An iris of 11.7 mm with a pupil of 4.2 mm, on a ball of 24.2 mm: rings of points about the x axis through the middle
/// of the ball. All lengths are divided by the ball's radius. The cap is flatter than a cornea, whose radius is 7.8 mm:
/// tissue slides on the white ball, and a cornea would show through closed lids.
RenderMesh iris_cap()
{
  struct Ring
  {
    double radius;
    Point colour;
  };
  const Point pupil{ { 0.02F, 0.02F, 0.02F } }, inner{ { 0.42F, 0.28F, 0.16F } }, outer{ { 0.30F, 0.19F, 0.11F } },
      limbus{ { 0.13F, 0.09F, 0.07F } };
  const std::array<Ring, 10> rings{ { { 0, pupil },
                                      { 0.08, pupil },
                                      { 0.165, pupil },
                                      { 0.185, inner },
                                      { 0.27, inner },
                                      { 0.36, outer },
                                      { 0.425, outer },
                                      { 0.455, limbus },
                                      { 0.475, limbus },
                                      { 0.50, white_colour } } };
  constexpr int columns = 72;
  constexpr double curvature = 1 / 0.8, turn = 2 * physics::pi / columns, above = 0.004;
  const auto height = [](double radius) { return std::sqrt(1 - radius * radius * curvature * curvature) / curvature; };
  const double rim = rings.back().radius, base = std::sqrt(1 - rim * rim) - height(rim) + above;
  RenderMesh mesh;
  for (std::size_t r = 0; r < rings.size(); ++r)
    for (int c = 0; c < columns; ++c)
    {
      const double radius = rings[r].radius;
      mesh.vertices.push_back({ static_cast<float>(base + height(radius)),
                                static_cast<float>(radius * std::cos(turn * c)),
                                static_cast<float>(radius * std::sin(turn * c)) });
      // fibres of the iris
      const double light = r > 2 && r < 7 ? 0.12 * std::sin(2.3 * c + double(r)) * std::sin(0.7 * c * c) : 0;
      mesh.colours.push_back(blend(rings[r].colour, inner, std::abs(light)));
      const auto next = (c + 1) % columns, here = static_cast<std::int32_t>(r) * columns;
      if (r + 1 == rings.size())
        continue;
      mesh.triangles.push_back({ here + c, here + columns + c, here + columns + next });
      mesh.triangles.push_back({ here + c, here + columns + next, here + next });
    }
  mesh.labels.assign(mesh.vertices.size(), eye_label);
  return mesh;
}

}  // namespace

std::vector<Eyeball> eyeballs(const Model& model, const std::function<RigidTransform(std::size_t bone)>& motion)
{
  static const RenderMesh cap = iris_cap();
  std::vector<Eyeball> out;
  for (const ConstraintSurface& eye : model.constraint_surfaces)
  {
    const auto bone = static_cast<std::size_t>(eye.bone);
    if (eye.bone < 0 || eye.field.radius <= 0 || bone >= model.bones.size() ||
        model.bones[bone].compare(0, 3, "eye") != 0)
      continue;
    const std::array<double, 3> centre = model.to_face(eye.field.origin);
    const double radius = eye.field.radius;
    const RigidTransform pose = motion(bone);
    Eyeball& ball = out.emplace_back();
    ball.bone = bone;
    ball.ball = { pose(centre), radius, white_colour, eye_label };
    ball.iris = cap;
    for (Point& p : ball.iris.vertices)
    {
      const auto now = pose(
          std::array<double, 3>{ { centre[0] + radius * p[0], centre[1] + radius * p[1], centre[2] + radius * p[2] } });
      p = { { static_cast<float>(now[0]), static_cast<float>(now[1]), static_cast<float>(now[2]) } };
    }
  }
  return out;
}

// The socket is behind the eyeball and nearer to the midline, where lids leave a gap at the inner corner.
RenderBall socket_of(const RenderBall& eyeball)
{
  const auto& [x, y, z] = eyeball.centre;
  const double r = eyeball.radius;
  return { { x - 0.55 * r, y - std::copysign(0.2 * r, y), z }, 1.3 * r, corner_colour, inside_label };
}

std::vector<RenderBall> resting_eyes(const Model& model)
{
  std::vector<RenderBall> balls;
  for (const Eyeball& eye : eyeballs(model, [](std::size_t) { return RigidTransform(); }))
    balls.push_back(eye.ball);
  return balls;
}

RenderMesh body_at_rest(const Model& model, const BodyShape& body)
{
  TriangleMesh surface = *body.surface;
  for (auto& p : surface.vertices)
    p = model.to_face(p);
  const auto corner = std::find(model.landmarks.begin(), model.landmarks.end(), "mouth_corner_left");
  if (body.name.compare(0, 5, "teeth") == 0 && corner != model.landmarks.end())
  {
    const auto landmark = static_cast<std::size_t>(corner - model.landmarks.begin());
    return painted_teeth(surface, body.bone >= 0, model.to_face(model.landmark_positions[landmark])[2]);
  }
  BodyAppearance look = body_appearance(body.name, body.only_shown, surface);
  RenderMesh mesh;
  mesh.triangles = std::move(surface.triangles);
  mesh.colours = std::move(look.colours);
  mesh.labels.assign(surface.vertices.size(), look.label);
  mesh.vertices.reserve(surface.vertices.size());
  for (const auto& p : surface.vertices)
    mesh.vertices.push_back({ static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]) });
  return mesh;
}

FaceAppearance::FaceAppearance(const Model& model, const SkinState& rest)
    : model_(model), appearance_(skin_appearance(model.landmarks, rest.landmarks, rest.vertices, resting_eyes(model)))
{
  const std::vector<Eyeball> eyes = eyeballs(model, [](std::size_t) { return RigidTransform(); });
  for (const BodyShape& body : body_shapes(model))
  {
    // The ball that stands for the inside of a mouth would be seen below a mask on a robot's core.
    if (is_core(body.name))
      appearance_.mouth.reset();
    const auto is_ball = [&](const Eyeball& eye) { return static_cast<std::int32_t>(eye.bone) == body.bone; };
    if (!std::any_of(eyes.begin(), eyes.end(), is_ball))
      bodies_.push_back({ body_at_rest(model, body), body.bone });
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
    scene.balls.push_back(socket_of(eye.ball));
    scene.balls.push_back(eye.ball);
    scene.meshes.push_back(eye.iris);
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
