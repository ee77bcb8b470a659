// what constraints make hard: ridges, edges, two surfaces at once, bones that jump, a head that is turned

#include "frontalis/physics/closest_point.hpp"
#include "frontalis/solver/rigid_motion.hpp"
#include "stability_cases.hpp"
#include "stability_models.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace frontalis
{
namespace
{

using Point = std::array<double, 3>;

physics::Vec3<double> vector(const Point& p) { return { p[0], p[1], p[2] }; }

double distance_to(const TriangleMesh& mesh, const Point& p)
{
  double nearest = 1e300;
  for (const auto& t : mesh.triangles)
  {
    const auto foot = physics::closest_point(vector(p), vector(mesh.vertices[t[0]]), vector(mesh.vertices[t[1]]),
                                             vector(mesh.vertices[t[2]]));
    nearest = std::min(nearest, norm(vector(p) - foot));
  }
  return nearest;
}

// the nodes for which the condition holds slide on a surface at the distance that they have
void slide(Model& model, const TriangleMesh& mesh, const std::function<bool(const Point&)>& condition, double sign = 1)
{
  const auto surface = static_cast<std::int32_t>(model.constraint_surfaces.size());
  model.constraint_surfaces.push_back({ "surface " + std::to_string(surface), mesh });
  for (const auto node : nodes_where(model, condition))
    model.sliding.push_back({ node, surface, sign * distance_to(mesh, rest_position(model, node)) });
}

// largest error of the distances that sliding nodes keep [m], and how far one has come along x
std::pair<double, double> slid(const WatchedMotion& motion)
{
  double worst = 0, way = 0;
  const Vectors u = motion.displacements();
  for (const auto& node : motion.model().sliding)
  {
    auto p = rest_position(motion.model(), node.node);
    for (std::size_t axis = 0; axis < 3; ++axis)
      p[axis] += u[node.node][axis];
    const double now = distance_to(motion.model().constraint_surfaces[node.surface].mesh, p);
    worst = std::max(worst, std::abs(now - std::abs(node.distance)));
    way = std::max(way, std::abs(u[node.node][0]));
  }
  return { worst, way };
}

TriangleMesh strip_of(const std::vector<std::array<double, 2>>& profile)
{
  TriangleMesh mesh;
  for (const auto& [x, z] : profile)
    for (const double y : { -30e-3, 30e-3 })
      mesh.vertices.push_back({ { x, y, z } });
  for (std::int32_t i = 0; i + 1 < static_cast<std::int32_t>(profile.size()); ++i)
  {
    mesh.triangles.push_back({ { 2 * i, 2 * i + 2, 2 * i + 1 } });
    mesh.triangles.push_back({ { 2 * i + 1, 2 * i + 2, 2 * i + 3 } });
  }
  return mesh;
}

bool underside(const Point& p) { return p[2] < 0.5e-3; }

void drag(const StabilitySettings& settings, Trial& trial, const Model& model, const std::string& name,
          const std::string& title, double least_way)
{
  WatchedMotion motion(settings, trial, model);
  double worst = 0, way = 0;
  for (int i = 0; i < 40; ++i)
  {
    motion.advance(4e-3, motion.controls());
    const auto [error, come] = slid(motion);
    worst = std::max(worst, error);
    way = std::max(way, come);
  }
  const std::string of = name == "sharp_ridge" ? "over the ridge" : "off the edge";
  motion.expect_balance(of, 0.05);
  motion.plot(name, title);
  trial.checks.push_back(absolute_check("error of kept distances, " + of, "um", 0, 1e6 * worst, 20));
  trial.checks.push_back(absolute_check("has come that far short of " + readable(1e3 * least_way) + " mm", "mm", 0,
                                        std::max(0.0, 1e3 * (least_way - way)), 0));
}

void sharp_ridge(const StabilitySettings& settings, Trial& trial)
{
  // a roof of 53° in the way of a soft block; its nodes start over the left slope and the ridge
  VoxelBox box;
  box.size = { { 8, 3, 2 } };
  box.materials = { neo_hookean(10e3, 0.49) };
  Model model = voxel_model(box);
  model.damping = 50;
  slide(model, strip_of({ { -40e-3, -98e-3 }, { 9e-3, -1e-3 }, { 58e-3, -98e-3 } }), underside);
  model.gravity = { { 60, 0, 0 } };
  drag(settings, trial, model, "sharp_ridge", "A soft block is dragged over a ridge of 53°", 5e-3);
}

void off_the_edge(const StabilitySettings& settings, Trial& trial)
{
  Model model = soft_block({ { 8, 3, 2 } });
  model.damping = 50;
  slide(model, strip_of({ { -40e-3, -0.3e-3 }, { 12.7e-3, -0.3e-3 } }), underside);
  model.gravity = { { 30, 0, -9.81 } };
  drag(settings, trial, model, "off_the_edge", "A block is dragged off the edge of the surface that it slides on",
       5e-3);
}

void two_surfaces(const StabilitySettings& settings, Trial& trial)
{
  // one voxel between surfaces that are 0.6 mm apart where it starts, and 0.4 mm where it is drawn to
  Model model = soft_block({ { 12, 4, 1 } });
  model.damping = 50;
  slide(model, strip_of({ { -40e-3, 0.2e-3 }, { 60e-3, 0.2e-3 } }), underside, -1);
  slide(model, strip_of({ { -40e-3, 0.8e-3 }, { 10e-3, 0.8e-3 }, { 30e-3, 0.6e-3 }, { 60e-3, 0.6e-3 } }),
        [](const Point& p) { return !underside(p); });
  add_muscles(model, { Muscle{ "sheet", 50e3, false, true } },
              [](std::size_t) -> std::vector<Fibre> {
                return { { 0, { { 1, 0, 0 } } } };
              });
  model.gravity = { { 60, 0, -9.81 } };
  WatchedMotion motion(settings, trial, model);
  double worst = 0, way = 0;
  for (int i = 0; i < 40; ++i)
  {
    motion.advance(2e-3, motion.controls(i % 10 < 5 ? 1 : 0));
    const auto [error, come] = slid(motion);
    worst = std::max(worst, error);
    way = std::max(way, come);
  }
  motion.expect_balance("between two surfaces", 0.05);
  motion.plot("two_surfaces", "A sheet of one voxel is drawn between surfaces 0.6 mm apart");
  trial.checks.push_back(absolute_check("error of kept distances", "um", 0, 1e6 * worst, 20));
  trial.checks.push_back(absolute_check("has come that far short of 5 mm", "mm", 0, std::max(0.0, 5 - 1e3 * way), 0));
}

void bone_jump(const StabilitySettings& settings, Trial& trial)
{
  Model model = soft_block({ { 6, 6, 6 } });
  model.damping = 50;
  hold_face(model, 0, false, "bone");
  const RigidTransform jumped{ RigidTransform().rotation, { { 3e-3, 4e-3, 0 } } };
  const double frame = 1.0 / 30, step = make_solver(std::make_shared<const Model>(model))->time_step();
  for (const auto& jump : { std::pair("frame", frame), std::pair("millisecond", 1e-3), std::pair("step", step) })
  {
    const std::string name = jump.first;
    const double seconds = jump.second;
    WatchedMotion motion(settings, trial, model);
    // ten times as fast as sound in the tissue
    const bool violent = seconds < 1e-4;
    const auto play = [&]
    {
      motion.advance(seconds, motion.controls(0, jumped), 1);
      motion.advance(20e-3, motion.controls(0, jumped), 40);
      motion.expect_balance("within a " + name, 0.05);
    };
    if (violent)
      motion.hold_or_stop(play);
    else
      play();
    motion.plot("bone_jump_" + name, "A bone jumps by 5 mm within a " + name);
    if (violent && !trial.stopped.empty())
      continue;
    motion.advance(0.3, motion.controls(0, jumped), 10);
    Vectors moved(model.nodes.size(), { { 3e-3, 4e-3, 0 } });
    trial.checks.push_back(absolute_check(std::string("off its place after a jump within a ") + name, "um", 0,
                                          1e6 * farthest(motion.displacements(), moved), 20));
  }
}

// a bone that is turned turns gravity for what hangs on it
void turning_gravity(const StabilitySettings& settings, Trial& trial)
{
  Model model = soft_block({ { 8, 4, 4 } });
  model.damping = 20;
  model.gravity = { { 0, 0, -9.81 } };
  hold_face(model, 0, false, "head");
  WatchedMotion motion(settings, trial, model);
  std::mt19937 random(3);
  const auto value = [&] { return 2 * (static_cast<double>(random()) / 4294967295.0) - 1; };
  motion.advance(20e-3, motion.controls(), 10);
  for (int turn = 0; turn < 20; ++turn)
  {
    Point axis{ { value(), value(), value() } };
    const double angle = 3 / std::hypot(axis[0], axis[1], axis[2]) * value();
    for (double& x : axis)
      x *= angle;
    motion.advance(20e-3, motion.controls(0, turned_about(axis, { { 0, 2e-3, 2e-3 } })), 4);
  }
  motion.expect_balance("turned at random", 0.02);
  motion.plot("turning_gravity", "Gravity is switched on at once, and the head turned at random every 20 ms");
  const Controls end = motion.solver().controls();
  motion.settle(end, 1e-4, 5);
  trial.checks.push_back(absolute_check("smallest J at rest", "1", 1, motion.monitor().worst_jacobian, 0.02));
}

}  // namespace

std::vector<StabilityCase> hard_constraints()
{
  return { { "sharp_ridge", true, "sliding over a ridge of 53 degrees",
             "A soft block is dragged over a ridge of 53°: at the ridge the tangent plane jumps. Kept distances err by "
             "at most 20 µm, and projection adds no energy: explained to 5 %. Put back to their planes at once and not "
             "in halves, the nodes of an undamped shell on a ball gained 43 % of its energy in 40 ms.",
             sharp_ridge },
           { "off_the_edge", true, "sliding off the edge of a surface",
             "A block is dragged off the edge of the surface that it slides on. Nodes that come to the rim go round it "
             "at their distance and hold the block there. Kept distances to 20 µm, energy explained to 5 %.",
             off_the_edge },
           { "two_surfaces", true, "two sliding surfaces closer than a voxel",
             "A sheet of one voxel between two surfaces 0.6 mm apart, which then come closer, drawn by gravity and a "
             "muscle that is switched. Kept distances to 20 µm, energy explained to 5 %.",
             two_surfaces },
           { "bone_jump", true, "a bone that jumps 5 mm in a frame, in a step",
             "A bone jumps by 5 mm, five voxels, within a frame (33 ms), a millisecond and one time step. It must be "
             "followed, and the tissue be at rest in its new place to 20 µm. Within one step, which is ten times as "
             "fast as sound in the tissue, voxels turn inside out; the motion may be stopped there with a report. "
             "Steps in which a bone moves by more than a tenth of a voxel are cut: without this the energy was 29 "
             "times what the ledger explains.",
             bone_jump },
           { "turning_gravity", true, "gravity at once, the head turned at random",
             "Gravity is switched on at once for a block that hangs on a bone, and the bone is turned at random, by up "
             "to 3 rad, every 20 ms. Energy explained to 2 %, and rest in the end.",
             turning_gravity } };
}

}  // namespace frontalis
