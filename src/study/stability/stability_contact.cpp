// Hard cases of contact: a finger, a lid, bodies that jump, edges, two bodies on one sheet, and lips.

#include "frontalis/model/sample_field.hpp"
#include "frontalis/solver/rigid_motion.hpp"
#include "frontalis/study/contact_model.hpp"
#include "frontalis/study/self_contact_model.hpp"
#include "study/stability/stability_cases.hpp"

#include <algorithm>
#include <cmath>

namespace frontalis
{
namespace
{

// Adds a body that may touch the lower or upper side of a box of full voxels, moved by a new bone with this name.
void touch(Model& model, const std::string& bone, bool upper, const SampledField& body, double friction)
{
  Contact contact = touching_side(model, upper, body);
  contact.name = bone;
  contact.friction = friction;
  contact.bone = static_cast<std::int32_t>(model.bones.size());
  model.bones.push_back(bone);
  model.contacts.push_back(contact);
}

// A wedge of 90 degrees along y that points down to (x, z) [m].
SampledField wedge(const Model& model, double x, double z)
{
  const auto distance = [=](const Point& p)
  {
    const double beside = std::abs(p[0] - x), above = p[2] - z;
    return above < -beside ? std::hypot(beside, above) : (beside - above) * std::sqrt(0.5);
  };
  constexpr double depth = 6e-3;  // largest depth of tissue in the wedge [m]
  return sample_band({ { x - depth, -1e-3, z } }, { { x + depth, 1e-3 * (model.size[1] + 1), z + depth } }, distance,
                     0.5e-3, depth);
}

Controls moved(const GuardedTrial& motion, const std::vector<Point>& shifts)
{
  Controls controls = motion.controls();
  for (std::size_t b = 0; b < shifts.size(); ++b)
    controls.bone[b] = shifted(shifts[b]);
  return controls;
}

Point way_of(const CaseRun& run, const std::string& key)
{
  const std::vector<double> way = run.numbers(key, "mm", 3);
  return { { 1e-3 * way[0], 1e-3 * way[1], 1e-3 * way[2] } };
}

Point plus(const Point& a, const Point& b) { return { { a[0] + b[0], a[1] + b[1], a[2] + b[2] } }; }

// Largest depth [m] of a point of the tissue inside the body that it touches.
double deepest(GuardedTrial& motion)
{
  const Model& model = motion.model();
  const Vectors u = motion.displacements();
  double deepest = 0;
  for (const Contact& contact : model.contacts)
  {
    const RigidTransform pose = contact.bone < 0 ? RigidTransform() : motion.solver().controls().bone[contact.bone];
    for (std::size_t p = 0; p < contact.points.size(); ++p)
    {
      const auto& at = contact.binding.coordinates[p];
      Point place{}, x = contact.points[p];
      for (std::size_t b = 0; b < 8; ++b)
        for (std::size_t axis = 0; axis < 3; ++axis)
          x[axis] += ((b & 1) != 0 ? double(at[0]) : 1 - double(at[0])) *
                     ((b & 2) != 0 ? double(at[1]) : 1 - double(at[1])) *
                     ((b & 4) != 0 ? double(at[2]) : 1 - double(at[2])) *
                     u[model.voxel_nodes[contact.binding.voxel[p]][b]][axis];
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
          place[i] += pose.rotation[3 * j + i] * (x[j] - pose.translation[j]);
      const double distance = level_at(contact.field, place);
      deepest = std::isnan(distance) ? deepest : std::max(deepest, -distance);
    }
  }
  return deepest;
}

// The last part of each case: after the body has left, the tissue must come to rest at its first position.
void let_rest(CaseRun& run, GuardedTrial& motion, const std::string& of, const std::string& picture,
              const std::string& title)
{
  motion.plot(picture, title);
  motion.advance({ run.seconds("rest"), motion.controls(), 20 });
  motion.check_balance(of);
  run.check("remaining displacement, " + of, "mm", 0, 1e3 * farthest(motion.displacements()), "left");
}

void finger(CaseRun& run)
{
  // Skin lies on fat, and fat on bone.
  VoxelBox box{ run.size(), { { 1e-3, 1e-3, 1e-3 } }, { neo_hookean(4e3, 0.49), neo_hookean(40e3, 0.49) } };
  box.material = [&](const Voxel& v) { return v[2] + 2 >= box.size[2] ? 1 : 0; };
  Model model = voxel_model(box);
  model.damping = run.number("damping", "1/s");
  hold_face(model, 2, false);
  const double radius = 1e-3 * run.number("radius", "mm");
  const Point tip{ { 1e-3 * run.number("from", "mm"), 0.5e-3 * model.size[1], 1e-3 * model.size[2] + radius } };
  touch(model, "finger", true, sphere_field(tip, radius), run.number("friction"));
  const Point pushed{ { 0, 0, -1e-3 * run.number("push", "mm") } }, drawn = plus(pushed, way_of(run, "draw"));
  GuardedTrial motion(run, model);
  motion.advance({ run.seconds("pushing"), moved(motion, { pushed }), 20 });
  run.check("depth of tissue in the finger", "mm", 0, 1e3 * deepest(motion), "depth");
  motion.advance({ run.seconds("drawing"), moved(motion, { drawn }), 20 });
  motion.advance({ run.seconds("lifting"), moved(motion, { plus(drawn, { { 0, 0, 2 * -pushed[2] } }) }), 20 });
  let_rest(run, motion, "pushed, drawn and lifted", "finger", "A finger is pushed into a cheek, drawn and lifted");
}

void blinking(CaseRun& run)
{
  // A lid in front of an eyeball, whose centre is the middle of the grid. The lid hangs from a bone that turns about x.
  const double eye = 1e-3 * run.number("eye", "mm"), thick = 1e-3 * run.number("thickness", "mm");
  const auto half = static_cast<std::int32_t>(std::ceil(1e3 * (eye + thick)) + 1);
  const Point centre{ { 1e-3 * half, 1e-3 * half, 0 } };
  const double half_width = run.number("half_width", "rad"), height = run.number("height", "rad");
  // Polar coordinates: angle about z, angle above the equator, distance from the centre.
  const auto polar = [=](const Point& p) -> Point
  {
    const double x = p[0] - centre[0], y = p[1] - centre[1], z = p[2] - centre[2], r = std::hypot(x, y, z);
    return { { std::atan2(x, z), std::asin(y / r), r } };
  };
  VoxelBox box{ { { 2 * half, 2 * half, half } }, { { 1e-3, 1e-3, 1e-3 } }, { soft_tissue() } };
  box.fill = sampled_fill(box.spacing,
                          [&](const Point& p)
                          {
                            const Point q = polar(p);
                            return std::abs(q[0]) < half_width && std::abs(q[1]) < 0.5 * height && q[2] > eye &&
                                   q[2] < eye + thick;
                          });
  Model model = voxel_model(box);
  model.damping = run.number("damping", "1/s");
  hold(
      model, [&](const Point& p) { return polar(p)[1] > 0.5 * height - 1.5e-3 / eye; }, "lid");
  Contact contact;
  contact.name = "eye";
  contact.friction = run.number("friction");
  contact.field = sphere_field(centre, eye);
  const TriangleMesh underside =
      grid_mesh(24, 24,
                [&](double s, double t) -> Point
                {
                  const double a = (2 * s - 1) * half_width, b = (t - 0.5) * height;
                  return { { centre[0] + eye * std::cos(b) * std::sin(a), centre[1] + eye * std::sin(b),
                             centre[2] + eye * std::cos(b) * std::cos(a) } };
                });
  set_points(contact, underside, bind_points(model, underside.vertices));
  model.contacts.push_back(contact);
  GuardedTrial motion(run, model);
  const double blink = run.seconds("blink");
  const auto turned = [&](double turn)
  {
    Controls controls = motion.controls(0, turned_about({ { turn, 0, 0 } }, centre));
    controls.bone[0].translation[2] -= 1e-3 * run.number("pressed", "mm");
    return controls;
  };
  Vectors shut_before;
  double worst = 0, depth = 0;
  const int blinks = static_cast<int>(run.count("blinks"));
  motion.advance({ blink, turned(0) });
  for (int i = 0; i < blinks; ++i)
  {
    motion.advance({ 0.5 * blink, turned(run.number("turn", "rad")) });
    const Vectors shut = motion.displacements();
    depth = std::max(depth, deepest(motion));
    motion.advance({ 0.5 * blink, turned(0) });
    // The initial vibration has died away by the 20th blink.
    if (i == 20)
      shut_before = shut;
    if (i > 20)
      worst = std::max(worst, farthest(shut, shut_before));
    run.settings.watch((i + 1.0) / blinks);
  }
  motion.plot("blinking", "A lid is drawn over an eye, a hundred times");
  motion.check_balance("all blinks");
  run.check("deviation from the 20th blink", "um", 0, 1e6 * worst, "blink");
  run.check("depth of the lid in the eye", "mm", 0, 1e3 * depth, "depth");
}

void body_jump(CaseRun& run)
{
  Model model = damped_block(run);
  hold_face(model, 2, false);
  touch(model, "body", true, flat_body(1e-3 * model.size[2] + 1e-6, 1), run.number("friction"));
  const Controls jumped{ {}, { shifted(way_of(run, "jump")) } };
  const double step = make_solver(std::make_shared<const Model>(model))->time_step();
  for (const auto& [name, seconds] :
       { std::pair<std::string, double>{ "frame", run.seconds("frame") }, { "millisecond", 1e-3 }, { "step", step } })
  {
    GuardedTrial motion(run, model);
    motion.advance({ seconds, jumped });
    motion.advance({ run.seconds("watched"), jumped, 40 });
    run.check("depth of tissue in the body, within a " + name, "mm", 0, 1e3 * deepest(motion), "depth");
    motion.advance({ seconds, motion.controls() });
    let_rest(run, motion, "there and back within a " + name, "body_jump_" + name,
             "A body jumps into tissue by a voxel within a " + name + ", and out");
  }
}

void sharp_edge(CaseRun& run)
{
  Model model = damped_block(run);
  hold_face(model, 2, false);
  touch(model, "edge", true, wedge(model, 1e-3 * run.number("from", "mm"), 1e-3 * model.size[2]),
        run.number("friction"));
  const Point pressed{ { 0, 0, -1e-3 * run.number("press", "mm") } }, drawn = plus(pressed, way_of(run, "draw"));
  GuardedTrial motion(run, model);
  motion.advance({ run.seconds("pressing"), moved(motion, { pressed }), 20 });
  motion.advance({ run.seconds("drawing"), moved(motion, { drawn }), 20 });
  motion.advance({ run.seconds("lifting"), moved(motion, { plus(drawn, { { 0, 0, -2 * pressed[2] } }) }), 10 });
  let_rest(run, motion, "pressed in and drawn", "sharp_edge", "A wedge of 90° is pressed into tissue and drawn along");
}

void pinched_sheet(CaseRun& run)
{
  // A sheet with the thickness of one voxel, held at its ends, between two fingertips.
  Model model = damped_block(run);
  hold_ends(model, 0);
  const double radius = 1e-3 * run.number("radius", "mm"), top = 1e-3 * model.size[2];
  const Point middle{ { 0.5e-3 * model.size[0], 0.5e-3 * model.size[1], 0 } };
  touch(model, "lower", false, sphere_field(plus(middle, { { 0, 0, -radius } }), radius), run.number("friction"));
  touch(model, "upper", true, sphere_field(plus(middle, { { 0, 0, top + radius } }), radius), run.number("friction"));
  const double pinch = 1e-3 * run.number("pinch", "mm");
  const Point draw = way_of(run, "draw"), up{ { 0, 0, pinch } }, down{ { 0, 0, -pinch } };
  const Point apart{ { 0, 0, 4 * pinch } }, below{ { 0, 0, -4 * pinch } };
  GuardedTrial motion(run, model);
  motion.advance({ run.seconds("pinching"), moved(motion, { up, down }), 20 });
  run.check("depth of the sheet in the fingertips", "mm", 0, 1e3 * deepest(motion), "depth");
  motion.advance({ run.seconds("drawing"), moved(motion, { plus(up, draw), plus(down, draw) }), 20 });
  motion.advance({ run.seconds("opening"), moved(motion, { plus(below, draw), plus(apart, draw) }), 10 });
  let_rest(run, motion, "pinched, drawn and let go", "pinched_sheet", "A thin sheet is pinched, drawn and let go");
}

void lips(CaseRun& run)
{
  // Two lips that are joined at the corners of the mouth and held by bones above and below. A muscle runs around them
  // as a ring.
  const Voxel size = run.size();
  const std::int32_t slit = size[2] / 2, corner = static_cast<std::int32_t>(run.number("corner"));
  VoxelBox box{ size, { { 1e-3, 1e-3, 1e-3 } }, { soft_tissue() } };
  box.fill = [&](const Voxel& v) { return v[2] == slit && v[0] >= corner && v[0] < size[0] - corner ? 0.0 : 1.0; };
  Model model = voxel_model(box);
  model.damping = run.number("damping", "1/s");
  const double x0 = 0.5 * size[0], z0 = slit + 0.5;
  add_muscles(model, { Muscle{ "ring", 1e6 * run.number("stress", "MPa"), true, true } },
              [&](std::size_t e)
              {
                // The ring is an ellipse around the slit; fibres run along it.
                const auto& v = model.voxels[e];
                const double a = x0 - 0.5 * corner, b = run.number("half_height"), x = (v[0] + 0.5 - x0) / a,
                             z = (v[2] + 0.5 - z0) / b, radius = std::hypot(x, z);
                if (radius < 0.5 || radius > 1.2)
                  return std::vector<Fibre>();
                const double tx = -z / b, tz = x / a, along = std::hypot(tx, tz);
                return std::vector<Fibre>{
                  { 0, { { static_cast<float>(tx / along), 0, static_cast<float>(tz / along) } }, 0.5F }
                };
              });
  hold_face(model, 2, false, "jaw");
  hold_face(model, 2, true, "skull");
  const auto side = [&](std::int32_t k, bool faces_up)
  {
    return grid_mesh(2 * (size[0] - 2 * corner), 2 * size[1],
                     [&](double s, double t) -> Point
                     {
                       const double x = corner + (faces_up ? s : 1 - s) * (size[0] - 2 * corner);
                       return { { 1e-3 * x, 1e-3 * t * size[1], 1e-3 * k } };
                     });
  };
  let_touch(model, { side(slit, true), side(slit + 1, false) }, run.number("friction"));
  GuardedTrial motion(run, model);
  const auto opened = [&](float activation, double millimetres)
  {
    Controls controls = motion.controls(activation);
    controls.bone[0] = shifted({ { 0, 0, -1e-3 * millimetres } });
    return controls;
  };
  const double shut = run.number("shut", "mm"), open = run.number("open", "mm");
  motion.advance({ run.seconds("pressing"), opened(1, -shut), 20 });
  // The two sides of the slit are grids with equal numbers of nodes.
  const Vectors u = motion.displacements();
  double overlap = -1;
  const auto across = nodes_where(model, [&](const Point& p) { return std::lround(1e3 * p[2]) == slit; });
  for (const auto n : across)
    for (const auto m : nodes_where(model,
                                    [&](const Point& p)
                                    {
                                      return p[0] == rest_position(model, n)[0] && p[1] == rest_position(model, n)[1] &&
                                             std::lround(1e3 * p[2]) == slit + 1;
                                    }))
      overlap = std::max(overlap, 1e3 * (u[n][2] - u[m][2]) - 1);
  run.check("overlap of the lips", "mm", 0, std::max(overlap, 0.0), "overlap");
  run.check("lips apart", "mm", 0, std::max(-overlap, 0.0), "apart");
  motion.advance({ run.seconds("tearing"), opened(1, open), 20 });
  motion.advance({ run.seconds("closing"), opened(0, 0), 20 });
  let_rest(run, motion, "pressed, torn open and closed", "lips", "Lips are pressed by full activation and torn open");
}

}  // namespace

CaseFunctions hard_contacts()
{
  return { { "finger", finger },         { "blinking", blinking },           { "body_jump", body_jump },
           { "sharp_edge", sharp_edge }, { "pinched_sheet", pinched_sheet }, { "lips", lips } };
}

}  // namespace frontalis
