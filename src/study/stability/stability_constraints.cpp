// Hard cases of constraints: ridges, edges, two surfaces at once, bones that jump, a head that is turned.

#include "frontalis/model/sample_field.hpp"
#include "frontalis/runner/named_controls.hpp"
#include "frontalis/solver/rigid_motion.hpp"
#include "study/stability/stability_cases.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace frontalis
{
namespace
{

// Corners (x, z) [m] of a surface that is infinite along y.
using Profile = std::vector<std::array<double, 2>>;

// Distance from a surface, positive above it. With `thin` it is positive on both sides, so that nodes can pass round
// the surface's ends.
double distance_to(const Profile& profile, bool thin, const Point& p)
{
  double nearest = 1e300, height = 0;
  for (std::size_t i = 0; i + 1 < profile.size(); ++i)
  {
    const auto [x, z] = profile[i];
    const double dx = profile[i + 1][0] - x, dz = profile[i + 1][1] - z;
    const double along = ((p[0] - x) * dx + (p[2] - z) * dz) / (dx * dx + dz * dz), on = std::clamp(along, 0.0, 1.0);
    nearest = std::min(nearest, std::hypot(p[0] - x - on * dx, p[2] - z - on * dz));
    if (i == 0 || p[0] > x)
      height = p[2] - z - (p[0] - x) * dz / dx;
  }
  return thin || height > 0 ? nearest : -nearest;
}

// Lets the nodes that fulfil a condition slide on a surface.
void slide(Model& model, const Profile& profile, const Condition& condition)
{
  slide_on(
      model, fmt::format("surface {}", model.constraint_surfaces.size()),
      [&](const Point& p) { return distance_to(profile, false, p); }, nodes_where(model, condition), 0.5e-3, 100e-3);
}

// Largest deviation of sliding nodes from their level in the field of their surface [m], and their largest displacement
// along x [m].
std::pair<double, double> slid(const GuardedTrial& motion)
{
  double worst = 0, travel = 0;
  const Vectors u = motion.displacements();
  for (const auto& node : motion.model().sliding)
  {
    auto p = rest_position(motion.model(), node.node);
    for (std::size_t axis = 0; axis < 3; ++axis)
      p[axis] += u[node.node][axis];
    const double error = level_at(motion.model().constraint_surfaces[node.surface].field, p) - node.distance;
    // There is no level where the field ends.
    worst = std::isnan(error) ? 1 : std::max(worst, std::abs(error));
    travel = std::max(travel, std::abs(u[node.node][0]));
  }
  return { worst, travel };
}

bool underside(const Point& p) { return p[2] < 0.5e-3; }

// Advances by the case's `drag` [s] in forty parts, with activation(i) in part i. Checks the levels of sliding nodes
// after each part, and finally that nodes have moved by `least_travel` [mm] along x.
void drag(
    CaseRun& run, GuardedTrial& motion, const std::string& of, double least_travel,
    const std::function<float(int)>& activation = [](int) { return 0.0F; })
{
  constexpr int parts = 40;
  const double seconds = run.seconds("drag") / parts;
  double worst = 0, travel = 0;
  for (int i = 0; i < parts; ++i)
  {
    motion.advance({ seconds, motion.controls(activation(i)) });
    const auto [error, moved] = slid(motion);
    worst = std::max(worst, error);
    travel = std::max(travel, moved);
  }
  motion.check_balance(of);
  run.check("error of kept levels, " + of, "um", 0, 1e6 * worst, "kept_level");
  run.trial.checks.absolute("shortfall from " + readable(least_travel) + " mm of travel", "mm", 0,
                            std::max(0.0, least_travel - 1e3 * travel), 0);
}

void sharp_ridge(CaseRun& run)
{
  // A ridge with an angle of 53° at its top obstructs a soft block, which starts above the left slope and the top.
  Model model = damped_block(run);
  model.materials = { neo_hookean(10e3, 0.49) };
  const double ridge = 1e-3 * run.number("ridge", "mm");
  slide(model, { { ridge - 49e-3, -98e-3 }, { ridge, -1e-3 }, { ridge + 49e-3, -98e-3 } }, underside);
  model.gravity = { { run.number("pull", "m/s2"), 0, 0 } };
  GuardedTrial motion(run, model);
  drag(run, motion, "over the ridge", run.number("least_way", "mm"));
  motion.plot("sharp_ridge", "A soft block is dragged over a ridge of 53°");
}

void off_the_edge(CaseRun& run)
{
  const std::vector<double> rims = run.numbers("rims", "mm");
  const std::vector<double> ways = run.numbers("least_ways", "mm", rims.size());
  for (std::size_t i = 0; i < rims.size(); ++i)
  {
    Model model = damped_block(run);
    // The spacing of the field is below two thirds of the nodes' distance from the sheet. The samples around a node are
    // then all on the node's side of the sheet.
    const Profile sheet{ { -40e-3, -0.3e-3 }, { 1e-3 * rims[i], -0.3e-3 } };
    slide_on(
        model, "sheet", [&](const Point& p) { return distance_to(sheet, true, p); }, nodes_where(model, underside),
        0.15e-3, 15e-3);
    model.gravity = { { run.number("pull", "m/s2"), 0, -9.81 } };
    GuardedTrial motion(run, model);
    drag(run, motion, "off an edge at " + readable(rims[i]) + " mm", ways[i]);
    motion.plot(fmt::format("off_the_edge_{}", i + 1),
                fmt::format("A block is dragged off an edge at {:g} mm of the surface that it slides on", rims[i]));
  }
}

void two_surfaces(CaseRun& run)
{
  // A layer of one voxel between two surfaces, whose distance falls from 0.6 mm at the start to 0.4 mm at the end.
  Model model = damped_block(run);
  slide(model, { { -40e-3, 0.2e-3 }, { 60e-3, 0.2e-3 } }, underside);
  slide(model, { { -40e-3, 0.8e-3 }, { 10e-3, 0.8e-3 }, { 30e-3, 0.6e-3 }, { 60e-3, 0.6e-3 } },
        [](const Point& p) { return !underside(p); });
  add_muscle(model, Muscle{ "sheet", 1e3 * run.number("stress", "kPa"), false, true }, along_x);
  model.gravity = { { run.number("pull", "m/s2"), 0, -9.81 } };
  GuardedTrial motion(run, model);
  drag(run, motion, "between two surfaces", run.number("least_way", "mm"),
       [](int part) { return part % 10 < 5 ? 1.0F : 0.0F; });
  motion.plot("two_surfaces", "A sheet of one voxel is drawn between surfaces 0.6 mm apart");
}

void two_bones(CaseRun& run)
{
  GuardedTrial motion(run, run.settings.scene("two_bones"));
  std::vector<GuardedTrial::Phase> phases;
  for (const std::string& name : run.words("expressions"))
    phases.push_back({ run.seconds("moving"), expression_controls(motion.model(), name), 10 });
  motion.play_and_release(phases, "pressed, parted, sheared and turned", "two_bones",
                          "Two bones, closer than two voxels, move against each other");
}

void bone_jump(CaseRun& run)
{
  Model model = damped_block(run);
  hold_face(model, 0, false, "bone");
  const std::vector<double> jump = run.numbers("jump", "mm", 3);
  const RigidTransform jumped = shifted({ { 1e-3 * jump[0], 1e-3 * jump[1], 1e-3 * jump[2] } });
  const double frame = run.seconds("frame"), step = make_solver(std::make_shared<const Model>(model))->time_step();
  const std::pair<std::string, double> times[] = { { "frame", frame }, { "millisecond", 1e-3 }, { "step", step } };
  for (const auto& [name, seconds] : times)
  {
    GuardedTrial motion(run, model);
    motion.advance({ seconds, motion.controls(0, jumped), 1 });
    motion.advance({ run.seconds("watched"), motion.controls(0, jumped), 40 });
    motion.check_balance("within a " + name);
    motion.plot("bone_jump_" + name, "A bone jumps by 5 mm within a " + name);
    motion.advance({ run.seconds("rest"), motion.controls(0, jumped), 10 });
    const Vectors moved(model.nodes.size(), jumped.translation);
    run.check("distance from the goal after a jump within a " + name, "um", 0,
              1e6 * farthest(motion.displacements(), moved), "place");
  }
}

// Turns the bone, which changes the direction of gravity relative to the tissue that is attached to it.
void turning_gravity(CaseRun& run)
{
  Model model = damped_block(run);
  model.gravity = { { 0, 0, -9.81 } };
  hold_face(model, 0, false, "head");
  GuardedTrial motion(run, model);
  std::mt19937 random(3);
  const double seconds = run.seconds("turn"), largest = run.number("largest_turn", "rad");
  const int turns = static_cast<int>(run.number("turns"));
  motion.advance({ seconds, motion.controls(), 10 });
  for (int turn = 0; turn < turns; ++turn)
  {
    Point axis{ { drawn_from(random), drawn_from(random), drawn_from(random) } };
    const double angle = largest / std::hypot(axis[0], axis[1], axis[2]) * drawn_from(random);
    for (double& x : axis)
      x *= angle;
    motion.advance({ seconds, motion.controls(0, turned_about(axis, { { 0, 2e-3, 2e-3 } })), 4 });
  }
  motion.check_balance("turned at random", "turning_gravity",
                       "Gravity is switched on at once, and the head turned at random every 20 ms");
  motion.settle(motion.solver().controls());
  run.check("smallest J at rest", "1", 1, motion.monitor().worst_jacobian, "smallest_J");
}

}  // namespace

CaseFunctions hard_constraints()
{
  return { { "sharp_ridge", sharp_ridge }, { "off_the_edge", off_the_edge }, { "two_surfaces", two_surfaces },
           { "two_bones", two_bones },     { "bone_jump", bone_jump },       { "turning_gravity", turning_gravity } };
}

}  // namespace frontalis
